// server/run/robot_library.hpp: the known robot models: the built-in ones and the user's own files.
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
  std::string description{};  // of an unreadable file: the reason
  bool builtin = false;
  bool usable = true;
};

/// Reads its folder again on each call. Any thread, but never the io thread when it has a folder.
class RobotLibrary {
 public:
  /// `own`: folder of the user's *.json files; empty: none.
  explicit RobotLibrary(std::filesystem::path own = {}) : own_(std::move(own)) {}

  std::vector<RobotEntry> list() const;
  /// Throws LibraryError.
  sim::RobotModel load(const std::string& name) const;
  /// Takes `text` as a path if such a file exists or it looks like a path, else as a name. Command
  /// line only: a name from the network is never used as a path.
  sim::RobotModel load_file_or_name(const std::string& text) const;

 private:
  std::filesystem::path own_;
};

/// The built-in robot of that name. Throws LibraryError.
sim::RobotModel builtin_robot(const std::string& name);

/// Reads the field "robot" of `in`: a name or a whole model. Throws DocumentError.
sim::RobotModel read_robot(const JsonReader& in, const RobotLibrary& robots);
/// Replaces the scenario's robot by `robot`, with its sensors and limits. Other robots that share
/// the first robot's sensors get the new ones.
void replace_robot(sim::Scenario& scenario, const sim::RobotModel& robot);
/// As replace_robot(), for a name or a whole model. The name of the scenario's own robot keeps the
/// scenario's sensors and limits. Throws DocumentError about "robot".
void choose_robot(sim::Scenario& scenario,
                  const nlohmann::json& choice,
                  const RobotLibrary& robots);
/// The field that read_robot() reads: the name of a built-in robot, else the whole model without
/// its sensors, so that the document needs no other file.
nlohmann::json robot_reference(const sim::RobotModel& robot);

}  // namespace server
