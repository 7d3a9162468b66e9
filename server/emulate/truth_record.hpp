// server/emulate/truth_record.hpp: what emulated devices did, one line each, to hold a driver
// against.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "algo/types.hpp"
#include "drivers/emulators/base.hpp"
#include "drivers/emulators/lms200_emulator.hpp"

namespace server::emulate {

/// Times are those of machine_time(), with six decimals; ranges are beams on the wire
/// (algo/laser_scan.hpp), millimetres but for the codes.
///
///   scan DEVICE NUMBER TIME FATE PART BEAM...   FATE sent, damaged, cut, lost, muted or unheard
///   wheels TIME LEFT RIGHT                      [mm/s] told by the host, or 0 by the base itself
///   pose TIME X Y HEADING LEFT RIGHT            [mm, mrad, mm/s] the truth, ten times a second
///   event TIME TEXT                             a fault injected
///
/// For any thread.
class TruthRecord {
 public:
  /// Keeps nothing without a path. Throws std::runtime_error with a sentence.
  explicit TruthRecord(const std::filesystem::path& path = {});

  void scan(std::string_view device, const drivers::lms200::SentScan& scan, bool heard);
  void wheels(const drivers::emulators::BaseCommand& command);
  void pose(double time, const algo::Pose2& pose, const drivers::emulators::WheelMotion& motion);
  void event(double time, std::string_view text);

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  void write(std::string_view line, bool at_once);

  std::unique_ptr<std::FILE, Close> file_{};
  std::mutex mutex_{};
};

}  // namespace server::emulate
