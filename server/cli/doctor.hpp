// server/cli/doctor.hpp: checks each device of a robot and gives advice.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "drivers/robot_file.hpp"

namespace server {

/// The result of one check.
struct Finding {
  enum class Verdict : std::uint8_t { Well, Note, Bad };
  Verdict verdict = Verdict::Well;
  std::string device{};  // "front laser", "base", "system", "file"
  std::string sentence{};
  std::string advice{};  // empty if nothing is to be done
};

struct DoctorOptions {
  bool move = false;     // may turn the wheels, briefly and slowly
  double patience = 20;  // [s] to find and set up each device
  double measuring = 3;  // [s] of scans to check
  std::function<bool()> interrupted = [] { return false; };
};

/// Runs all checks in turn and calls `found` for each finding. True when no finding is bad. Throws
/// std::runtime_error when interrupted, with the wheels stopped and each device left in order.
bool examine(const drivers::RobotFile& file,
             const DoctorOptions& options,
             const std::function<void(const Finding&)>& found);

/// Number of beams that differ from both neighbours, which agree: dust, rain, a damaged mirror.
std::size_t count_spikes(const std::vector<double>& ranges);

/// Whether a reported distance `came` [m] matches the commanded one `told` [m] for the wheels in
/// the file.
bool drove_as_told(double told, double came);

}  // namespace server
