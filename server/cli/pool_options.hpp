// server/cli/pool_options.hpp: options of the commands that run many trials.
#pragma once

#include <functional>
#include <string>

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
/// A check for the name of a judge.
std::string refuse_unknown_judge(const std::string& name);

}  // namespace server
