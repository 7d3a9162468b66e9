// server/experiment/figures.hpp: the figures of runs under the names and units of paper.json.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "algo/metrics.hpp"
#include "server/experiment/path_figures.hpp"
#include "server/experiment/standing.hpp"

namespace server::reproduce {

/// One run.
struct RunFigures {
  algo::Outcome outcome = algo::Outcome::Running;
  algo::Metrics metrics{};
  PathFigures path{};
  StandingFigures standing{};
  algo::Vec2 end_W{0, 0};
  std::vector<algo::Vec2> track_W{};  // where asked for
};

/// The runs of one layout with one reading of the strip, in the order of their seeds.
struct Row {
  std::string layout{};
  std::string reading{};
  std::vector<RunFigures> runs{};
};

/// How paper.json makes one figure of many runs.
enum class Aggregate : std::uint8_t { Sum, Mean, Largest, Least };

struct MetricInfo {
  std::string_view name{};  // "path_mm"
  Aggregate aggregate = Aggregate::Mean;
  double (*of)(const RunFigures&) = nullptr;  // in the unit the name says
};

/// Every metric of paper.json `common.metrics`, and the counts of outcomes.
std::span<const MetricInfo> metric_table();
const MetricInfo* find_metric(std::string_view name);

/// The figure of the row; it has at least one run.
double figure(const Row& row, const MetricInfo& metric);

/// The figure that must keep a limit. A least clearance holds for every run, so that an upper
/// limit is held against the largest of them.
double figure_against(const Row& row, const MetricInfo& metric, bool at_least);

std::size_t count(const Row& row, algo::Outcome outcome);
/// The outcome of every run, or nothing when they differ.
std::optional<algo::Outcome> common_outcome(const Row& row);
/// "10 reached", "7 reached, 3 stuck".
std::string outcomes_text(const Row& row);
/// "r", "s", "t" or "C"; "r2 s1" when runs end differently.
std::string outcome_letters(const Row& row);

const Row* find_row(std::span<const Row> rows, std::string_view layout, std::string_view reading);

}  // namespace server::reproduce
