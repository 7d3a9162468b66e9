// server/experiment/sweep/machine.hpp: names what the last digits of a run depend on besides the
// program: the processor and the mathematical library.
#pragma once

#include <string>

namespace server::sweep {

struct Machine {
  std::string processor{};    // model name of /proc/cpuinfo
  std::string mathematics{};  // version of the C library, and a hash of values of its functions
  auto operator<=>(const Machine&) const = default;
};

/// The machine that this program runs on. A library chooses its code by the processor, so that two
/// processors with one library may have different hashes.
Machine this_machine();

/// The `model name` in the text of /proc/cpuinfo; "unknown" if there is none.
std::string processor_in(const std::string& cpuinfo);

}  // namespace server::sweep
