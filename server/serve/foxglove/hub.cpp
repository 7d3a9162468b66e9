// server/serve/foxglove/hub.cpp: sets up the hub and sends. Client operations are in
// hub_clients.cpp.
#include "server/serve/foxglove/hub.hpp"

#include <algorithm>
#include <random>
#include <stdexcept>
#include <utility>

#include "server/serve/foxglove/schemas.hpp"

namespace server::foxglove {
namespace {

constexpr std::chrono::milliseconds kTimePeriod{100};

std::string made_up_session_id() {
  std::random_device source;
  return "tautline-" + std::to_string(source()) + std::to_string(source());
}

}  // namespace

Hub::Hub() : session_id_(made_up_session_id()) {}

net::WsEndpoint Hub::endpoint(std::string path) {
  net::WsEndpoint endpoint;
  endpoint.path = std::move(path);
  endpoint.subprotocols = {std::string(kLegacySubprotocol), std::string(kSdkSubprotocol)};
  endpoint.on_open = [this](const std::shared_ptr<net::WsClient>& socket) { opened(socket); };
  endpoint.on_text = [this](net::WsClient& c, std::string_view message) { text(c.id(), message); };
  endpoint.on_binary = [this](net::WsClient& c, std::string_view m) { binary(c.id(), m); };
  endpoint.on_close = [this](net::WsClient& c) { closed(c.id()); };
  return endpoint;
}

ChannelId Hub::add_channel(const ChannelSpec& spec) {
  for (const Channel& channel : channels_) {
    if (channel.topic == spec.topic) {
      throw std::invalid_argument("the channel " + spec.topic + " is there already");
    }
  }
  const Schema& found = schema(spec.schema_name);
  Channel channel;
  channel.id = static_cast<ChannelId>(channels_.size() + 1);
  channel.topic = spec.topic;
  channel.encoding = found.encoding == "jsonschema" ? "json" : std::string(found.encoding);
  channel.schema_name = spec.schema_name;
  channel.schema = std::string(found.text);
  channel.schema_encoding = std::string(found.encoding);
  channels_.push_back(std::move(channel));
  states_.emplace_back();
  states_.back().newest = spec.newest;
  return channels_.back().id;
}

void Hub::add_service(std::string name, ServiceHandler handler, net::Role needed) {
  // Requests and responses are documented per service; the schema only says that both are objects.
  static constexpr std::string_view kObject = R"({"type":"object"})";
  Service service;
  service.id = static_cast<std::uint32_t>(services_.size() + 1);
  service.type = "tautline" + name;
  std::replace(service.type.begin(), service.type.end(), '/', '.');
  service.name = std::move(name);
  service.request_schema = kObject;
  service.response_schema = kObject;
  services_.push_back(std::move(service));
  service_handlers_.push_back({std::move(handler), needed});
}

void Hub::on_publish(std::string topic, PublishHandler handler) {
  publish_handlers_[std::move(topic)] = std::move(handler);
}

void Hub::on_publisher_gone(std::function<void(ClientId, const std::string& topic)> callback) {
  publisher_gone_ = std::move(callback);
}

void Hub::on_client_gone(std::function<void(ClientId)> callback) {
  client_gone_ = std::move(callback);
}

Hub::ChannelState& Hub::state(ChannelId channel) {
  if (channel == 0 || channel > states_.size()) {
    throw std::out_of_range("no channel with id " + std::to_string(channel));
  }
  return states_[channel - 1];
}

bool Hub::wanted(ChannelId channel) const {
  return channel > 0 && channel <= states_.size() && !states_[channel - 1].subscribers.empty();
}

void Hub::publish(ChannelId channel, std::uint64_t t_ns, Payload payload) {
  ChannelState& to = state(channel);
  for (const Subscriber& subscriber : to.subscribers) {
    const MessageHeader header = message_header(subscriber.subscription_id, t_ns);
    subscriber.client->socket->send_latest(channel, header, payload);
    subscriber.client->served = true;
  }
  to.last = {t_ns, std::move(payload)};
}

void Hub::publish_event(ChannelId channel, std::uint64_t t_ns, Payload payload) {
  ChannelState& to = state(channel);
  for (const Subscriber& subscriber : to.subscribers) {
    const MessageHeader header = message_header(subscriber.subscription_id, t_ns);
    Client& client = *subscriber.client;
    const bool kept = client.socket->send_latest(channel, header, payload, kEventRing);
    // Once per episode: a slow client must not get one status per lost message.
    if (!kept && !client.dropping_events) {
      complain(client,
               StatusLevel::Warning,
               "Send buffer limit reached: this connection is too slow, messages of " +
                   channels_[channel - 1].topic + " are left out");
    }
    client.dropping_events = !kept;
  }
  to.last = {t_ns, std::move(payload)};
}

void Hub::broadcast_time(std::uint64_t t_ns, std::chrono::steady_clock::time_point now) {
  time_ns_ = t_ns;
  if (time_sent_ && now - *time_sent_ < kTimePeriod) return;
  time_sent_ = now;
  const TimeMessage message = time_message(t_ns);
  for (auto& [id, client] : clients_) {
    client.socket->ride(client.served ? std::span<const std::byte>(message)
                                      : std::span<const std::byte>());
    if (!client.served) client.socket->send_latest(kTimeKey, message, nullptr);
    client.served = false;
  }
}

void Hub::parameters_changed(std::span<const std::string> names) {
  if (parameters_ == nullptr) return;
  const std::vector<Parameter> changed = values(names);
  for (auto& [id, client] : clients_) {
    std::vector<Parameter> wanted;
    for (const Parameter& parameter : changed) {
      if (client.all_parameters || client.parameters.count(parameter.name) > 0) {
        wanted.push_back(parameter);
      }
    }
    if (!wanted.empty()) send(client, parameter_values(wanted));
  }
}

void Hub::warn(ClientId id, std::string_view sentence) {
  const auto found = clients_.find(id);
  if (found != clients_.end()) complain(found->second, StatusLevel::Warning, sentence);
}

void Hub::announce(StatusLevel level, std::string_view sentence) {
  for (auto& [id, client] : clients_) complain(client, level, sentence);
}

void Hub::send(Client& client, std::string message) {
  client.socket->send_control(net::FrameKind::Text,
                              std::make_shared<const std::string>(std::move(message)));
}

void Hub::complain(Client& client, StatusLevel level, std::string_view sentence) {
  send(client, status(level, sentence));
}

std::vector<Parameter> Hub::values(std::span<const std::string> names) const {
  std::vector<Parameter> all =
      parameters_ == nullptr ? std::vector<Parameter>{} : parameters_->list();
  if (names.empty()) return all;
  std::erase_if(all, [&](const Parameter& parameter) {
    return std::find(names.begin(), names.end(), parameter.name) == names.end();
  });
  return all;
}

}  // namespace server::foxglove
