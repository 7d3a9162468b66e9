// server/emulate/truth_record.cpp: writes the lines of the record.
#include "server/emulate/truth_record.hpp"

#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace server::emulate {
namespace {

const char* word_for(drivers::lms200::SentScan::Fate fate) {
  using Fate = drivers::lms200::SentScan::Fate;
  switch (fate) {
    case Fate::Sent:
      return "sent";
    case Fate::Damaged:
      return "damaged";
    case Fate::Cut:
      return "cut";
    case Fate::Lost:
      return "lost";
    default:
      return "muted";
  }
}

}  // namespace

TruthRecord::TruthRecord(const std::filesystem::path& path) {
  if (path.empty()) return;
  file_.reset(std::fopen(path.c_str(), "w"));
  if (!file_) throw std::runtime_error(path.string() + " cannot be written.");
}

void TruthRecord::write(std::string_view line, bool at_once) {
  const std::lock_guard held(mutex_);
  const bool written = std::fwrite(line.data(), 1, line.size(), file_.get()) == line.size();
  if (written && (!at_once || std::fflush(file_.get()) == 0)) return;
  if (!std::exchange(incomplete_, true)) {
    fmt::print(stderr, "tautline: The record is incomplete: is the disk full?\n");
  }
}

void TruthRecord::scan(std::string_view device, const drivers::lms200::SentScan& scan, bool heard) {
  if (!file_) return;
  const bool unheard = !heard && scan.fate == drivers::lms200::SentScan::Fate::Sent;
  write(fmt::format("scan {} {} {:.6f} {} {} {}\n",
                    device,
                    scan.number,
                    scan.end,
                    unheard ? "unheard" : word_for(scan.fate),
                    scan.part ? static_cast<int>(*scan.part) : -1,
                    fmt::join(scan.beams, " ")),
        false);
}

void TruthRecord::wheels(const drivers::emulators::BaseCommand& command) {
  if (!file_) return;
  write(fmt::format("wheels {:.6f} {:.1f} {:.1f}\n",
                    command.time,
                    1000 * command.wanted.left,
                    1000 * command.wanted.right),
        true);
}

void TruthRecord::pose(double time,
                       const algo::Pose2& pose,
                       const drivers::emulators::WheelMotion& motion) {
  if (!file_) return;
  write(fmt::format("pose {:.6f} {:.2f} {:.2f} {:.2f} {:.2f} {:.2f}\n",
                    time,
                    1000 * pose.x,
                    1000 * pose.y,
                    1000 * pose.heading,
                    1000 * motion.left,
                    1000 * motion.right),
        true);
}

void TruthRecord::event(double time, std::string_view text) {
  if (!file_) return;
  write(fmt::format("event {:.6f} {}\n", time, text), true);
}

}  // namespace server::emulate
