// server/serve/open_session.cpp: connects the parts of a session.
#include "server/serve/open_session.hpp"

#include <utility>

namespace server {

OpenSession::OpenSession(std::string id, SessionHouse house, std::size_t most_runs)
    : id_(std::move(id)),
      house_(std::move(house)),
      session_(house_.runs,
               [this] {
                 if (!news_.exchange(true, std::memory_order_acq_rel)) house_.ring();
               }),
      loader_(session_, house_.workers, house_.to_io, most_runs),
      bridge_(
          session_,
          {.load =
               [this](const nlohmann::json& body, SessionLoader::Done done) {
                 return house_.load(*this, body, std::move(done));
               },
           .reset = [this](SessionLoader::Done done) { return loader_.reset(std::move(done)); }}),
      door_(bridge_.hub().endpoint("/ws")) {}

void OpenSession::tend(Clock::time_point now) {
  tended_ = now;
  news_.store(false, std::memory_order_release);
  session_.poll();
  bridge_.flush();
}

}  // namespace server
