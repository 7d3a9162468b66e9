// server/run/version.hpp: the program's version, from CMakeLists.txt.
#pragma once

namespace server {
inline constexpr const char* kVersion = TAUTLINE_VERSION;
}
