// server/record/recorder_room.cpp: decides what to keep when there is no room for everything.
//
// Finished runs are never deleted unless the host or a person asked for it. Runs that a person
// deleted wait in the trash for some minutes, as long as there is room. A live run drops its own
// oldest ticks. If that is not enough, recording stops until room is made.
#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "server/record/recorder.hpp"

namespace server {

namespace {

// Time in one commit interval for making room.
constexpr std::chrono::milliseconds kRoomTime{400};
// Blocks of a live run deleted in one transaction: about a thousand ticks.
constexpr std::size_t kDropBlocks = 16;
// Frames of a run stored between two steps of making room: more than arrive meanwhile in real time,
// and far fewer than a step frees. A fast run has a whole ring waiting, which could fill a small
// disk.
constexpr std::size_t kFewFrames = 64;
// Limits of the [bytes] of room at which stopped recording resumes.
constexpr std::int64_t kLeastRoom = 64 << 10;
constexpr std::int64_t kMostRoom = 16 << 20;

// Runs deleted from the trash in one transaction.
constexpr std::size_t kTrashSlice = 200;

constexpr double kMegabyte = 1024.0 * 1024.0;

}  // namespace

/// [bytes] that may still be written; negative: the excess already written.
std::int64_t Recorder::room() {
  used_ = store_.used_bytes() + store_.log_bytes();
  const auto bytes = [](std::uint64_t value) {
    constexpr auto kMost = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max() / 4);
    return static_cast<std::int64_t>(std::min(value, kMost));
  };
  const DiskSpace disk = options_.disk(store_.path());
  // While the log is folded into the file, its pages are in both. Dropping ticks also writes to the
  // log.
  const std::uint64_t for_log = 2 * store_.log_limit();
  const std::int64_t on_disk =
      bytes(disk.free) + bytes(store_.spare_bytes()) - bytes(disk.reserve()) - bytes(for_log);
  if (options_.retention_bytes == 0) return on_disk;
  return std::min(on_disk, bytes(options_.retention_bytes) - bytes(used_));
}

/// Frees the room of deleted runs in slices, at least one. Commits each slice, so frames that come
/// meanwhile are as safe as without the sweep. True while more is left.
bool Recorder::sweep(Clock::time_point until) {
  bool more = true;
  for (bool first = true; more && !ailment_ && (first || Clock::now() < until); first = false) {
    try {
      more = store_.sweep();
    } catch (const db::DatabaseError&) {
      throw;
    } catch (const db::StoreError& error) {
      report(error.what());  // one damaged run: the next may be intact
    }
    take_frames(kFewFrames);
  }
  return more;
}

/// Deletes some runs that came into the trash at `until` or before. True if there were any.
bool Recorder::empty_trash(std::chrono::system_clock::time_point until) {
  const std::int64_t seconds =
      std::chrono::duration_cast<std::chrono::seconds>(until.time_since_epoch()).count();
  const bool some = store_.empty_trash(seconds, kTrashSlice) > 0;
  store_.commit();
  return some;
}

/// Deletes the oldest finished run. False if there is none.
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

/// Drops some of the oldest ticks of live runs beyond their newest `span` [s]. True if any were
/// dropped.
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

/// True if another step of making room is due: until there is room, or the time for it is over. On
/// a slow machine that time may end before the room used since the last check is freed. Then the
/// steps go on, and the frames wait, until there is as much room as at that check.
bool Recorder::must_free(Clock::time_point until) {
  if (room() > 0) return false;
  if (Clock::now() < until) {
    take_frames(kFewFrames);
    return true;
  }
  store_.fold_log();  // freed room counts only once the log is folded
  return room() < room_left_;
}

/// Stops recording when there is no room and no more can be freed. Resumes it when there is room.
void Recorder::judge_room(bool more_to_come) {
  const std::int64_t left = room();
  room_left_ = left;
  const auto limit = static_cast<std::int64_t>(options_.retention_bytes);
  const std::int64_t enough =
      limit == 0 ? kMostRoom : std::clamp(limit / 64, kLeastRoom, kMostRoom);
  if (full_ && left >= enough) {
    full_.reset();
    for (const auto& channel : channels_) channel->recover();
    takes_more_ = true;  // set only once it is true for every run
    report("There is room again: the record goes on.");
  } else if (!full_ && left <= 0 && !more_to_come) {
    const bool by_limit = limit > 0 && used_ >= options_.retention_bytes;
    const std::string why = by_limit
                                ? fmt::format("The record is full: it holds {:.0f} of {:.0f} MB.",
                                              static_cast<double>(used_) / kMegabyte,
                                              static_cast<double>(limit) / kMegabyte)
                                : std::string("The disk under the record is almost full.");
    full_ = fmt::format("{} {}", why, options_.when_full);
    for (const auto& channel : channels_) channel->fail(*full_);
    publish();  // before takes_more() refuses: its caller then reads the reason in the status
    takes_more_ = false;
    report(*full_);
  }
}

void Recorder::make_room() {
  if (ailment_) return;
  const auto until = Clock::now() + kRoomTime;
  try {
    const auto now = std::chrono::system_clock::now();
    empty_trash(now - options_.trash_time);
    bool more = sweep(until);
    while (drop_live(options_.live_span) && Clock::now() < until) take_frames(kFewFrames);
    // A log without further writes would keep its length.
    if (full_ || room() <= 0) store_.fold_log();
    while (!ailment_ && must_free(until)) {
      if (more) {
        more = sweep(until);
      } else if (empty_trash(now) || (options_.evict_oldest && evict())) {
        more = true;
      } else if (!drop_live(options_.least_span)) {
        break;
      }
    }
    judge_room(more || Clock::now() >= until);
  } catch (const db::DatabaseError& error) {
    // A failure here concerns old runs and ends no current recording. If writing fails too, the
    // next commit reports it.
    if (error.trouble() != db::Trouble::Busy && room_problem_ != error.what()) {
      room_problem_ = error.what();
      report(room_problem_);
    }
  }
  if (const auto failure = store_.take_failure()) note_trouble(*failure);
}

}  // namespace server
