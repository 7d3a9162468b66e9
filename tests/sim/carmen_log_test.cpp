// tests/sim/carmen_log_test.cpp: good, short, overlong and garbage lines; units and device codes.
#include "sim/carmen_log.hpp"

#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace sim {
namespace {

constexpr double kPi = std::numbers::pi;

std::string flaser(std::size_t n, const std::string& reading = "1.5") {
  std::string line = "FLASER " + std::to_string(n);
  for (std::size_t i = 0; i < n; ++i) line += " " + reading;
  return line + " 1 2 0.5 3 4 0.25 10.5 pippo 0.1";
}

std::string reason_of(const std::string& line) {
  const CarmenLine parsed = parse_carmen_line(line);
  const auto* error = std::get_if<CarmenError>(&parsed);
  return error ? error->reason : "";
}

TEST(CarmenLog, FlaserFields) {
  const CarmenLine line =
      parse_carmen_line("FLASER 3 1.65 81.91 0.5 1 2 0.5 3 4 0.25 10.5 host 0.1");
  const auto& scan = std::get<CarmenScan>(line);
  EXPECT_EQ(scan.laser, CarmenLaser::Front);
  EXPECT_EQ(scan.readings, (std::vector<double>{1.65, 81.91, 0.5}));
  EXPECT_EQ(scan.laser_W, (algo::Pose2{1, 2, 0.5}));
  EXPECT_EQ(scan.robot_W, (algo::Pose2{3, 4, 0.25}));
  EXPECT_EQ(scan.stamp, 10.5);
}

TEST(CarmenLog, AnglesOfEachBeamCount) {
  struct Row {
    std::size_t beams;
    double step_degrees, last_degrees;
  };
  for (const Row& row :
       {Row{180, 1, 89}, Row{181, 1, 90}, Row{360, 0.5, 89.5}, Row{361, 0.5, 90}}) {
    const auto scan = std::get<CarmenScan>(parse_carmen_line(flaser(row.beams)));
    ASSERT_EQ(scan.readings.size(), row.beams);
    EXPECT_NEAR(scan.angle_min, -kPi / 2, 1e-12);
    EXPECT_NEAR(scan.angle_increment * 180 / kPi, row.step_degrees, 1e-12);
    const double last = scan.angle_min + static_cast<double>(row.beams - 1) * scan.angle_increment;
    EXPECT_NEAR(last * 180 / kPi, row.last_degrees, 1e-9);
  }
}

TEST(CarmenLog, RobotlaserBringsItsOwnAngles) {
  const auto scan = std::get<CarmenScan>(
      parse_carmen_line("ROBOTLASER1 0 -1.5 3.0 1.0 81.9 0.01 0 3 1 2 3 2 100 200 "
                        "5 6 0.1 7 8 0.2 0.3 0.4 0 0 0 99.5 host 0.1"));
  EXPECT_EQ(scan.angle_min, -1.5);
  EXPECT_EQ(scan.angle_increment, 1.0);
  EXPECT_EQ(scan.readings, (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(scan.laser_W, (algo::Pose2{5, 6, 0.1}));
  EXPECT_EQ(scan.robot_W, (algo::Pose2{7, 8, 0.2}));
  EXPECT_EQ(scan.stamp, 99.5);
}

TEST(CarmenLog, RearLaserAndOdometry) {
  std::string rear = flaser(3);
  rear[0] = 'R';
  EXPECT_EQ(std::get<CarmenScan>(parse_carmen_line(rear)).laser, CarmenLaser::Rear);
  EXPECT_TRUE(std::holds_alternative<CarmenOdometry>(
      parse_carmen_line("ODOM 1 2 0.5 0.3 -0.1 0 7.5 host 0.2\r")));
}

TEST(CarmenLog, OtherMessagesAreSkippedNotRejected) {
  for (const char* line : {"",
                           "   ",
                           "# FLASER 3 1 2 3",
                           "PARAM robot_length 0.5 nohost 0",
                           "NEFF 12.5 0.1 host 0.1",
                           "TRUEPOS 1 2 3",
                           "FLASERX 1"}) {
    EXPECT_TRUE(std::holds_alternative<CarmenOther>(parse_carmen_line(line))) << line;
  }
}

TEST(CarmenLog, DamagedLinesGiveASentence) {
  EXPECT_EQ(reason_of("FLASER"), "the number of readings is missing or out of bounds");
  EXPECT_EQ(reason_of("FLASER 1e9 1 2 3"), "the number of readings is missing or out of bounds");
  EXPECT_EQ(reason_of("FLASER 2.5 1 2 3"), "the number of readings is missing or out of bounds");
  EXPECT_EQ(reason_of("FLASER 3 1 2"), "reading 3 of 3 is missing or not a distance");
  EXPECT_EQ(reason_of("FLASER 3 1 nan 3 0 0 0 0 0 0 1 h 1"),
            "reading 2 of 3 is missing or not a distance");
  EXPECT_EQ(reason_of("FLASER 3 1 -2 3 0 0 0 0 0 0 1 h 1"),
            "reading 2 of 3 is missing or not a distance");
  EXPECT_EQ(reason_of("FLASER 3 1 2 3 0 0 0 0 0 inf 1 h 1"),
            "the poses after the readings are incomplete");
  EXPECT_NE(reason_of("FLASER 3 1 2 3 0 0 0 0 0 0 1 h"), "");
  EXPECT_NE(reason_of("FLASER 3 1 2 3 0 0 0 0 0 0 1 h 1 extra"), "");
  EXPECT_NE(reason_of("ODOM 1 2 nan 0 0 0 1 h 1"), "");
  EXPECT_NE(reason_of("ODOM 1 2 0.5"), "");
  EXPECT_NE(reason_of("ROBOTLASER1 0 -1.5 3.0 0 81.9 0.01 0 3 1 2 3 0"), "");
  EXPECT_NE(reason_of("ROBOTLASER1 0 -1.5 3.0 1.0 81.9 0.01 0 3 1 2 3 5 1 2"), "");
}

TEST(CarmenLog, CutAtEveryPositionALineIsNeverMoreThanAnError) {
  const std::string line = flaser(20, "2.34");
  ASSERT_TRUE(std::holds_alternative<CarmenScan>(parse_carmen_line(line)));
  // Whole only once the last field has its first character.
  for (std::size_t cut = 6; cut + 3 <= line.size(); ++cut) {
    const CarmenLine parsed = parse_carmen_line(line.substr(0, cut));
    EXPECT_TRUE(std::holds_alternative<CarmenError>(parsed)) << line.substr(0, cut);
  }
}

TEST(CarmenLog, GarbageNeverCrashes) {
  std::mt19937_64 random(1);
  const std::string good = flaser(10);
  std::size_t refused = 0;
  for (int i = 0; i < 20000; ++i) {
    std::string line = good;
    for (int k = 0; k < 4; ++k)
      line[7 + random() % (line.size() - 7)] = static_cast<char>(random());
    const CarmenLine parsed = parse_carmen_line(line);
    if (const auto* scan = std::get_if<CarmenScan>(&parsed)) {
      for (const double reading : scan->readings) EXPECT_TRUE(reading >= 0 && reading <= 1000);
    } else {
      ++refused;
    }
  }
  EXPECT_GT(refused, 10000u);
}

TEST(CarmenUnits, AreInferredFromTheReadings) {
  const auto guess = [](std::initializer_list<std::uint32_t> readings_mm) {
    CarmenUnitGuess result;
    for (const std::uint32_t reading : readings_mm) result.see(reading);
    return result.unit();
  };
  EXPECT_EQ(guess({1650, 81910, 40}), CarmenUnit::Centimetre);
  EXPECT_EQ(guess({1653, 8191}), CarmenUnit::Millimetre8m);
  EXPECT_EQ(guess({1653, 16383}), CarmenUnit::Millimetre16m);
  EXPECT_EQ(guess({1653, 32767}), CarmenUnit::Millimetre32m);
  EXPECT_EQ(guess({1653, 81910}), CarmenUnit::Centimetre);
  EXPECT_EQ(carmen_range_max(CarmenUnit::Centimetre), 81.91);
  EXPECT_EQ(carmen_range_max(CarmenUnit::Millimetre32m), 32.767);
}

TEST(CarmenUnits, DeviceCodesAreNeverDistances) {
  using algo::BeamCode;
  const auto code = [](BeamCode c) {
    return static_cast<std::uint16_t>(algo::kPackedCodeBase + static_cast<std::uint16_t>(c));
  };
  const auto cm = CarmenUnit::Centimetre;
  EXPECT_EQ(pack_carmen(1650, cm), 1650);
  EXPECT_EQ(pack_carmen(81790, cm), algo::kPackedMaxRange);  // 81.79 m, more than a beam can hold
  EXPECT_EQ(pack_carmen(81830, cm), algo::kPackedFree);      // 8183 = 1FF7
  EXPECT_EQ(pack_carmen(81860, cm), code(BeamCode::ReadError));   // 1FFA
  EXPECT_EQ(pack_carmen(81870, cm), code(BeamCode::WeakSignal));  // 1FFB
  EXPECT_EQ(pack_carmen(81890, cm), code(BeamCode::Overflow));    // 1FFD
  EXPECT_EQ(pack_carmen(81900, cm), code(BeamCode::Dazzled));     // 1FFE
  EXPECT_EQ(pack_carmen(81910, cm), code(BeamCode::NoEcho));      // 1FFF
  EXPECT_EQ(pack_carmen(81800, cm), code(BeamCode::Unknown));
  EXPECT_EQ(pack_carmen(100000, cm), code(BeamCode::Unknown));
  const auto mm = CarmenUnit::Millimetre32m;
  EXPECT_EQ(pack_carmen(32754, mm), 32754);
  EXPECT_EQ(pack_carmen(32755, mm), code(BeamCode::Unknown));
  EXPECT_EQ(pack_carmen(32759, mm), algo::kPackedFree);
  EXPECT_EQ(pack_carmen(32763, mm), code(BeamCode::WeakSignal));
  EXPECT_EQ(pack_carmen(32765, mm), code(BeamCode::Overflow));
  EXPECT_EQ(pack_carmen(32767, mm), code(BeamCode::NoEcho));
  EXPECT_EQ(pack_carmen(8182, CarmenUnit::Millimetre8m), 8182);
  EXPECT_EQ(pack_carmen(8191, CarmenUnit::Millimetre8m), code(BeamCode::NoEcho));
  EXPECT_EQ(pack_carmen(16375, CarmenUnit::Millimetre16m), algo::kPackedFree);
}

}  // namespace
}  // namespace sim
