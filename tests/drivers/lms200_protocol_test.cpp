// tests/drivers/lms200_protocol_test.cpp: writes and reads every telegram that is printed in the
// manual or computed from it.
#include "drivers/lms200_protocol.hpp"

#include "tests/drivers/lms200_telegrams.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace drivers::lms200 {
namespace {

using ::testing::HasSubstr;

/// A telegram owned by the test; also asserts that the printed bytes are an intact frame.
class Printed {
 public:
  explicit Printed(const std::string& text) {
    Kept kept;
    kept.feed(hex(text));
    EXPECT_EQ(kept.frames.size(), 1U) << text;
    if (!kept.frames.empty()) frame_ = kept.frames[0];
    EXPECT_EQ(frame_, hex(text));
  }
  Telegram telegram() const { return telegram_of(frame_); }

 private:
  Bytes frame_{};
};

Configuration configuration(std::uint8_t threshold_mv,
                            std::uint8_t availability,
                            std::uint8_t mode,
                            bool millimetres) {
  Bytes block = hex("00 00 00 00 00 00 00 00 00 02 02 21x00 02 00");
  block[2] = threshold_mv;
  block[4] = availability;
  Configuration result{block};
  result.set_measuring_mode(mode);
  result.set_millimetres(millimetres);
  return result;
}

struct PrintedRow {
  Command command;
  std::string bytes;
};

std::vector<PrintedRow> requests() {
  return {
      {status_command(), "02 00 01 00 31 15 12"},
      {type_command(), "02 00 01 00 3A 1E 12"},
      {read_configuration_command(), "02 00 01 00 74 50 12"},
      {rate_command(Rate::Baud9600), "02 00 02 00 20 42 52 08"},
      {rate_command(Rate::Baud19200), "02 00 02 00 20 41 51 08"},
      {rate_command(Rate::Baud38400), "02 00 02 00 20 40 50 08"},
      {rate_command(Rate::Baud500000), "02 00 02 00 20 48 58 08"},
      {mode_command(Mode::Continuous), "02 00 02 00 20 24 34 08"},
      {mode_command(Mode::OnRequest), "02 00 02 00 20 25 35 08"},
      {mode_command(Mode::PartialScans), "02 00 02 00 20 2A 3A 08"},
      {mode_command(Mode::Continuous, 1), "02 01 02 00 20 24 24 00"},
      {installation_command(), "02 00 0A 00 20 00 53 49 43 4B 5F 4C 4D 53 BE C5"},
      {variant_command({100, 100}), "02 00 05 00 3B 64 00 64 00 1D 0F"},
      {variant_command({100, 50}), "02 00 05 00 3B 64 00 32 00 B1 59"},
      {variant_command({100, 25}), "02 00 05 00 3B 64 00 19 00 E7 72"},
      {variant_command({180, 100}), "02 00 05 00 3B B4 00 64 00 97 49"},
      {variant_command({180, 50}), "02 00 05 00 3B B4 00 32 00 3B 1F"},
      {write_configuration_command(configuration(0x46, 0, 0, true)),
       "02 00 23 00 77 00 00 46 00 00 00 01 00 00 02 02 21x00 02 00 CD 67"},
      {write_configuration_command(configuration(0x46, 2, 6, true)),
       "02 00 23 00 77 00 00 46 00 02 06 01 00 00 02 02 21x00 02 00 8D A6"},
      {write_configuration_command(configuration(0x46, 0, 0, false)),
       "02 00 23 00 77 00 00 46 00 00 00 00 00 00 02 02 21x00 02 00 9D 57"},
      {write_configuration_command(configuration(0x70, 0, 4, true)),
       "02 00 23 00 77 00 00 70 00 00 04 01 00 00 02 02 21x00 02 00 94 8A"},
      {write_configuration_command(configuration(0x70, 0, 0, true)),
       "02 00 23 00 77 00 00 70 00 00 00 01 00 00 02 02 21x00 02 00 11 88"},
  };
}

TEST(Lms200Protocol, RequestsMatchTheManualAndDecodeAgain) {
  for (const PrintedRow& row : requests()) {
    EXPECT_EQ(bytes_of(row.command.view()), hex(row.bytes));
    Kept kept(Sender::Host);
    kept.feed(hex(row.bytes));
    EXPECT_EQ(kept.frames, std::vector<Bytes>{hex(row.bytes)});
  }
}

TEST(Lms200Protocol, FramesOfTheTestPasswordFitTheirCrc) {
  Kept kept(Sender::Host);
  const Bytes printed = hex("02 00 0A 00 20 30 53 49 43 4B 5F 4C 4D 53 EE F5");
  kept.feed(printed);
  EXPECT_EQ(kept.frames, std::vector<Bytes>{printed});
}

TEST(Lms200Protocol, UnsupportedSettingsGiveNoTelegram) {
  EXPECT_EQ(variant_command({180, 25}).size(), 0U);
  EXPECT_EQ(variant_command({90, 100}).size(), 0U);
  EXPECT_EQ(installation_command("short").size(), 0U);
}

TEST(Lms200Protocol, AnswersEncodeAsPrinted) {
  for (const char* text : {"02 80 03 00 A0 00 10 16 0A",
                           "02 81 03 00 A0 00 10 36 1A",
                           "02 80 02 00 92 10 7F 33",
                           "02 80 07 00 BB 00 B4 00 32 00 10 23 8D"}) {
    const Printed printed(text);
    const Telegram t = printed.telegram();
    EXPECT_EQ(framed(t.address, bytes_of(t.payload)), hex(text));
  }
}

TEST(Lms200Protocol, ModeAnswers) {
  EXPECT_EQ(refusal_text(Printed("02 80 03 00 A0 00 10 16 0A").telegram()), "");
  EXPECT_EQ(refusal_text(Printed("02 81 03 00 A0 00 10 36 1A").telegram()), "");
  EXPECT_THAT(refusal_text(Printed("02 80 03 00 A0 01 10 14 0B").telegram()),
              HasSubstr("password"));
  EXPECT_THAT(refusal_text(Printed("02 80 02 00 92 10 7F 33").telegram()), HasSubstr("refuses"));
  const Printed reset("02 80 02 00 91 10 79 30");
  EXPECT_EQ(reset.telegram().code(), static_cast<std::uint8_t>(Answer::ResetConfirmed));
  EXPECT_EQ(refusal_text(reset.telegram()), "");
}

TEST(Lms200Protocol, VariantAnswers) {
  EXPECT_EQ(variant_answer(Printed("02 80 07 00 BB 01 B4 00 32 00 10 03 9D").telegram()),
            (VariantAnswer{.done = true, .now = {180, 50}}));
  EXPECT_EQ(variant_answer(Printed("02 80 07 00 BB 00 B4 00 32 00 10 23 8D").telegram()),
            (VariantAnswer{.done = false, .now = {180, 50}}));
}

TEST(Lms200Protocol, TypeAndPowerOnTexts) {
  const Printed type(
      "02 80 17 00 BA 4C 4D 53 32 30 30 3B 33 30 31 30 36 33 3B 56 30 32 2E 31 30 20 10 22 61");
  EXPECT_EQ(type_text(type.telegram()), "LMS200;301063;V02.10 ");
  const Printed greeting(
      "02 80 17 00 90 4C 4D 53 32 30 30 3B 33 30 31 30 36 33 3B 56 30 32 2E 33 30 20 10 73 56");
  EXPECT_EQ(type_text(greeting.telegram()), "LMS200;301063;V02.30 ");
  // Misprinted as 63 56.
  const Printed old_greeting(
      "02 80 17 00 90 4C 4D 53 32 30 30 3B 33 30 31 30 36 33 3B 56 30 32 2E 31 30 20 10 63 5E");
  EXPECT_EQ(type_text(old_greeting.telegram()), "LMS200;301063;V02.10 ");
}

TEST(Lms200Protocol, ConfigurationAnswers) {
  const Printed written("02 80 25 00 F7 01 00 00 70 00 00 00 01 00 00 02 02 21x00 02 00 10 C5 7A");
  const auto answer = configuration_answer(written.telegram());
  ASSERT_TRUE(answer);
  EXPECT_TRUE(answer->done);
  EXPECT_EQ(answer->now, configuration(0x70, 0, 0, true));
  EXPECT_TRUE(answer->now.in_millimetres());
  EXPECT_FALSE(answer->now.sends_indices());

  // Old devices send a shorter block, which can be written back at that length.
  const Bytes read = framed(0x80, hex("F4 00 00 70 00 02 06 00 00 00 10"));
  const auto shorter = configuration_answer(telegram_of(read));
  ASSERT_TRUE(shorter);
  EXPECT_TRUE(shorter->done);
  EXPECT_TRUE(shorter->now.sends_indices());
  EXPECT_EQ(shorter->now.measuring_mode(), 6);
  EXPECT_EQ(telegram_of(write_configuration_command(shorter->now).view()).payload.size(), 10U);

  const Bytes refused = framed(0x80, hex("F7 00 00 00 70 00 00 00 01 00 00 02 02 21x00 02 00 10"));
  EXPECT_FALSE(configuration_answer(telegram_of(refused))->done);
  EXPECT_FALSE(configuration_answer(telegram_of(framed(0x80, hex("F4 00 00 70 00 10")))));
}

TEST(Lms200Protocol, StatusFieldsAreReadByTheirIndices) {
  Bytes payload(154, 0);
  const auto word = [&payload](std::size_t at, unsigned value) {
    payload[at] = static_cast<std::uint8_t>(value & 0xFFU);
    payload[at + 1] = static_cast<std::uint8_t>(value >> 8U);
  };
  payload[0] = 0xB1;
  std::copy_n("V02.30 ", 7, payload.begin() + 1);
  payload[102] = 6;
  word(107, 180);
  word(109, 50);
  payload[122] = 1;
  payload[153] = 0x10;
  const Bytes frame = framed(0x81, payload);
  const auto status = device_status(telegram_of(frame));
  ASSERT_TRUE(status);
  EXPECT_EQ(status->software, "V02.30 ");
  EXPECT_FALSE(status->faulty);
  EXPECT_EQ(status->measuring_mode, 6);
  EXPECT_EQ(status->variant, (Variant{180, 50}));
  EXPECT_TRUE(status->in_millimetres);
  payload.pop_back();
  EXPECT_FALSE(device_status(telegram_of(framed(0x81, payload))));
}

TEST(Lms200Protocol, HealthTellsWhetherToDrive) {
  EXPECT_TRUE(Health(0x10).usable());
  EXPECT_EQ(health_text(Health(0x10)), "");
  EXPECT_TRUE(Health(0x92).usable());
  EXPECT_TRUE(Health(0x92).polluted());
  EXPECT_THAT(health_text(Health(0x92)), HasSubstr("clean it"));
  EXPECT_FALSE(Health(0x13).usable());
  EXPECT_FALSE(Health(0x50).usable());
}

TEST(Lms200Protocol, VariantsKnowTheirBeams) {
  EXPECT_EQ((Variant{100, 100}.beams()), 101U);
  EXPECT_EQ((Variant{100, 25}.beams()), 401U);
  EXPECT_EQ((Variant{180, 50}.beams()), 361U);
  EXPECT_EQ((Variant{180, 50}.turns()), 2U);
}

}  // namespace
}  // namespace drivers::lms200
