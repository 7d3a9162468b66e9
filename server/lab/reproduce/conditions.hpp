// server/lab/reproduce/conditions.hpp: makes a run from one scenario, one reading and one seed.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "server/lab/reproduce/study_file.hpp"
#include "server/run/run_spec.hpp"

namespace server::reproduce {

/// Which of the paper's conditions the full simulator replaces.
struct Conditions {
  bool noise = true;         // of the paper's scanner
  bool base = false;         // Bullet with its ramps and wheels, else exact arcs
  bool scanner = false;      // the rolling LMS200, else flat-time with uniform noise
  bool fast_period = false;  // 26 ms, else the file's dt
};
constexpr Conditions kPaper{};
constexpr Conditions kNoiseFree{.noise = false};
constexpr Conditions kFullSimulator{.base = true, .scanner = true, .fast_period = true};

/// Throws std::exception with a sentence if the scenario cannot run under the conditions.
RunSpec make_run(const PaperConditions& paper,
                 const sim::Scenario& scenario,
                 std::string_view reading,
                 const Conditions& conditions,
                 std::uint64_t seed);

/// Builds the world of every scenario once, to find an invalid scenario before any run. Throws
/// std::runtime_error naming it.
void check_scenarios(const StudyFile& file);

}  // namespace server::reproduce
