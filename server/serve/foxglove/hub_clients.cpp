// server/serve/foxglove/hub_clients.cpp: client operations of the hub, with one handle() each.
#include <algorithm>
#include <exception>
#include <utility>
#include <variant>

#include "server/run/json_limits.hpp"
#include "server/run/paths.hpp"
#include "server/serve/foxglove/hub.hpp"

namespace server::foxglove {
namespace {

constexpr std::size_t kMaxPublishing = 64;  // channels one client may advertise

/// Why `client` may not do what is for operators; empty if it may.
std::string refusal_of(const net::WsClient& client) {
  const net::Role has = client.who().role;
  return has >= net::Role::Operator ? "" : net::role_refusal(has, net::Role::Operator);
}

}  // namespace

// ---- service replies

struct ServiceReply::Call {
  Call(std::shared_ptr<net::WsClient> to, std::uint32_t service, std::uint32_t call)
      : client(std::move(to)), service_id(service), call_id(call) {}
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;
  ~Call() {
    try {
      answer(net::FrameKind::Text,
             service_call_failure(service_id, call_id, "the service did not answer"));
    } catch (...) {  // NOLINT(bugprone-empty-catch): a destructor cannot report it
      client = nullptr;
    }
  }
  void answer(net::FrameKind kind, std::string message) {
    const auto to = std::exchange(client, nullptr);
    if (to) to->send_control(kind, std::make_shared<const std::string>(std::move(message)));
  }

