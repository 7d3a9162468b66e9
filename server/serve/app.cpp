// server/serve/app.cpp: wires the parts together; the io thread runs here.
#include "server/serve/app.hpp"

#include <system_error>
#include <utility>

#include <spdlog/spdlog.h>

#include "server/record/record_sink.hpp"
#include "server/record/run_json.hpp"
#include "server/serve/api/api.hpp"
#include "server/serve/bridge.hpp"

namespace server {
namespace {

// Frames are looked for this often: a good part of a tick sooner than any display shows them.
constexpr std::chrono::milliseconds kPollPeriod{4};

std::string prepared(const std::filesystem::path& database) {
  std::error_code error;
  if (database.has_parent_path()) {
    std::filesystem::create_directories(database.parent_path(), error);
  }
  return database.string();
}

RecorderOptions recorder_options_for(const AppOptions& options) {
  RecorderOptions out = recorder_options();
  out.retention_bytes = options.keep_bytes;
  out.evict_oldest = options.evict_oldest;
  out.wait_for_room = true;
  return out;
}

}  // namespace

// Members go in the opposite order: the doors close first, the record last.
struct App::Impl {
  explicit Impl(AppOptions options)
      : recorder(prepared(options.database), recorder_options_for(options)),
        library(options.scenarios, options.logs),
        workers(options.database.string()),
        experiments(recorder),
        session(&recorder),
        loader(session,
               workers,
               [this](std::function<void()> work) { server->post(std::move(work)); }),
        context{.session = session,
                .library = library,
                .experiments = experiments,
                .recorder = recorder,
                .workers = workers,
                .loader = loader},
        bridge(
            session,
            {.load =
                 [this](const nlohmann::json& body, SessionLoader::Done done) {
                   return load_from_json(context, body, std::move(done));
                 },
             .reset = [this](SessionLoader::Done done) { return loader.reset(std::move(done)); }}) {
    options.net.limits.frame_bytes = kRequestBytes;
    options.net.offload = [this](std::function<void()> job) {
      workers.post([job = std::move(job)](Worker&) { job(); });
    };
    server = std::make_unique<net::Server>(options.net);
    add_api(server->router(), context);
    server->add(bridge.hub().endpoint("/ws"));
    context.post_to_io = [this](std::function<void()> work) { server->post(std::move(work)); };
    if (options.unattended) session.watch().need_nobody();
    if (options.require_record) session.require_record();
    session.load(std::move(options.first));
    if (options.armed) session.arm_when_ready();
    server->every(kPollPeriod, [this, ended = std::move(options.ended)] {
      session.poll();
      bridge.flush();
      if (ended && ended()) server->stop();
    });
  }
  ~Impl() {
    session.end(true);  // first: the robot stops, however long the others take
    workers.stop();
    experiments.stop();
    // What was posted may still answer through the server: while it is there.
    try {
      if (!recorder.flush()) spdlog::error("The last of the record could not be written.");
    } catch (const std::exception& e) {
      spdlog::error("The last of the record could not be written: {}", e.what());
    }
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  Recorder recorder;
  ScenarioLibrary library;
  std::unique_ptr<net::Server> server{};  // outlives workers and experiments, which post to it
  Workers workers;
  Experiments experiments;
  Session session;
  SessionLoader loader;
  ApiContext context;
  Bridge bridge;
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
