// server/cli/pool_options.cpp: options for threads, shard, rows and judges.
#include "server/cli/pool_options.hpp"

#include <exception>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "server/cli/output_files.hpp"
#include "server/experiment/judge.hpp"
#include "server/experiment/table.hpp"

namespace server {
namespace {

/// The message that `check` throws, as an option's error; empty when it throws nothing.
template <typename Check>
std::string complaint(const Check& check) {
  try {
    check();
  } catch (const std::exception& e) {
    return e.what();
  }
  return {};
}

}  // namespace

void add_threads_option(Command command, unsigned& threads, const std::string& name) {
  command.add_option(name, threads, "0 (default): one per core").range(0, 256);
}

void add_first_seed_option(Command command, std::uint64_t& seed, const std::string& help) {
  command.add_option("--first-seed", seed, help).range(0, 1'000'000'000);
}

Option add_shard_option(Command command, std::function<void(const experiment::Shard&)> take) {
  return command
      .add_option_function(
          "--shard",
          [take = std::move(take)](const std::string& text) {
            take(experiment::shard_from_text(text));
          },
          "Only every Nth run from number I on (0 is the first). The shards of all I together are "
          "all runs")
      .check([](const std::string& text) {
        return complaint([&] { experiment::shard_from_text(text); });
      })
      .type_name("I/N");
}

void add_pool_options(Command command, experiment::PoolOptions& pool, const std::string& threads) {
  add_threads_option(command, pool.threads, threads);
  add_shard_option(command, [&pool](const experiment::Shard& shard) { pool.shard = shard; });
}

void refuse_nothing(std::size_t jobs, const experiment::Shard& shard, const std::string& noun) {
  if (jobs == 0) throw std::runtime_error(fmt::format("These options select no {}.", noun));
  if (shard.share(jobs) > 0) return;
  throw std::runtime_error(fmt::format(
      "--shard {}/{} is empty: the number of {} is {}.", shard.index, shard.count, noun, jobs));
}

void add_rows_option(Command command, std::string& file) {
  command.add_option("--rows", file, "Also write every run with every figure to this file")
      .check([](const std::string& path) -> std::string {
        return experiment::is_table_file(path)
                   ? ""
                   : path + ": must end in .txt, .md, .csv, .tex or .json";
      })
      .check(refuse_unwritable)
      .type_name("FILE");
}

std::string refuse_unknown_judge(const std::string& name) {
  return complaint([&] { experiment::find_judge(name); });
}

}  // namespace server
