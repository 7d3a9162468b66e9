// server/run/robot_library.hpp: the robot models there are: built in, and the user's own files.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "server/run/json_reader.hpp"
#include "sim/scenario.hpp"

namespace server {

struct RobotEntry {
  std::string name{};
  std::string title{};
  std::string description{};  // of a file that does not read: why
  bool builtin = false;
  bool usable = true;
};

/// Reads its folder anew on each call. Any thread, but with a folder never the io thread.
class RobotLibrary {
 public:
  /// `own`: folder of the user's *.json; empty: none.
  explicit RobotLibrary(std::filesystem::path own = {}) : own_(std::move(own)) {}

  std::vector<RobotEntry> list() const;
  /// Throws LibraryError.
  sim::RobotModel load(const std::string& name) const;
  /// `text` as a path when there is such a file or it looks like one, else a name (command line
  /// only: a name from the network is never used as a path).
  sim::RobotModel load_file_or_name(const std::string& text) const;

 private:
  std::filesystem::path own_;
};

/// One of those that are built in; throws LibraryError.
sim::RobotModel builtin_robot(const std::string& name);

/// The field "robot" of `in`: a name, or a whole model. Throws DocumentError.
sim::RobotModel read_robot(const JsonReader& in, const RobotLibrary& robots);
/// Puts `robot` in place of the scenario's: it drives with its own sensors and limits. The
/// scenario's other robots that have the first one's sensors have the new ones.
void replace_robot(sim::Scenario& scenario, const sim::RobotModel& robot);
/// The same by a name or a whole model. The name of the scenario's own robot keeps its sensors and
/// limits. Throws DocumentError about "robot".
void choose_robot(sim::Scenario& scenario,
                  const nlohmann::json& choice,
                  const RobotLibrary& robots);
/// The field that read_robot() reads: the name of a built-in one, else the whole model but for its
/// sensors, so that the document needs no other file.
nlohmann::json robot_reference(const sim::RobotModel& robot);

}  // namespace server
