// server/lab/reproduce/accept.hpp: checks the runs against the limits of the study file.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "server/experiment/series.hpp"
#include "server/lab/reproduce/study_file.hpp"

namespace server::reproduce {

using experiment::Series;

/// One limit, and whether it held.
struct Check {
  std::string scenario{};
  std::string subject{};  // "modified", "modified < original", "modified, noise-free"
  std::string asked{};    // "path_mm at most 7651"
  std::string figure{};   // "6955.2"
  bool held = false;
};

/// Checks every limit of the file against `paper` or, if the limit says so, `noise_free`. A missing
/// series fails its checks.
std::vector<Check> evaluate(const StudyFile& file,
                            std::span<const Series> paper,
                            std::span<const Series> noise_free);

bool all_held(std::span<const Check> checks);

}  // namespace server::reproduce
