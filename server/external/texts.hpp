// server/external/texts.hpp: keeps the names of foreign layers and measures, which frames refer to
// after their tick.
#pragma once

#include <cstddef>
#include <mutex>
#include <set>
#include <string>
#include <string_view>

namespace server::external {

/// Callable from any thread. A text stays valid as long as this object.
class Texts {
 public:
  static constexpr std::size_t kMost = 1024;
  static constexpr std::size_t kLongest = 64;  // bytes

  /// The kept copy of `text`. Throws ControllerError for a text that is too long, or one too many.
  std::string_view keep(std::string_view text);

 private:
  std::mutex mutex_{};
  std::set<std::string, std::less<>> kept_{};
};

}  // namespace server::external
