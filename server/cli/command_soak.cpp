// server/cli/command_soak.cpp: `tautline soak`: random worlds in search of what must never happen.
#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <memory>

#include <fmt/format.h>

#include "server/cli/cli.hpp"
#include "server/lab/soak/random_world.hpp"
#include "server/lab/soak/soak.hpp"
#include "server/run/scenario_json.hpp"

namespace server {
namespace {

struct SoakCommand {
  std::string scenario{};
  bool list = false;
  soak::Options options{};
};

/// Faults, or with `all` everything but the goals reached.
void print_worlds(const std::vector<soak::Outcome>& outcomes, bool all) {
  for (const soak::Outcome& o : outcomes) {
    if (!is_fault(o.ending) && (!all || o.ending == soak::Ending::Reached)) continue;
    fmt::print("world {}: {}{} after {:.1f} s at ({:.2f}, {:.2f}): {}\n",
               o.seed,
               name(o.ending),
               o.has_way ? ", though there is a way," : "",
               o.time,
               o.end.x,
               o.end.y,
               o.why);
  }
}

void print_table(const std::vector<soak::Outcome>& outcomes) {
  using soak::Ending;
  fmt::print("{:>14} {:>8} {:>17} {:>14}\n", "", "worlds", "with a way there", "without");
  for (const Ending ending : {Ending::Reached,
                              Ending::GaveReason,
                              Ending::OutOfTime,
                              Ending::Silent,
                              Ending::Collision,
                              Ending::NotFinite}) {
    std::array<std::ptrdiff_t, 2> count{};
    for (const bool has_way : {false, true}) {
      count.at(has_way ? 1 : 0) = std::ranges::count_if(outcomes, [&](const soak::Outcome& o) {
        return o.ending == ending && o.has_way == has_way;
      });
    }
    fmt::print(
        "{:>14} {:>8} {:>17} {:>14}\n", name(ending), count[0] + count[1], count[1], count[0]);
  }
  const auto nearest = std::ranges::min_element(outcomes, {}, &soak::Outcome::min_clearance);
  fmt::print("least clearance {:.3f} m, in world {}\n", nearest->min_clearance, nearest->seed);
}

int execute(SoakCommand command) {
  if (!command.scenario.empty()) {
    std::ofstream out(command.scenario);
    out << to_json(soak::random_world(command.options.first_seed, command.options.controller))
               .dump(1)
        << '\n';
    if (!out) throw std::runtime_error("cannot write " + command.scenario);
    return kReached;
  }
  std::vector<soak::Outcome> outcomes;
  {
    ProgressLine progress;
    command.options.progress = [&](std::size_t done, std::size_t all) {
      progress.show(fmt::format("{} of {} worlds", done, all));
    };
    outcomes = run_worlds(command.options);
  }
  print_worlds(outcomes, command.list);
  print_table(outcomes);
  const bool fault =
      std::ranges::any_of(outcomes, [](const soak::Outcome& o) { return is_fault(o.ending); });
  return fault ? kNotHeld : kReached;
}

}  // namespace

void add_soak_command(CLI::App& app, int& status) {
  auto command = std::make_shared<SoakCommand>();
  CLI::App* soak = app.add_subcommand(
      "soak",
      "Random worlds, random goals: no collision, nothing that is not a number, no standing still "
      "without saying why. Exit status 3 when one of them happened");
  soak->add_option("--worlds", command->options.worlds, "How many (default 1000)")
      ->check(CLI::Range(1, 1'000'000));
  soak->add_option("--first-seed", command->options.first_seed, "The first world (default 1)")
      ->check(CLI::Range(0, 1'000'000'000));
  soak->add_option("--controller", command->options.controller, "Default: strip");
  soak->add_option("--workers", command->options.workers, "0 (default): one a core")
      ->check(CLI::Range(0, 256));
  soak->add_flag("--list", command->list, "List every world whose goal was not reached");
  soak->add_option("--scenario",
                   command->scenario,
                   "Run nothing: write the first world there as a scenario the page can open")
      ->type_name("FILE");
  soak->callback([command, &status] { status = execute(*command); });
}

}  // namespace server
