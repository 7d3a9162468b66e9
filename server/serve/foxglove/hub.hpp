// server/serve/foxglove/hub.hpp: channels, subscriptions, parameters and services of all Foxglove
// clients.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "server/serve/foxglove/protocol.hpp"
#include "server/serve/net/websocket.hpp"

namespace server::foxglove {

using ClientId = std::uint32_t;   // net::WsClient::id()
using ChannelId = std::uint32_t;  // from 1, in order of add_channel
using net::Payload;

/// Where the hub reads and writes parameters.
class ParameterSource {
 public:
  virtual ~ParameterSource() = default;
  /// All parameters with the values that clients should see, including those just set.
  virtual std::vector<Parameter> list() const = 0;
  /// Sets a parameter. @return the refusal as a sentence; empty if it is accepted
  virtual std::string set(ClientId client,
                          const std::string& name,
                          const nlohmann::json& value) = 0;
};

/// Answers one service call, at once or later, on the io thread only. The first answer counts; a
/// client that has gone is no error. If the last copy is destroyed unused, the call fails with a
/// sentence.
class ServiceReply {
 public:
  ServiceReply(std::shared_ptr<net::WsClient> client,
               std::uint32_t service_id,
               std::uint32_t call_id);
  void success(const nlohmann::json& answer) const;
  void failure(std::string_view sentence) const;

 private:
  struct Call;
  std::shared_ptr<Call> call_;
};

/// A service handler: reads the request, and answers now or keeps `reply` for later. An exception
/// fails the call with its what().
using ServiceHandler =
    std::function<void(ClientId, const nlohmann::json& request, const ServiceReply& reply)>;

/// Takes a message that a client published. @return the refusal as a sentence; empty if accepted
using PublishHandler = std::function<std::string(ClientId, const nlohmann::json& message)>;

/// A message with its time on the run clock.
struct Stamped {
  std::uint64_t t_ns = 0;
  Payload payload{};
};

/// Every channel is latched: a new subscriber gets the newest message at once, so that it sees the
/// scene of a robot at rest.
struct ChannelSpec {
  std::string topic{};
  std::string schema_name{};  // one of schemas.hpp
  /// For a channel encoded only while a client subscribes: makes the newest message for the first
  /// subscriber, or a null payload. Without it, the channel keeps its last published message.
  std::function<Stamped()> newest{};
};

/// Io thread only. Must outlive the net::Server that has its endpoint. A client's mistake gets a
/// status message and never ends its connection.
class Hub {
 public:
  Hub();
  Hub(const Hub&) = delete;
  Hub& operator=(const Hub&) = delete;

  /// The endpoint to give to the server.
  net::WsEndpoint endpoint(std::string path);

  // ---- setting up, before the first client
  /// Throws std::invalid_argument if the topic exists already, std::out_of_range on an unknown
  /// schema. The schema decides the encoding: JSON Schema "json", else "flatbuffer".
  ChannelId add_channel(const ChannelSpec& spec);
  /// A client of a lower role than `needed` gets a failure that says so.
  void add_service(std::string name,
                   ServiceHandler handler,
                   net::Role needed = net::Role::Operator);
  /// Publishing, like setting parameters, is for operators.
  void on_publish(std::string topic, PublishHandler handler);
  /// `source` must outlive the hub.
  void set_parameters(ParameterSource& source) { parameters_ = &source; }
  /// Called when a client stops publishing on `topic`, or has gone.
  void on_publisher_gone(std::function<void(ClientId, const std::string& topic)> callback);
  void on_client_gone(std::function<void(ClientId)> callback);
  void on_client_came(std::function<void(ClientId)> callback) {
    client_came_ = std::move(callback);
  }
  /// Called when a client has come or gone.
  void on_clients(std::function<void()> callback) { clients_changed_ = std::move(callback); }

