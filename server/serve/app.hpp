// server/serve/app.hpp: the serving program: the sessions, their record, and the doors to both.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "server/run/run_spec.hpp"
#include "server/serve/net/server.hpp"
#include "server/serve/session_registry.hpp"

namespace server {

struct AppOptions {
  net::ServerOptions net{};
  std::filesystem::path database{};
  std::filesystem::path scenarios{};  // the user's own
  std::filesystem::path robots{};     // the user's own robot models
  std::filesystem::path logs{};       // CARMEN logs offered as scenarios
  std::uint64_t keep_bytes = std::uint64_t{2} << 30;
  bool evict_oldest = false;    // finished runs may be deleted for room
  bool require_record = false;  // a tick that is not recorded ends the live run
  RunSpec first{};              // of the session `main`, loaded at the start
  SessionRules sessions{};
  std::size_t threads = 0;        // that advance simulated runs; 0: one a processor
  bool armed = false;             // hardware: its motors on as soon as its devices are well
  bool unattended = false;        // hardware: drives on though nobody is there to stop it
  std::function<bool()> ended{};  // asked some twenty times a second: true ends run()
};

class App {
 public:
  /// Opens the database, binds the port and loads the first scenario. Throws std::exception with a
  /// sentence.
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
