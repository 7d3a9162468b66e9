// server/external/process_source.cpp: a stack of idle processes.
#include "server/external/process_source.hpp"

#include <utility>

namespace server::external {

ProcessSource::~ProcessSource() {
  for (const auto& peer : idle_) peer->say_end("Tautline ends.");
}

std::unique_ptr<Peer> ProcessSource::take(const std::stop_token& stop) {
  std::vector<std::unique_ptr<SocketPeer>> dead;  // ended outside the lock
  {
    const std::lock_guard lock(mutex_);
    while (!idle_.empty()) {
      std::unique_ptr<SocketPeer> peer = std::move(idle_.back());
      idle_.pop_back();
      if (peer->idle()) return peer;
      dead.push_back(std::move(peer));
    }
  }
  auto process = std::make_unique<ChildProcess>(registration_.command);
  Descriptor socket = process->take_socket();
  return std::make_unique<SocketPeer>(
      SocketPeer::Settings{.name = registration_.name, .answer_limit = registration_.answer_limit},
      std::move(socket),
      std::move(process),
      texts_,
      stop);
}

void ProcessSource::give_back(std::unique_ptr<Peer> peer, bool well) {
  if (!well) return;
  const std::lock_guard lock(mutex_);
  idle_.emplace_back(static_cast<SocketPeer*>(peer.release()));
}

}  // namespace server::external
