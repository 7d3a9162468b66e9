// server/emulate/log_player.cpp: scans of a log, offered to an emulated scanner.
#include "server/emulate/log_player.hpp"

#include <cmath>
#include <numbers>

#include "server/emulate/clock.hpp"
#include "server/run/pacer.hpp"

namespace server::emulate {

LogPlayer::LogPlayer(const std::filesystem::path& log, Served<drivers::lms200::Emulator> scanner)
    : replay_(log), scanner_(scanner) {}

void LogPlayer::start() {
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

void LogPlayer::run(const std::stop_token& stop) {
  Pacer pacer;
  algo::Observation observation;
  replay_.reset(observation);
  while (!stop.stop_requested()) {
    for (const algo::LaserScan& scan : observation.scans) {
      if (std::abs(scan.mount_R.heading) > std::numbers::pi / 2) continue;  // from another scanner
      const auto held = scanner_.connection->lock();
      // Partial scans need single turns of the mirror, which a log does not record.
      if (scanner_.device->sweep().parts.empty()) scanner_.device->offer(scan, machine_time());
      scanner_.connection->wake();
    }
    if (!pacer.wait(replay_.next_period(), stop)) return;
    if (!replay_.step({}, observation)) replay_.reset(observation);
  }
}

}  // namespace server::emulate
