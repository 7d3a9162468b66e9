// server/foxglove/hub.cpp: operations of the protocol, one function each.
#include "server/foxglove/hub.hpp"

#include <algorithm>
#include <utility>

#include "server/json_limits.hpp"

namespace server::foxglove {
namespace {

using nlohmann::json;
constexpr std::size_t kMaxSubscriptions = 256;  // of one client

std::shared_ptr<const std::string> shared(std::string text) {
  return std::make_shared<const std::string>(std::move(text));
}

}  // namespace

Hub::Hub(std::string session_id, ParameterSource& parameters)
    : session_id_(std::move(session_id)), parameters_(parameters) {}

Hub::ChannelId Hub::add_channel(Channel channel, bool latched) {
  channel.id = static_cast<ChannelId>(topics_.size() + 1);
  topics_.push_back({.channel = std::move(channel), .latched = latched});
  return topics_.back().channel.id;
}

void Hub::add_service(const std::string& name, const std::string& type, ServiceHandler handler) {
  const auto id = static_cast<std::uint32_t>(services_.size() + 1);
  services_.emplace_back(Service{id, name, type}, std::move(handler));
}

void Hub::add_topic(const std::string& topic, TopicHandler handler) {
  inlets_[topic] = std::move(handler);
}

void Hub::on_publisher_gone(std::function<void(const std::string&)> handler) {
  on_publisher_gone_ = std::move(handler);
}

net::WsHandlers Hub::handlers() {
  return {.on_open = [this](const auto& link) { open(link); },
          .on_message = [this](const auto& link,
                               bool binary,
                               std::string_view message) { receive(link, binary, message); },
          .on_close = [this](const auto& link) { close(link); }};
}

void Hub::open(const std::shared_ptr<net::WsClient>& link) {
  clients_[link->id()].link = link;
  std::vector<Channel> channels;
  for (const Topic& topic : topics_) channels.push_back(topic.channel);
  std::vector<Service> services;
  for (const auto& [service, handler] : services_) services.push_back(service);
  link->send_text(shared(server_info(session_id_)));
  link->send_text(shared(advertise(channels)));
  link->send_text(shared(advertise_services(services)));
}

void Hub::close(const std::shared_ptr<net::WsClient>& link) {
  const auto it = clients_.find(link->id());
  if (it == clients_.end()) return;
  const Client gone = std::move(it->second);
  clients_.erase(it);
  for (const auto& [subscription, channel] : gone.subscriptions) --topics_[channel - 1].subscribers;
  for (const auto& [id, topic] : gone.published) withdraw(topic);
}

void Hub::withdraw(const std::string& topic) {
  if (on_publisher_gone_) on_publisher_gone_(topic);
}

void Hub::receive(const std::shared_ptr<net::WsClient>& link,
                  bool binary,
                  std::string_view message) {
  const auto it = clients_.find(link->id());
  if (it == clients_.end()) return;
  Client& client = it->second;
  try {
    if (binary) {
      std::visit([&](const auto& op) { handle(client, op); }, parse_binary(message));
    } else {
      std::visit([&](const auto& op) { handle(client, op); }, parse_text(message));
    }
  } catch (const std::exception& e) {
    // What a client gets wrong is said to it; the connection and the server live on.
    complain(client, StatusLevel::Error, e.what());
  }
}

void Hub::complain(const Client& client, StatusLevel level, const std::string& sentence) const {
  client.link->send_text(shared(status(level, sentence)));
}

void Hub::handle(Client& client, const Subscribe& op) {
  for (const Subscribe::One& one : op.subscriptions) {
    if (one.channel == 0 || one.channel > topics_.size()) {
      complain(client,
               StatusLevel::Warning,
               "There is no channel " + std::to_string(one.channel) + " to subscribe to.");
      continue;
    }
    if (client.subscriptions.size() >= kMaxSubscriptions) {
      complain(client, StatusLevel::Warning, "Too many subscriptions on one connection.");
      return;
    }
    if (!client.subscriptions.emplace(one.id, one.channel).second) {
      complain(client,
               StatusLevel::Warning,
               "Subscription " + std::to_string(one.id) + " exists already.");
      continue;
    }
    Topic& topic = topics_[one.channel - 1];
    ++topic.subscribers;
    if (topic.latched && topic.last) {
      client.link->send_latest(one.id, message_header(one.id, topic.last_time_ns), topic.last);
    }
  }
}

void Hub::handle(Client& client, const Unsubscribe& op) {
  for (const std::uint32_t id : op.ids) {
    const auto it = client.subscriptions.find(id);
    if (it == client.subscriptions.end()) {
      complain(client, StatusLevel::Warning, "There is no subscription " + std::to_string(id) + ".");
      continue;
    }
    --topics_[it->second - 1].subscribers;
    client.subscriptions.erase(it);
    client.link->drop_latest(id);
  }
}

void Hub::handle(Client& client, const Advertise& op) {
  for (const Advertise::Channel& channel : op.channels) {
    if (channel.encoding != "json") {
      complain(client,
               StatusLevel::Warning,
               "Publish '" + channel.topic + "' as json; '" + channel.encoding + "' is not read.");
    } else if (!inlets_.contains(channel.topic)) {
      complain(client, StatusLevel::Info, "Nobody listens to '" + channel.topic + "' here.");
    }
    if (client.published.size() < kMaxSubscriptions) client.published[channel.id] = channel.topic;
  }
}

void Hub::handle(Client& client, const Unadvertise& op) {
  for (const std::uint32_t id : op.ids) {
    const auto it = client.published.find(id);
    if (it == client.published.end()) continue;
    const std::string topic = it->second;
    client.published.erase(it);
    withdraw(topic);
  }
}

void Hub::handle(Client& client, const ClientMessage& message) {
  const auto channel = client.published.find(message.channel);
  if (channel == client.published.end()) {
    complain(client,
             StatusLevel::Warning,
             "Channel " + std::to_string(message.channel) + " was not advertised.");
    return;
  }
  const auto inlet = inlets_.find(channel->second);
  if (inlet == inlets_.end()) return;  // said when it was advertised
  const std::uint64_t id = client.link->id();
  const std::string topic = channel->second;
  inlet->second(parse_json(message.payload), [this, id, topic](const std::string& sentence) {
    const auto it = clients_.find(id);
    if (it != clients_.end()) complain(it->second, StatusLevel::Warning, topic + ": " + sentence);
  });
}

void Hub::handle(Client& client, const ServiceRequest& request) {
  const auto fail = [link = client.link, request](const std::string& sentence) {
    link->send_text(shared(service_failure(request.service, request.call, sentence)));
  };
  if (request.service == 0 || request.service > services_.size()) {
    fail("There is no service " + std::to_string(request.service) + ".");
    return;
  }
  if (request.encoding != "json") {
    fail("Services are called in json, not '" + std::string(request.encoding) + "'.");
    return;
  }
  Reply reply;
  reply.fail = fail;
  reply.ok = [link = client.link, request](const json& body) {
    link->send_binary(shared(service_response(request.service, request.call, dump_json(body))));
  };
  try {
    const bool empty = request.payload.find_first_not_of(" \n\t") == std::string_view::npos;
    services_[request.service - 1].second(empty ? json::object() : parse_json(request.payload),
                                          reply);
  } catch (const std::exception& e) {
    fail(e.what());
  }
}

void Hub::send_parameters(const Client& client,
                          const std::vector<std::string>& names,
                          const std::optional<std::string>& id) const {
  json wanted = json::array();
  for (const json& parameter : parameters_.list()) {
    const auto& name = parameter.at("name").get_ref<const std::string&>();
    if (names.empty() || std::find(names.begin(), names.end(), name) != names.end()) {
      wanted.push_back(parameter);
    }
  }
  client.link->send_text(shared(parameter_values(wanted, id)));
}

void Hub::handle(Client& client, const GetParameters& op) {
  send_parameters(client, op.names, op.id);
}

void Hub::handle(Client& client, const SetParameters& op) {
  const std::uint64_t id = client.link->id();
  std::vector<std::string> names;
  for (const SetParameters::One& one : op.parameters) names.push_back(one.name);
  const auto left = std::make_shared<std::size_t>(op.parameters.size());
  for (const SetParameters::One& one : op.parameters) {
    parameters_.set(
        one.name,
        one.value,
        [this, id, names, left, request = op.id](const std::optional<std::string>& refusal) {
          const auto it = clients_.find(id);
          if (it == clients_.end()) return;
          if (refusal) complain(it->second, StatusLevel::Warning, *refusal);
          // The values as they are now: a refused one snaps back at the client. Those who only
          // subscribed hear of it too.
          if (--*left == 0) send_parameters(it->second, names, request);
        });
  }
}

void Hub::handle(Client& client, const SubscribeParameters& op) {
  client.wants_parameters = true;
  send_parameters(client, op.names, std::nullopt);
}

void Hub::handle(Client& client, const UnsubscribeParameters& /*op*/) {
  client.wants_parameters = false;
}

bool Hub::wanted(ChannelId channel) const { return topics_[channel - 1].subscribers > 0; }

void Hub::publish(ChannelId channel,
                  std::uint64_t time_ns,
                  std::shared_ptr<const std::string> payload) {
  Topic& topic = topics_[channel - 1];
  if (topic.latched) {
    topic.last = payload;
    topic.last_time_ns = time_ns;
  }
  if (topic.subscribers == 0) return;
  for (auto& [id, client] : clients_) {
    for (const auto& [subscription, wanted_channel] : client.subscriptions) {
      if (wanted_channel != channel) continue;
      client.link->send_latest(subscription, message_header(subscription, time_ns), payload);
    }
  }
}

void Hub::publish_event(ChannelId channel, std::uint64_t time_ns, const std::string& payload) {
  for (auto& [id, client] : clients_) {
    for (const auto& [subscription, wanted_channel] : client.subscriptions) {
      if (wanted_channel != channel) continue;
      const auto header = message_header(subscription, time_ns);
      std::string message(reinterpret_cast<const char*>(header.data()), header.size());
      client.link->send_binary(shared(message + payload));
    }
  }
}

void Hub::publish_time(std::uint64_t time_ns) {
  const auto message = shared(time_message(time_ns));
  constexpr std::uint64_t kTimeSlot = std::uint64_t{1} << 40;  // beyond every subscription id
  for (auto& [id, client] : clients_) client.link->send_latest(kTimeSlot, {}, message);
}

void Hub::parameters_changed() {
  for (const auto& [id, client] : clients_) {
    if (client.wants_parameters) send_parameters(client, {}, std::nullopt);
  }
}

}  // namespace server::foxglove
