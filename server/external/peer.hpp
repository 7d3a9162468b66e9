// server/external/peer.hpp: the side that answers: a controller in another process or in a shared
// object.
#pragma once

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <stop_token>

#include "algo/controller.hpp"

namespace server::external {

/// A controller outside the program cannot go on. what() is a sentence, perhaps followed by the
/// last lines that the controller printed.
class ControllerError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The beginning of a run.
struct Begin {
  const algo::RunFacts& run;
  algo::Pose2 start_W{};
  const algo::RobotSpec& robot;
  algo::ParameterList parameters{};  // each question has their values, in this order
};

/// One tick, to be answered.
struct Question {
  std::uint64_t tick = 0;  // counted from the reset
  const algo::ControlInput& in;
  const algo::Parameters& parameters;
};

/// Belongs to one run at a time.
class Peer {
 public:
  virtual ~Peer() = default;
  /// Throws ControllerError.
  virtual void begin(const Begin& run) = 0;
  /// Fills `out` and `words`, which are cleared on entry. The texts of layers and measures stay
  /// valid as long as the source of the peer. Throws ControllerError, after which the peer must not
  /// be used again.
  virtual void answer(const Question& question,
                      algo::ControlOutput& out,
                      algo::Explanation& words) = 0;
};

/// Lends peers to runs. Callable from any thread.
class PeerSource {
 public:
  virtual ~PeerSource() = default;
  /// May wait, until `stop`. Throws ControllerError.
  virtual std::unique_ptr<Peer> take(const std::stop_token& stop) = 0;
  /// For a peer whose run has ended; `well`: it may serve another run.
  virtual void give_back(std::unique_ptr<Peer> peer, bool well) = 0;
};

}  // namespace server::external
