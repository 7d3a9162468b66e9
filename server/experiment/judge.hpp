// server/experiment/judge.hpp: what is measured of a run: plug-ins that see each tick and write
// columns.
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

/// How one figure is made of runs that differ in their seed.
enum class Aggregate : std::uint8_t { Sum, Mean, Largest, Least };

struct Column {
  std::string_view name{};  // ends in its unit, SI: "path_m"
  Aggregate aggregate = Aggregate::Mean;
  int digits = 2;  // in tables for people
};

/// Numbers that a judge is given besides the run: "goal_radius".
using Settings = std::map<std::string, double, std::less<>>;

/// The run that a judge is made for.
struct JudgedRun {
  const RunSpec& spec;
  const algo::RobotSpec& robot;
  const Settings& settings;

  double setting(std::string_view name, double otherwise) const;
};

/// Watches a run tick by tick, from the start on, and adds columns to its row. It reads the core of
/// the telemetry and the truth, never a drawing.
class Judge {
 public:
  virtual ~Judge() = default;
  virtual void see(const algo::Telemetry& t) = 0;
  /// One value a column, in their order; NaN: not known.
  virtual void write(std::span<double> row) const = 0;
  /// Whether the run is over in this judge's own terms. Asked after each tick, of the judge whose
  /// ending a trial names as its own.
  virtual std::optional<Ending> ending() const { return std::nullopt; }
};

struct JudgeInfo {
  std::string_view help{};
  std::span<const Column> columns{};
  std::unique_ptr<Judge> (*make)(const JudgedRun& run) = nullptr;
  std::span<const std::string_view> settings{};  // the names that make() asks for
  bool ends = false;                             // has an ending of its own
  std::string_view name{};                       // given by the table
};

/// `make` of a judge that is built from the run alone.
template <typename Kind>
std::unique_ptr<Judge> make_judge(const JudgedRun& run) {
  return std::make_unique<Kind>(run);
}

/// Every judge, in the order of their names.
std::span<const JudgeInfo> judge_table();
/// Throws std::invalid_argument with the names there are.
const JudgeInfo& find_judge(std::string_view name);
/// The column of that name of any judge; nullptr when there is none.
const Column* find_column(std::string_view name);

}  // namespace server::experiment
