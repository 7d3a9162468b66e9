// server/experiment/judge.hpp: judges: plug-ins that see each tick of a run and write columns of
// figures.
//
// A judge is one file, judges/NAME.cpp, with one function `JudgeInfo NAME()`: CMake puts every file
// of that folder into judge_table().
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "algo/telemetry.hpp"
#include "server/record/headless.hpp"
#include "server/run/run_spec.hpp"

namespace server::experiment {

/// How the values of runs that differ only in their seed become one figure.
enum class Aggregate : std::uint8_t { Sum, Mean, Largest, Least };

struct Column {
  std::string_view name{};  // ends in its unit, SI: "path_m"
  Aggregate aggregate = Aggregate::Mean;
  int digits = 2;  // decimals in tables for people
};

/// Numbers that a judge gets besides the run, such as "goal_radius".
using Settings = std::map<std::string, double, std::less<>>;

/// The run to be judged.
struct JudgedRun {
  const RunSpec& spec;
  const algo::RobotSpec& robot;
  const Settings& settings;

  double setting(std::string_view name, double otherwise) const;
};

/// Watches a run tick by tick, from the start on, and adds columns to its row. It reads the core of
/// the telemetry and the ground truth, never a drawing.
class Judge {
 public:
  virtual ~Judge() = default;
  virtual void see(const algo::Telemetry& t) = 0;
  /// Writes one value per column, in order; NaN: not known.
  virtual void write(std::span<double> row) const = 0;
  /// The ending, if the run is over by this judge's own rules. Called after each tick, for the
  /// judge that the trial's `until` names.
  virtual std::optional<Ending> ending() const { return std::nullopt; }
};

struct JudgeInfo {
  std::string_view help{};
  std::span<const Column> columns{};
  std::unique_ptr<Judge> (*make)(const JudgedRun& run) = nullptr;
  std::span<const std::string_view> settings{};  // the names that make() reads
  bool ends = false;                             // has an ending of its own
  std::string_view name{};                       // set by the table
};

/// The `make` of a judge whose constructor takes only the run.
template <typename Kind>
std::unique_ptr<Judge> make_judge(const JudgedRun& run) {
  return std::make_unique<Kind>(run);
}

/// All judges, sorted by name.
std::span<const JudgeInfo> judge_table();
/// Throws std::invalid_argument that lists the known names.
const JudgeInfo& find_judge(std::string_view name);
/// The column of that name, of any judge; nullptr if there is none.
const Column* find_column(std::string_view name);

}  // namespace server::experiment
