// server/external/listening_source.hpp: a socket to which one controller at a time connects.
#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "server/external/registration.hpp"
#include "server/external/socket_peer.hpp"

namespace server::external {

/// True for "unix:/path" and "tcp:127.0.0.1:PORT".
bool is_address(std::string_view command);

/// Listens from construction on, on a thread of its own. A controller that has said Hello keeps its
/// place from run to run until it disconnects or fails; until then every other is refused.
class ListeningSource final : public PeerSource {
 public:
  /// `registration.command` is the address. The file of a Unix socket gets the mode 0600; TCP needs
  /// the token, and port 0 takes a free one. Throws ControllerError.
  ListeningSource(Registration registration, std::string token);
  ~ListeningSource() override;
  ListeningSource(const ListeningSource&) = delete;
  ListeningSource& operator=(const ListeningSource&) = delete;

  /// Waits for a controller as long as for an answer.
  std::unique_ptr<Peer> take(const std::stop_token& stop) override;
  void give_back(std::unique_ptr<Peer> peer, bool well) override;

  /// With the port that was taken.
  const std::string& address() const { return address_; }

 private:
  void listen_unix(const std::string& path);
  void listen_tcp(const std::string& place);
  void accept_all(const std::stop_token& stop);
  void seat(Descriptor socket, const std::stop_token& stop);

  Registration registration_{};
  std::string token_{};
  std::string address_{};
  std::string path_{};  // of the Unix socket's file; empty: TCP
  Texts texts_{};
  Descriptor listener_{};
  Descriptor bell_{};  // wakes the thread
  std::mutex mutex_{};
  std::condition_variable_any seated_{};
  std::unique_ptr<SocketPeer> idle_{};  // connected and without a run
  bool lent_ = false;                   // connected, and a run has it
  std::jthread thread_{};               // last: it uses all of the above
};

}  // namespace server::external
