// tests/server/emulate/robot_toml_test.cpp: the emulator writes a file that `serve --robot` takes.
#include "server/emulate/robot_toml.hpp"

#include <filesystem>
#include <numbers>
#include <string>
#include <variant>

#include "tests/folders.hpp"
#include "tests/temporary_folder.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/robot_file.hpp"
#include "server/run/robot_library.hpp"
#include "server/run/text_file.hpp"

namespace server::emulate {
namespace {

namespace fs = std::filesystem;

class RobotTomlTest : public testing::Test {
 protected:
  EmulationOptions options(BaseKind base, const std::string& robot = "silvermate") const {
    EmulationOptions out;
    out.scenario.robot = builtin_robot(robot);
    out.base = base;
    out.base_link = folder_.path() / "base";
    for (std::size_t i = 0; i < out.scenario.robot.sensors.lasers.size(); ++i) {
      out.scanner_links.push_back(folder_.path() / ("scanner" + std::to_string(i)));
    }
    return out;
  }
  fs::path file() const { return folder_.path() / "robot.toml"; }
  /// While the emulator runs.
  drivers::RobotFile read(const EmulationOptions& options) const {
    const Emulation emulation(options);
    EXPECT_TRUE(write_robot_toml(options, tests::emulated_comedi(), file()));
    return drivers::read_robot_file(file());
  }

 private:
  tests::TemporaryFolder folder_{};
};

TEST_F(RobotTomlTest, EachBaseHasAFileThatIsAccepted) {
  const drivers::RobotFile roboteq = read(options(BaseKind::Roboteq));
  EXPECT_TRUE(roboteq.emulated);
  EXPECT_EQ(roboteq.spec.radius, 0.35);
  EXPECT_EQ(roboteq.spec.half_track, 0.25);
  EXPECT_EQ(roboteq.lasers.size(), 1U);
  EXPECT_TRUE(std::holds_alternative<drivers::p2os::PioneerSetup>(
      read(options(BaseKind::P2os)).base.setup));
  const drivers::RobotFile analog = read(options(BaseKind::Analog));
  const auto& setup = std::get<drivers::AnalogEntry>(analog.base.setup);
  EXPECT_EQ(setup.base.counts_per_turn, 2000);
  EXPECT_EQ(setup.base.speed_per_volt, 0.1);
  EXPECT_EQ(setup.card.relay_closed_line, 1U);
  EXPECT_EQ(setup.card.stop_line, 2U);
  EXPECT_EQ(setup.card.fault_line, 3U);
}

TEST_F(RobotTomlTest, EachBuiltInRobotHasOne) {
  for (const RobotEntry& robot : RobotLibrary().list()) {
    SCOPED_TRACE(robot.name);
    EmulationOptions made = options(BaseKind::Roboteq, robot.name);
    made.psd_link = file().parent_path() / "psd";
    const drivers::RobotFile read_back = read(made);
    EXPECT_EQ(read_back.lasers.size(), made.scanner_links.size());
    EXPECT_DOUBLE_EQ(read_back.spec.half_track, made.scenario.robot.half_track);
    EXPECT_TRUE(read_back.floor);
    for (std::size_t i = 0; i < read_back.lasers.size(); ++i) {
      const algo::Pose2& mount = made.scenario.robot.sensors.lasers[i].mount_R;
      EXPECT_NEAR(read_back.lasers[i].mount_R.heading, mount.heading, 1e-12);
      EXPECT_EQ(read_back.lasers[i].mount_R.x, mount.x);
    }
  }
}

TEST_F(RobotTomlTest, ACardWithFewerLinesHasFewerInItsFile) {
  EmulationOptions made = options(BaseKind::Analog);
  made.card.lines = 3;
  const std::string text = robot_toml(made, tests::emulated_comedi());
  EXPECT_THAT(text, testing::HasSubstr("stop_line = 2"));
  EXPECT_THAT(text, testing::Not(testing::HasSubstr("fault_line")));
}

TEST_F(RobotTomlTest, AnOwnFileIsKeptAndAnEarlierOneReplaced) {
  const EmulationOptions made = options(BaseKind::P2os);
  EXPECT_TRUE(write_robot_toml(made, tests::emulated_comedi(), file()));
  EXPECT_TRUE(write_robot_toml(options(BaseKind::Roboteq), tests::emulated_comedi(), file()));
  EXPECT_THAT(read_text(file()), testing::HasSubstr("roboteq"));
  write_text(file(), "name = \"mine\"\n");
  EXPECT_FALSE(write_robot_toml(made, tests::emulated_comedi(), file()));
  EXPECT_EQ(read_text(file()), "name = \"mine\"\n");
}

}  // namespace
}  // namespace server::emulate