  std::shared_ptr<net::WsClient> client;  // empty once answered
  std::uint32_t service_id;
  std::uint32_t call_id;
};

ServiceReply::ServiceReply(std::shared_ptr<net::WsClient> client,
                           std::uint32_t service_id,
                           std::uint32_t call_id)
    : call_(std::make_shared<Call>(std::move(client), service_id, call_id)) {}

void ServiceReply::success(const nlohmann::json& answer) const {
  call_->answer(net::FrameKind::Binary,
                service_response(call_->service_id, call_->call_id, "json", dump_json(answer)));
}

void ServiceReply::failure(std::string_view sentence) const {
  call_->answer(net::FrameKind::Text,
                service_call_failure(call_->service_id, call_->call_id, sentence));
}

// ---- coming and going

void Hub::opened(const std::shared_ptr<net::WsClient>& socket) {
  Client& client = clients_[socket->id()];
  client.socket = socket;
  send(client, server_info(session_id_));  // must be the first message
  send(client, advertise(channels_));
  if (!services_.empty()) send(client, advertise_services(services_));
  if (time_ns_) socket->send_latest(kTimeKey, time_message(*time_ns_), nullptr);
  if (client_came_) client_came_(socket->id());
  if (clients_changed_) clients_changed_();
}

void Hub::closed(ClientId id) {
  const auto found = clients_.find(id);
  if (found == clients_.end()) return;
  for (ChannelState& channel : states_) {
    std::erase_if(channel.subscribers,
                  [&](const Subscriber& s) { return s.client == &found->second; });
  }
  // Remove it from the map first: the callbacks may publish or read the clients.
  const Client client = std::move(found->second);
  clients_.erase(found);
  for (const auto& [channel_id, topic] : client.publishing) {
    if (publisher_gone_) publisher_gone_(id, topic);
  }
  if (client_gone_) client_gone_(id);
  if (clients_changed_) clients_changed_();
}

/// Parses a message of client `id` with `parse` and handles it.
template <typename Parse>
void Hub::take(ClientId id, std::string_view message, Parse parse) {
  const auto found = clients_.find(id);
  if (found == clients_.end()) return;
  try {
    std::visit([&](const auto& op) { handle(found->second, op); }, parse(message));
  } catch (const ProtocolError& error) {
    complain(found->second, StatusLevel::Error, error.what());
  }
}

void Hub::text(ClientId id, std::string_view message) {
  take(id, message, parse_text);
}

void Hub::binary(ClientId id, std::string_view message) {
  take(id, message, parse_binary);
}

// ---- subscriptions

void Hub::handle(Client& client, const Subscribe& op) {
  for (const Subscription& subscription : op.subscriptions) subscribe(client, subscription);
}

void Hub::subscribe(Client& client, const Subscription& subscription) {
  const ChannelId channel = subscription.channel_id;
  if (channel == 0 || channel > channels_.size()) {
    complain(client,
             StatusLevel::Error,
             "subscribe: there is no channel with id " + std::to_string(channel));
    return;
  }
  if (client.subscriptions.count(subscription.id) > 0) {
    complain(
        client,
        StatusLevel::Error,
        "subscribe: the subscription id " + std::to_string(subscription.id) + " is in use already");
    return;
  }
  for (const auto& [id, subscribed] : client.subscriptions) {
    if (subscribed != channel) continue;
    complain(client,
             StatusLevel::Warning,
             "subscribe: " + channels_[channel - 1].topic + " is subscribed already, as " +
                 std::to_string(id));
    return;
  }
  client.subscriptions[subscription.id] = channel;
  ChannelState& to = states_[channel - 1];
  // The last encoded message is old if no client subscribed since.
  if (to.newest && to.subscribers.empty()) to.last = to.newest();
  to.subscribers.push_back({&client, subscription.id});
  if (to.last.payload) {
    const MessageHeader header = message_header(subscription.id, to.last.t_ns);
    client.socket->send_latest(channel, header, to.last.payload);
  }
}

void Hub::remove_subscriber(const Client& client, ChannelId channel) {
  std::erase_if(states_[channel - 1].subscribers,
                [&](const Subscriber& s) { return s.client == &client; });
  client.socket->forget(channel);  // queued messages carry the old subscription id
}

void Hub::handle(Client& client, const Unsubscribe& op) {
  for (const std::uint32_t id : op.subscription_ids) {
    const auto found = client.subscriptions.find(id);
    if (found == client.subscriptions.end()) {
      complain(client,
               StatusLevel::Warning,
               "unsubscribe: there is no subscription " + std::to_string(id));
      continue;
    }
    remove_subscriber(client, found->second);
    client.subscriptions.erase(found);
  }
}

// ---- client publishing

void Hub::handle(Client& client, const ClientAdvertise& op) {
  for (const ClientChannel& channel : op.channels) {
    std::string wrong = refusal_of(*client.socket);
    if (!wrong.empty()) {
      // said below
    } else if (publish_handlers_.count(channel.topic) == 0) {
      wrong = "nothing here listens to the topic '" + channel.topic + "'; there are:";
      for (const auto& [topic, handler] : publish_handlers_) wrong += ' ' + topic;
    } else if (channel.encoding != "json") {
      wrong = "the topic '" + channel.topic + "' takes the encoding json, not '" +
              channel.encoding + "'";
    } else if (client.publishing.count(channel.id) > 0) {
      wrong = "the channel id " + std::to_string(channel.id) + " is in use already";
    } else if (client.publishing.size() >= kMaxPublishing) {
      wrong = "one client advertises at most " + std::to_string(kMaxPublishing) + " channels";
    }
    if (wrong.empty()) {
      client.publishing[channel.id] = channel.topic;
    } else {
      complain(client, StatusLevel::Warning, "advertise: " + wrong);
    }
  }
}

void Hub::handle(Client& client, const ClientUnadvertise& op) {
  for (const std::uint32_t id : op.channel_ids) {
    const auto found = client.publishing.find(id);
    if (found == client.publishing.end()) {
      complain(client,
               StatusLevel::Warning,
               "unadvertise: there is no channel with id " + std::to_string(id));
      continue;
    }
    const std::string topic = std::move(found->second);
    client.publishing.erase(found);
    if (publisher_gone_) publisher_gone_(client.socket->id(), topic);
  }
}

void Hub::handle(Client& client, const ClientMessage& message) {
  const auto channel = client.publishing.find(message.channel_id);
  if (channel == client.publishing.end()) {
    throw ProtocolError("message data for the channel id " + std::to_string(message.channel_id) +
                        ", which was not advertised");
  }
  const std::string& topic = channel->second;
  std::string refusal;
  try {
    refusal = publish_handlers_.at(topic)(client.socket->id(), parse_json(message.payload));
  } catch (const std::exception& error) {
    refusal = error.what();
  }
  if (!refusal.empty()) complain(client, StatusLevel::Warning, topic + ": " + refusal);
}

// ---- parameters

void Hub::handle(Client& client, const GetParameters& op) {
  send(client, parameter_values(values(op.names), op.id));
}

void Hub::handle(Client& client, const SetParameters& op) {
  std::vector<std::string> named;
  std::vector<std::string> taken;
  bool refused = false;
  for (const Parameter& parameter : op.parameters) {
    named.push_back(parameter.name);
    const std::string not_allowed = refusal_of(*client.socket);
    std::string refusal = "there are no parameters here";
    try {
      if (!not_allowed.empty()) {
        refusal = not_allowed;
      } else if (parameters_ != nullptr && parameter.value.is_null()) {
        refusal = "a parameter cannot be unset";
      } else if (parameters_ != nullptr) {
        refusal = parameters_->set(client.socket->id(), parameter.name, parameter.value);
      }
    } catch (const std::exception& error) {
      refusal = error.what();
    }
    if (refusal.empty()) {
      taken.push_back(parameter.name);
      continue;
    }
    refused = true;
    complain(client, StatusLevel::Warning, parameter.name + ": " + refusal);
  }
  // Send the requested answer, or after a refusal the old values, so that a slider jumps back.
  if (op.id || refused) {
    send(client, parameter_values(named.empty() ? std::vector<Parameter>{} : values(named), op.id));
  }
  if (!taken.empty()) parameters_changed(taken);
}

void Hub::handle(Client& client, const SubscribeParameterUpdates& op) {
  if (op.names.empty()) client.all_parameters = true;
  // Only existing names: a client cannot fill memory with others.
  for (const Parameter& parameter :
       op.names.empty() ? std::vector<Parameter>{} : values(op.names)) {
    client.parameters.insert(parameter.name);
  }
}

void Hub::handle(Client& client, const UnsubscribeParameterUpdates& op) {
  if (op.names.empty()) {
    client.all_parameters = false;
    client.parameters.clear();
  }
  for (const std::string& name : op.names) client.parameters.erase(name);
}

// ---- services

void Hub::handle(Client& client, const ServiceRequest& request) {
  const ServiceReply reply(client.socket, request.service_id, request.call_id);
  if (request.service_id == 0 || request.service_id > services_.size()) {
    reply.failure("there is no service with id " + std::to_string(request.service_id));
    return;
  }
  if (request.encoding != "json") {
    reply.failure("services take the encoding json, not '" +
                  std::string(request.encoding.substr(0, 100)) + "'");
    return;
  }
  const Handling& handling = service_handlers_[request.service_id - 1];
  if (const net::Role has = client.socket->who().role; has < handling.needed) {
    reply.failure(net::role_refusal(has, handling.needed));
    return;
  }
  try {
    const nlohmann::json body =
        request.payload.empty() ? nlohmann::json::object() : parse_json(request.payload);
    handling.handler(client.socket->id(), body, reply);
  } catch (const std::exception& error) {
    reply.failure(without_folders(error.what()));
  }
}

}  // namespace server::foxglove
