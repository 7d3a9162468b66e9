// server/bridge.hpp: a session on the Foxglove protocol: channels out; goals, edits, gains in.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include <nlohmann/json.hpp>

#include "server/foxglove/hub.hpp"
#include "server/session.hpp"

namespace server {

class Bridge {
 public:
  /// `load` carries out a `/load` document; it throws with a sentence.
  Bridge(Session& session, std::function<void(const nlohmann::json&)> load);

  foxglove::Hub& hub() { return hub_; }

 private:
  /// The session's tunables as protocol parameters.
  class Gains final : public foxglove::ParameterSource {
   public:
    explicit Gains(Bridge& bridge) : bridge_(bridge) {}
    std::vector<foxglove::Parameter> list() const override;
    std::string set(const std::string& name, const nlohmann::json& value) override;
    /// Takes over what the session has now; values still on their way keep showing.
    void follow();

   private:
    Bridge& bridge_;
    algo::Parameters shown_{};
    std::size_t on_their_way_ = 0;
  };

  void add_channels();
  void add_services();
  void add_topics();
  void publish_frame(const FrameRef& frame);
  void publish_state();
  void submit(algo::Request request, const foxglove::ServiceReply& reply);
  std::string hand_over(foxglove::ClientId client, algo::Request request);
  std::uint64_t now_ns() const;

  Session& session_;
  std::function<void(const nlohmann::json&)> load_;
  foxglove::Hub hub_{};
  Gains gains_{*this};
  algo::Parameters told_parameters_{};
  std::size_t path_published_ = 0;

  foxglove::ChannelId telemetry_ = 0, state_ = 0, scan_ = 0, tf_ = 0, odom_ = 0, strip_ = 0,
                      forces_ = 0, obstacles_ = 0, goal_ = 0, trajectory_ = 0, log_ = 0;
};

}  // namespace server