  // ---- sending
  /// True while a client subscribes. A channel with ChannelSpec::newest is encoded only then.
  bool wanted(ChannelId channel) const;
  /// State-like data: each client gets the newest message that it can take. `t_ns` is the run
  /// clock.
  void publish(ChannelId channel, std::uint64_t t_ns, Payload payload);
  /// Log-like data: a slow client gets the newest kEventRing messages, and a status for the rest.
  void publish_event(ChannelId channel, std::uint64_t t_ns, Payload payload);
  static constexpr std::size_t kEventRing = 64;
  /// Sends the run clock to all clients, at most ten times a second by `now`. A client that was
  /// sent something since the last time gets it with its next message, which saves a write.
  void broadcast_time(std::uint64_t t_ns, std::chrono::steady_clock::time_point now);
  /// Sends the current values of `names` (empty: all) to the clients that subscribed to them.
  void parameters_changed(std::span<const std::string> names = {});
  /// Sends a status message to one client, for instance a late refusal.
  void warn(ClientId client, std::string_view sentence);
  /// Sends a status message to all clients.
  void announce(StatusLevel level, std::string_view sentence);

  std::size_t clients() const { return clients_.size(); }
  /// Of a client that is connected.
  const net::Visitor& who(ClientId client) const { return clients_.at(client).socket->who(); }

 private:
  struct Client {
    std::shared_ptr<net::WsClient> socket{};
    std::map<std::uint32_t, ChannelId> subscriptions{};  // by the client's subscription id
    std::map<std::uint32_t, std::string> publishing{};   // topic by the client's channel id
    bool all_parameters = false;
    std::set<std::string> parameters{};
    bool dropping_events = false;
    bool served = false;  // was sent something since the last time message
  };
  struct Subscriber {
    Client* client = nullptr;
    std::uint32_t subscription_id = 0;
  };
  struct ChannelState {
    std::function<Stamped()> newest{};
    Stamped last{};
    std::vector<Subscriber> subscribers{};
  };

  void opened(const std::shared_ptr<net::WsClient>& socket);
  void closed(ClientId id);
  template <typename Parse>
  void take(ClientId id, std::string_view message, Parse parse);
  void text(ClientId id, std::string_view message);
  void binary(ClientId id, std::string_view message);

  void handle(Client& client, const Subscribe& op);
  void handle(Client& client, const Unsubscribe& op);
  void handle(Client& client, const ClientAdvertise& op);
  void handle(Client& client, const ClientUnadvertise& op);
  void handle(Client& client, const GetParameters& op);
  void handle(Client& client, const SetParameters& op);
  void handle(Client& client, const SubscribeParameterUpdates& op);
  void handle(Client& client, const UnsubscribeParameterUpdates& op);
  void handle(Client& client, const ClientMessage& message);
  void handle(Client& client, const ServiceRequest& request);

  ChannelState& state(ChannelId channel);
  void subscribe(Client& client, const Subscription& subscription);
  void remove_subscriber(const Client& client, ChannelId channel);
  std::vector<Parameter> values(std::span<const std::string> names) const;
  static constexpr std::uint32_t kTimeKey = 0xFFFFFFFF;  // send slot; channels use their id
  static void send(Client& client, std::string message);
  static void complain(Client& client, StatusLevel level, std::string_view sentence);

  std::string session_id_;              // viewers start again when it changes
  std::vector<Channel> channels_{};     // id = index + 1
  std::vector<ChannelState> states_{};  // same order
  std::vector<Service> services_{};     // id = index + 1
  struct Handling {
    ServiceHandler handler{};
    net::Role needed = net::Role::Operator;
  };
  std::vector<Handling> service_handlers_{};
  std::map<std::string, PublishHandler> publish_handlers_{};
  ParameterSource* parameters_ = nullptr;
  std::function<void(ClientId, const std::string&)> publisher_gone_{};
  std::function<void(ClientId)> client_gone_{};
  std::function<void(ClientId)> client_came_{};
  std::function<void()> clients_changed_{};
  std::map<ClientId, Client> clients_{};
  std::optional<std::chrono::steady_clock::time_point> time_sent_{};
  std::optional<std::uint64_t> time_ns_{};  // the run clock as last sent
};

}  // namespace server::foxglove
