// tests/hardware/trials.hpp: the trials. Each prints a table; true when all limits held.
#pragma once

#include <filesystem>
#include <string>

#include "server/emulate/emulation.hpp"

namespace server::hardware {

/// Thesis experiments 1 to 4 over both bases, beside pure simulation. `only`: one, as
/// "exp1-roboteq".
bool experiments(const std::filesystem::path& folder, const std::string& only);
/// One telegram in a hundred damaged for this time [s]: memory, and the fate of each scan.
bool soak(const std::filesystem::path& folder, double seconds);

inline const char* name_of(emulate::BaseKind base) {
  if (base == emulate::BaseKind::Analog) return "analog";
  return base == emulate::BaseKind::P2os ? "p2os" : "roboteq";
}

}  // namespace server::hardware
