// server/experiment/sweep/sweep_results.hpp: what an experiment says about its controllers, with
// intervals and paired tests.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "algo/metrics.hpp"
#include "server/experiment/clusters.hpp"
#include "server/experiment/paired_tests.hpp"
#include "server/experiment/statistics.hpp"
#include "server/experiment/sweep/robustness.hpp"
#include "server/experiment/sweep/run_log.hpp"
#include "server/experiment/sweep/sweep_plan.hpp"

namespace server::sweep {

/// A figure of the report. Of runs that did not reach their goal, a time or a path says nothing.
struct Figure {
  std::string_view column{};
  bool reached_only = false;
};
std::span<const Figure> figures();

struct Rate {
  algo::Outcome outcome = algo::Outcome::Reached;
  std::size_t count = 0;
  std::size_t runs = 0;                                // that ended, however
  std::optional<experiment::RateInterval> interval{};  // nothing without runs
  double value() const { return static_cast<double>(count) / static_cast<double>(runs); }
};

/// The runs of one arm, in all scenarios or in one.
struct Group {
  std::size_t arm = 0;
  std::optional<std::size_t> scenario{};
  std::size_t runs = 0;  // that ended, however
  std::size_t missing = 0;
  std::vector<Rate> rates{};  // reached, collided, stuck, out of time, failed
  std::vector<std::optional<experiment::Summary>> figures{};  // in the order of figures()
};

/// A figure of an arm against the baseline's. Pairs of runs have the same scenario, seed and swept
/// setting; the pairs of one scenario give one difference, the mean of theirs.
struct PairedTest {
  std::size_t pairs = 0;                             // of runs
  std::optional<experiment::McNemar> mcnemar{};      // of a rate, if each difference is one pair
  experiment::Wilcoxon signed_rank{};                // of the differences
  std::optional<experiment::Summary> differences{};  // arm minus baseline
  double p_holm = 1;                                 // over all tests of all pairings
  double p() const { return mcnemar ? mcnemar->p : signed_rank.p; }
};

/// An arm against the baseline.
struct Pairing {
  std::size_t arm = 0;
  std::size_t baseline = 0;
  /// With one scenario each pair of runs is a difference; the tests hold for that scenario alone.
  bool over_scenarios = true;
  PairedTest reached{};   // rate
  PairedTest collided{};  // rate
  PairedTest time{};      // [s] where both reached
};

struct Results {
  std::size_t runs = 0;
  std::size_t missing = 0;
  std::size_t failed = 0;
  std::vector<Group> arms{};       // in the order of the plan
  std::vector<Group> scenarios{};  // scenario after scenario
  std::vector<Pairing> pairings{};
  std::vector<Ranking> rankings{};  // the first is that of all runs
  bool complete() const { return missing == 0 && failed == 0; }
};

/// Of any part of the runs, at any moment. Does not depend on the order in which they ended.
Results results_of(const Plan& plan, const Rows& rows);

}  // namespace server::sweep
