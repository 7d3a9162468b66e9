// server/app.cpp: wires the parts together; the io thread runs here.
#include "server/app.hpp"

#include <csignal>
#include <system_error>
#include <utility>

#include <spdlog/spdlog.h>

#include "server/api/api.hpp"
#include "server/bridge.hpp"
#include "server/record_sink.hpp"
#include "server/run_json.hpp"

namespace server {
namespace {

// Frames are looked for this often: a good part of a tick sooner than any display shows them.
constexpr std::chrono::milliseconds kPollPeriod{4};

constexpr std::chrono::milliseconds kWatchPeriod{100};

volatile std::sig_atomic_t g_terminated = 0;  // NOLINT: the one thing a signal may touch

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
  return out;
}

}  // namespace

// Members go in the opposite order: the doors close first, the record last.
struct App::Impl {
  explicit Impl(AppOptions options)
      : recorder(prepared(options.database), recorder_options_for(options)),
        reader(options.database.string()),
        library(options.scenarios, options.logs),
        experiments(recorder),
        session(&recorder),
        context{.session = session,
                .library = library,
                .experiments = experiments,
                .recorder = recorder,
                .reader = reader},
        bridge(session, [this](const nlohmann::json& body) { load_from_json(context, body); }) {
    server = std::make_unique<net::Server>(options.net);
    add_api(server->router(), context);
    server->add(bridge.hub().endpoint("/ws"));
    context.post_to_io = [this](std::function<void()> work) { server->post(std::move(work)); };
    session.load(std::move(options.first));
    if (options.armed) session.arm_when_ready();
    if (session.state().spec.hardware && !options.unattended) {
      server->every(kWatchPeriod, [this] { look_for_operator(); });
    }
    server->every(kPollPeriod, [this] {
      session.poll();
      if (g_terminated != 0) server->stop();
    });
    std::signal(SIGINT, [](int) { g_terminated = 1; });
    std::signal(SIGTERM, [](int) { g_terminated = 1; });
  }
  ~Impl() {
    session.end();
    // What was posted may still answer through the server: while it is there.
    try {
      recorder.flush();
    } catch (const std::exception& e) {
      spdlog::error("The last of the record could not be written: {}", e.what());
    }
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  /// A real robot that is on its way stops when nobody is left who could stop it.
  void look_for_operator() {
    const SessionState& state = session.state();
    const bool on_its_way = state.hardware && state.hardware->armed && state.goal;
    context.watch.seen(bridge.hub().heard());
    if (on_its_way && context.watch.nobody(OperatorWatch::Clock::now())) {
      state.spec.hardware->disarm(OperatorWatch::kWords);
    }
  }

  Recorder recorder;
  db::RunReader reader;
  ScenarioLibrary library;
  std::unique_ptr<net::Server> server{};  // outlives experiments, which post to it
  Experiments experiments;
  Session session;
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
