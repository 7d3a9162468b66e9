// server/record/recorder_health.cpp: handles a failing store, its recovery, and reports to people.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "server/record/recorder.hpp"

namespace server {

namespace {

using std::chrono::milliseconds;

// Delay before a locked store is tried again.
constexpr milliseconds kBusyRetry{20};
// A longer lock is reported: a backup locks a store only for moments.
constexpr milliseconds kBusyNotable{1000};
// If a new store is damaged within this time, the disk is faulty: do not set aside one store after
// another.
constexpr std::chrono::minutes kSetAsideAgain{1};
constexpr std::size_t kMostNews = 100;
// [bytes] that must be free before a store that filled its disk is opened again.
constexpr std::uint64_t kToWorkWith = std::uint64_t{4} << 20;

}  // namespace

void Recorder::open_store() {
  try {
    store_.open();
  } catch (const db::DatabaseError& error) {
    if (error.trouble() == db::Trouble::Refused) throw;
    note_trouble(error);
    recover();
  }
}

/// Uncommitted data is lost. From now on frames are dropped, or wait if the store is only locked.
void Recorder::note_trouble(const db::DatabaseError& error) {
  const auto now = Clock::now();
  const bool busy = error.trouble() == db::Trouble::Busy;
  if (!busy && (!ailment_ || ailment_->sentence != error.what())) report(error.what());
  ailment_ = {.trouble = error.trouble(),
              .sentence = error.what(),
              .since = ailment_ ? ailment_->since : now,
              .retry = now + (busy ? kBusyRetry : options_.retry_interval)};
  if (busy) return;
  takes_more_ = false;
  for (const auto& channel : channels_) {
    channel->fail(error.what());
    channel->missing_ = {.cause = db::GapCause::Failed, .sentence = without_folder(error.what())};
  }
  if (error.trouble() == db::Trouble::Damaged) set_aside("damaged");
  if (error.trouble() == db::Trouble::Outdated) set_aside("older");
}

void Recorder::set_aside(std::string_view why) {
  const auto now = Clock::now();
  if (set_aside_ != Clock::time_point{} && now - set_aside_ < kSetAsideAgain) return;
  try {
    const std::time_t wall = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
    const std::string name =
        store_.set_aside(why, fmt::format("{:%Y%m%dT%H%M%SZ}", fmt::gmtime(wall)));
    report(fmt::format("The {} run store was set aside as {}, and a new one is begun.", why, name));
    set_aside_ = now;
    ailment_->retry = now;
  } catch (const db::DatabaseError& error) {
    report(error.what());
  }
}

/// Begins a new store if the file was deleted or replaced: nobody could read runs written to the
/// old one.
void Recorder::look_at_file() {
  if (!store_.is_open() || store_.in_place()) return;
  note_trouble(db::DatabaseError(
      "The run store " + store_.path() + " was deleted or replaced: a new one is begun.",
      db::Trouble::Failed));
  ailment_->retry = {};
  recover();
}

/// Tries the store again, and resumes every run if it works.
void Recorder::recover() {
  if (!ailment_ || Clock::now() < ailment_->retry) return;
  const Ailment was = *ailment_;
  const bool busy = was.trouble == db::Trouble::Busy;
  try {
    if (was.trouble == db::Trouble::Full) {
      const DiskSpace disk = options_.disk(store_.path());
      // Little space is enough to delete runs. The room to record is judged later.
      if (disk.free < std::min(disk.reserve(), kToWorkWith)) {
        ailment_->retry = Clock::now() + options_.retry_interval;
        return;
      }
    }
    if (!busy || !store_.is_open()) store_.open();
    store_.begin();
    if (was.trouble == db::Trouble::Full) make_way();
    for (const auto& channel : channels_) resume(*channel);
    store_.commit();
  } catch (const db::DatabaseError& error) {
    store_.take_failure();
    note_trouble(error);
    return;
  }
  ailment_.reset();
  takes_more_ = !full_;
  for (const auto& channel : channels_) {
    if (!full_) channel->recover();
  }
  if (!busy) report("The run store takes writes again: the record goes on.");
  publish();
}

RunChannel* Recorder::live_channel() const {
  const auto live = std::find_if(channels_.rbegin(), channels_.rend(), [](const auto& channel) {
    return channel->keep() == Keep::NewestHour;
  });
  return live == channels_.rend() ? nullptr : live->get();
}

std::string Recorder::state_sentence(RecordKind kind, const RunChannel* live) const {
  switch (kind) {
    case RecordKind::Failed:
      return without_folder(ailment_->sentence) +
             " What happens now is not recorded; the record goes on by itself.";
    case RecordKind::Full:
      return *full_;
    case RecordKind::Paused:
      return "Nothing happens: the record pauses, and goes on with the next request.";
    default:
      break;
  }
  const auto span = live != nullptr ? store_.span(live->run()) : db::RunStore::Span{};
  if (span.from <= 0) return "Every tick is kept.";
  if (!live->dropped_) {
    return fmt::format("This store holds the run from {:.0f} s on.", std::ceil(span.from));
  }
  const double minutes = (span.to - span.from) / 60;
  if (span.to - span.from >= options_.live_span * 0.99) {
    return fmt::format("The newest {:.0f} min of this run are kept.", minutes);
  }
  return fmt::format("The newest {:.0f} min of this run are kept: there is no room for more.",
                     std::max(1.0, minutes));
}

/// The status of the run `live`, or of the store alone if null.
RecordStatus Recorder::status_of(const RunChannel* live) const {
  RecordStatus now{.kind = RecordKind::Recording, .limit = options_.retention_bytes};
  const bool notable = ailment_ && (ailment_->trouble != db::Trouble::Busy ||
                                    Clock::now() - ailment_->since > kBusyNotable);
  if (notable) {
    now.kind = RecordKind::Failed;
  } else if (full_) {
    now.kind = RecordKind::Full;
  } else if (live != nullptr && live->paused_) {
    now.kind = RecordKind::Paused;
  }
  now.sentence = state_sentence(now.kind, live);
  now.bytes = used_;
  if (live != nullptr) now.kept_from = store_.span(live->run()).from;
  now.deleted = evicted_;
  if (now.kept_from > 0 && live->dropped_) {
    if (!now.deleted.empty()) now.deleted += ' ';
    now.deleted += fmt::format("The first {:.0f} min of this run went for newer ticks.",
                               std::floor(now.kept_from / 60));
  }
  return now;
}

/// Updates the status of the newest live run, for status(), and of each run.
void Recorder::publish() {
  bool news = false;
  for (const auto& channel : channels_) {
    if (channel->keep() == Keep::NewestHour) news = channel->tell(status_of(channel.get())) || news;
  }
  RecordStatus now = status_of(live_channel());
  const std::lock_guard lock(mutex_);
  if (now != status_) {
    status_ = std::move(now);
    news = true;
  }
  if (news) ++revision_;
}

RecordStatus Recorder::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

std::vector<std::string> Recorder::take_news() {
  const std::lock_guard lock(mutex_);
  return std::exchange(news_, {});
}

/// Removes the store's folder, which only the host may know.
std::string Recorder::without_folder(std::string sentence) const {
  const std::filesystem::path path(store_.path());
  const std::string folder = path.parent_path().string() + "/";
  for (std::size_t at = sentence.find(folder); folder.size() > 1 && at != std::string::npos;
       at = sentence.find(folder, at)) {
    sentence.erase(at, folder.size());
  }
  return sentence;
}

void Recorder::report(const std::string& sentence) {
  if (options_.report) options_.report(sentence);
  const std::lock_guard lock(mutex_);
  if (news_.size() >= kMostNews) return;  // nobody listens
  news_.push_back(without_folder(sentence));
  ++revision_;
}

}  // namespace server
