// server/external/registration.hpp: a user's controller, as the command line names it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "algo/pipeline/controllers.hpp"

namespace server::external {

/// What happens to the run clock while the controller thinks.
struct ThinkTime {
  enum class Kind : std::uint8_t {
    Pause,     // it stands still
    Measured,  // the answer acts as much later as it took, in whole ticks
    Fixed,     // the answer acts `ticks` later
  };
  Kind kind = Kind::Pause;
  std::uint32_t ticks = 0;
};
/// Parses "pause", "measured" or a number of ticks. Throws std::invalid_argument with a sentence.
ThinkTime think_time_from_text(std::string_view text);

struct Registration {
  std::string name{};  // in the catalogue
  /// A shell command; the path of a shared object, which ends in .so; or an address to listen on,
  /// "unix:/path" or "tcp:127.0.0.1:PORT".
  std::string command{};
  double answer_limit = 10;  // [s] longest wait for an answer; 0: no limit
  ThinkTime think{};
};

/// True if `text` of `--controller` is a command or NAME=COMMAND rather than the name of a
/// controller: it has a space, a slash or an equals sign.
bool is_command(std::string_view text);
/// Parses "NAME=COMMAND", or "COMMAND", whose name is "external". Throws std::invalid_argument with
/// a sentence if the name is not made of a-z, 0-9, _ and -, or is that of a built-in controller.
Registration registration_from_text(std::string_view text);

/// The built-in controllers and these. Each entry keeps its processes, at most one for each run in
/// progress, until the last copy of the catalogue is gone. Throws ControllerError if a shared
/// object cannot be loaded, std::invalid_argument for a name given twice.
algo::ControllerCatalogue catalogue_with(const std::vector<Registration>& own);

}  // namespace server::external
