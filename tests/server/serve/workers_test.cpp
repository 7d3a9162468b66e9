// tests/server/serve/workers_test.cpp: long work runs beside the io thread, never on it.
#include "server/serve/workers.hpp"

#include <atomic>
#include <future>
#include <latch>
#include <set>
#include <string>

#include "tests/server/serve/app_fixture.hpp"
#include <gtest/gtest.h>

#include "server/run/io_thread.hpp"
#include "server/serve/api/api.hpp"

namespace server {
namespace {

using net::test::Client;
using net::test::eventually;

TEST(Workers, RunJobsInTheOrderPostedAndDropTheRest) {
  Workers workers("none", 1);
  std::vector<int> done;
  std::promise<void> last;
  for (int i = 0; i < 5; ++i) {
    workers.post([&done, &last, i](Worker&) {
      done.push_back(i);
      if (i == 4) last.set_value();
    });
  }
  last.get_future().wait();
  EXPECT_EQ(done, (std::vector<int>{0, 1, 2, 3, 4}));
  workers.stop();
  workers.post([](Worker&) { FAIL(); });
}

TEST(Workers, AReaderFollowsTheStoreToItsNewFile) {
  const auto folder =
      std::filesystem::temp_directory_path() / ("tautline_workers_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  const std::string path = (folder / "runs.db").string();
  const db::NewRun run{.scenario = "a", .document = "{}", .started = "now"};
  Worker worker(path);
  {
    db::RunStore store(path);
    const db::RunId id = store.begin_run(run);
    store.commit();
    EXPECT_TRUE(worker.runs().get(id));
  }
  std::filesystem::remove_all(folder);
  EXPECT_THROW(worker.runs(), db::StoreError);
  std::filesystem::create_directories(folder);
  {
    const db::RunStore store(path);
    EXPECT_FALSE(worker.runs().get(1));
  }
  std::filesystem::remove_all(folder);
}

TEST(IoThread, RefusesWholeRunWork) {
  const net::IoThreadMark mark;
  const ScenarioLibrary library({}, {});
  EXPECT_THROW(library.list(), std::logic_error);
  EXPECT_THROW(library.load("case1"), std::logic_error);
  EXPECT_THROW(make_robot({}), std::logic_error);
  std::thread([&] { EXPECT_NO_THROW(library.load("case1")); }).join();
}

TEST(PageRoom, PagesGetShorterWhileManyAreHeld) {
  PageRoom room;
  const std::size_t first = room.page();
  std::vector<net::Payload> held;
  std::size_t total = 0;
  for (int i = 0; i < 200; ++i) {
    held.push_back(room.hold(std::string(room.page(), ' ')));
    total += held.back()->size();
  }
  EXPECT_LT(room.page(), first / 10);
  EXPECT_LT(total, std::size_t{80} << 20);
  held.clear();
  EXPECT_EQ(room.page(), first);
}

/// The routes of a server with all workers busy.
class BusyWorkers : public ::testing::Test {
 protected:
  BusyWorkers() {
    session.load(make_spec(library.load("case1"), {}));
    add_api(running.server.router(), context);
    context.post_to_io = [this](std::function<void()> work) {
      running.server.post(std::move(work));
    };
    for (std::size_t i = 0; i < Workers::kThreads; ++i) {
      workers.post([this](Worker&) { busy.arrive_and_wait(); });
    }
    running.server.every(std::chrono::milliseconds(4),
                         [this] { sessions.tend(SessionRegistry::Clock::now()); });
    running.start();
  }
  ~BusyWorkers() override {
    if (!released) release();
    workers.stop();
    queue.stop();
    running.stop();
    sessions.end_all();
    std::filesystem::remove_all(folder);
  }

  void release() {
    released = true;
    busy.count_down();
  }
  static std::filesystem::path make_folder() {
    const auto path =
        std::filesystem::temp_directory_path() / ("tautline_busy_" + std::to_string(::getpid()));
    std::filesystem::create_directories(path);
    return path;
  }
  static std::string concrete(std::string pattern) {
    for (const auto& [name, value] : {std::pair<std::string, std::string>{"{id}", "1"},
                                      {"{name}", "case1"},
                                      {"{session}", "main"}}) {
      const std::size_t at = pattern.find(name);
      if (at != std::string::npos) pattern.replace(at, name.size(), value);
    }
    return pattern;
  }

  const std::filesystem::path folder = make_folder();
  bool released = false;
  std::latch busy{Workers::kThreads + 1};
  Recorder recorder{(folder / "runs.db").string()};
  ScenarioLibrary library{folder, {}};
  net::test::RunningServer running{};
  Workers workers{(folder / "runs.db").string()};
  Experiments experiments{{.folder = folder / "experiments"}, library};
  RunQueue queue{recorder};
  Scheduler scheduler{};
  SessionRegistry sessions{
      {.runs = {.recorder = &recorder,
                .scheduler = scheduler,
                .frames = std::make_shared<FrameRoom>(1024)},
       .workers = workers,
       .to_io = [this](std::function<void()> work) { running.server.post(std::move(work)); },
       .ring = [] {}},
      {}};
  Session& session = sessions.main().session();
  ApiContext context{.sessions = sessions,
                     .library = library,
                     .experiments = experiments,
                     .queue = queue,
                     .recorder = recorder,
                     .workers = workers,
                     .checker = workers,
                     .first = make_spec(library.load("case1"), {}),
                     .server = &running.server,
                     .log_tail = [] { return std::vector<std::string>{}; }};
};

TEST_F(BusyWorkers, StopIsAnsweredWhileEveryOtherRouteWaits) {
  std::vector<std::pair<std::string, Client>> asked;
  for (const auto& route : running.server.router().routes()) {
    const std::string target = concrete(route.pattern);
    const std::string body = route.pattern == "/api/v1/runs"        ? R"({"scenario":"case1"})"
                             : route.pattern.ends_with("/control")  ? R"({"action":"reset"})"
                             : route.pattern.ends_with("/scenario") ? R"({"name":"mine"})"
                                                                    : R"({})";
    Client client(running.port());
    client.send(route.method == "GET"
                    ? net::test::get_request(target)
                    : route.method + net::test::post_request(target, body).substr(4));
    asked.emplace_back(route.method + " " + target, std::move(client));
  }
  for (int i = 0; i < 20; ++i) {
    const net::test::Answer stop = net::test::ask(
        running.port(), net::test::post_request("/api/v1/session/control", R"({"action":"stop"})"));
    EXPECT_EQ(stop.status, 200);
    EXPECT_NE(stop.body.find("\"stop\""), std::string::npos) << stop.body;
  }
  release();
  // None of them worked on the io thread, which would answer 500.
  for (auto& [what, client] : asked) {
    const int status = net::test::read_answer(client, false).status;
    EXPECT_GE(status, 200) << what;
    EXPECT_LT(status, 500) << what;
  }
}

TEST_F(BusyWorkers, LoadsWaitInTurnAndTooManyAreRefused) {
  std::vector<Client> asked;
  const std::string reset =
      net::test::post_request("/api/v1/session/control", R"({"action":"reset"})");
  for (std::size_t i = 0; i < SessionLoader::kMaxWaiting; ++i) {
    asked.emplace_back(running.port());
    asked.back().send(reset);
  }
  ASSERT_TRUE(eventually([&] {
    return running.on_io([&] { return sessions.main().loader().waiting(); }) ==
           SessionLoader::kMaxWaiting;
  }));
  EXPECT_EQ(net::test::ask(running.port(), reset).status, 503);
  const db::RunId before = running.on_io([&] { return session.run_id(); });
  release();
  for (Client& client : asked) EXPECT_EQ(net::test::read_answer(client).status, 200);
  EXPECT_GE(running.on_io([&] { return session.run_id(); }), before + 8);
}

}  // namespace
}  // namespace server
