// server/serve/session_loader.hpp: prepares a session's next run without blocking the io thread.
#pragma once

#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <memory>

#include "server/serve/session.hpp"
#include "server/serve/workers.hpp"

namespace server {

/// Does loads and resets one after another. A worker reads files, builds worlds and waits for the
/// current run to end. The current run goes on until the next one is ready. Io thread only, except
/// Make.
class SessionLoader {
 public:
  using Make = std::function<RunSpec()>;  // on a worker; throws if the run cannot be made
  /// Called when its turn has come, because it may depend on the load before it.
  using Plan = std::function<Make()>;
  /// Null if the run has begun; else the reason why the current run goes on.
  using Done = std::function<void(std::exception_ptr)>;
  using Post = std::function<void(std::function<void()>)>;

  static constexpr std::size_t kMaxWaiting = 8;

  /// `to_io` runs a function on the io thread, from any thread. `most`: most loads in all; 0: no
  /// limit.
  SessionLoader(Session& session, Workers& workers, Post to_io, std::size_t most = 0)
      : session_(session), workers_(workers), to_io_(std::move(to_io)), most_(most) {}

  /// False if too many loads wait already: try again later. Throws net::HttpError when the session
  /// has used up its loads.
  bool load(Plan plan, Done done);
  /// Loads the current run again from its start.
  bool reset(Done done);
  /// Unfinished loads, including the current one.
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
  std::deque<Load> loads_{};  // the first is in progress
};

}  // namespace server
