// server/lab/soak/soak.hpp: many random worlds, and what must never happen in any.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "algo/types.hpp"

namespace server::soak {

enum class Ending : std::uint8_t {
  Reached,
  GaveReason,  // stands, and says why
  OutOfTime,   // still under way
  Silent,      // stands, and does not say why: never
  Collision,   // never
  NotFinite,   // never
};
std::string_view name(Ending ending);
bool is_fault(Ending ending);

struct Options {
  std::uint64_t worlds = 1000;
  std::uint64_t first_seed = 1;
  std::string controller = "strip";
  unsigned workers = 0;  // 0: one a core
  std::function<void(std::size_t done, std::size_t all)> progress{};
};

struct Outcome {
  std::uint64_t seed = 0;
  Ending ending = Ending::OutOfTime;
  bool has_way = false;      // in truth, with 10 cm to spare
  double time = 0;           // [s]
  double min_clearance = 0;  // [m] hull to surface
  algo::Pose2 end{};
  std::string why{};  // what it said last
};

/// One world: until the goal, until it has stood for long, or 300 s.
Outcome run_world(std::uint64_t seed, const std::string& controller);
/// In the order of the seeds, whatever the workers.
std::vector<Outcome> run_worlds(const Options& options);

}  // namespace server::soak
