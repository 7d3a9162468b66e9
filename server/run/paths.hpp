// server/run/paths.hpp: where Tautline keeps things on this machine.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace server {

/// $XDG_STATE_HOME/tautline, else ~/.local/state/tautline, else a folder in the temporary folder
/// when there is no home at all. Not created here.
std::filesystem::path state_folder();

/// The built page: --web, else beside the program, else the source tree it was built from.
std::filesystem::path web_folder();

/// A sentence for visitors: of each absolute path its last name alone. What lies where on this
/// machine is for its log. Devices (/dev) and addresses of the API stay whole.
std::string without_folders(std::string_view sentence);

}  // namespace server
