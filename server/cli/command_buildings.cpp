// server/cli/command_buildings.cpp: `tautline buildings`: drives to goals in random buildings.
#include <charconv>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "server/cli/cli.hpp"
#include "server/cli/output_files.hpp"
#include "server/cli/pool_options.hpp"
#include "server/lab/buildings/building_study.hpp"
#include "server/lab/buildings/tour_study.hpp"
#include "server/run/scenario_json.hpp"
#include "server/run/text_file.hpp"

namespace server {
namespace {

struct BuildingsCommand {
  std::string seeds = "0-199";
  std::vector<std::string> kinds{};
  bool as_json = false;
  bool list = false;
  std::string rows{};
  std::string scenario{};
  std::size_t tour = 0;  // goals; 0: one goal in each building
  std::vector<std::string> odometries{};
  buildings::Options options{};
};

/// Parses "A-B" or "A".
void read_seeds(std::string_view text, buildings::Options& options) {
  const std::size_t dash = text.find('-');
  const auto number = [&](std::string_view digits) {
    std::uint64_t value = 0;
    const char* const end = digits.data() + digits.size();
    const auto [stopped, error] = std::from_chars(digits.data(), end, value);
    if (error != std::errc{} || stopped != end) {
      throw std::invalid_argument(
          fmt::format("--seeds: '{}' is no seed or range of seeds like 0-199", text));
    }
    return value;
  };
  options.first_seed = number(text.substr(0, dash));
  options.last_seed =
      dash == std::string_view::npos ? options.first_seed : number(text.substr(dash + 1));
  constexpr std::uint64_t kMostSeeds = 1'000'000;
  if (options.last_seed < options.first_seed ||
      options.last_seed - options.first_seed > kMostSeeds) {
    throw std::invalid_argument(
        fmt::format("--seeds: '{}' must ascend, by at most {}", text, kMostSeeds));
  }
}

int execute_tours(const BuildingsCommand& command) {
  buildings::TourStudyOptions options{.buildings = command.options, .goals = command.tour};
  if (!command.odometries.empty()) options.odometries.clear();
  for (const std::string& odometry : command.odometries) {
    options.odometries.push_back(buildings::odometry_named(odometry));
  }
  refuse_nothing(seeds_of(command.options).size() * options.odometries.size(),
                 command.options.pool.shard,
                 "tours");
  const std::vector<buildings::Tour> tours =
      with_progress(options.buildings.pool, "tours", [&] { return run_tours(options); });
  if (command.as_json) {
    fmt::print("{}\n", tours_json(tours).dump(2));
  } else {
    if (command.list) fmt::print("{}\n", to_text(tour_faults_table(tours)));
    fmt::print("{}", to_markdown(tours_table(tours)));
  }
  if (!command.rows.empty()) write_table(legs_table(tours), command.rows);
  return kReached;
}

int execute(BuildingsCommand command) {
  read_seeds(command.seeds, command.options);
  for (const std::string& kind : command.kinds) {
    command.options.kinds.push_back(buildings::kind_named(kind));
  }
  if (!command.scenario.empty()) {
    write_text(command.scenario, to_json(first_scenario(command.options)).dump(1) + "\n");
    return kReached;
  }
  if (command.tour > 0) return execute_tours(command);
  refuse_nothing(seeds_of(command.options).size(), command.options.pool.shard, "buildings");
  const std::vector<buildings::BuildingRun> runs = with_progress(
      command.options.pool, "buildings", [&] { return run_buildings(command.options); });
  if (command.as_json) {
    fmt::print("{}\n", to_json(runs).dump(2));
  } else {
    if (command.list) fmt::print("{}\n", to_text(faults_table(runs)));
    const buildings::TickTimes ticks = tick_times(runs);
    fmt::print("{}\ncontrol tick p50 {:.0f} us, p99 {:.0f} us\n",
               to_text(figures_table(runs)),
               ticks.p50,
               ticks.p99);
  }
  if (!command.rows.empty()) write_table(rows_table(runs), command.rows);
  return kReached;
}

}  // namespace

void add_buildings_command(Command app, int& status) {
  auto command = std::make_shared<BuildingsCommand>();
  const Command buildings = app.add_subcommand(
      "buildings",
      "Drive to goals in random mazes, flats, offices, halls, dead ends and spirals, and compare "
      "with a search over the true world");
  buildings.add_option("--seeds", command->seeds, "One building per seed (default 0-199)")
      .type_name("A-B");
  buildings.add_option(
      "--kinds", command->kinds, "Only these: maze, flat, office, hall, dead_ends, spiral");
  buildings.add_option("--controller", command->options.controller, "Default: strip");
  add_pool_options(buildings, command->options.pool, "--workers");
  add_rows_option(buildings, command->rows);
  buildings.add_flag("--list", command->list, "List every run that did not end as it should");
  buildings
      .add_option("--scenario",
                  command->scenario,
                  "Run nothing: write the first building to this file as a scenario for the page")
      .excludes(buildings.get_option("--rows"))
      .check(refuse_unwritable)
      .type_name("FILE");
  const Option tour =
      buildings
          .add_option(
              "--tour",
              command->tour,
              "In each building this many goals, one after another without a restart (200 are a "
              "long tour)")
          .excludes(buildings.get_option("--scenario"))
          .type_name("GOALS")
          .range(std::size_t{1}, std::size_t{10'000});
  buildings
      .add_option("--odometry",
                  command->odometries,
                  "What the robot knows its place by in a tour: true, wheels (2 % off), matched "
                  "(the same wheels, corrected by matched scans); default: all three")
      .needs(tour);
  buildings.add_flag("--json", command->as_json, "Print JSON");
  buildings.callback([command, &status] { status = execute(*command); });
}

}  // namespace server
