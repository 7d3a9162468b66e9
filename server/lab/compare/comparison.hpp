// server/lab/compare/comparison.hpp: the runs of `tautline compare`: every controller in the
// papers' worlds and at bottlenecks, and the strips on random layouts.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "server/experiment/series.hpp"
#include "server/lab/compare/findings.hpp"
#include "server/lab/compare/scenes.hpp"

namespace server::compare {

using experiment::Series;

struct Options {
  std::size_t seeds = 3;  // runs per row
  std::uint64_t first_seed = 1;
  std::size_t layouts = 150;        // random layouts of each kind
  std::size_t layout_seeds = 2;     // runs per layout
  std::vector<std::string> only{};  // these controllers; empty: all
  /// Further judges for the worlds and the bottlenecks; the details show their columns.
  std::vector<std::string> judges{};
  bool worlds = true;  // these three: parts to run
  bool bottlenecks = true;
  bool random_layouts = true;
  unsigned threads = 0;  // 0: one per core
  experiment::NamedProgress progress{};
};

/// Layouts with the same number of obstacles and the same K_r.
struct LayoutSet {
  std::size_t obstacles = 0;
  double repulsion_gain = 0;
  /// Paper conditions: one row per layout, controller after controller.
  std::vector<Series> paper{};
  std::vector<Series> full{};  // only `strip`, in the full simulator
};

struct Comparison {
  Options options{};
  std::vector<std::string> labels{};  // of the contestants
  std::vector<Series> worlds{};       // one row per world, contestant after contestant
  std::vector<Series> bottlenecks{};  // one row per gap, likewise
  std::vector<LayoutSet> layouts{};
  std::vector<Finding> findings{};  // on the sources' claims whose runs were made
};

/// The same options give the same comparison with any number of threads. Throws std::exception with
/// a sentence.
Comparison compare(const Options& options);

/// The rows of one contestant, in the order of the scenes.
std::vector<const Series*> rows_of(const std::vector<Series>& rows, const std::string& label);

/// `strip` on all layouts under both conditions. Held if at least 99 % of the runs reach the goal
/// and none collides.
struct LayoutResult {
  std::size_t runs = 0, reached = 0, collided = 0;
  bool held() const { return collided == 0 && 100 * reached >= 99 * runs; }
};
LayoutResult strip_on_layouts(const std::vector<LayoutSet>& sets);

}  // namespace server::compare
