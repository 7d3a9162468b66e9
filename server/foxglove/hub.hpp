// server/foxglove/hub.hpp: who is connected and what they want: channels, parameters, services.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "server/foxglove/protocol.hpp"
#include "server/net/server.hpp"

namespace server::foxglove {

/// The tunables as the protocol's parameters.
class ParameterSource {
 public:
  virtual ~ParameterSource() = default;
  /// [{"name", "value", "type"?}] of all.
  virtual nlohmann::json list() const = 0;
  /// Asks for a change; `done` is called now or later with the refusal, if any.
  virtual void set(const std::string& name,
                   const nlohmann::json& value,
                   std::function<void(const std::optional<std::string>&)> done) = 0;
};

/// Speaks the protocol with every client. All calls on the io thread.
class Hub {
 public:
  using ChannelId = std::uint32_t;
  /// Answers a service call, now or later: a JSON document, or a failure sentence.
  struct Reply {
    std::function<void(const nlohmann::json&)> ok{};
    std::function<void(const std::string&)> fail{};
  };
  using ServiceHandler = std::function<void(const nlohmann::json& request, const Reply& reply)>;
  /// `complain` puts a warning on that client's status line.
  using TopicHandler = std::function<void(const nlohmann::json& message,
                                          const std::function<void(const std::string&)>& complain)>;

  Hub(std::string session_id, ParameterSource& parameters);

  // Set-up, before the first client.
  /// `latched`: a new subscriber gets the last message at once.
  ChannelId add_channel(Channel channel, bool latched);
  void add_service(const std::string& name, const std::string& type, ServiceHandler handler);
  void add_topic(const std::string& topic, TopicHandler handler);
  /// Called when a client that had advertised `topic` unadvertises it or goes.
  void on_publisher_gone(std::function<void(const std::string& topic)> handler);

  net::WsHandlers handlers();

  /// Somebody subscribes: only then is it worth encoding.
  bool wanted(ChannelId channel) const;
  /// The newest message of a state-like channel: one that has not gone out yet is replaced.
  void publish(ChannelId channel, std::uint64_t time_ns, std::shared_ptr<const std::string> payload);
  /// A message that must arrive, such as a log line.
  void publish_event(ChannelId channel, std::uint64_t time_ns, const std::string& payload);
  void publish_time(std::uint64_t time_ns);
  /// Tells those who asked for parameter updates.
  void parameters_changed();
  std::size_t clients() const { return clients_.size(); }

 private:
  struct Client {
    std::shared_ptr<net::WsClient> link{};
    std::map<std::uint32_t, ChannelId> subscriptions{};  // subscription id to channel
    std::map<std::uint32_t, std::string> published{};    // client channel id to topic
    bool wants_parameters = false;
  };
  struct Topic {
    Channel channel{};
    bool latched = false;
    std::size_t subscribers = 0;
    std::uint64_t last_time_ns = 0;
    std::shared_ptr<const std::string> last{};
  };

  void open(const std::shared_ptr<net::WsClient>& link);
  void close(const std::shared_ptr<net::WsClient>& link);
  void receive(const std::shared_ptr<net::WsClient>& link, bool binary, std::string_view message);
  void handle(Client& client, const Subscribe& op);
  void handle(Client& client, const Unsubscribe& op);
  void handle(Client& client, const Advertise& op);
  void handle(Client& client, const Unadvertise& op);
  void handle(Client& client, const GetParameters& op);
  void handle(Client& client, const SetParameters& op);
  void handle(Client& client, const SubscribeParameters& op);
  void handle(Client& client, const UnsubscribeParameters& op);
  void handle(Client& client, const ClientMessage& message);
  void handle(Client& client, const ServiceRequest& request);
  void complain(const Client& client, StatusLevel level, const std::string& sentence) const;
  void send_parameters(const Client& client,
                       const std::vector<std::string>& names,
                       const std::optional<std::string>& id) const;
  void withdraw(const std::string& topic);

  std::string session_id_;
  ParameterSource& parameters_;
  std::vector<Topic> topics_{};  // by channel id - 1
  std::vector<std::pair<Service, ServiceHandler>> services_{};  // by service id - 1
  std::map<std::string, TopicHandler> inlets_{};
  std::function<void(const std::string&)> on_publisher_gone_{};
  std::map<std::uint64_t, Client> clients_{};
};

}  // namespace server::foxglove
