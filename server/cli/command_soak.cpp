// server/cli/command_soak.cpp: `tautline soak`: searches random worlds for forbidden outcomes.
#include <algorithm>
#include <memory>
#include <stdexcept>

#include <fmt/format.h>

#include "server/cli/cli.hpp"
#include "server/cli/output_files.hpp"
#include "server/cli/pool_options.hpp"
#include "server/lab/soak/course_study.hpp"
#include "server/lab/soak/indoor_world.hpp"
#include "server/lab/soak/operator_study.hpp"
#include "server/lab/soak/random_world.hpp"
#include "server/lab/soak/slope_study.hpp"
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

  bool slopes = false;
  bool courses = false;
  bool by_hand = false;
  double seconds = 0;  // 0: by the kind of study
  std::string physics = "bullet";
  std::string robot{};
};

constexpr std::uint64_t kWorlds = 1000;
constexpr std::uint64_t kOperatorWorlds = 100;
constexpr double kOperatorSeconds = 10'000;  // of each robot and mode, in all worlds together

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

/// The robots of the study, or the one of that name. Throws std::invalid_argument.
std::vector<soak::Driven> robots_named(const std::string& name) {
  std::vector<soak::Driven> robots = soak::driven_robots();
  if (name.empty()) return robots;
  std::erase_if(robots, [&](const soak::Driven& driven) { return driven.name != name; });
  if (robots.empty()) {
    throw std::invalid_argument(fmt::format("No robot '{}' is in the operator's study.", name));
  }
  return robots;
}

int execute_operator(const SoakCommand& command) {
  soak::OperatorOptions options{
      .worlds = command.options.worlds > 0 ? command.options.worlds : kOperatorWorlds,
      .first_seed = command.options.first_seed,
      .seconds = command.seconds > 0 ? command.seconds : kOperatorSeconds,
      .physics =
          command.physics == "kinematic" ? sim::PhysicsKind::Kinematic : sim::PhysicsKind::Bullet,
      .robots = robots_named(command.robot),
      .pool = command.options.pool};
  if (!command.scenario.empty()) {
    sim::Scenario world =
        soak::indoor_world(options.first_seed, options.robots.front().robot.radius);
    world.robot = options.robots.front().robot;
    world.controller = options.robots.front().controller;
    world.physics = options.physics;
    write_text(command.scenario, to_json(world).dump(1) + "\n");
    return kReached;
  }
  refuse_nothing(options.worlds * options.robots.size(), options.pool.shard, "drives");
  const soak::OperatorStudy study =
      with_progress(options.pool, "worlds", [&] { return run_operator(options); });
  for (const soak::DrivenWorld& world : study.worlds) {
    for (std::size_t hand = 0; hand < soak::kHands.size(); ++hand) {
      if (soak::kHands.at(hand) == soak::Hand::Raw) continue;
      for (const std::string& text : world.drives.at(hand).seen) {
        fmt::print("world {}, {}, {}: {}\n",
                   world.seed,
                   world.robot,
                   soak::name(soak::kHands.at(hand)),
                   text);
      }
    }
  }
  fmt::print("{}", to_text(operator_table(study)));
  if (!study.places.empty()) fmt::print("\n{}", to_text(places_table(study)));
  if (!command.rows.empty()) write_table(operator_rows(study), command.rows);
  return soak::counted_contacts(study) > 0 ? kNotHeld : kReached;
}

int execute_slopes(const SoakCommand& command) {
  soak::SlopeOptions options{.first_seed = command.options.first_seed,
                             .pool = command.options.pool};
  if (command.options.worlds > 0) options.worlds = command.options.worlds;
  if (command.seconds > 0) options.seconds = command.seconds;
  if (!command.scenario.empty()) {
    const sim::Scenario world = soak::slope_world(options.first_seed).scenario;
    write_text(command.scenario, to_json(world).dump(1) + "\n");
    return kReached;
  }
  refuse_nothing(options.worlds, options.pool.shard, "worlds");
  const std::vector<soak::SlopeRow> rows =
      with_progress(options.pool, "worlds", [&] { return run_slopes(options); });
  for (const soak::SlopeRow& row : rows) {
    if (!row.counts() || !row.guarded.overturned) continue;
    fmt::print("world {}: turned over after {:.1f} s\n", row.seed, row.guarded.seconds);
  }
  fmt::print("{}", to_text(slopes_table(rows)));
  if (!command.rows.empty()) write_table(slope_rows(rows), command.rows);
  return soak::turned_over(rows) > 0 ? kNotHeld : kReached;
}

