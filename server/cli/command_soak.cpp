// server/cli/command_soak.cpp: `tautline soak`: searches random worlds for forbidden outcomes.
#include <algorithm>
#include <memory>

#include <fmt/format.h>

#include "server/cli/cli.hpp"
#include "server/cli/pool_options.hpp"
#include "server/lab/soak/random_world.hpp"
#include "server/lab/soak/soak.hpp"
#include "server/run/scenario_json.hpp"
#include "server/run/text_file.hpp"

namespace server {
namespace {

struct SoakCommand {
  std::string scenario{};
  bool list = false;
  std::string rows{};
  soak::Options options{};
};

/// Prints faults, or with `all` every run that did not reach its goal.
void print_worlds(const std::vector<soak::World>& worlds, bool all) {
  for (const soak::World& world : worlds) {
    const experiment::Row& row = world.row;
    if (!soak::is_fault(row) && (!all || row.outcome == algo::Outcome::Reached)) continue;
    fmt::print("world {}: {}{} after {:.1f} s at ({:.2f}, {:.2f}): {}\n",
               world.seed,
               soak::ending(row),
               world.has_way ? ", though there is a way," : "",
               row["time_s"],
               row["end_x_m"],
               row["end_y_m"],
               row.reason);
  }
}

void print_table(const std::vector<soak::World>& worlds) {
  fmt::print("{}", to_text(endings_table(worlds)));
  if (worlds.empty()) return;
  const auto nearest = std::ranges::min_element(
      worlds, {}, [](const soak::World& world) { return world.row["min_clearance_m"]; });
  fmt::print(
      "least clearance {:.3f} m, in world {}\n", nearest->row["min_clearance_m"], nearest->seed);
}

int execute(SoakCommand command) {
  if (!command.scenario.empty()) {
    const sim::Scenario world =
        soak::random_world(command.options.first_seed, command.options.controller);
    write_text(command.scenario, to_json(world).dump(1) + "\n");
    return kReached;
  }
  std::vector<soak::World> worlds;
  {
    ProgressLine progress;
    command.options.pool.progress = [&](std::size_t done, std::size_t all) {
      progress.show(fmt::format("{} of {} worlds", done, all));
    };
    worlds = run_worlds(command.options);
  }
  if (!command.rows.empty()) write_table(rows_table(worlds), command.rows);
  print_worlds(worlds, command.list);
  print_table(worlds);
  const bool fault = std::ranges::any_of(
      worlds, [](const soak::World& world) { return soak::is_fault(world.row); });
  return fault ? kNotHeld : kReached;
}

}  // namespace

void add_soak_command(Command app, int& status) {
  auto command = std::make_shared<SoakCommand>();
  const Command soak = app.add_subcommand(
      "soak",
      "Drive to random goals in random worlds. Exit status 3 after a collision, a NaN, or a stop "
      "without a reason given");
  soak.add_option("--worlds", command->options.worlds, "Number of worlds (default 1000)")
      .range(1, 1'000'000);
  add_first_seed_option(soak, command->options.first_seed, "The first world (default 1)");
  soak.add_option("--controller", command->options.controller, "Default: strip");
  add_pool_options(soak, command->options.pool, "--workers");
  add_rows_option(soak, command->rows);
  soak.add_flag("--list", command->list, "List every world whose goal was not reached");
  soak.add_option("--scenario",
                  command->scenario,
                  "Run nothing: write the first world to this file as a scenario for the page")
      .type_name("FILE");
  soak.callback([command, &status] { status = execute(*command); });
}

}  // namespace server
