// server/cli/command_run.cpp: `tautline run` and `tautline replay`: run headless and print figures.
#include <cstdio>
#include <memory>
#include <stop_token>

#include <fmt/format.h>

#include "server/cli/cli.hpp"
#include "server/cli/interrupt_watch.hpp"
#include "server/cli/signals.hpp"
#include "server/record/headless.hpp"
#include "server/record/run_json.hpp"
#include "server/run/scenario_json.hpp"
#include "server/run/scenario_library.hpp"
#include "sim/replay.hpp"

namespace server {
namespace {

using nlohmann::json;

struct RunCommand {
  std::string scenario{};  // or a log
  bool replays = false;
  std::string out{};
  double pace = 0;
  bool as_json = false;
  RunFlags flags{};
};

int exit_status(algo::Outcome outcome) {
  switch (outcome) {
    case algo::Outcome::Reached:
    case algo::Outcome::EndOfLog:
      return kReached;
    case algo::Outcome::Collided:
    case algo::Outcome::Overturned:
    case algo::Outcome::Fallen:
      return kCollided;
    case algo::Outcome::Failed:
      return kBadInput;
    default:
      return kNotReached;
  }
}

void print_table(const RunSpec& spec, const HeadlessResult& result, std::int64_t run_id) {
  const algo::Metrics& m = result.run.metrics;
  const bool log = !spec.scenario.log.empty();
  fmt::print("{} · {} · {}", spec.scenario.name, spec.scenario.controller, spec.scenario.filter);
  if (!log) {
    fmt::print(" · {} · seed {}", physics_of(spec), spec.seed);
  }
  fmt::print("\n");
  fmt::print("  outcome          {}\n", algo::name(result.run.outcome));
  if (!result.run.reason.empty()) fmt::print("                   {}\n", result.run.reason);
  fmt::print("  time             {:.2f} s, {} ticks\n", m.time, m.ticks);
  fmt::print("  path length      {:.3f} m\n", m.path_length);
  fmt::print("  least clearance  {:.3f} m\n", m.min_clearance);
  fmt::print("  intrusion        {:.3f} m for {:.1f} s\n", m.intrusion, m.infringed_time);
  fmt::print("  turning          {:.2f} rad\n", m.turning);
  fmt::print("  via points       {}\n", m.via_points);
  if (run_id > 0) fmt::print("  stored as run    {}\n", run_id);
  fmt::print("  telemetry_hash   {:016x}\n", result.telemetry_hash);
}

int execute(const RunCommand& options) {
  if (options.replays) warn_of_damage(options.scenario, sim::Replay(options.scenario).damage());
  const RunSpec spec = make_spec(options.replays ? ScenarioLibrary::from_log(options.scenario)
                                                 : find_scenario(options.scenario),
                                 options.flags.resolved(),
                                 own_robots());
  const std::unique_ptr<algo::Robot> robot = make_robot(spec);
  std::unique_ptr<Recorder> recorder;
  HeadlessOptions headless;
  headless.pace = options.pace;
  headless.hash_frames = true;
  if (!options.out.empty()) {
    RecorderOptions recording = recorder_options();
    recording.when_full = "Make room on the disk, then make the run again.";
    recorder = std::make_unique<Recorder>(options.out, std::move(recording));
    headless.record = recorder->open(headless_run(spec, robot->spec(), options.pace));
  }
  ProgressLine progress;
  const double limit = time_limit(spec);
  headless.progress = [&](double stamp, std::uint64_t ticks) {
    const std::string most = limit > 0 ? fmt::format(" of at most {:.0f} s", limit) : std::string();
    progress.show(fmt::format("{:.0f} s{}, {} ticks", stamp, most, ticks));
  };

  std::stop_source stop;
  HeadlessResult result;
  {
    const InterruptWatch watch(stop);
    result = run_headless(spec, *robot, headless, stop.get_token());
  }
  std::int64_t run_id = 0;
  std::string problem;  // of the record
  if (recorder) {
    // Waits for a locked store without a limit; the user may interrupt.
    while (!recorder->flush() && !end_requested()) {
    }
    run_id = headless.record->run();
    problem = headless.record->incomplete();
  }
  if (options.as_json) {
    json out = {{"scenario", spec.scenario.name},
                {"controller", spec.scenario.controller},
                {"filter", spec.scenario.filter},
                {"seed", spec.seed},
                {"outcome", algo::name(result.run.outcome)},
                {"reason", result.run.reason},
                {"metrics", to_json(result.run.metrics)},
                {"telemetry_hash", fmt::format("{:016x}", result.telemetry_hash)}};
    out["physics"] = physics_of(spec);
    out["vehicle"] = physics_of(spec);  // its old name
    if (run_id > 0) out["run"] = run_id;
    fmt::print("{}\n", out.dump(2));
  } else {
    print_table(spec, result, run_id);
  }
  if (problem.empty()) return exit_status(result.run.outcome);
  fmt::print(stderr, "tautline: The record of this run is incomplete. {}\n", problem);
  return kBadInput;
}

}  // namespace

void add_run_command(Command app, int& status) {
  auto options = std::make_shared<RunCommand>();
  const Command command =
      app.add_subcommand("run", "Run a scenario headless and print its figures");
  command.add_option("SCENARIO", options->scenario, "Name of a scenario, or path of a .json file")
      .required();
  options->flags.add_to(command);
  options->flags.add_arm_to(command);
  options->flags.add_map_to(command);
  command.add_option("--out", options->out, "Also store the run in this database").type_name("DB");
  command.add_option("--pace", options->pace, "Times real time; 0 (default): as fast as it goes")
      .range(0.0, 1000.0);
  command.add_flag("--json", options->as_json, "Print JSON");
  command.footer(
      "Exit status: 0 reached, 1 bad input or error, 2 stuck or out of time, 3 collision.");
  command.callback([options, &status] { status = execute(*options); });
}

void add_replay_command(Command app, int& status) {
  auto options = std::make_shared<RunCommand>();
  options->replays = true;
  const Command command =
      app.add_subcommand("replay", "Replay a CARMEN laser log through the whole pipeline");
  command.add_option("LOG", options->scenario, "A CARMEN log file").required().existing_file();
  command.add_option(
      "--filter", options->flags.overrides.filter, "pseudomedian (default), median, lulu or none");
  add_set_option(command, options->flags.settings);
  options->flags.add_map_to(command);
  command.add_option("--out", options->out, "Store the run in this database").type_name("DB");
  command
      .add_option("--pace",
                  options->pace,
                  "1: the log's own pace; N: times that; 0 (default): as fast as it goes")
      .range(0.0, 1000.0);
  command.add_flag("--json", options->as_json, "Print JSON");
  command.footer("To watch a log in the browser: tautline serve --scenario LOG");
  command.callback([options, &status] { status = execute(*options); });
}

}  // namespace server
