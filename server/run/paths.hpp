// server/run/paths.hpp: the folders that Tautline uses on this machine.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace server {

/// $XDG_STATE_HOME/tautline, else ~/.local/state/tautline, else, without a home, a folder in the
/// temporary folder. Does not create it.
std::filesystem::path state_folder();

/// Folder of the built page: --web, else beside the program, else in the source tree.
std::filesystem::path web_folder();

/// Shortens each absolute path in `sentence` to its last name, because visitors must not learn
/// where files are; the log may say it. Devices (/dev) and addresses of the API stay whole.
std::string without_folders(std::string_view sentence);

}  // namespace server
