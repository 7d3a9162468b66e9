// db/run_store_remarks.cpp: what people write on runs, and the trash from which they come back.
#include <algorithm>

#include "db/run_store_parts.hpp"
#include "db/tags.hpp"

namespace db {

using detail::ResetLater;
using detail::Statement;

bool RunStore::remark(RunId run, const RunRemarks& remarks) {
  return guarded([&] {
    begin();
    std::optional<std::string> tags;  // bound text must live as long as the statement is used
    if (remarks.tags) tags = detail::tags_text(*remarks.tags);
    Statement& changed = sql_->remark.reset();
    const ResetLater reset(changed);
    for (const std::optional<std::string>* text :
         {&remarks.label, &remarks.note, &std::as_const(tags)}) {
      *text ? changed << std::string_view(**text) : changed.skip();
    }
    changed << run;
    return changed.step();
  });
}

bool RunStore::change_tags(RunId run,
                           std::span<const std::string> added,
                           std::span<const std::string> removed) {
  const auto written = written_tags(run);
  if (!written) return false;
  std::vector<std::string> tags = detail::tags_of(*written);
  const auto has = [](std::span<const std::string> list, const std::string& tag) {
    return std::ranges::find(list, tag) != list.end();
  };
  std::erase_if(tags, [&](const std::string& tag) { return has(removed, tag); });
  for (const std::string& tag : added) {
    if (!has(tags, tag)) tags.push_back(tag);
  }
  return remark(run, {.tags = std::move(tags)});
}

std::optional<std::string> RunStore::written_tags(RunId run) {
  return guarded([&]() -> std::optional<std::string> {
    const ResetLater reset(sql_->tags.reset() << run);
    if (!sql_->tags.step()) return std::nullopt;
    return sql_->tags.text(0);
  });
}

std::vector<RunId> RunStore::runs_of_batch(RunId batch) {
  return guarded([&] {
    std::vector<RunId> runs;
    const ResetLater reset(sql_->batch.reset() << batch);
    while (sql_->batch.step()) runs.push_back(sql_->batch.integer(0));
    return runs;
  });
}

RunStore::Deletion RunStore::trash(RunId run, std::int64_t now) {
  return guarded([&] {
    begin();
    {
      const ResetLater reset(sql_->is_there.reset() << run);
      if (!sql_->is_there.step()) return Deletion::NotFound;
    }
    if (open_.contains(run)) return Deletion::StillRecording;
    const ResetLater reset(sql_->trash.reset() << now << run);
    return sql_->trash.step() ? Deletion::Deleted : Deletion::StillRecording;
  });
}

bool RunStore::restore(RunId run) {
  return guarded([&] {
    begin();
    const ResetLater reset(sql_->restore.reset() << run);
    return sql_->restore.step();
  });
}

std::size_t RunStore::empty_trash(std::int64_t until, std::size_t runs) {
  return guarded([&] {
    std::size_t count = 0;
    {
      const ResetLater reset(sql_->in_trash.reset() << until);
      if (!sql_->in_trash.step()) return count;
    }
    begin();
    const ResetLater reset(sql_->empty_trash.reset() << until << std::uint64_t{runs});
    while (sql_->empty_trash.step()) ++count;
    return count;
  });
}

}  // namespace db
