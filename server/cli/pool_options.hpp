// server/cli/pool_options.hpp: options of the commands that run many trials.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "server/cli/cli.hpp"
#include "server/cli/options.hpp"
#include "server/experiment/pool.hpp"

namespace server {

/// `threads` ("--workers") and --shard.
void add_pool_options(Command command, experiment::PoolOptions& pool, const std::string& threads);
/// --shard I/N; `take` gets what is given.
Option add_shard_option(Command command, std::function<void(const experiment::Shard&)> take);
/// Throws std::runtime_error if the options select no job, or the shard holds none of them.
/// `noun`: "runs".
void refuse_nothing(std::size_t jobs, const experiment::Shard& shard, const std::string& noun);
/// --threads of a study.
void add_threads_option(Command command, unsigned& threads, const std::string& name = "--threads");
/// --first-seed.
void add_first_seed_option(Command command,
                           std::uint64_t& seed,
                           const std::string& help = "The first seed (default 1)");
/// --rows FILE: every run with every figure.
void add_rows_option(Command command, std::string& file);
/// The result of `run`, which uses `pool`, while a line shows how many of the `noun` are done.
template <typename Run>
auto with_progress(experiment::PoolOptions& pool, std::string_view noun, const Run& run) {
  ProgressLine line;
  pool.progress = [&](std::size_t done, std::size_t all) {
    line.show(fmt::format("{} of {} {}", done, all, noun));
  };
  auto result = run();
  pool.progress = {};
  return result;
}

/// A check for the name of a judge.
std::string refuse_unknown_judge(const std::string& name);

}  // namespace server
