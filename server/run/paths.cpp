// server/run/paths.cpp: the freedesktop.org rules for state, with a fallback when HOME is unset.
#include "server/run/paths.hpp"

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

std::string without_folders(std::string_view sentence) {
  constexpr std::string_view kBefore = " \t\n'\"([=,;";
  constexpr std::string_view kAfter = " \t\n'\"()[],;:";
  std::string out;
  while (!sentence.empty()) {
    const bool word_begins = out.empty() || kBefore.find(out.back()) != std::string_view::npos;
    if (sentence.front() != '/' || !word_begins) {
      out.push_back(sentence.front());
      sentence.remove_prefix(1);
      continue;
    }
    std::string_view path = sentence.substr(0, sentence.find_first_of(kAfter));
    sentence.remove_prefix(path.size());
    const bool public_name = path.starts_with("/dev/") || path.starts_with("/api/");
    if (!public_name) {
      while (path.size() > 1 && path.back() == '/') path.remove_suffix(1);
      path.remove_prefix(path.size() > 1 ? path.rfind('/') + 1 : 0);
    }
    out.append(path);
  }
  return out;
}

}  // namespace server
