// server/cli/command_barn.cpp: `tautline barn`: runs the BARN worlds and scores them by the
// official formula.
#include <array>
#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "algo/driving.hpp"
#include "algo/strip/strip_law.hpp"
#include "server/cli/cli.hpp"
#include "server/cli/output_files.hpp"
#include "server/cli/pool_options.hpp"
#include "server/lab/barn/barn_run.hpp"
#include "server/run/scenario_json.hpp"
#include "server/run/text_file.hpp"

namespace server {
namespace {

using nlohmann::json;

struct BarnCommand {
  std::string file{};
  std::string physics = "bullet";
  std::string scanner = "flat";
  std::string robot{};
  std::vector<std::uint64_t> only{};
  std::vector<std::string> settings{};
  bool as_json = false;
  std::string scenarios{};
  std::string rows{};
  ControllerFlags controllers{};
  barn::Options options{};
};

std::string_view name(experiment::Contact contact) {
  constexpr std::array<std::string_view, 4> kNames{"none", "avoidable", "unavoidable", "jumped"};
  return kNames.at(static_cast<std::size_t>(contact));
}

/// The parameters that every figure of the benchmark depends on.
constexpr std::array kNamed{&algo::kContractionGain, &algo::kSafetyDistance, &algo::kMaxSpeed};

json json_of(const barn::Rates& rates) {
  return {{"runs", rates.runs},
          {"success", rates.success},
          {"collisions", rates.collisions},
          {"timeouts", rates.timeouts}};
}

json result_json(const barn::Result& result) {
  const barn::Summary sum = summarise(result);
  json out = {{"worlds", sum.worlds},
              {"parameters", json::object()},
              {"by_difficulty", json::object()},
              {"score", sum.score},
              {"score_quarter", sum.score_quarter},
              {"mean_time_s", sum.mean_time},
              {"tick_us_p50", sum.tick_us_p50},
              {"tick_us_p99", sum.tick_us_p99},
              {"contacts_avoidable", sum.avoidable},
              {"contacts_unavoidable", sum.unavoidable},
              {"contacts_after_jump", sum.jumped},
              {"outcomes", json::array()}};
  out.update(json_of(sum.rates));
  for (const algo::ParameterInfo* parameter : kNamed) {
    out["parameters"][parameter->key()] = result.parameters[*parameter];
  }
  for (const barn::Bin& bin : by_difficulty(result)) {
    out["by_difficulty"][bin.difficulty] = json_of(bin.rates);
  }
  for (const barn::Run& run : result.runs) {
    out["outcomes"].push_back(
        {{"world", run.world},
         {"seed", run.seed},
         {"outcome", algo::name(run.row.outcome)},
         {"contact", name(run.contact())},
         {"time_s", run.row["barn_time_s"]},
         {"score", run.row["barn_score"]},
         {"min_clearance_m", run.row["min_clearance_m"]},
         {"path_m", run.row["path_m"]},
         {"end", {run.row["end_x_m"], run.row["end_y_m"], run.row["end_heading_rad"]}}});
  }
  return out;
}

void print_table(const barn::Result& result) {
  fmt::print("{}", to_text(runs_table(result)));
  const barn::Summary sum = summarise(result);
  fmt::print("\nPublic BARN worlds, our simulator, the official score formula: no rank.\n");
  for (const algo::ParameterInfo* parameter : kNamed) {
    fmt::print("{} {}\n",
               parameter->label,
               algo::with_unit(result.parameters[*parameter], parameter->unit));
  }
  fmt::print("worlds {}, runs {}\n", sum.worlds, sum.rates.runs);
  fmt::print("success    {:7.2f} %\n", 100 * sum.rates.success);
  fmt::print("collisions {:7.2f} %\n", 100 * sum.rates.collisions);
  fmt::print("timeouts   {:7.2f} %\n", 100 * sum.rates.timeouts);
  for (const barn::Bin& bin : by_difficulty(result)) {
    fmt::print("  {:9}{:6.2f} % success, {:.2f} % collisions, {} runs\n",
               bin.difficulty,
               100 * bin.rates.success,
               100 * bin.rates.collisions,
               bin.rates.runs);
  }
  fmt::print("score      {:7.4f} of 0.5\n", sum.score);
  fmt::print("           {:7.4f} of 0.25, the formula of 2022 and 2023\n", sum.score_quarter);
  if (sum.avoidable + sum.unavoidable + sum.jumped > 0) {
    fmt::print(
        "contacts   {} avoidable with hindsight, {} not, {} with an obstacle that had jumped\n",
        sum.avoidable,
        sum.unavoidable,
        sum.jumped);
  }
  fmt::print("mean time  {:7.2f} s\n", sum.mean_time);
  fmt::print("control tick p50 {:.0f} us, p99 {:.0f} us\n", sum.tick_us_p50, sum.tick_us_p99);
}

void write_scenarios(const std::vector<barn::World>& worlds,
                     const barn::Conditions& conditions,
                     const std::filesystem::path& folder) {
  make_folder(folder);
  for (const barn::World& world : worlds) {
    const sim::Scenario scenario = scenario_of(world, conditions);
    write_text(folder / (scenario.name + ".json"), to_json(scenario).dump(1) + "\n");
  }
  fmt::print(
      "{} scenarios written; `tautline serve --scenario {}/NAME.json` opens one in the page\n",
      worlds.size(),
      folder.string());
}

int execute(BarnCommand command) {
  refuse_shared_files({{"FILE", command.file}, {"--robot-model", command.robot}},
                      {{"--rows", command.rows}});
  std::vector<barn::World> worlds = barn::read_worlds(command.file);
  if (!command.only.empty()) {
    worlds = barn::worlds_numbered(std::move(worlds), command.only);
  }
  command.options.conditions.controller = command.controllers.chosen().value_or("");
  command.options.conditions.controllers = command.controllers.catalogue();
  command.options.conditions.parameters = parameters_set(command.settings);
  command.options.conditions.physics = physics_named(command.physics, "--physics");
  if (!command.robot.empty()) {
    command.options.conditions.robot = own_robots().load_file_or_name(command.robot);
  }
  command.options.conditions.scanner =
      command.scanner == "lms200" ? barn::Scanner::Lms200 : barn::Scanner::Flat;
  if (!command.scenarios.empty()) {
    write_scenarios(worlds, command.options.conditions, command.scenarios);
    return kReached;
  }
  refuse_nothing(worlds.size() * command.options.repeats, command.options.pool.shard, "runs");
  const barn::Result result = with_progress(
      command.options.pool, "runs", [&] { return run_worlds(worlds, command.options); });
  if (command.as_json) {
    fmt::print("{}\n", result_json(result).dump(2));
  } else {
    print_table(result);
  }
  if (!command.rows.empty()) write_table(rows_table(result), command.rows);
  return kReached;
}

}  // namespace

void add_barn_command(Command app, int& status) {
  auto command = std::make_shared<BarnCommand>();
  const Command barn = app.add_subcommand(
      "barn", "Run the worlds of a BARN or DynaBARN file and score them by the official formula");
  barn.add_option("file", command->file, "The worlds, as JSON").required().type_name("FILE");
  command->controllers.add_to(
      barn,
      "Default: strip; strip_moving in worlds with moving obstacles; or the command that starts "
      "your own (docs/external-controllers.md)");
  barn.add_flag(
      "--stress",
      command->options.conditions.stress,
      "Short scanner range, slow base, delay, slip, odometry drift; another robot keeps its own "
      "scanners and limits");
  barn.add_option("--physics", command->physics, "bullet (default) or kinematic")
      .one_of({"bullet", "kinematic"});
  const Option robot = add_robot_option(barn, command->robot);
  barn.add_option(
          "--scanner",
          command->scanner,
          "flat (default): the benchmark's, which measures all beams at one instant; lms200: the "
          "default LMS200, which sweeps")
      .one_of({"flat", "lms200"})
      .excludes(robot);
  barn.add_option("--repeats", command->options.repeats, "Seeds per world (default 1)")
      .range(1, 10'000);
  add_set_option(barn, command->settings);
  add_first_seed_option(barn, command->options.first_seed);
  barn.add_option("--phase",
                  command->options.conditions.phase,
                  "[s] Time of the obstacles' motion at the start of a run (default 0)")
      .range(0.0, 1e6);
  add_pool_options(barn, command->options.pool, "--workers");
  add_rows_option(barn, command->rows);
  barn.add_option("--world", command->only, "Only the worlds of these numbers");
  barn.add_option("--scenarios",
                  command->scenarios,
                  "Run nothing: write each world to this folder as a scenario for the page")
      .excludes(barn.get_option("--rows"))
      .type_name("DIR");
  barn.add_flag("--json", command->as_json, "Print JSON");
  barn.callback([command, &status] { status = execute(*command); });
}

}  // namespace server
