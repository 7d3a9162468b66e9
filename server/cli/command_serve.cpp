// server/cli/command_serve.cpp: `tautline serve`.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/ringbuffer_sink.h>
#include <spdlog/spdlog.h>

#include "drivers/open_robot.hpp"
#include "server/cli/cli.hpp"
#include "server/cli/signals.hpp"
#include "server/run/hardware.hpp"
#include "server/run/json_limits.hpp"
#include "server/run/json_reader.hpp"
#include "server/run/library_files.hpp"
#include "server/run/paths.hpp"
#include "server/run/scenario_library.hpp"
#include "server/serve/app.hpp"

namespace server {
namespace {

struct ServeCommand {
  AppOptions app{};
  std::optional<std::string> scenario{};
  std::string robot{};  // file of real hardware; empty: simulation
  RunFlags flags{};
  double keep_gigabytes = 2;
  std::string evict = "never";
  std::uint32_t idle_seconds = 900;  // --session-idle
};

/// Choices that a simulated robot has. Throws DocumentError for the first one given.
void refuse_choices_of_simulation(const ServeCommand& options) {
  const auto refuse = [](bool given, const char* option) {
    if (given) throw DocumentError(option, "cannot be chosen: this is real hardware");
  };
  refuse(options.scenario.has_value(), "--scenario");
  refuse(!options.flags.physics.empty(), "--physics");
  refuse(options.flags.overrides.seed.has_value(), "--seed");
  refuse(!options.flags.robot.empty(), "--robot-model");
}

/// The initial spec, from the devices of a robot's file or from a scenario.
RunSpec first_spec(const ServeCommand& options) {
  if (!options.robot.empty()) refuse_choices_of_simulation(options);
  const RobotLibrary robots(options.app.robots);
  RunOverrides overrides = options.flags.resolved(robots);
  // Commands only add to the catalogue, from which the page chooses.
  overrides.controller = options.flags.controllers.named();
  if (options.robot.empty()) {
    const ScenarioLibrary library(options.app.scenarios, options.app.logs, robots);
    const std::string scenario = options.scenario.value_or("demo");
    return make_spec(names_file(scenario) ? ScenarioLibrary::from_file(scenario, robots)
                                          : library.load(scenario),
                     overrides,
                     robots);
  }
  const drivers::RobotFile file = drivers::read_robot_file(options.robot);
  const bool locked = drivers::lock_memory();
  for (const std::string& warning : file.warnings) spdlog::warn(warning);
  if (!locked) spdlog::warn(drivers::memory_advice());
  if (!drivers::check_real_time().priority) spdlog::warn(drivers::priority_advice());
  const std::shared_ptr<drivers::SerialRobot> robot = drivers::open_robot(file);
  robot->note_memory_locked(locked);
  return hardware_spec(describe(robot), overrides);
}

/// Of a world that is no library's; null for another one.
std::shared_ptr<const nlohmann::json> first_document(const ServeCommand& options) {
  const std::string file = options.scenario.value_or("");
  if (!names_file(file) || file.ends_with(".log")) return nullptr;
  return std::make_shared<const nlohmann::json>(parse_json(read_file(file, file), kOwnDocument));
}

/// A loud warning, since docker commands and shell histories often contain --insecure.
void warn_of_open_door(const net::ServerOptions& net, bool hardware) {
  if (!net.access.insecure || !net.access.token.empty() || net::is_loopback_name(net.address)) {
    return;
  }
  const std::string bar(78, '!');
  fmt::print(stderr,
             "{0}\n"
             "INSECURE: there is no token. Everybody who can reach this port can {1},\n"
             "change its world and delete its runs. Set TAUTLINE_TOKEN and leave --insecure out,\n"
             "unless a firewall or a port mapping lets only people you trust come in.\n"
             "{0}\n",
             bar,
             hardware ? "DRIVE THE REAL ROBOT" : "drive the robot");
}

/// Takes the tokens that were not given as options from the environment, where no other user of
/// this machine sees them.
void read_tokens(net::AccessOptions& access) {
  const auto read = [](std::string& token, const char* variable) {
    const char* const value = std::getenv(variable);
    if (token.empty() && value != nullptr) token = value;
  };
  read(access.token, "TAUTLINE_TOKEN");
  read(access.operator_token, "TAUTLINE_OPERATOR_TOKEN");
  read(access.viewer_token, "TAUTLINE_VIEWER_TOKEN");
}

/// Keeps the newest lines of the log for the System view.
std::function<std::vector<std::string>()> keep_log_tail() {
  constexpr std::size_t kLines = 200;
  const auto tail = std::make_shared<spdlog::sinks::ringbuffer_sink_mt>(kLines);
  tail->set_formatter(std::make_unique<spdlog::pattern_formatter>(
      "%Y-%m-%dT%H:%M:%SZ %l: %v", spdlog::pattern_time_type::utc, ""));
  spdlog::default_logger()->sinks().push_back(tail);
  return [tail] { return tail->last_formatted(); };
}

void serve(ServeCommand& options) {
  AppOptions& app = options.app;
  read_tokens(app.net.access);
  app.log_tail = keep_log_tail();
  app.keep_bytes = static_cast<std::uint64_t>(options.keep_gigabytes * 1024 * 1024 * 1024);
  app.evict_oldest = options.evict == "oldest";
  app.sessions.idle = std::chrono::seconds(options.idle_seconds);
  app.first = first_spec(options);
  app.first_document = first_document(options);
  app.net.log = [](std::string_view sentence) { spdlog::warn(sentence); };
  const std::string database = app.database.string();
  const bool armed = app.armed;
  const bool hardware = app.first.hardware != nullptr;
  const bool emulated = hardware && app.first.hardware->emulated;
  app.ended = end_requested;
  warn_of_open_door(app.net, hardware);
  heed_signals();  // first: writing the database, opened next, may raise a signal
  // Moved, so that the devices are left in order when `program` ends, not later.
  App program(std::move(app));
  fmt::print("Tautline is at {}\n", program.url());
  fmt::print("Runs are kept in {}\n", database);
  if (hardware) {
    fmt::print("{}: {}. It moves only once it is armed{}.\n",
               emulated ? "EMULATED DEVICES" : "REAL HARDWARE",
               options.robot,
               armed ? ", which happens as soon as its devices have no fault" : "");
  }
  std::fflush(stdout);
  program.run();
}

}  // namespace

void add_serve_command(Command app, int& status) {
  auto options = std::make_shared<ServeCommand>();
  net::ServerOptions& net = options->app.net;
  net.web_root = web_folder();
  options->app.database = state_folder() / "runs.db";
  options->app.scenarios = state_folder() / "scenarios";
  options->app.robots = state_folder() / "robots";
  options->app.logs = state_folder() / "logs";

  const Command command = app.add_subcommand("serve", "Serve the page, REST and WebSocket");
  command.add_option("--port", net.port, "Port; 0: any free one").show_default();
  command.add_option("--listen", net.address, "Address to listen on").show_default();
  command.add_option("--token",
                     net.access.token,
                     "Require this token (or set TAUTLINE_TOKEN); needed beyond this machine. "
                     "Who has it is an admin");
  command.add_option("--operator-token",
                     net.access.operator_token,
                     "Token of operators: they drive, edit and start runs, but delete nothing "
                     "(or set TAUTLINE_OPERATOR_TOKEN)");
  command.add_option("--viewer-token",
                     net.access.viewer_token,
                     "Token of viewers: they see everything and may press Stop (or set "
                     "TAUTLINE_VIEWER_TOKEN)");
  command.add_flag("--insecure", net.access.insecure, "Listen beyond this machine without a token");
  command
      .add_option(
          "--trusted-proxy",
          net.access.trusted_proxies,
          "A trusted proxy whose X-Forwarded-For and X-Forwarded-Proto count, such as 127.0.0.1 or "
          "172.17.0.0/16; repeatable")
      .type_name("ADDRESS");
  command
      .add_option("--per-address",
                  net.limits.connections_per_address,
                  "Connections per address; raise it for many people behind one router")
      .range(8, 100000)
      .show_default();
  command.add_option("--allow-host",
                     net.access.allow_hosts,
                     "A further host name of this server, such as one of a port mapping");
  command.add_option(
      "--allow-origin",
      net.access.allow_origins,
      "Origin of a page hosted elsewhere that may connect, such as https://viewer.example");
  command.add_option("--db", options->app.database, "Database of the runs")
      .type_name("FILE")
      .show_default();
  command
      .add_option(
          "--keep",
          options->keep_gigabytes,
          "Room for the record. When it is full, a live run drops its oldest ticks, and other runs "
          "are not recorded; 0: as much as the disk has")
      .type_name("GB")
      .range(0.0, 1e6)
      .show_default();
  command
      .add_option("--evict",
                  options->evict,
                  "Finished runs to delete when the room is full: never or the oldest")
      .one_of({"never", "oldest"})
      .show_default();
  command.add_flag("--require-record",
                   options->app.require_record,
                   "Stop a live run that cannot be recorded; without this the robot drives on");
  command.add_option("--scenarios", options->app.scenarios, "Folder of your own scenarios")
      .type_name("DIR")
      .show_default();
  command.add_option("--robots", options->app.robots, "Folder of your own robot models")
      .type_name("DIR")
      .existing_folder()
      .show_default();
  command.add_option("--logs", options->app.logs, "Folder of CARMEN logs to offer for replay")
      .type_name("DIR")
      .show_default();
  command.add_option("--web", net.web_root, "Folder of the built page").type_name("DIR");
  command
      .add_option("--scenario",
                  options->scenario,
                  "First world to load: a name (demo if none is given), a .json file, or a .log to "
                  "replay")
      .type_name("NAME|FILE");
  command
      .add_option(
          "--robot", options->robot, "TOML file that describes real hardware (docs/hardware.md)")
      .type_name("FILE");
  command.add_flag(
      "--armed", options->app.armed, "Arm real hardware as soon as its devices have no fault");
  command.add_flag("--unattended",
                   options->app.unattended,
                   "Let real hardware drive on when no page or script is there to stop it");
  AppOptions& app_options = options->app;
  command.add_flag("--per-visitor",
                   app_options.sessions.per_visitor,
                   "Give each visitor who opens the page without a session a session of their own");
  command
      .add_option("--sessions", app_options.sessions.sessions, "Most sessions at once, beside main")
      .range(0, 100000)
      .show_default();
  command
      .add_option("--session-runs",
                  app_options.sessions.runs,
                  "Most loads and resets of a session other than main; 0: no limit")
      .show_default();
  command
      .add_option("--session-idle",
                  options->idle_seconds,
                  "A session other than main ends after this time without a viewer or a request")
      .type_name("SECONDS")
      .range(1, 31'536'000)
      .show_default();
  command
      .add_option("--control-threads",
                  app_options.threads,
                  "Threads that drive simulated robots; 0: one per processor")
      .range(0, 1024)
      .show_default();
  command
      .add_option("--experiment-workers",
                  app_options.workers,
                  "Threads that run experiments; 0: one per processor but one")
      .range(0, 1024)
      .show_default();
  options->flags.add_to(command);
  options->flags.add_arm_to(command);
  options->flags.add_map_to(command);
  command.callback([options, &status] {
    serve(*options);
    status = 0;
  });
}

}  // namespace server
