// server/run/scenario_library.hpp: the scenarios a server offers: built-in ones, the user's own,
// and logs.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "server/run/library_files.hpp"
#include "server/run/robot_library.hpp"
#include "sim/scenario.hpp"

namespace server {

struct ScenarioEntry {
  std::string name{};
  std::string title{};
  std::string description{};
  bool builtin = false;
  bool is_log = false;  // a recorded log to replay instead of a world
};

/// Reads its folders again on each call, because people edit them. Any thread, but never the io
/// thread.
class ScenarioLibrary {
 public:
  /// `own`: folder for the user's *.json files, created on the first save; `logs`: folder of CARMEN
  /// *.log files. Either may be empty: none. `map`: a file that scenarios may name besides those in
  /// `own`; empty: none.
  ScenarioLibrary(std::filesystem::path own,
                  std::filesystem::path logs,
                  RobotLibrary robots = RobotLibrary(),
                  std::filesystem::path map = {});

  /// The robots that the scenarios may name.
  const RobotLibrary& robots() const { return robots_; }

  std::vector<ScenarioEntry> list() const;
  /// Whether there is a world of this name.
  bool has(const std::string& name) const;
  /// Throws LibraryError, or DocumentError when the file is invalid.
  sim::Scenario load(const std::string& name) const;
  /// `scenario` from the network, with the folder of its map if it names one.
  sim::Scenario placed(sim::Scenario scenario) const;
  /// Writes to the user's folder, with a copy of the map beside it if that lies elsewhere. Returns
  /// the scenario as written. Throws LibraryError on a built-in name or an unwritable folder.
  sim::Scenario save(sim::Scenario scenario) const;
  void remove(const std::string& name) const;

  /// Reads a scenario file, or a log if `path` ends in .log. Command line only: a name from the
  /// network is never used as a path.
  static sim::Scenario from_file(const std::filesystem::path& path,
                                 const RobotLibrary& robots = RobotLibrary());
  /// Replays the CARMEN log `path`, whatever its name ends in.
  static sim::Scenario from_log(const std::filesystem::path& path);

 private:
  std::filesystem::path own_map(const std::string& name) const;

  std::filesystem::path own_;
  std::filesystem::path logs_;
  RobotLibrary robots_;
  std::filesystem::path map_;
};

}  // namespace server
