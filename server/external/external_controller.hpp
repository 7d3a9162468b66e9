// server/external/external_controller.hpp: the controller of the pipeline that asks a peer.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include "server/external/peer.hpp"
#include "server/external/registration.hpp"

namespace server::external {

/// Asks its peer in each tick, and in the first after a reset begins a run with it. While an answer
/// is under way by the run clock, the last one holds and nothing is asked. update() throws
/// ControllerError. In update(), `in.observation` and `in.spec` must not be null.
class ExternalController final : public algo::Controller {
 public:
  ExternalController(std::shared_ptr<PeerSource> source,
                     algo::ParameterList parameters,
                     ThinkTime think)
      : source_(std::move(source)), parameters_(parameters), think_(think) {}
  ~ExternalController() override;
  ExternalController(const ExternalController&) = delete;
  ExternalController& operator=(const ExternalController&) = delete;

  void begin(const algo::RunFacts& run) override { run_ = run; }
  void reset(const algo::Pose2& start_W) override;
  void update(const algo::ControlInput& in,
              const algo::Parameters& parameters,
              algo::ControlOutput& out) override;
  void explain(const algo::Telemetry& t, algo::Explanation& words) const override;

 private:
  void take_peer(const algo::RobotSpec& robot);
  void ask(const algo::ControlInput& in,
           const algo::Parameters& parameters,
           algo::ControlOutput& out,
           algo::Explanation& words);
  void ask_later(const algo::ControlInput& in,
                 const algo::Parameters& parameters,
                 algo::ControlOutput& out);
  std::uint32_t delay(std::chrono::duration<double> thought, double period) const;
  void give_back();

  std::shared_ptr<PeerSource> source_;
  algo::ParameterList parameters_;
  ThinkTime think_;
  algo::RunFacts run_{};
  algo::Pose2 start_W_{};
  std::unique_ptr<Peer> peer_{};
  bool well_ = true;        // the peer has answered all that it was asked
  std::uint64_t tick_ = 0;  // since the reset
  algo::Explanation words_{};
  // Of an answer that comes later than its question:
  std::uint32_t wait_ = 0;        // [ticks] until it acts
  algo::ControlOutput held_{};    // acts
  algo::ControlOutput coming_{};  // acts next
  algo::Explanation coming_words_{};
};

}  // namespace server::external
