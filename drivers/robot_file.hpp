// drivers/robot_file.hpp: a robot of real devices, described by some ten lines of TOML
// (docs/hardware.md has every key).
#pragma once

#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "algo/robot.hpp"
#include "drivers/analog_base.hpp"
#include "drivers/base.hpp"
#include "drivers/comedi_card.hpp"
#include "drivers/lms200_machine.hpp"
#include "drivers/p2os_machine.hpp"
#include "drivers/psd_machine.hpp"
#include "drivers/roboteq_machine.hpp"

namespace drivers {

/// what() is "FILE:LINE: what is wrong".
struct RobotFileError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct LaserEntry {
  std::string name{};  // "front laser"
  std::string port{};
  algo::Pose2 mount_R{};
  lms200::LaserSetup setup{};
};

struct FloorEntry {
  std::string port{};
  psd::PsdSetup setup{};
};

/// The sensors that a process beside the robot publishes.
struct PublishedEntry {
  bool inclinometer = false;
  bool line = false;  // of the laser, as a camera sees it
};

struct AnalogEntry {
  AnalogSetup base{};
  ComediSetup card{};
};

struct BaseEntry {
  std::string port{};
  std::variant<p2os::PioneerSetup, roboteq::RoboteqSetup, AnalogEntry> setup{};
  double watchdog = 0;     // [s]
  double battery_low = 0;  // [V] below it the robot does not drive; 0: not watched
  std::vector<algo::Pose2> sonar_mounts_R{};
};

struct RobotFile {
  std::string path{};
  bool emulated = false;  // devices of `tautline emulate`; read_robot_file() checks the ports
  algo::RobotSpec spec{};
  BaseLimits limits{};
  std::string controller = "modified";
  /// The controller outside the program that may drive this robot; empty: none.
  std::string external_controller{};
  std::string filter = "pseudomedian";
  std::vector<LaserEntry> lasers{};
  std::optional<FloorEntry> floor{};  // the sensors that look at the floor ahead
  PublishedEntry published{};
  BaseEntry base{};
  std::vector<std::string> warnings{};  // for the user; no errors
};

/// Where the sixteen sonars of a Pioneer 3-DX sit, seen from the middle of its wheels: front array
/// then rear, by their numbers.
std::vector<algo::Pose2> pioneer_sonars();

/// Throws RobotFileError.
RobotFile read_robot_file(const std::filesystem::path& path);
/// As above, from a text; `name` replaces the path in messages.
RobotFile parse_robot(std::string_view text, const std::string& name);

}  // namespace drivers
