// server/paths.hpp: where Tautline keeps things on this machine.
#pragma once

#include <filesystem>

namespace server {

/// $XDG_STATE_HOME/tautline, else ~/.local/state/tautline, else a folder in the temporary folder
/// when there is no home at all. Not created here.
std::filesystem::path state_folder();

/// The built page: --web, else beside the program, else the source tree it was built from.
std::filesystem::path web_folder();

}  // namespace server
