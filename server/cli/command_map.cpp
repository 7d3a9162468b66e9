// server/cli/command_map.cpp: `tautline map`: maps a recorded log, with errors added to its
// odometry and corrected by scan matching.
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "server/cli/cli.hpp"
#include "server/cli/output_files.hpp"
#include "server/cli/pool_options.hpp"
#include "server/lab/mapping/long_building.hpp"
#include "server/lab/mapping/map_study.hpp"
#include "server/run/map_file.hpp"
#include "server/run/text_file.hpp"

namespace server {
namespace {

struct MapCommand {
  std::vector<std::string> logs{};
  mapping::MapOptions options{};
  std::string simulate{};
  std::string relations{};
  std::string poses{};
  std::string map{};
  std::string out{};
  std::string markdown{};
  bool as_json = false;
};

void write_picture(const mapping::MapStudy& study, const std::string& file) {
  const std::string title =
      fmt::format("{}, {}", study.log.name, study.options.match ? "matched" : "by its odometry");
  write_text(file, draw_map(study.log, first_path(study), title));
}

/// Throws std::runtime_error if an output would overwrite a log or another output.
void refuse_shared(const MapCommand& command) {
  std::vector<NamedFile> inputs{{"--relations", command.relations}};
  for (const std::string& log : command.logs) inputs.push_back({"LOG", log});
  std::vector<NamedFile> outputs{
      {"--poses", command.poses}, {"--out", command.out}, {"--markdown", command.markdown}};
  if (!command.map.empty()) {
    outputs.push_back({"--map", command.map});
    outputs.push_back({"the picture of --map", picture_beside(command.map)});
  }
  refuse_shared_files(inputs, outputs);
}

/// Options that speak of the path of one log.
void refuse_several(const MapCommand& command) {
  if (command.logs.size() == 1) return;
  if (!command.out.empty()) {
    throw std::runtime_error("--out takes the map of one log; --markdown those of several");
  }
  if (!command.relations.empty()) throw std::runtime_error("--relations belong to one log");
  if (!command.map.empty()) throw std::runtime_error("--map takes the map of one log");
  if (!command.poses.empty()) throw std::runtime_error("--poses takes the path of one log");
}

int simulate(const MapCommand& command) {
  if (!command.logs.empty()) throw std::runtime_error("--simulate writes a log and takes none");
  mapping::write_long_building(
      command.simulate, command.options.first_seed, command.options.errors);
  return kReached;
}

int execute(MapCommand command) {
  if (!command.simulate.empty()) return simulate(command);
  if (command.logs.empty()) throw std::runtime_error("map needs a LOG, or --simulate FILE");
  refuse_several(command);
  refuse_shared(command);
  const bool wants_path =
      !command.relations.empty() || !command.poses.empty() || !command.map.empty();
  command.options.match = command.options.match || wants_path;
  std::vector<mapping::MapStudy> studies;
  {
    ProgressLine progress;
    for (const std::string& log : command.logs) {
      command.options.progress = [&](std::size_t done, std::size_t all) {
        progress.show(fmt::format("{}: {} of {}", log, done, all));
      };
      mapping::Recording recording = mapping::read_recording(log);
      if (!command.relations.empty()) {
        command.options.relations = mapping::read_relations(command.relations, recording.stamps);
      }
      studies.push_back(study_map(std::move(recording), command.options));
    }
  }
  for (std::size_t i = 0; i < studies.size(); ++i) {
    warn_of_damage(command.logs[i], studies[i].log.damage);
  }
  if (command.as_json) {
    fmt::print("{}\n", to_json(studies).dump(2));
  } else {
    for (const mapping::MapStudy& study : studies) fmt::print("{}\n", to_text(study));
  }
  if (!command.out.empty()) write_picture(studies.front(), command.out);
  if (!command.poses.empty()) write_poses(studies.front(), command.poses);
  if (!command.map.empty()) {
    const mapping::MapStudy& study = studies.front();
    write_map(mapping::map_along(study.log, first_path(study)), command.map);
  }
  if (!command.markdown.empty()) write_markdown(studies, command.markdown);
  return kReached;
}

}  // namespace

void add_map_command(Command app, int& status) {
  auto command = std::make_shared<MapCommand>();
  mapping::MapOptions& options = command->options;
  const Command map = app.add_subcommand(
      "map", "Map recorded CARMEN logs and print the error of the path against the log's own");
  map.add_option("logs", command->logs, "The logs").type_name("LOG");
  map.add_flag("--match", options.match, "Correct each scan's pose by matching it to the map");
  map.add_option("--simulate",
                 command->simulate,
                 "Instead of mapping, write the log of a simulated drive through a building of "
                 "300 m with loops of 500 m to FILE, and its true relations beside it")
      .check(refuse_unwritable)
      .type_name("FILE");
  map.add_option("--relations",
                 command->relations,
                 "Judge the matched path by surveyed relations: lines of t1 t2 dx dy dz roll pitch "
                 "yaw")
      .existing_file()
      .type_name("FILE");
  map.add_option("--poses",
                 command->poses,
                 "Write the matched path of the first seed: lines of stamp, x, y [m], theta [rad]")
      .check(refuse_unwritable)
      .type_name("FILE");
  map.add_option("--map",
                 command->map,
                 "Write the map of the matched path as a YAML file of map_server, its picture "
                 "beside it")
      .check(refuse_unwritable)
      .check([](const std::string& yaml) { return refuse_unwritable(picture_beside(yaml)); })
      .type_name("FILE");
  map.add_option("--odometry-scale",
                 options.errors.odometry_scale,
                 "Add errors to the log's poses: of distances and of angles, each of random sign "
                 "(0.02 is 2 %)");
  map.add_option("--yaw-slip",
                 options.errors.odometry_slip,
                 "Share of each turn that the wheels lose by slip (0.05 is 5 %)");
  map.add_option("--odometry-noise",
                 options.errors.odometry_noise,
                 "Random error per metre and per radian, relative (0.01 is 1 %)");
  map.add_option("--seed", options.first_seed, "Seed of the errors (default 1)")
      .range(0, 1'000'000'000);
  map.add_option("--seeds", options.seeds, "Number of seeds from --seed on (default 1)")
      .range(1, 1000);
  add_threads_option(map, options.threads);
  map.add_option("--out", command->out, "A picture of the first seed's map, as SVG")
      .check(refuse_unwritable)
      .type_name("FILE");
  map.add_option("--markdown",
                 command->markdown,
                 "Also write tables to this file, and pictures into pictures/mapping/ beside it")
      .check(refuse_unwritable_document)
      .type_name("FILE");
  map.add_flag("--json", command->as_json, "Print JSON: an object, or an array of several logs'");
  const Option simulated = map.get_option("--simulate");
  for (const char* unused : {"--match",
                             "--relations",
                             "--poses",
                             "--map",
                             "--seeds",
                             "--threads",
                             "--out",
                             "--markdown",
                             "--json"}) {
    simulated.excludes(map.get_option(unused));
  }
  map.callback([command, &status] { status = execute(*command); });
}

}  // namespace server
