// server/serve/open_session.hpp: a session with its id, its loader and its connection to viewers.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include <nlohmann/json.hpp>

#include "server/serve/bridge.hpp"
#include "server/serve/session.hpp"
#include "server/serve/session_loader.hpp"
#include "server/serve/workers.hpp"

namespace server {

class OpenSession;

/// Services that all sessions of a server share.
struct SessionHouse {
  RunHouse runs;
  Workers& workers;
  SessionLoader::Post to_io{};  // from any thread
  /// Tells the io thread that a session has news. From any thread; allocates nothing.
  std::function<void()> ring{};
  /// Carries out a `/load` document for a session. False if too many loads wait. Throws
  /// DocumentError.
  std::function<bool(OpenSession&, const nlohmann::json&, SessionLoader::Done)> load{};
};

/// Io thread only, except has_news(). Sessions know nothing of each other.
class OpenSession {
 public:
  using Clock = std::chrono::steady_clock;

  /// `most_runs`: most loads and resets; 0: no limit.
  OpenSession(std::string id, SessionHouse house, std::size_t most_runs);
  OpenSession(const OpenSession&) = delete;
  OpenSession& operator=(const OpenSession&) = delete;

  const std::string& id() const { return id_; }
  Session& session() { return session_; }
  SessionLoader& loader() { return loader_; }
  Bridge& bridge() { return bridge_; }
  /// The endpoint of its WebSocket clients.
  const net::WsEndpoint& door() const { return door_; }

  /// The document of the world, if it came as one; null: the world is one of the library. The world
  /// is read from it again when another robot is chosen.
  const std::shared_ptr<const nlohmann::json>& document() const { return document_; }
  void set_document(std::shared_ptr<const nlohmann::json> document) {
    document_ = std::move(document);
  }

  /// True if data came from the control thread since the last tend().
  bool has_news() const { return news_.load(std::memory_order_acquire); }
  /// Handles that data and any work due by the clock.
  void tend(Clock::time_point now);
  Clock::time_point last_tended() const { return tended_; }

  /// A client requested it or watches it.
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
  std::shared_ptr<const nlohmann::json> document_{};
  Clock::time_point used_ = Clock::now();
  Clock::time_point tended_{};
};

}  // namespace server