int execute_courses(const SoakCommand& command) {
  soak::CourseOptions options{.first_seed = command.options.first_seed,
                              .pool = command.options.pool};
  if (command.options.worlds > 0) options.worlds = command.options.worlds;
  if (command.seconds > 0) options.seconds = command.seconds;
  if (!command.scenario.empty()) {
    const soak::GroundCourse course =
        soak::random_course(options.first_seed, soak::masuda_limits());
    write_text(command.scenario, to_json(course.scenario).dump(1) + "\n");
    return kReached;
  }
  refuse_nothing(options.worlds, options.pool.shard, "courses");
  const std::vector<soak::CourseRow> rows =
      with_progress(options.pool, "courses", [&] { return run_courses(options); });
  bool fault = false;
  for (const soak::CourseRow& row : rows) {
    if (!soak::is_fault(row)) continue;
    fault = true;
    fmt::print("course {}: {}{}\n", row.seed, row.end.fell ? "fell, " : "", row.end.words);
  }
  fmt::print("{}", to_text(courses_table(rows)));
  if (!command.rows.empty()) write_table(course_rows(rows), command.rows);
  return fault ? kNotHeld : kReached;
}

int execute(SoakCommand command) {
  if (command.courses) return execute_courses(command);
  if (command.slopes) return execute_slopes(command);
  if (command.by_hand) return execute_operator(command);
  if (command.seconds > 0) {
    throw std::runtime_error("--seconds needs --operator, --slopes or --courses");
  }
  if (command.options.worlds == 0) command.options.worlds = kWorlds;
  if (!command.scenario.empty()) {
    const sim::Scenario world =
        soak::random_world(command.options.first_seed, command.options.controller);
    write_text(command.scenario, to_json(world).dump(1) + "\n");
    return kReached;
  }
  refuse_nothing(command.options.worlds, command.options.pool.shard, "worlds");
  const std::vector<soak::World> worlds =
      with_progress(command.options.pool, "worlds", [&] { return run_worlds(command.options); });
  print_worlds(worlds, command.list);
  print_table(worlds);
  if (!command.rows.empty()) write_table(rows_table(worlds), command.rows);
  const bool fault = std::ranges::any_of(
      worlds, [](const soak::World& world) { return soak::is_fault(world.row); });
  return fault ? kNotHeld : kReached;
}

}  // namespace

void add_soak_command(Command app, int& status) {
  auto command = std::make_shared<SoakCommand>();
  command->options.worlds = 0;  // by the kind of study
  const Command soak = app.add_subcommand(
      "soak",
      "Drive to random goals in random worlds. Exit status 3 after a collision, a NaN, or a stop "
      "without a reason given");
  soak.add_option("--worlds",
                  command->options.worlds,
                  "Number of worlds (default 1000, with --operator 100, with --slopes 200, with "
                  "--courses 50)")
      .range(1, 1'000'000);
  add_first_seed_option(soak, command->options.first_seed, "The first world (default 1)");
  soak.add_option("--controller", command->options.controller, "Default: strip");
  add_pool_options(soak, command->options.pool, "--workers");
  add_rows_option(soak, command->rows);
  soak.add_flag("--list", command->list, "List every world whose goal was not reached");
  soak.add_option("--scenario",
                  command->scenario,
                  "Run nothing: write the first world to this file as a scenario for the page")
      .excludes(soak.get_option("--rows"))
      .check(refuse_unwritable)
      .type_name("FILE");
  soak.add_flag("--operator",
                command->by_hand,
                "Instead, drive by hand as an operator who tries to hit something, guarded, with "
                "changing modes, and raw. Exit status 3 after a contact with what was seen");
  const Option slopes =
      soak.add_flag("--slopes",
                    command->slopes,
                    "Instead, drive a robot with a high centre of mass over random slopes at full "
                    "stick, with its "
                    "turnover guard and without. Exit status 3 if it turns over with it");
  slopes.excludes(soak.get_option("--operator"));
  const Option courses = soak.add_flag(
      "--courses",
      command->courses,
      "Instead, drive a robot with floor sensors over random courses of steps, slopes "
      "and trenches. Exit status 3 if it falls, climbs what is above its limits, or "
      "refuses what is not");
  const Option by_hand = soak.get_option("--operator");
  courses.excludes(by_hand);
  courses.excludes(slopes);
  for (const Option& study : {by_hand, slopes, courses}) {
    study.excludes(soak.get_option("--controller"));
    study.excludes(soak.get_option("--list"));
  }
  soak.add_option(
          "--seconds",
          command->seconds,
          "With --operator: of each robot and mode, in all worlds together (default 10000). "
          "With --slopes and --courses: of each drive (default 30 and 240)")
      .range(1.0, 1e7);
  soak.add_option("--physics", command->physics, "With --operator (default: bullet)")
      .one_of({"bullet", "kinematic"})
      .needs(by_hand);
  soak.add_option("--robot", command->robot, "With --operator: only this robot").needs(by_hand);
  soak.callback([command, &status] { status = execute(*command); });
}

}  // namespace server
