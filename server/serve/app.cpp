// server/serve/app.cpp: wires the parts together; the io thread runs here.
#include "server/serve/app.hpp"

#include <system_error>
#include <utility>

#include <spdlog/spdlog.h>

#include "server/record/run_json.hpp"
#include "server/run/map_robot.hpp"
#include "server/serve/api/api.hpp"

namespace server {
namespace {

// Period of work that is due by the clock. Frames and answers ring a bell instead.
constexpr std::chrono::milliseconds kTendPeriod{40};

// Shared by all fast runs: about 50 MB.
constexpr std::size_t kSharedFrames = 1024;

std::string prepared(const std::filesystem::path& database) {
  std::error_code error;
  if (database.has_parent_path()) {
    std::filesystem::create_directories(database.parent_path(), error);
  }
  return database.string();
}

std::filesystem::path beside(std::filesystem::path database) {
  return database.replace_extension(".experiments");
}

RecorderOptions recorder_options_for(const AppOptions& options) {
  RecorderOptions out = recorder_options();
  out.retention_bytes = options.keep_bytes;
  out.evict_oldest = options.evict_oldest;
  out.wait_for_room = true;
  return out;
}

}  // namespace

// Members are destroyed in reverse order: the network closes first, the record last.
struct App::Impl {
  explicit Impl(AppOptions options)
      : recorder(prepared(options.database), recorder_options_for(options)),
        library(options.scenarios,
                options.logs,
                RobotLibrary(options.robots),
                options.first.map ? options.first.map->path : std::string{}),
        scheduler(options.threads),
        workers(options.database.string()),
        checker(options.database.string(), 1),
        experiments({.folder = beside(options.database),
                     .keep_bytes = options.keep_bytes,
                     .evict_oldest = options.evict_oldest,
                     .workers = options.workers,
                     .controllers = options.first.controllers},
                    library),
        queue(recorder),
        sessions(house(options.require_record), options.sessions),
        context{.sessions = sessions,
                .library = library,
                .experiments = experiments,
                .queue = queue,
                .recorder = recorder,
                .workers = workers,
                .checker = checker,
                .first = options.first.hardware
                             ? make_spec(library.load("demo"),
                                         {.controllers = options.first.controllers})
                             : options.first,
                .first_document = options.first_document} {
    options.net.limits.frame_bytes = kRequestBytes;
    options.net.offload = [this](std::function<void()> job) {
      workers.post([job = std::move(job)](Worker&) { job(); });
    };
    server = std::make_unique<net::Server>(options.net);
    context.started = wall_time();
    context.server = server.get();
    context.log_tail = std::move(options.log_tail);
    bell = server->bell([this] { take_news(); });
    add_api(server->router(), context);
    server->add(sessions.endpoint());
    context.post_to_io = [this](std::function<void()> work) { server->post(std::move(work)); };
    Session& main = sessions.main().session();
    if (options.unattended) main.watch().need_nobody();
    main.load(std::move(options.first));
    sessions.main().set_document(std::move(options.first_document));
    if (options.armed) main.arm_when_ready();
    server->every(kTendPeriod, [this, ended = std::move(options.ended)] {
      sessions.tend(SessionRegistry::Clock::now());
      if (ended && ended()) server->stop();
    });
  }
  ~Impl() {
    sessions.end_all();  // first: the robot stops, even if the other parts take long
    workers.stop();
    checker.stop();
    queue.stop();
    // Posted jobs may still answer through the server, so wait while it exists.
    try {
      if (!recorder.flush()) spdlog::error("The last of the record could not be written.");
    } catch (const std::exception& e) {
      spdlog::error("The last of the record could not be written: {}", e.what());
    }
  }
  SessionHouse house(bool require_record) {
    return {.runs = {.recorder = &recorder,
                     .scheduler = scheduler,
                     .frames = std::make_shared<FrameRoom>(kSharedFrames),
                     .require_record = require_record},
            .workers = workers,
            .to_io = [this](std::function<void()> work) { server->post(std::move(work)); },
            .ring = [this] { bell(); },
            .load =
                [this](OpenSession& session, const nlohmann::json& body, SessionLoader::Done done) {
                  return load_from_json(context, session, body, std::move(done));
                }};
  }
  /// At once, except for sessions that were tended a moment ago.
  void take_news() {
    if (!sessions.take_news(SessionRegistry::Clock::now()) || news_later) return;
    news_later = true;
    server->after(SessionRegistry::kLeast, [this] {
      news_later = false;
      take_news();
    });
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  Recorder recorder;
  ScenarioLibrary library;
  Scheduler scheduler;
  std::unique_ptr<net::Server> server{};  // outlives the workers and the queue, which post to it
  Workers workers;
  Workers checker;
  Experiments experiments;
  RunQueue queue;
  SessionRegistry sessions;
  ApiContext context;
  std::function<void()> bell{};
  bool news_later = false;
};

App::App(AppOptions options) : impl_(std::make_unique<Impl>(std::move(options))) {}
App::~App() = default;

std::string App::url() const {
  return impl_->server->url();
}
void App::run() {
  impl_->server->run();
}
void App::stop() {
  impl_->server->stop();
}

}  // namespace server
