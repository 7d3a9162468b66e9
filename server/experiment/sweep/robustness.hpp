// server/experiment/sweep/robustness.hpp: does the order of the controllers depend on choices that
// could have been made otherwise?
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "server/experiment/sweep/run_log.hpp"
#include "server/experiment/sweep/sweep_plan.hpp"

namespace server::sweep {

constexpr std::size_t kMostRanked = 100;  // arms; more are not ranked

/// The order of the arms in one reading of the finished runs.
struct Ranking {
  std::string reading{};             // "all runs", "time limit x 0.5"
  std::vector<double> rates{};       // of success, by arm; NaN for an arm without runs
  std::vector<std::size_t> order{};  // arms, best first: by rate, then by mean time of success [s]
  std::size_t swapped = 0;           // pairs of arms in the other order than with all runs
  std::size_t pairs = 0;             // of arms
  bool holds() const { return swapped == 0; }
};

/// The ranking of all runs, followed by those of other readings of the same runs: half and three
/// quarters of the time limit, clearances of at least 0.05 m and 0.1 m asked of a success, every
/// second seed (with two or more), every second scenario (with two or more). Two arms that tie in
/// one reading are not swapped. Empty for a single arm and for more than kMostRanked.
std::vector<Ranking> rankings_of(const Plan& plan, const Rows& rows);

}  // namespace server::sweep
