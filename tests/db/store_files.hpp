// tests/db/store_files.hpp: a temporary folder for every test, and helpers that fill a store.
#pragma once

#include <filesystem>
#include <string>

#include "tests/db/frames.hpp"
#include <gtest/gtest.h>
#include <stdlib.h>

#include "db/run_reader.hpp"
#include "db/run_store.hpp"

namespace test {

class StoreFiles : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = testing::TempDir() + "tautline_db_XXXXXX";
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder = pattern;
    path = (folder / "runs.db").string();
  }
  void TearDown() override { std::filesystem::remove_all(folder); }

  static db::NewRun what(const std::string& scenario = "case1") {
    return {.scenario = scenario,
            .document = R"({"name":")" + scenario + R"("})",
            .controller = "modified",
            .filter = "pseudomedian",
            .physics = "kinematic",
            .seed = 0xFFFFFFFFFFFFFFF1ULL,
            .parameters = R"({"k_r":0.6})",
            .version = "0.1.0",
            .started = "2026-11-21T10:40:47Z"};
  }
  /// [s] run clock
  static double time_of(std::uint64_t tick) { return 0.026 * static_cast<double>(tick); }
  /// Frames 0 .. count-1 of a run, the same for the same seed.
  static std::vector<Frame> frames(std::size_t count, std::uint64_t seed = 1) {
    FrameMaker maker(seed, 3);
    std::vector<Frame> made;
    for (std::size_t i = 0; i < count; ++i) made.push_back(maker.next());
    return made;
  }
  static void append(db::RunStore& store, db::RunId run, std::uint64_t tick, const Frame& frame) {
    store.append_tick(run, tick, time_of(tick), frame.bytes, frame.windows);
  }
  /// A whole run of `count` ticks, committed.
  static db::RunId record(db::RunStore& store,
                          std::size_t count,
                          const std::string& scenario = "case1",
                          const std::string& outcome = "reached") {
    const db::RunId run = store.begin_run(what(scenario));
    const auto made = frames(count);
    for (std::size_t i = 0; i < count; ++i) append(store, run, i, made[i]);
    store.end_run(run, {.outcome = outcome, .metrics = R"({"ticks":1})"});
    store.commit();
    return run;
  }
  /// All frames from tick `from` on, in pages of `limit`.
  static std::vector<std::vector<std::byte>> read_frames(db::RunReader& reader,
                                                         db::RunId run,
                                                         std::uint64_t from = 0,
                                                         std::size_t limit = 10) {
    std::vector<std::vector<std::byte>> found;
    for (std::uint64_t at = from;;) {
      const auto next =
          reader.frames(run, at, limit, [&](std::uint64_t, std::span<const std::byte> bytes) {
            found.emplace_back(bytes.begin(), bytes.end());
          });
      if (!next) return found;
      at = *next;
    }
  }
  /// The row of a run that must exist.
  static db::RunRow get(db::RunReader& reader, db::RunId run) {
    std::optional<db::RunRow> found = reader.get(run);
    EXPECT_TRUE(found.has_value()) << "run " << run;
    return std::move(found).value_or(db::RunRow{});
  }
  static std::string integrity(const std::string& file) {
    const db::detail::Connection connection(file, db::detail::Connection::Mode::Write);
    db::detail::Statement check = connection.prepare("PRAGMA integrity_check");
    return check.step() ? check.text(0) : "no answer";
  }

  std::filesystem::path folder{};
  std::string path{};
};

/// The sentence of the StoreError that `action` throws, or "".
template <typename Action>
std::string refusal(const Action& action) {
  try {
    action();
  } catch (const db::StoreError& error) {
    return error.what();
  }
  return "";
}

}  // namespace test
