// server/serve/open_session.hpp: a session under its id, with what loads its runs and what speaks
// to its viewers.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <string>

#include <nlohmann/json.hpp>

#include "server/serve/bridge.hpp"
#include "server/serve/session.hpp"
#include "server/serve/session_loader.hpp"
#include "server/serve/workers.hpp"

namespace server {

class OpenSession;

/// What all sessions of a server share.
struct SessionHouse {
  RunHouse runs;
  Workers& workers;
  SessionLoader::Post to_io{};  // from any thread
  /// From any thread, allocating nothing: a session has news for the io thread.
  std::function<void()> ring{};
  /// Carries out a `/load` document for a session; false: too many wait. Throws DocumentError.
  std::function<bool(OpenSession&, const nlohmann::json&, SessionLoader::Done)> load{};
};

/// Io thread only, but for what it says of news. Nothing of one session is known to another.
class OpenSession {
 public:
  using Clock = std::chrono::steady_clock;

  /// `most_runs`: how often it may load and reset; 0: as often as it likes.
  OpenSession(std::string id, SessionHouse house, std::size_t most_runs);
  OpenSession(const OpenSession&) = delete;
  OpenSession& operator=(const OpenSession&) = delete;

  const std::string& id() const { return id_; }
  Session& session() { return session_; }
  SessionLoader& loader() { return loader_; }
  Bridge& bridge() { return bridge_; }
  /// What its WebSocket clients come through.
  const net::WsEndpoint& door() const { return door_; }

  /// Something came from the control thread since the last tend().
  bool has_news() const { return news_.load(std::memory_order_acquire); }
  /// Hands it over, and does what is due by the clock.
  void tend(Clock::time_point now);
  Clock::time_point last_tended() const { return tended_; }

  /// Somebody asked for it or looks at it.
  void used(Clock::time_point now) { used_ = now; }
  Clock::time_point last_used() const { return used_; }

 private:
  std::string id_;
  SessionHouse house_;
  std::atomic<bool> news_{false};
  Session session_;
  SessionLoader loader_;
  Bridge bridge_;
  net::WsEndpoint door_;
  Clock::time_point used_ = Clock::now();
  Clock::time_point tended_{};
};

}  // namespace server
