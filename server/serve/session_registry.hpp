// server/serve/session_registry.hpp: opens, finds and ends the sessions of a server by their ids.
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
  std::size_t runs = 200;          // loads and resets per session; 0: no limit
  std::chrono::seconds idle{900};  // an unused session ends after this time
  bool per_visitor = false;        // a client that names no session must open one
};

/// A WebSocket client of a session.
struct SessionClient {
  std::shared_ptr<net::WsClient> socket{};
  std::string session{};  // its id
  std::string since{};    // ISO 8601, UTC
};

/// Io thread only. The session `main` exists from start to end, has no limits, and is the only one
/// that may have hardware. The others have ids that cannot be guessed.
class SessionRegistry {
 public:
  using Clock = OpenSession::Clock;
  static constexpr std::string_view kMain = "main";
  static constexpr std::uint16_t kGoneCode = 4404;  // for a session that does not exist
  static constexpr std::string_view kOwn =
      "Here each visitor has a session: open one with POST /api/v1/sessions.";
  /// Sent to a client that names a session that does not exist.
  static constexpr std::string_view kGone =
      "There is no such session: it has ended, or it never was. Open a new one.";

  SessionRegistry(SessionHouse house, const SessionRules& rules);
  ~SessionRegistry();
  SessionRegistry(const SessionRegistry&) = delete;
  SessionRegistry& operator=(const SessionRegistry&) = delete;

  OpenSession& main() { return *main_; }
  /// Null if there is none. Counts as use of the session.
  OpenSession* find(std::string_view id);
  /// Opens a session whose first run `make` describes, on a worker. `done` gets the session or the
  /// error. Throws net::HttpError if there are too many sessions.
  using Opened = std::function<void(OpenSession*, std::exception_ptr)>;
  void open(SessionLoader::Make make, Opened done);
  /// Ends a session and tells its viewers. False if there is none; `main` cannot be ended.
  bool end(std::string_view id);

  /// All sessions that find() can find: `main` first, then in order of opening.
  const std::vector<OpenSession*>& all() const { return all_; }
  const SessionRules& rules() const { return rules_; }
  /// Of all sessions, in order of their coming.
  std::vector<SessionClient> clients() const;

  /// Tends sessions that have news, each at least `kLeast` after its last time. True if some are
  /// left for later.
  bool take_news(Clock::time_point now);
  static constexpr std::chrono::milliseconds kLeast{4};
  /// Does work due by the clock. Call it about 20 times a second.
  void tend(Clock::time_point now);

  /// One endpoint for all sessions: `?session=` names one; the default is `main`.
  net::WsEndpoint endpoint();

  /// Ends all runs, because the program ends.
  void end_all();

 private:
  struct Client {
    std::shared_ptr<net::WsClient> socket{};
    OpenSession* session = nullptr;
    std::string since{};
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
  std::vector<OpenSession*> all_{};      // main and those of sessions_: scanned for each frame
  std::vector<OpenSession*> in_turn_{};  // workspace
  std::vector<std::shared_ptr<OpenSession>> opening_{};
  std::vector<std::shared_ptr<OpenSession>> ending_{};  // their last load is still in progress
  std::map<std::uint32_t, Client> clients_{};           // by WsClient::id()
};

}  // namespace server
