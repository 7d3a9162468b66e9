// server/paths.cpp: the freedesktop.org rules for state, with a way out when HOME is unset.
#include "server/paths.hpp"

#include <cstdlib>
#include <system_error>

#include <pwd.h>
#include <unistd.h>

namespace server {
namespace fs = std::filesystem;

fs::path state_folder() {
  if (const char* xdg = std::getenv("XDG_STATE_HOME"); xdg != nullptr && *xdg == '/') {
    return fs::path(xdg) / "tautline";
  }
  if (const char* home = std::getenv("HOME"); home != nullptr && *home == '/') {
    return fs::path(home) / ".local/state/tautline";
  }
  if (const passwd* user = getpwuid(getuid()); user != nullptr && user->pw_dir != nullptr) {
    return fs::path(user->pw_dir) / ".local/state/tautline";
  }
  return fs::temp_directory_path() / "tautline";
}

fs::path web_folder() {
  std::error_code error;
  const fs::path self = fs::read_symlink("/proc/self/exe", error);
  for (const fs::path& candidate : {self.parent_path() / "web",
                                    self.parent_path() / "../share/tautline/web",
                                    fs::path(TAUTLINE_WEB_DIST)}) {
    if (fs::exists(candidate / "index.html", error)) return fs::weakly_canonical(candidate, error);
  }
  return TAUTLINE_WEB_DIST;
}

}  // namespace server
