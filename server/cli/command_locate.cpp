// server/cli/command_locate.cpp: `tautline locate`: finds a log's poses on a known map.
#include <memory>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include "server/cli/cli.hpp"
#include "server/cli/output_files.hpp"
#include "server/cli/pool_options.hpp"
#include "server/lab/mapping/locate_log.hpp"
#include "server/lab/mapping/locate_study.hpp"
#include "server/run/map_file.hpp"

namespace server {
namespace {

struct LocateCommand {
  std::string log{};
  std::string map{};
  std::string start{};
  std::string poses{};
  std::string markdown{};
  bool study = false;
  bool as_json = false;
  mapping::LocateOptions options{};
};

int run_study(LocateCommand& command) {
  mapping::LocateStudy study;
  {
    ProgressLine progress;
    const auto count = [&](const char* what) {
      command.options.pool.progress = [&progress, what](std::size_t done, std::size_t all) {
        progress.show(fmt::format("{} of {} drives{}", done, all, what));
      };
    };
    count("");
    study.runs = study_locate(command.options);
    count(" round dead ends");
    study.dead_ends = study_dead_ends(command.options);
  }
  fmt::print("{}\n", command.as_json ? to_json(study).dump(2) : to_text(study));
  if (!command.markdown.empty()) write_markdown(study, command.markdown);
  return kReached;
}

int execute(LocateCommand& command) {
  refuse_shared_files({{"LOG", command.log}, {"--map", command.map}}, {{"--poses", command.poses}});
  if (command.study) return run_study(command);
  if (command.log.empty() || command.map.empty()) {
    throw std::runtime_error("locate needs a LOG and --map FILE, or --study");
  }
  const mapping::Recording log = mapping::read_recording(command.log);
  warn_of_damage(command.log, log.damage);
  const mapping::LocatedLog found =
      mapping::locate_log(log, seen_walls(read_map(command.map)), mapping::start_of(command.start));
  fmt::print("{}\n", command.as_json ? to_json(found).dump(2) : to_text(found));
  if (!command.poses.empty()) write_poses(log, found, command.poses);
  return found.located > 0 ? kReached : kNotReached;
}

}  // namespace

void add_locate_command(Command app, int& status) {
  auto command = std::make_shared<LocateCommand>();
  const Command locate = app.add_subcommand(
      "locate",
      "Find the poses of a recorded CARMEN log on a known map, by its scans and odometry");
  locate.add_option("LOG", command->log, "The log");
  locate
      .add_option(
          "--map", command->map, "The map: a YAML file of map_server, its picture beside it")
      .existing_file()
      .type_name("FILE");
  locate
      .add_option("--start",
                  command->start,
                  "The first pose on the map, within 2 m and 0.5 rad: x,y,heading [m, rad]. "
                  "Without it, the whole map is searched")
      .type_name("POSE");
  locate
      .add_option("--poses",
                  command->poses,
                  "Write the poses of the scans at which the robot was located: lines of stamp, x, "
                  "y [m], theta [rad]")
      .check(refuse_unwritable)
      .type_name("FILE");
  locate.add_flag("--study",
                  command->study,
                  "Instead, let robots with poor wheels drive to goals 60 m off and farther, by a "
                  "map and without, in drawings of three buildings with a part of each map wrong");
  locate
      .add_option("--markdown",
                  command->markdown,
                  "Also write the study's table to this file, and pictures into pictures/maps/ "
                  "beside it")
      .check(refuse_unwritable_document)
      .type_name("FILE");
  locate.add_option("--wrong", command->options.wrong, "That part of the map (default 0.1)")
      .range(0.0, 0.5);
  locate.add_option("--seeds", command->options.seeds, "Drawings of each building (default 5)")
      .range<std::size_t>(1, 1000);
  add_threads_option(locate, command->options.pool.threads);
  locate.add_flag("--json", command->as_json, "Print JSON");
  const Option study = locate.get_option("--study");
  for (const char* own : {"LOG", "--map", "--start", "--poses"}) {
    study.excludes(locate.get_option(own));
  }
  for (const char* own : {"--markdown", "--wrong", "--seeds", "--threads"}) {
    locate.get_option(own).needs(study);
  }
  locate.callback([command, &status] { status = execute(*command); });
}

}  // namespace server
