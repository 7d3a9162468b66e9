// server/emulate/truth_record.hpp: a log of what emulated devices did, to check a driver by.
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

/// Times are from machine_time(), with six decimals. Beams are packed (algo/laser_scan.hpp):
/// millimetres or codes.
///
///   scan DEVICE NUMBER TIME FATE PART BEAM...   FATE sent, damaged, cut, lost, muted or unheard
///   wheels TIME LEFT RIGHT                      [mm/s] commanded by the host; 0: watchdog stop
///   pose TIME X Y HEADING LEFT RIGHT            [mm, mrad, mm/s] true pose and speeds, at 10 Hz
///   event TIME TEXT                             an injected fault
///
/// Thread-safe. Says once on standard error that the record is incomplete, such as on a full disk.
class TruthRecord {
 public:
  /// Records nothing without a path. Throws std::runtime_error with a sentence.
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
  bool incomplete_ = false;
};

}  // namespace server::emulate
