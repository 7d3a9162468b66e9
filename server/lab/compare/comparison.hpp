// server/lab/compare/comparison.hpp: the runs of `tautline compare`: every controller on the
// papers' worlds, before bottlenecks, and the strips on random layouts.
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
  std::size_t seeds = 3;  // runs of each row
  std::uint64_t first_seed = 1;
  std::size_t layouts = 150;        // random ones of each kind
  std::size_t layout_seeds = 2;     // runs of each
  std::vector<std::string> only{};  // these controllers; empty: all
  /// More judges of the worlds and the bottlenecks: their columns stand in the details.
  std::vector<std::string> judges{};
  bool worlds = true;  // which parts are run
  bool bottlenecks = true;
  bool random_layouts = true;
  unsigned threads = 0;  // 0: one a core
  experiment::NamedProgress progress{};
};

/// Layouts with the same number of obstacles and the same K_r.
struct LayoutSet {
  std::size_t obstacles = 0;
  double repulsion_gain = 0;
  /// Paper conditions; a row a layout, for one controller after the other.
  std::vector<Series> paper{};
  std::vector<Series> full{};  // `strip` alone in the full simulator
};

struct Comparison {
  Options options{};
  std::vector<std::string> labels{};  // of the contestants
  std::vector<Series> worlds{};       // a world a row, for one contestant after the other
  std::vector<Series> bottlenecks{};  // a gap a row, likewise
  std::vector<LayoutSet> layouts{};
  std::vector<Finding> findings{};  // of the sources' claims, where their runs were made
};

/// Same options, same comparison, however many threads. Throws std::exception with a sentence.
Comparison compare(const Options& options);

/// The rows of one contestant, in the order of the scenes.
std::vector<const Series*> rows_of(const std::vector<Series>& rows, const std::string& label);

/// `strip` on all layouts under both conditions: at least 99 % of the runs reach, none collides.
struct LayoutResult {
  std::size_t runs = 0, reached = 0, collided = 0;
  bool held() const { return collided == 0 && 100 * reached >= 99 * runs; }
};
LayoutResult strip_on_layouts(const std::vector<LayoutSet>& sets);

}  // namespace server::compare
