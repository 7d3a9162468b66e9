// server/experiment/arithmetic.hpp: tells mathematical libraries apart.
#pragma once

#include <string>

namespace server::experiment {

/// A fingerprint of this machine's sines, exponentials and the like: 16 hexadecimal digits. Their
/// last bits differ between processors and libraries, and after some driving so do the runs.
const std::string& arithmetic();

}  // namespace server::experiment
