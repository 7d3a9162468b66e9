// server/cli/controller_flags.hpp: --controller and the options about controllers outside the
// program.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "algo/pipeline/controllers.hpp"
#include "server/cli/options.hpp"

namespace server {

struct ControllerFlags {
  std::vector<std::string> given{};  // names, commands, NAME=COMMAND
  double answer_limit = 10;          // [s] 0: none
  std::string think_time = "pause";

  void add_to(Command command, const std::string& help);
  /// The built-in controllers and those given as commands; null if none is. Throws std::exception
  /// with a sentence.
  std::shared_ptr<const algo::ControllerCatalogue> catalogue() const;
  /// The last one given by its name alone; else nothing.
  std::optional<std::string> named() const;
  /// named(), else the first one given as a command.
  std::optional<std::string> chosen() const;
};

}  // namespace server
