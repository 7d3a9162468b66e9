// server/emulate/log_player.hpp: feeds a recorded log to an emulated scanner instead of a world.
#pragma once

#include <filesystem>
#include <stop_token>
#include <thread>

#include "server/emulate/emulated_world.hpp"
#include "sim/replay.hpp"

namespace server::emulate {

/// Plays the scans of a CARMEN log to a scanner at their recorded rate, in a loop.
class LogPlayer {
 public:
  /// Throws std::runtime_error with a sentence when the file is no log.
  LogPlayer(const std::filesystem::path& log, Served<drivers::lms200::Emulator> scanner);

  void start();

 private:
  void run(const std::stop_token& stop);

  sim::Replay replay_;
  Served<drivers::lms200::Emulator> scanner_;
  std::jthread thread_{};
};

}  // namespace server::emulate
