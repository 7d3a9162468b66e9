// server/cli/command_worlds.cpp: `tautline worlds`: steps worlds for a program that writes actions
// to standard input and reads states from standard output (docs/external-controllers.md).
#include <cstdio>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "server/cli/cli.hpp"
#include "server/experiment/worlds.hpp"

namespace server {
namespace {

using experiment::WorldAction;
using experiment::Worlds;
using experiment::WorldState;
constexpr std::size_t kMostWorlds = 4096;

struct WorldsCommand {
  std::string scenario{};
  std::size_t count = 1;
  RunFlags flags{};
};

/// The first line: what the numbers mean.
std::string header(const Worlds& worlds, std::size_t count) {
  const algo::RobotSpec& robot = worlds.robot();
  const algo::LaserScan& scan = worlds.scan();
  return nlohmann::json{{"version", 1},
                        {"worlds", count},
                        {"beams", scan.size()},
                        {"angle_min", scan.angle_min},
                        {"angle_increment", scan.angle_increment},
                        {"range_max", scan.range_max},
                        {"period", robot.period},
                        {"radius", robot.radius},
                        {"max_v", robot.max_v},
                        {"max_omega", robot.max_omega},
                        {"state_values", sizeof(WorldState) / sizeof(double)}}
             .dump() +
         "\n";
}

template <typename T>
bool write(std::span<const T> values) {
  return std::fwrite(values.data(), sizeof(T), values.size(), stdout) == values.size();
}

bool show(const Worlds& worlds) {
  return write(worlds.states()) && write(worlds.ranges()) && std::fflush(stdout) == 0;
}

/// Ends when the other side closes either pipe.
int execute(const WorldsCommand& options) {
  const RunSpec spec =
      make_spec(find_scenario(options.scenario), options.flags.resolved(), own_robots());
  Worlds worlds(spec, options.count);
  std::fputs(header(worlds, options.count).c_str(), stdout);
  std::vector<WorldAction> actions(options.count);
  while (show(worlds)) {
    if (std::fread(actions.data(), sizeof(WorldAction), actions.size(), stdin) != actions.size()) {
      break;
    }
    worlds.step(actions);
  }
  return kReached;
}

}  // namespace

void add_worlds_command(Command app, int& status) {
  auto options = std::make_shared<WorldsCommand>();
  const Command command = app.add_subcommand(
      "worlds", "Step worlds of a scenario by actions from standard input, for training");
  command.add_option("SCENARIO", options->scenario, "Name of a scenario, or path of a .json file")
      .required();
  command.add_option("--worlds", options->count, "How many, with successive seeds")
      .range(std::size_t{1}, kMostWorlds)
      .show_default();
  options->flags.add_to(command);
  command.callback([options, &status] { status = execute(*options); });
}

}  // namespace server
