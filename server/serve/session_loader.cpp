// server/serve/session_loader.cpp: worker, io thread, worker, io thread: prepare, part, wait,
// begin.
#include "server/serve/session_loader.hpp"

#include <utility>

#include <fmt/format.h>

#include "server/serve/net/http.hpp"

namespace server {

bool SessionLoader::load(Plan plan, Done done) {
  if (loads_.size() >= kMaxWaiting) return false;
  if (most_ > 0 && taken_ >= most_) {
    throw net::HttpError(
        409, fmt::format("This session has had its {} runs. Open a new session to go on.", most_));
  }
  ++taken_;
  loads_.push_back({std::move(plan), std::move(done)});
  if (loads_.size() == 1) begin_first();
  return true;
}

bool SessionLoader::reset(Done done) {
  return load([this] { return [spec = session_.again()] { return spec; }; }, std::move(done));
}

void SessionLoader::begin_first() {
  workers_.post([this, make = loads_.front().plan()](Worker&) {
    auto next = std::make_shared<PreparedRun>();
    std::exception_ptr failure;
    try {
      *next = session_.prepare(make());
    } catch (...) {
      failure = std::current_exception();
    }
    // Moved: only the io thread may hold, and release, the exception.
    to_io_([this, next, failure = std::move(failure)] {
      if (failure) {
        finish(failure);
      } else {
        prepared(next);
      }
    });
  });
}

void SessionLoader::prepared(const std::shared_ptr<PreparedRun>& next) {
  std::shared_ptr<LiveRun> last = session_.part();
  // Moved: destroying the run waits for its last tick, which the io thread must not do.
  workers_.post([this, last = std::move(last), next](Worker&) mutable {
    last.reset();
    to_io_([this, next] {
      session_.begin(std::move(*next));
      finish(nullptr);
    });
  });
}

void SessionLoader::finish(std::exception_ptr failure) {
  const Load load = std::move(loads_.front());
  loads_.pop_front();
  if (load.done) load.done(std::move(failure));
  if (!loads_.empty()) begin_first();
}

}  // namespace server
