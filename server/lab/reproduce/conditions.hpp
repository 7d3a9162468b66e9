// server/lab/reproduce/conditions.hpp: one scenario, one reading, one seed as a run.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "server/lab/reproduce/study_file.hpp"
#include "server/run/run_spec.hpp"

namespace server::reproduce {

/// What of the full simulator is in place of the paper's conditions.
struct Conditions {
  bool noise = true;         // of the paper's scanner
  bool base = false;         // Bullet with its ramps and wheels, else exact arcs
  bool scanner = false;      // the rolling LMS200, else flat-time with uniform noise
  bool fast_period = false;  // 26 ms, else the file's dt
};
constexpr Conditions kPaper{};
constexpr Conditions kNoiseFree{.noise = false};
constexpr Conditions kFullSimulator{.base = true, .scanner = true, .fast_period = true};

/// Throws std::exception with a sentence when the scenario cannot be run so.
RunSpec make_run(const PaperConditions& paper,
                 const sim::Scenario& scenario,
                 std::string_view reading,
                 const Conditions& conditions,
                 std::uint64_t seed);

/// Builds the world of every scenario once, so that what cannot be run is said before anything is.
/// Throws std::runtime_error naming the scenario.
void check_scenarios(const StudyFile& file);

}  // namespace server::reproduce
