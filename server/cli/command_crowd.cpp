// server/cli/command_crowd.cpp: `tautline crowd`: lets the robot cross a scene of recorded people.
#include <memory>
#include <stdexcept>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "server/cli/cli.hpp"
#include "server/cli/output_files.hpp"
#include "server/cli/pool_options.hpp"
#include "server/lab/crowd/crowd_scenario.hpp"
#include "server/lab/crowd/crowd_study.hpp"
#include "server/run/json_limits.hpp"
#include "server/run/json_reader.hpp"
#include "server/run/scenario_json.hpp"
#include "server/run/scenario_library.hpp"
#include "server/run/text_file.hpp"

namespace server {
namespace {

/// Robot, scanner, controller and parameters of the crossings.
constexpr const char* kScenario = "people";

struct CrowdCommand {
  std::string file{};
  std::string tracks{};
  std::string scenario{};
  bool as_json = false;
  RunFlags flags{};
  experiment::PoolOptions pool{};
};

/// Writes the first crossing as a scenario, if the program can load it again.
void write_scenario(const crowd::Recording& recording,
                    const sim::Scenario& robot,
                    const CrowdCommand& command) {
  const nlohmann::json document = to_json(scenario_of(recording, robot));
  try {
    scenario_from_json(document, own_robots());
  } catch (const DocumentError& error) {
    throw std::runtime_error(
        fmt::format("{} makes a scenario that cannot be loaded: {}", command.file, error.what()));
  }
  write_text(command.scenario, dump_json(document) + "\n");
}

int execute(CrowdCommand command) {
  refuse_shared_files({{"FILE", command.file}, {"--robot-model", command.flags.robot}},
                      {{"--tracks", command.tracks}, {"--scenario", command.scenario}});
  const crowd::Recording recording = crowd::read_people(std::filesystem::path(command.file));
  const RunSpec robot = make_spec(ScenarioLibrary({}, {}, own_robots()).load(kScenario),
                                  command.flags.resolved(),
                                  own_robots());
  if (!command.scenario.empty()) {
    write_scenario(recording, robot.scenario, command);
    return kReached;
  }
  const crowd::CrowdStudy study = with_progress(command.pool, "crossings", [&] {
    return crowd::study_crowd(recording, robot, command.pool);
  });
  fmt::print("{}\n", command.as_json ? to_json(study).dump(2) : to_text(study));
  if (!command.tracks.empty()) crowd::write_tracks(study, robot.scenario.period, command.tracks);
  return kReached;
}

}  // namespace

void add_crowd_command(Command app, int& status) {
  auto command = std::make_shared<CrowdCommand>();
  const Command crowd = app.add_subcommand(
      "crowd",
      "Let the robot of the scenario 'people' cross a scene of recorded people from side to side, "
      "at 100 moments; they yield to nobody");
  crowd
      .add_option(
          "FILE", command->file, "The people: lines `frame id x y`, 25 frames a second, metres")
      .required();
  const Option tracks =
      crowd
          .add_option(
              "--tracks", command->tracks, "Also write the robot's true pose at each tick, as CSV")
          .check(refuse_unwritable)
          .type_name("FILE");
  crowd
      .add_option("--scenario",
                  command->scenario,
                  "Drive nothing: write the first crossing to this file as a scenario for the page")
      .excludes(tracks)
      .check(refuse_unwritable)
      .type_name("FILE");
  crowd.add_flag("--json", command->as_json, "Print JSON");
  command->flags.add_to(crowd);
  add_threads_option(crowd, command->pool.threads);
  crowd.callback([command, &status] { status = execute(*command); });
}

}  // namespace server
