// server/cli/command_sweep.cpp: `tautline sweep`: runs an experiment from a document.
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <stop_token>
#include <vector>

#include <fmt/format.h>

#include "server/cli/cli.hpp"
#include "server/cli/interrupt_watch.hpp"
#include "server/cli/pool_options.hpp"
#include "server/cli/slurm_sweep.hpp"
#include "server/cli/sweep_files.hpp"
#include "server/experiment/sweep/origin.hpp"
#include "server/experiment/sweep/sweep_run.hpp"
#include "server/record/run_json.hpp"
#include "server/run/json_limits.hpp"
#include "server/run/text_file.hpp"

namespace server {
namespace {

struct SweepCommand {
  std::string file{};
  std::string out{};
  unsigned workers = 0;
  std::optional<experiment::Shard> shard{};
  bool dry_run = false;
  std::string rerun{};             // "failed", "lost", or empty
  std::string record = "nothing";  // or "failures" or "all"
  bool slurm = false;
  std::optional<std::size_t> tasks{};
  std::vector<std::string> sbatch{};
  ControllerFlags controllers{};
};

sweep::Plan read_plan(const SweepCommand& command) {
  const std::string& file = command.file;
  try {
    return plan_from(
        parse_json(read_text(file), kOwnDocument), file, command.controllers.catalogue());
  } catch (const JsonError& e) {
    throw std::runtime_error(fmt::format("{}: {}", file, e.what()));
  }
}

std::string duration_text(double seconds) {
  if (seconds < 120) return fmt::format("{:.0f} s", std::ceil(seconds));
  if (seconds < 7200) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

std::string bytes_text(double bytes) {
  return bytes < 1e6 ? fmt::format("{:.0f} kB", bytes / 1e3)
                     : fmt::format("{:.1f} MB", bytes / 1e6);
}

int print_estimate(const sweep::Plan& plan) {
  const sweep::Document& document = plan.document();
  const sweep::Estimate cost = estimate(plan);
  fmt::print("{}: {} scenarios x {} controllers x {} settings x {} seeds\n",
             document.name,
             document.scenarios.size(),
             document.controllers.size(),
             document.points.size(),
             document.most_repeats());
  fmt::print("runs      {}\n", plan.size());
  fmt::print("CPU time  at most {}, if every run lasts until its time limit\n",
             duration_text(cost.cpu_time));
  fmt::print("files     about {}\n", bytes_text(cost.bytes));
  if (cost.extrapolated) {
    fmt::print(
        "These runs are slow: both are guessed from the first seconds of some controllers.\n");
  }
  return kReached;
}

/// "12 of 40 runs, 3.1 runs/s, 9 s left"
std::string progress_text(std::size_t done, std::size_t all, double elapsed) {
  const double rate = static_cast<double>(done) / elapsed;
  return fmt::format("{} of {} runs, {:.1f} runs/s, {} left",
                     done,
                     all,
                     rate,
                     duration_text(static_cast<double>(all - done) / rate));
}

sweep::Wanted wanted_runs(const std::string& rerun) {
  return rerun == "failed" ? sweep::Wanted::Failed
         : rerun == "lost" ? sweep::Wanted::Lost
                           : sweep::Wanted::Missing;
}

/// Its room is the disk: what was asked for must not be thinned.
std::unique_ptr<Recorder> open_recorder(const std::string& folder) {
  make_folder(folder);
  RecorderOptions options = recorder_options();
  options.retention_bytes = 0;
  options.when_full =
      "Make room on the disk, then give the same command again: it makes the missing records.";
  return std::make_unique<Recorder>((std::filesystem::path(folder) / "runs.db").string(), options);
}

sweep::Rows run(const sweep::Plan& plan, const SweepCommand& command) {
  using Clock = std::chrono::steady_clock;
  ProgressLine line;
  std::stop_source stop;
  const InterruptWatch watch(stop);
  const Clock::time_point begin = Clock::now();
  experiment::PoolOptions pool{.threads = command.workers, .stop = stop.get_token()};
  if (command.shard) pool.shard = *command.shard;
  pool.progress = [&](std::size_t done, std::size_t all) {
    const double elapsed = std::chrono::duration<double>(Clock::now() - begin).count();
    line.show(progress_text(done, all, elapsed));
  };
  std::unique_ptr<Recorder> recorder;
  if (command.record != "nothing") recorder = open_recorder(command.out);
  try {
    return run_sweep(
        plan,
        command.out,
        pool,
        wanted_runs(command.rerun),
        [](const std::string& text) { fmt::print(stderr, "tautline: warning: {}\n", text); },
        {recorder.get(), command.record == "failures"});
  } catch (const sweep::OtherExperiment& e) {
    throw std::runtime_error(std::string(e.what()) +
                             " Choose another folder with --out, or remove this one.");
  }
}

/// Runs one shard and writes no report, which only the whole can have.
int run_shard(const sweep::Plan& plan, const SweepCommand& command) {
  const experiment::Shard& shard = *command.shard;
  sweep::claim_for_shard(command.out, shard);
  const sweep::Rows rows = run(plan, command);
  std::size_t ended = 0;
  std::size_t failed = 0;
  for (std::size_t i = shard.index; i < rows.size(); i += shard.count) {
    if (rows.has(i)) ++(rows.broken(i) ? failed : ended);
  }
  const std::size_t all = shard.share(plan.size());
  fmt::print(
      "shard {}/{}: {} of {} runs in {}, {} failed; `tautline merge` folds shards into one\n",
      shard.index,
      shard.count,
      ended,
      all,
      command.out,
      failed);
  if (failed > 0) return kBadInput;
  return ended == all ? kReached : kIncomplete;
}

int run_on_slurm(const sweep::Plan& plan, const SweepCommand& command) {
  if (command.workers > 0) {
    throw std::runtime_error(
        "--workers is for this machine; with --slurm, --sbatch=--cpus-per-task=N gives each task "
        "N");
  }
  SlurmSweep request{.folder = command.out, .tasks = command.tasks, .options = command.sbatch};
  for (const std::string& controller : command.controllers.given) {
    request.controllers.insert(request.controllers.end(), {"--controller", controller});
  }
  request.controllers.insert(request.controllers.end(),
                             {"--answer-limit",
                              fmt::format("{}", command.controllers.answer_limit),
                              "--think-time",
                              command.controllers.think_time});
  return sweep_on_slurm(plan, request);
}

int execute(SweepCommand command) {
  const sweep::Plan plan = read_plan(command);
  if (command.dry_run) return print_estimate(plan);
  if (command.shard) return run_shard(plan, command);
  if (command.out.empty()) command.out = plan.document().name;
  sweep::check_is_whole(command.out);
  if (command.slurm) return run_on_slurm(plan, command);
  return write_and_print(plan, run(plan, command), command.out);
}

void add_slurm_options(Command sweep, SweepCommand& command) {
  const Option slurm = sweep.add_flag(
      "--slurm",
      command.slurm,
      "Submit the runs as one array of Slurm. Again: submit what is missing; if nothing is, merge "
      "and report (docs/scale.md)");
  sweep.add_option("--tasks", command.tasks, "Tasks of the array (default 16)")
      .range(1, 100'000)
      .needs(slurm);
  sweep
      .add_option(
          "--sbatch", command.sbatch, "An option of sbatch, as --sbatch=--time=1:00:00; repeatable")
      .type_name("OPTION")
      .one_value()
      .needs(slurm);
}

}  // namespace

void add_sweep_command(Command app, int& status) {
  auto command = std::make_shared<SweepCommand>();
  const Command sweep = app.add_subcommand(
      "sweep", "Run an experiment: scenarios x controllers x parameters x seeds, from a document");
  sweep.add_option("file", command->file, "The document, as JSON (docs/experiments.md)")
      .required()
      .existing_file()
      .type_name("FILE");
  add_threads_option(sweep, command->workers, "--workers");
  command->controllers.add_to(
      sweep, "A controller of your own for the document to name, as NAME=COMMAND; repeatable");
  sweep.add_flag("--dry-run",
                 command->dry_run,
                 "Run nothing: check everything, print the number of runs, CPU time and bytes");
  const Option out =
      sweep
          .add_option(
              "--out",
              command->out,
              "Folder of the results (default: the document's name); the finished runs that it "
              "holds are not made again")
          .type_name("DIR");
  add_shard_option(sweep, [command](const experiment::Shard& shard) {
    command->shard = shard;
  }).needs(out);
  sweep
      .add_option("--rerun",
                  command->rerun,
                  "Make only some runs again, with their seeds: failed (those that broke or killed "
                  "the program), lost (those under way when the program died)")
      .one_of({"failed", "lost"})
      .type_name("WHICH");
  sweep
      .add_option("--record",
                  command->record,
                  "Whole runs to store in runs.db of the folder, for `tautline serve --db`: "
                  "nothing (default), failures (those that do not reach), all")
      .one_of({"nothing", "failures", "all"})
      .type_name("WHICH");
  add_slurm_options(sweep, *command);
  sweep.get_option("--slurm").excludes(sweep.get_option("--shard"));
  sweep.get_option("--slurm").excludes(sweep.get_option("--record"));
  sweep.footer(
      "Ctrl-C keeps the finished runs; the same command goes on from there. Exit status: 0, 1 bad "
      "input or a run failed, 4 interrupted, or not yet at its end with --slurm.");
  sweep.callback([command, &status] { status = execute(*command); });
}

}  // namespace server
