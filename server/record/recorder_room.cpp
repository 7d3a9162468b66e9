// server/record/recorder_room.cpp: what is kept when there is no room for everything.
//
// Finished runs are never deleted unless the host asked for it. A live run gives its own oldest
// ticks up; when that is not enough, recording stops until somebody makes room.
#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "server/record/recorder.hpp"

namespace server {

namespace {

// What one commit interval may spend on making room.
constexpr std::chrono::milliseconds kRoomTime{400};
// Blocks of a live run that go in one transaction: some thousand ticks.
constexpr std::size_t kDropBlocks = 16;
// Frames of a run that are stored between two steps of making room: more than come meanwhile in
// real time, and far fewer than a step frees. A fast run has a whole ring of them waiting, and
// would fill a small disk.
constexpr std::size_t kFewFrames = 64;
// Recording that has stopped for want of room begins again when there is so much.
constexpr std::int64_t kLeastRoom = 64 << 10;
constexpr std::int64_t kMostRoom = 16 << 20;

constexpr double kMegabyte = 1024.0 * 1024.0;

}  // namespace

/// [bytes] that may still be written; negative: so many too many are.
std::int64_t Recorder::room() {
  used_ = store_.used_bytes() + store_.log_bytes();
  const auto bytes = [](std::uint64_t value) {
    constexpr auto kMost = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max() / 4);
    return static_cast<std::int64_t>(std::min(value, kMost));
  };
  const DiskSpace disk = options_.disk(store_.path());
  // While the log is folded into the file, its pages are in both; dropping ticks writes to it too.
  const std::uint64_t for_log = 2 * store_.log_limit();
  const std::int64_t on_disk =
      bytes(disk.free) + bytes(store_.spare_bytes()) - bytes(disk.reserve()) - bytes(for_log);
  if (options_.retention_bytes == 0) return on_disk;
  return std::min(on_disk, bytes(options_.retention_bytes) - bytes(used_));
}

/// Gives the room of deleted runs back, slice by slice, each committed: the frames that come
/// meanwhile are as safe as without it. One slice at least. True while there is more.
bool Recorder::sweep(Clock::time_point until) {
  bool more = true;
  for (bool first = true; more && !ailment_ && (first || Clock::now() < until); first = false) {
    try {
      more = store_.sweep();
    } catch (const db::DatabaseError&) {
      throw;
    } catch (const db::StoreError& error) {
      report(error.what());  // one run that is damaged: the next may be well
    }
    take_frames(kFewFrames);
  }
  return more;
}

/// Deletes the oldest finished run. False when there is none.
bool Recorder::evict() {
  const auto run = store_.retire_oldest(0);
  if (!run) return false;
  ++evicted_runs_;
  evicted_ = fmt::format("{} finished {} deleted for room (--evict oldest), run {} last.",
                         evicted_runs_,
                         evicted_runs_ == 1 ? "run was" : "runs were",
                         run->id);
  report(fmt::format("Deleted run {} ({}, {}, {} ticks) for room: --evict oldest.",
                     run->id,
                     run->what.scenario,
                     run->what.started,
                     run->ticks));
  return true;
}

/// Drops some of the oldest ticks of live runs beyond their newest `span` [s]. True when some went.
bool Recorder::drop_live(double span) {
  bool dropped = false;
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    const std::shared_ptr<RunChannel> channel = channels_[i];
    if (channel->keep() != Keep::NewestHour) continue;
    const auto kept = store_.span(channel->run());
    if (kept.to - kept.from <= span) continue;
    const bool went =
        store_.drop_oldest(channel->run(),
                           kept.to - span,
                           kDropBlocks,
                           "A live run gives its oldest ticks up for newer ones.") > 0;
    channel->dropped_ |= went;
    dropped |= went;
  }
  return dropped;
}

/// Whether another step of making room is due: until there is some, or the time for it is over. On
/// a slow machine it is over before what came since the last look is freed: then the frames wait,
/// and time passes, until there is as much room as at that look.
bool Recorder::must_free(Clock::time_point until) {
  if (room() > 0) return false;
  if (Clock::now() < until) {
    take_frames(kFewFrames);
    return true;
  }
  store_.fold_log();  // what was freed counts once it is out of the log
  return room() < room_left_;
}

/// Stops recording when there is no room and none to come, and begins again when there is.
void Recorder::judge_room(bool more_to_come) {
  const std::int64_t left = room();
  room_left_ = left;
  const auto limit = static_cast<std::int64_t>(options_.retention_bytes);
  const std::int64_t enough =
      limit == 0 ? kMostRoom : std::clamp(limit / 64, kLeastRoom, kMostRoom);
  if (full_ && left >= enough) {
    full_.reset();
    for (const auto& channel : channels_) channel->recover();
    takes_more_ = true;  // told once it holds of every run
    report("There is room again: the record goes on.");
  } else if (!full_ && left <= 0 && !more_to_come) {
    const bool by_limit = limit > 0 && used_ >= options_.retention_bytes;
    const std::string why = by_limit
                                ? fmt::format("The record is full: it holds {:.0f} of {:.0f} MB.",
                                              static_cast<double>(used_) / kMegabyte,
                                              static_cast<double>(limit) / kMegabyte)
                                : std::string("The disk under the record is almost full.");
    full_ = why +
            " Finished runs are never deleted unasked, so nothing more is recorded: delete"
            " runs, or start the server with a larger --keep or with --evict oldest.";
    for (const auto& channel : channels_) channel->fail(*full_);
    takes_more_ = false;
    report(*full_);
  }
}

void Recorder::make_room() {
  if (ailment_) return;
  const auto until = Clock::now() + kRoomTime;
  try {
    bool more = sweep(until);
    while (drop_live(options_.live_span) && Clock::now() < until) take_frames(kFewFrames);
    // A log that nobody writes to any more would stay as long as it is.
    if (full_ || room() <= 0) store_.fold_log();
    while (!ailment_ && must_free(until)) {
      if (more) {
        more = sweep(until);
      } else if (options_.evict_oldest && evict()) {
        more = true;
      } else if (!drop_live(options_.least_span)) {
        break;
      }
    }
    judge_room(more || Clock::now() >= until);
  } catch (const db::DatabaseError& error) {
    // What fails here is old: it ends no run that is being recorded. Unless writing fails too,
    // which the next commit says.
    if (error.trouble() != db::Trouble::Busy && room_problem_ != error.what()) {
      room_problem_ = error.what();
      report(room_problem_);
    }
  }
  if (const auto failure = store_.take_failure()) note_trouble(*failure);
}

}  // namespace server
