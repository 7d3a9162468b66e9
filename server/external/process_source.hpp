// server/external/process_source.hpp: the processes of one command, one for each run in progress.
#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "server/external/registration.hpp"
#include "server/external/socket_peer.hpp"

namespace server::external {

/// Starts a process when no idle one is left, and keeps it for the next run. Ends all with itself.
class ProcessSource final : public PeerSource {
 public:
  explicit ProcessSource(Registration registration) : registration_(std::move(registration)) {}
  ~ProcessSource() override;
  ProcessSource(const ProcessSource&) = delete;
  ProcessSource& operator=(const ProcessSource&) = delete;

  std::unique_ptr<Peer> take(const std::stop_token& stop) override;
  void give_back(std::unique_ptr<Peer> peer, bool well) override;

 private:
  Registration registration_{};
  Texts texts_{};
  std::mutex mutex_{};
  std::vector<std::unique_ptr<SocketPeer>> idle_{};
};

}  // namespace server::external
