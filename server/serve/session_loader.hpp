// server/serve/session_loader.hpp: the next run of a session, made without making the io thread
// wait.
#pragma once

#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <memory>

#include "server/serve/session.hpp"
#include "server/serve/workers.hpp"

namespace server {

/// Loads and resets, one after another. What reads files, builds worlds or waits for the present
/// run to end happens on a worker; the present run goes on until the next one is ready. Io thread
/// only, but for what it says of Make.
class SessionLoader {
 public:
  using Make = std::function<RunSpec()>;  // on a worker; throws what is wrong
  /// Called when its turn has come, as it may depend on what was loaded before it.
  using Plan = std::function<Make()>;
  /// Null when the run has begun; else why the present run goes on.
  using Done = std::function<void(std::exception_ptr)>;
  using Post = std::function<void(std::function<void()>)>;

  static constexpr std::size_t kMaxWaiting = 8;

  /// `to_io` runs a function on the io thread, from any. `most`: how many loads there may be in
  /// all; 0: as many as anybody likes.
  SessionLoader(Session& session, Workers& workers, Post to_io, std::size_t most = 0)
      : session_(session), workers_(workers), to_io_(std::move(to_io)), most_(most) {}

  /// False when too many wait already: try again later. Throws net::HttpError when the session has
  /// had all there may be.
  bool load(Plan plan, Done done);
  /// The same again from its beginning.
  bool reset(Done done);
  /// Loads not yet done, the one under way included.
  std::size_t waiting() const { return loads_.size(); }

 private:
  struct Load {
    Plan plan{};
    Done done{};
  };
  void begin_first();
  void prepared(const std::shared_ptr<PreparedRun>& next);
  void finish(std::exception_ptr failure);

  Session& session_;
  Workers& workers_;
  Post to_io_;
  std::size_t most_;
  std::size_t taken_ = 0;
  std::deque<Load> loads_{};  // the first is under way
};

}  // namespace server
