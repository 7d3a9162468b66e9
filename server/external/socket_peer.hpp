// server/external/socket_peer.hpp: asks a controller over a socket.
#pragma once

#include <memory>
#include <string>

#include "server/external/child_process.hpp"
#include "server/external/message_socket.hpp"
#include "server/external/messages.hpp"
#include "server/external/peer.hpp"

namespace server::external {

class SocketPeer final : public Peer {
 public:
  struct Settings {
    std::string name{};        // the controller's, for sentences
    double answer_limit = 10;  // [s] 0: no limit
    std::string token{};       // wanted in its Hello; empty: none
  };

  /// Shakes hands. `process` may be null: then somebody else started the controller. `texts`
  /// outlives the peer and all frames. Throws ControllerError.
  SocketPeer(Settings settings,
             Descriptor socket,
             std::unique_ptr<ChildProcess> process,
             Texts& texts,
             const std::stop_token& stop);
  ~SocketPeer() override;

  void begin(const Begin& run) override;
  void answer(const Question& question,
              algo::ControlOutput& out,
              algo::Explanation& words) override;

  /// True if it has kept quiet since its last answer, and so can serve another run.
  bool idle() const { return !socket_.disturbed(); }
  /// [s] 0: no limit.
  void set_answer_limit(double limit) { settings_.answer_limit = limit; }
  /// Lets it end in peace, without waiting for it.
  void say_end(const std::string& reason);

 private:
  void shake_hands();
  /// `limit` [s]; 0: none.
  Patience patience(double limit);
  void send(std::span<const std::byte> message);
  void receive(double limit);
  [[noreturn]] void refuse(const std::string& why);
  [[noreturn]] void fail(MessageSocket::Result result, double limit);
  [[noreturn]] void fail(const std::string& what);

  Settings settings_{};
  MessageSocket socket_;
  std::unique_ptr<ChildProcess> process_;
  Texts& texts_;
  std::stop_token stop_;  // of the run
  MessageWriter writer_{};
  algo::ParameterList parameters_{};
  std::string at_{"before its first run"};  // for sentences
};

}  // namespace server::external
