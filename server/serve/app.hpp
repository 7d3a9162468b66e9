// server/serve/app.hpp: the serving program: the sessions, their record, and the network interfaces
// to both.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "server/run/run_spec.hpp"
#include "server/serve/net/server.hpp"
#include "server/serve/session_registry.hpp"

namespace server {

struct AppOptions {
  net::ServerOptions net{};
  std::filesystem::path database{};   // experiments stand beside it: runs.sqlite, runs.experiments
  std::filesystem::path scenarios{};  // the user's own
  std::filesystem::path robots{};     // the user's own robot models
  std::filesystem::path logs{};       // CARMEN logs offered as scenarios
  std::uint64_t keep_bytes = std::uint64_t{2} << 30;
  bool evict_oldest = false;    // finished runs may be deleted to make room
  bool require_record = false;  // a tick that is not recorded ends the live run
  RunSpec first{};              // first run of the session `main`
  std::shared_ptr<const nlohmann::json> first_document{};  // its world, if not the library's
  SessionRules sessions{};
  std::function<std::vector<std::string>()> log_tail{};  // the newest log lines, oldest first
  std::size_t threads = 0;        // that advance simulated runs; 0: one per processor
  unsigned workers = 0;           // of the experiments; 0: one per processor but one
  bool armed = false;             // hardware: arm as soon as its devices are ready
  bool unattended = false;        // hardware: drives on even without an operator
  std::function<bool()> ended{};  // polled about 20 times a second; true ends run()
};

class App {
 public:
  /// Opens the database, binds the port and loads the first scenario. Throws std::exception with a
  /// sentence for people.
  explicit App(AppOptions options);
  ~App();
  App(const App&) = delete;
  App& operator=(const App&) = delete;

  std::string url() const;
  void run();   // until AppOptions::ended or stop()
  void stop();  // from any thread

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace server
