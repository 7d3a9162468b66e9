// tests/hardware/stored.cpp: frames of a database, and the offset between the two clocks.
#include "tests/hardware/stored.hpp"

#include <algorithm>
#include <cmath>

#include "algo/explain.hpp"
#include "algo/laser_scan.hpp"
#include "db/run_reader.hpp"
#include "drivers/lms200_telegram.hpp"
#include "server/record/frame_codec.hpp"

namespace server::hardware {
namespace {

/// [s] of the machine's clock at the start of the run's clock. A scan's stamp is the time of its
/// first byte; the emulator records the time of its last one.
double epoch_of(const StoredRun& run, const Truth& truth) {
  std::vector<double> offsets;
  auto at = truth.scans.begin();
  for (const StoredScan& scan : run.scans) {
    const auto same = std::find_if(
        at, truth.scans.end(), [&](const SentLine& line) { return line.beams == scan.beams; });
    if (same == truth.scans.end()) continue;
    const std::size_t bytes = 2 * scan.beams.size() + 10;
    offsets.push_back(same->time - drivers::lms200::transfer_time(bytes, 500'000) - scan.stamp);
    at = same + 1;
  }
  if (offsets.empty()) return 0;
  const auto middle = offsets.begin() + static_cast<std::ptrdiff_t>(offsets.size() / 2);
  std::nth_element(offsets.begin(), middle, offsets.end());
  return *middle;
}

}  // namespace

StoredRun read_stored(const std::filesystem::path& database) {
  db::RunReader reader(database.string());
  const db::RunPage page = reader.list({}, 1);
  StoredRun run;
  algo::Telemetry t;
  std::optional<std::uint64_t> from = 0;
  while (from) {
    from = reader.frames(
        page.runs.front().id, *from, 1000, [&](std::uint64_t, std::span<const std::byte> bytes) {
          decode_frame(bytes, t);
          run.commands.push_back({t.observation.stamp, t.command.base.omega});
          for (const algo::LaserScan& scan : t.observation.scans) {
            StoredScan& stored = run.scans.emplace_back();
            stored.stamp = scan.stamp;
            stored.beams.resize(scan.size());
            algo::pack_beams(scan, stored.beams);
          }
        });
  }
  return run;
}

std::size_t found_in_order(const std::vector<StoredScan>& stored,
                           const std::vector<SentLine>& sent) {
  std::size_t found = 0;
  auto at = sent.begin();
  for (const StoredScan& scan : stored) {
    const auto same = std::find_if(
        at, sent.end(), [&](const SentLine& line) { return line.beams == scan.beams; });
    if (same == sent.end()) continue;
    at = same + 1;
    ++found;
  }
  return found;
}

double command_delay(const StoredRun& run, const Truth& truth, double track) {
  constexpr int kMost_ms = 200;
  constexpr double kStep = 0.001;  // [s]
  const double epoch = epoch_of(run, truth);
  double best = 0;
  double least = -1;
  for (int shift = 0; shift <= kMost_ms; ++shift) {
    double sum = 0;
    std::size_t heard = 0;
    for (const StoredCommand& command : run.commands) {
      const double when = epoch + command.stamp + shift * kStep;
      while (heard + 1 < truth.wheels.size() && truth.wheels[heard + 1].time <= when) ++heard;
      const WheelLine& wheels = truth.wheels[heard];
      sum += std::abs((wheels.right - wheels.left) / 1000 / track - command.omega);
    }
    if (least >= 0 && sum >= least) continue;
    least = sum;
    best = shift * kStep;
  }
  return best;
}

}  // namespace server::hardware
