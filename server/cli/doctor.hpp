// server/cli/doctor.hpp: looks at each device of a robot as a technician would, and says what to
// do.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "drivers/robot_file.hpp"

namespace server {

enum class Verdict : std::uint8_t { Well, Note, Bad };

/// One thing looked at.
struct Finding {
  Verdict verdict = Verdict::Well;
  std::string device{};  // "front laser", "base", "system", "file"
  std::string sentence{};
  std::string advice{};  // what to do; empty when there is nothing to do
};

struct DoctorOptions {
  bool move = false;     // may turn the wheels, briefly and slowly
  double patience = 20;  // [s] for each device to be found and set up
  double measuring = 3;  // [s] of scans looked at
};

/// Looks at everything in turn; `found` is called as each finding is made. True when nothing is
/// bad.
bool examine(const drivers::RobotFile& file,
             const DoctorOptions& options,
             const std::function<void(const Finding&)>& found);

/// Beams that stand alone against both neighbours, which agree: dust, rain, a damaged mirror.
std::size_t count_spikes(const std::vector<double>& ranges);

/// Whether wheels that were told to go `told` [m] and say that they went `came` are as the file has
/// them.
bool drove_as_told(double told, double came);

}  // namespace server
