// tests/bench/headless_rows.cpp: the whole server at full speed: REST, record, a client that reads.
#include <filesystem>
#include <thread>

#include "tests/bench/driving.hpp"
#include "tests/bench/rows.hpp"
#include "tests/bench/ws_readers.hpp"
#include <fmt/core.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "algo/strip/strip_law.hpp"
#include "db/run_reader.hpp"
#include "server/run/scenario_json.hpp"
#include "server/run/scenario_library.hpp"
#include "server/serve/app.hpp"

namespace bench {
namespace {

using nlohmann::json;

/// The program on a free port in temporary folders.
class Program {
 public:
  explicit Program(const sim::Scenario& scenario)
      : folder_(std::filesystem::temp_directory_path() /
                ("tautline_bench_app_" + std::to_string(::getpid()))) {
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_ / "scenarios");
    server::AppOptions options;
    options.net.port = 0;
    options.database = database();
    options.scenarios = folder_ / "scenarios";
    options.first = server::make_spec(scenario, {});
    app_ = std::make_unique<server::App>(std::move(options));
    const std::string url = app_->url();
    port_ = static_cast<std::uint16_t>(std::stoi(url.substr(url.rfind(':') + 1)));
    thread_ = std::thread([this] { app_->run(); });
  }
  ~Program() {
    end();
    std::filesystem::remove_all(folder_);
  }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  void end() {
    if (!app_) return;
    app_->stop();
    thread_.join();
    app_.reset();
  }
  std::string database() const { return folder_ / "runs.db"; }
  std::uint16_t port() const { return port_; }

  json get(const std::string& path) const {
    return json::parse(
        server::net::test::ask(port_, server::net::test::get_request("/api/v1" + path)).body);
  }
  void send(const std::string& method, const std::string& path, const json& body) const {
    const std::string text = body.dump();
    const auto answer = server::net::test::ask(
        port_,
        fmt::format("{} /api/v1{} HTTP/1.1\r\nHost: localhost\r\nContent-Length: {}\r\n"
                    "Content-Type: application/json\r\n\r\n{}",
                    method,
                    path,
                    text.size(),
                    text));
    require(answer.status < 300,
            fmt::format("P9: {} {} answers {}: {}", method, path, answer.status, answer.body));
  }

 private:
  std::filesystem::path folder_;
  std::unique_ptr<server::App> app_{};
  std::uint16_t port_ = 0;
  std::thread thread_{};
};

/// Checks that the newest run has every tick in order, up to `seconds` of its time.
void check_record(const std::string& database, double seconds) {
  db::RunReader reader(database);
  const db::RunId run = reader.list({}, 1).runs.at(0).id;
  std::uint64_t next = 0;
  reader.frames(run, 0, 10'000'000, [&](std::uint64_t tick, std::span<const std::byte> /*frame*/) {
    require(tick == next, fmt::format("P9: tick {} is missing in the record", next));
    ++next;
  });
  require(static_cast<double>(next) * kTick >= seconds, "P9: the record ends early");
}

/// One run of 600 simulated seconds. @return simulated seconds per second of CPU time
double run_once(Pass& pass, sim::PhysicsKind physics, std::uint64_t& seen) {
  const double seconds = pass.count(600.0, 20.0);
  sim::Scenario scenario = room_scenario(20, physics, {full_laser()});
  // Slow enough to drive all the time.
  scenario.goal = algo::SetGoal{{4.3, 4.3}, std::nullopt};
  scenario.parameters = {{&algo::kMaxSpeed, 0.01}, {&algo::kFilterHalfWidth, 2}};
  Program program(scenario);
  program.send("PUT", "/scenarios/w20", server::to_json(scenario));
  WsReaders reader(program.port(), 1, 0);
  program.send("POST", "/session/control", {{"action", "pause"}});
  program.send("POST", "/session/control", {{"action", "speed"}, {"speed", 0}});
  const double cpu = process_cpu() - reader.cpu();
  program.send("POST", "/session/control", {{"action", "load"}, {"scenario", "w20"}});
  program.send("POST", "/session/control", {{"action", "play"}});
  double stamp = 0;
  double used = 0;
  while (stamp < seconds) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    const json session = program.get("/session");
    used = process_cpu() - reader.cpu() - cpu;
    stamp = session.value("stamp", 0.0);
  }
  program.send("POST", "/session/control", {{"action", "pause"}});
  reader.stop();
  seen = reader.received();
  require(seen > 0, "P9: the client read nothing");
  program.end();
  check_record(program.database(), seconds);
  return stamp / used;
}

void run_headless(Pass& pass, sim::PhysicsKind physics, Figure figure) {
  std::vector<double> speeds;
  std::uint64_t seen = 0;
  for (int repetition = 0; repetition < pass.count(5, 1); ++repetition) {
    speeds.push_back(run_once(pass, physics, seen));
  }
  figure.row = "P9";
  figure.value = median(speeds);
  figure.unit = "s/s";
  figure.noise = spread(speeds);
  figure.note =
      fmt::format("all threads but the client's; every tick stored, {} frames read by it", seen);
  pass.add(std::move(figure));
}

}  // namespace

void headless(Pass& pass) {
  run_headless(pass,
               sim::PhysicsKind::Bullet,
               {.name = "headless server, full physics", .floor = 250, .stretch = 400});
  run_headless(pass,
               sim::PhysicsKind::Kinematic,
               {.name = "headless server, kinematic", .floor = 800, .stretch = 1500});
}

}  // namespace bench
