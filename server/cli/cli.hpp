// server/cli/cli.hpp: the subcommands of the program. Each adds itself to the application and, if
// run, sets `status` to its exit status.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "server/cli/controller_flags.hpp"
#include "server/cli/options.hpp"
#include "server/run/robot_library.hpp"
#include "server/run/run_spec.hpp"

namespace server {

/// Exit statuses of `run`, also in its --help.
constexpr int kReached = 0;
constexpr int kBadInput = 1;
constexpr int kNotReached = 2;
constexpr int kCollided = 3;
constexpr int kNotHeld = 3;     // of `reproduce` and `compare`: a limit did not hold
constexpr int kDifferent = 2;   // of `verify`
constexpr int kIncomplete = 4;  // of `export`, `verify` and `sweep`: not the whole
constexpr int kNotWell = 2;     // of `doctor` and `lms200`: a device has a fault

void add_serve_command(Command app, int& status);
void add_run_command(Command app, int& status);
void add_replay_command(Command app, int& status);
void add_export_command(Command app, int& status);
void add_verify_command(Command app, int& status);
void add_health_command(Command app, int& status);
void add_reproduce_command(Command app, int& status);
void add_barn_command(Command app, int& status);
void add_buildings_command(Command app, int& status);
void add_climbs_command(Command app, int& status);
void add_soak_command(Command app, int& status);
void add_emulate_command(Command app, int& status);
void add_compare_command(Command app, int& status);
void add_crowd_command(Command app, int& status);
void add_doctor_command(Command app, int& status);
void add_lms200_command(Command app, int& status);
void add_locate_command(Command app, int& status);
void add_map_command(Command app, int& status);
void add_merge_command(Command app, int& status);
void add_report_command(Command app, int& status);
void add_sweep_command(Command app, int& status);
void add_tune_command(Command app, int& status);
void add_worlds_command(Command app, int& status);

/// The built-in scenarios and the user's own.
RobotLibrary own_robots();
/// --robot-model, for RobotLibrary::load_file_or_name().
Option add_robot_option(Command command, std::string& robot);

/// --password of a scanner.
Option add_password_option(Command command, std::string& password);

/// --set, for parameters_set().
Option add_set_option(Command command, std::vector<std::string>& settings);
/// Values by name. Throws DocumentError for a setting that is not NAME=VALUE.
nlohmann::json parameters_set(const std::vector<std::string>& settings);

/// Options that several commands share.
struct RunFlags {
  RunOverrides overrides{};
  ControllerFlags controllers{};
  std::vector<std::string> settings{};  // k=v
  std::string physics{};
  std::string robot{};  // --robot-model
  std::string hand_goal{};
  std::string joints{};
  std::string map{};
  void add_to(Command command);
  /// --hand-goal and --joints, for a command that runs one scenario.
  void add_arm_to(Command command);
  /// --map and --lost, for a command whose robot may drive by a map.
  void add_map_to(Command command);
  /// Throws DocumentError for a malformed --set, LibraryError for an unknown robot, and
  /// std::exception with a sentence for a controller that cannot be.
  RunOverrides resolved(const RobotLibrary& robots = own_robots()) const;
};

/// Loads `name`: a path if such a file exists or it looks like a path, else a name of the library.
sim::Scenario find_scenario(const std::string& name);

/// Warns of `damage`, sim::Replay::damage() of `log`, on standard error.
void warn_of_damage(const std::string& log, const std::string& damage);

/// Progress on standard error, only if that is a terminal.
class ProgressLine {
 public:
  ProgressLine();
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  void show(const std::string& text);

 private:
  bool interactive_ = false;
  bool shown_ = false;
};

}  // namespace server
