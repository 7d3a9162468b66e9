// server/cli/pool_options.hpp: options of the commands that run many trials.
#pragma once

#include <functional>
#include <string>

#include <CLI/CLI.hpp>

#include "server/experiment/pool.hpp"

namespace server {

/// `threads` ("--workers") and --shard.
void add_pool_options(CLI::App& command, experiment::PoolOptions& pool, const std::string& threads);
/// --shard I/N; `take` gets what is given.
CLI::Option* add_shard_option(CLI::App& command,
                              std::function<void(const experiment::Shard&)> take);
/// --threads of a study.
void add_threads_option(CLI::App& command,
                        unsigned& threads,
                        const std::string& name = "--threads");
/// --first-seed.
void add_first_seed_option(CLI::App& command,
                           std::uint64_t& seed,
                           const std::string& help = "The first seed (default 1)");
/// --rows FILE: every run with every figure.
void add_rows_option(CLI::App& command, std::string& file);
/// The name of a judge.
CLI::Validator judge_name();

}  // namespace server
