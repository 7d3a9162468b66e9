// server/serve/session_registry.hpp: all sessions of a server by their ids: opened, found, ended.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "server/serve/net/websocket.hpp"
#include "server/serve/open_session.hpp"

namespace server {

struct SessionRules {
  std::size_t sessions = 256;      // at once, beside `main`
  std::size_t runs = 200;          // that one may load and reset in its life; 0: no limit
  std::chrono::seconds idle{900};  // after which one that nobody watches or asks ends
  bool per_visitor = false;        // who connects without naming a session is to open one
};

/// Io thread only. The session `main` is there from the start to the end, has no limits, and is the
/// only one that may have hardware. The others have ids that nobody can guess.
class SessionRegistry {
 public:
  using Clock = OpenSession::Clock;
  static constexpr std::string_view kMain = "main";
  static constexpr std::uint16_t kGoneCode = 4404;  // closes the WebSocket of who asks for none
  static constexpr std::string_view kOwn =
      "Here each visitor has a session: open one with POST /api/v1/sessions.";
  /// Told to a client that asks for a session that is not there.
  static constexpr std::string_view kGone =
      "There is no such session: it has ended, or it never was. Open a new one.";

  SessionRegistry(SessionHouse house, const SessionRules& rules);
  ~SessionRegistry();
  SessionRegistry(const SessionRegistry&) = delete;
  SessionRegistry& operator=(const SessionRegistry&) = delete;

  OpenSession& main() { return *main_; }
  /// Null when there is none. Counts as use of it.
  OpenSession* find(std::string_view id);
  /// Makes a session whose first run is as `make` says, on a worker. `done` gets it, or what went
  /// wrong. Throws net::HttpError when there are as many as there may be.
  using Opened = std::function<void(OpenSession*, std::exception_ptr)>;
  void open(SessionLoader::Make make, Opened done);
  /// Ends it, and tells its viewers. False when there is none; `main` cannot be ended.
  bool end(std::string_view id);

  /// Those that can be found, `main` first, then in the order of their opening.
  const std::vector<OpenSession*>& all() const { return all_; }
  const SessionRules& rules() const { return rules_; }

  /// Tends the sessions that have news, each `kLeast` after the last time. True when some are left
  /// for later.
  bool take_news(Clock::time_point now);
  static constexpr std::chrono::milliseconds kLeast{4};
  /// What is due by the clock: call it some twenty times a second.
  void tend(Clock::time_point now);

  /// All sessions at one address: `?session=` says which, `main` without.
  net::WsEndpoint endpoint();

  /// Ends all runs, because the program does.
  void end_all();

 private:
  struct Client {
    std::shared_ptr<net::WsClient> socket{};
    OpenSession* session = nullptr;
  };

  void opened(const std::shared_ptr<net::WsClient>& socket);
  void closed(net::WsClient& socket);
  void loaded(const OpenSession* session, const std::exception_ptr& failure, const Opened& done);
  void see_off(const OpenSession& session);
  void bury();

  SessionHouse house_;
  SessionRules rules_;
  std::shared_ptr<OpenSession> main_;
  std::map<std::string, std::shared_ptr<OpenSession>, std::less<>> sessions_{};  // without main
  std::vector<OpenSession*> all_{};  // main and those of sessions_: looked through for each frame
  std::vector<OpenSession*> in_turn_{};  // workspace
  std::vector<std::shared_ptr<OpenSession>> opening_{};
  std::vector<std::shared_ptr<OpenSession>> ending_{};  // their last load is still under way
  std::map<std::uint32_t, Client> clients_{};           // by WsClient::id()
};

}  // namespace server
