// server/lab/compare/findings.hpp: tests against the runs what section 1.1 of the thesis says about
// its methods.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "server/experiment/series.hpp"

namespace server::compare {

enum class Verdict : std::uint8_t { Reproduced, InPart, NotReproduced };
std::string_view name(Verdict verdict);

struct Finding {
  std::string claim{};
  Verdict verdict = Verdict::NotReproduced;
  std::string because{};  // the figures
  std::string rule{};
};

/// The findings whose runs exist. `worlds` and `bottlenecks`: one row per scene and contestant; the
/// bottlenecks of one contestant by rising gap.
std::vector<Finding> judge(std::span<const experiment::Series> worlds,
                           std::span<const experiment::Series> bottlenecks);

/// Summary of one contestant's runs at the bottlenecks.
struct Passage {
  /// [m] The narrowest gap such that every run passes it and every wider gap.
  std::optional<double> smallest{};
  std::size_t runs = 0, passed = 0;
  std::size_t stuck = 0, out_of_time = 0, collided = 0;
  std::vector<double> traps{};  // [m] gaps at which every run was trapped: stuck or out of time
  bool trapped_sometimes() const { return stuck + out_of_time > 0; }
};
Passage passage_of(std::span<const experiment::Series> bottlenecks, std::string_view contestant);

}  // namespace server::compare
