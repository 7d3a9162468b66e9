// server/serve/bridge.hpp: connects a session to the Foxglove protocol: channels out; goals, edits
// and gains in.
#pragma once

#include <chrono>
#include <cstdint>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <string>

#include <nlohmann/json.hpp>

#include "server/record/frame_codec.hpp"
#include "server/serve/driving.hpp"
#include "server/serve/foxglove/hub.hpp"
#include "server/serve/session.hpp"

namespace server {

class Bridge {
 public:
  /// Carry out a `/load` document and a reset. Errors are thrown or passed to `done`.
  using Done = std::function<void(std::exception_ptr)>;
  struct Loads {
    std::function<bool(const nlohmann::json&, Done)> load{};  // false: too many loads wait
    std::function<bool(Done)> reset{};
  };
  Bridge(Session& session, Loads loads);

  foxglove::Hub& hub() { return hub_; }

  /// Publishes the state if it has changed and is due. Call it often.
  void flush();

 private:
  /// The session's tunable parameters as protocol parameters.
  class Gains final : public foxglove::ParameterSource {
   public:
    explicit Gains(Bridge& bridge) : bridge_(bridge) {}
    std::vector<foxglove::Parameter> list() const override;
    std::string set(foxglove::ClientId client,
                    const std::string& name,
                    const nlohmann::json& value) override;
    /// Copies the session's current values. A value still on its way to the run stays visible.
    void follow();

   private:
    Bridge& bridge_;
    algo::Parameters shown_{};
    std::size_t on_their_way_ = 0;
  };

  static constexpr const char* kBusy =
      "More is waiting to be done than this robot can take. Try again.";
  static constexpr const char* kTwistMode = "cmd_vel.mode";  // a Twist has no room for it

  void add_channels();
  void add_services();
  void add_topics();
  void publish_frame(const FrameRef& frame);
  std::shared_ptr<const std::string> with_news(const Frame& frame);
  void publish_state();
  void state_changed();
  Sender sender(foxglove::ClientId client) const;
  void submit(foxglove::ClientId client,
              StampedRequest request,
              const foxglove::ServiceReply& reply);
  std::string hand_over(foxglove::ClientId client, algo::Request request);
  std::string drive(foxglove::ClientId client, const nlohmann::json& twist);
  void advise_rate(foxglove::ClientId client, std::chrono::steady_clock::time_point now);
  std::string set_twist_mode(const nlohmann::json& value);
  void sign_of(foxglove::ClientId client);
  void say_refusal(foxglove::ClientId client, bool stick, const std::string& refusal);
  std::uint64_t now_ns() const;

  Session& session_;
  Loads loads_;
  foxglove::Hub hub_{};
  Gains gains_{*this};
  FrameEncoder encoder_{};  // encodes messages other than the frames themselves
  std::uint32_t told_legend_ = 0;
  algo::Explanation told_words_{};  // last words sent to viewers of the telemetry
  algo::Parameters told_parameters_{};
  bool state_waits_ = false;
  std::chrono::steady_clock::time_point state_due_{};  // earliest time of the next publication
  std::size_t path_published_ = 0;
  std::map<foxglove::ClientId, std::chrono::steady_clock::time_point> stick_refused_{};
  struct TwistRate {
    std::chrono::steady_clock::time_point last{}, told{};
  };
  std::map<foxglove::ClientId, TwistRate> twists_{};
  algo::StickMode twist_mode_ = algo::StickMode::Guarded;
  std::chrono::steady_clock::time_point path_sent_{};

  foxglove::ChannelId telemetry_ = 0, state_ = 0, scan_ = 0, tf_ = 0, odom_ = 0, layers_ = 0,
                      filtered_ = 0, obstacles_ = 0, goal_ = 0, trajectory_ = 0, log_ = 0;
};

}  // namespace server
