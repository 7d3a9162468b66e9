// server/external/texts.cpp: a set of texts.
#include "server/external/texts.hpp"

#include <fmt/format.h>

#include "server/external/peer.hpp"

namespace server::external {

std::string_view Texts::keep(std::string_view text) {
  if (text.empty()) return {};
  if (text.size() > kLongest) {
    throw ControllerError(
        fmt::format("It names a layer or a measure by {} bytes; at most {} are allowed.",
                    text.size(),
                    kLongest));
  }
  const std::lock_guard lock(mutex_);
  const auto found = kept_.find(text);
  if (found != kept_.end()) return *found;
  if (kept_.size() >= kMost) {
    throw ControllerError(fmt::format(
        "It has used {} different names of layers and measures; no more are kept.", kMost));
  }
  return *kept_.emplace(text).first;
}

}  // namespace server::external
