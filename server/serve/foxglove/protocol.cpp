// server/serve/foxglove/protocol.cpp: checks every field and length from a client before use.
#include "server/serve/foxglove/protocol.hpp"

#include <limits>

#include "server/run/json_limits.hpp"

namespace server::foxglove {
namespace {

using nlohmann::json;

constexpr std::byte kMessageData{0x01};
constexpr std::byte kTime{0x02};
constexpr std::byte kServiceResponse{0x03};
constexpr char kClientMessage = 0x01;
constexpr char kServiceRequest = 0x02;

// ---- reading JSON fields; `where` names the place for the error

const json& field(const json& object, const char* name, const std::string& where) {
  if (!object.is_object()) throw ProtocolError(where + " must be an object");
  const auto found = object.find(name);
  if (found == object.end()) throw ProtocolError(where + " lacks '" + name + "'");
  return *found;
}

std::uint32_t as_u32(const json& value, const std::string& what) {
  if (!value.is_number_unsigned() ||
      value.get<std::uint64_t>() > std::numeric_limits<std::uint32_t>::max()) {
    throw ProtocolError(what + " must be an integer from 0 to 4294967295");
  }
  return value.get<std::uint32_t>();
}

std::string as_text(const json& value, const std::string& what) {
  if (!value.is_string()) throw ProtocolError(what + " must be a text");
  return value.get<std::string>();
}

const json& as_list(const json& value, const std::string& what) {
  if (!value.is_array()) throw ProtocolError(what + " must be a list");
  return value;
}

std::string optional_text(const json& object, const char* name, const std::string& where) {
  const auto found = object.find(name);
  if (found == object.end() || found->is_null()) return {};
  return as_text(*found, where + ": '" + name + "'");
}

/// The fields of one item in a list of the operation `op`.
struct Item {
  const json& object;
  const std::string& op;
  const char* noun;

  const json& at(const char* name) const { return field(object, name, op + ": " + noun); }
  std::uint32_t u32(const char* name) const { return as_u32(at(name), label(name)); }
  std::string text(const char* name) const { return as_text(at(name), label(name)); }
  std::string label(const char* name) const { return op + ": '" + name + "'"; }
};

/// Reads each value of the operation's list `name` by `read(value, op)`.
template <typename Read>
auto list_of(const json& op, const char* name, const std::string& where, Read read) {
  std::vector<decltype(read(op, where))> out;
  for (const json& value : as_list(field(op, name, where), where + ": '" + name + "'")) {
    out.push_back(read(value, where));
  }
  return out;
}

std::vector<std::uint32_t> id_list(const json& op, const char* name, const std::string& where) {
  return list_of(op, name, where, [name](const json& value, const std::string& of) {
    return as_u32(value, of + ": each of '" + name + "'");
  });
}

std::vector<std::string> name_list(const json& op, const std::string& where) {
  return list_of(op, "parameterNames", where, [](const json& value, const std::string& of) {
    return as_text(value, of + ": each of 'parameterNames'");
  });
}

std::optional<std::string> request_id(const json& op, const std::string& where) {
  const auto found = op.find("id");
  if (found == op.end() || found->is_null()) return std::nullopt;
  return as_text(*found, where + ": 'id'");
}

Subscription read_subscription(const json& value, const std::string& op) {
  const Item in{value, op, "a subscription"};
  return {in.u32("id"), in.u32("channelId")};
}

ClientChannel read_channel(const json& value, const std::string& op) {
  const Item in{value, op, "a channel"};
  return {
      in.u32("id"), in.text("topic"), in.text("encoding"), optional_text(value, "schemaName", op)};
}

Parameter read_parameter(const json& value, const std::string& op) {
  const std::string name = Item{value, op, "a parameter"}.text("name");
  return {name, value.value("value", json(nullptr)), optional_text(value, "type", op)};
}

/// True for an operation that is valid in v1 but not offered here: the error says so, not
/// "unknown".
bool is_known_but_unsupported(const std::string& op) {
  return op == "subscribeConnectionGraph" || op == "unsubscribeConnectionGraph" ||
         op == "fetchAsset";
}

// ---- little-endian integers

template <typename Unsigned>
void put(std::byte* to, Unsigned value) {
  for (std::size_t i = 0; i < sizeof value; ++i) {
    to[i] = static_cast<std::byte>((value >> (8 * i)) & 0xFFu);
  }
}

std::uint32_t take_u32(std::string_view& bytes, const char* what) {
  if (bytes.size() < 4) {
    throw ProtocolError(std::string("a binary message ends before its ") + what);
  }
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    value |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[i])) << (8 * i);
  }
  bytes.remove_prefix(4);
  return value;
}

json parameter_json(const Parameter& parameter) {
  json out = {{"name", parameter.name}};
  if (!parameter.value.is_null()) out["value"] = parameter.value;
  if (!parameter.type.empty()) out["type"] = parameter.type;
  return out;
}

json service_json(const Service& service) {
  const auto message = [](const std::string& name, const std::string& schema) {
    return json{{"encoding", "json"},
                {"schemaName", name},
                {"schemaEncoding", "jsonschema"},
                {"schema", schema}};
  };
  return {{"id", service.id},
          {"name", service.name},
          {"type", service.type},
          {"request", message(service.type + ".Request", service.request_schema)},
          {"response", message(service.type + ".Response", service.response_schema)},
          {"requestSchema", service.request_schema},
          {"responseSchema", service.response_schema}};
}

}  // namespace

ClientText parse_text(std::string_view text) {
  json op;
  try {
    op = parse_json(text);
  } catch (const JsonError& error) {
    throw ProtocolError(error.what());
  }
  const std::string name = as_text(field(op, "op", "a text message"), "'op'");
  if (name == "subscribe") {
    return Subscribe{list_of(op, "subscriptions", name, read_subscription)};
  }
  if (name == "unsubscribe") return Unsubscribe{id_list(op, "subscriptionIds", name)};
  if (name == "advertise") return ClientAdvertise{list_of(op, "channels", name, read_channel)};
  if (name == "unadvertise") return ClientUnadvertise{id_list(op, "channelIds", name)};
  if (name == "getParameters") return GetParameters{name_list(op, name), request_id(op, name)};
  if (name == "setParameters") {
    return SetParameters{list_of(op, "parameters", name, read_parameter), request_id(op, name)};
  }
  if (name == "subscribeParameterUpdates") return SubscribeParameterUpdates{name_list(op, name)};
  if (name == "unsubscribeParameterUpdates") {
    return UnsubscribeParameterUpdates{name_list(op, name)};
  }
  if (is_known_but_unsupported(name)) {
    throw ProtocolError("the op '" + name + "' is not among this server's capabilities");
  }
  throw ProtocolError("the op '" + name.substr(0, 100) + "' is unknown");
}

ClientBinary parse_binary(std::string_view bytes) {
  if (bytes.empty()) throw ProtocolError("a binary message is empty");
  const char opcode = bytes.front();
  bytes.remove_prefix(1);
  if (opcode == kClientMessage) {
    const std::uint32_t channel_id = take_u32(bytes, "channel id");
    return ClientMessage{channel_id, bytes};
  }
  if (opcode == kServiceRequest) {
    ServiceRequest request;
    request.service_id = take_u32(bytes, "service id");
    request.call_id = take_u32(bytes, "call id");
    const std::uint32_t length = take_u32(bytes, "encoding length");
    if (length > bytes.size()) {
      throw ProtocolError("a service request names an encoding of " + std::to_string(length) +
                          " bytes but has only " + std::to_string(bytes.size()) + " left");
    }
    request.encoding = bytes.substr(0, length);
    request.payload = bytes.substr(length);
    return request;
  }
  throw ProtocolError("the binary opcode " +
                      std::to_string(static_cast<unsigned>(static_cast<unsigned char>(opcode))) +
                      " is unknown");
}

std::string server_info(const std::string& session_id) {
  return dump_json(
      {{"op", "serverInfo"},
       {"name", "Tautline"},
       {"capabilities", {"clientPublish", "time", "parameters", "parametersSubscribe", "services"}},
       {"supportedEncodings", json::array({"json"})},
       // A viewer shows its click-drag goal tool only for a server that names a ROS distribution.
       {"metadata", {{"ROS_DISTRO", "humble"}}},
       {"sessionId", session_id}});
}

std::string advertise(std::span<const Channel> channels) {
  json list = json::array();
  for (const Channel& channel : channels) {
    list.push_back({{"id", channel.id},
                    {"topic", channel.topic},
                    {"encoding", channel.encoding},
                    {"schemaName", channel.schema_name},
                    {"schema", channel.schema},
                    {"schemaEncoding", channel.schema_encoding}});
  }
  return dump_json({{"op", "advertise"}, {"channels", list}});
}

std::string status(StatusLevel level, std::string_view message) {
  return dump_json({{"op", "status"}, {"level", static_cast<int>(level)}, {"message", message}});
}

std::string parameter_values(std::span<const Parameter> parameters,
                             const std::optional<std::string>& id) {
  json list = json::array();
  for (const Parameter& parameter : parameters) list.push_back(parameter_json(parameter));
  json out = {{"op", "parameterValues"}, {"parameters", list}};
  if (id) out["id"] = *id;
  return dump_json(out);
}

std::string advertise_services(std::span<const Service> services) {
  json list = json::array();
  for (const Service& service : services) list.push_back(service_json(service));
  return dump_json({{"op", "advertiseServices"}, {"services", list}});
}

std::string service_call_failure(std::uint32_t service_id,
                                 std::uint32_t call_id,
                                 std::string_view message) {
  return dump_json({{"op", "serviceCallFailure"},
                    {"serviceId", service_id},
                    {"callId", call_id},
                    {"message", message}});
}

MessageHeader message_header(std::uint32_t subscription_id, std::uint64_t t_ns) {
  MessageHeader out{kMessageData};
  put(out.data() + 1, subscription_id);
  put(out.data() + 5, t_ns);
  return out;
}

TimeMessage time_message(std::uint64_t t_ns) {
  TimeMessage out{kTime};
  put(out.data() + 1, t_ns);
  return out;
}

std::string service_response(std::uint32_t service_id,
                             std::uint32_t call_id,
                             std::string_view encoding,
                             std::string_view payload) {
  std::array<std::byte, 13> head{kServiceResponse};
  put(head.data() + 1, service_id);
  put(head.data() + 5, call_id);
  put(head.data() + 9, static_cast<std::uint32_t>(encoding.size()));
  std::string out(reinterpret_cast<const char*>(head.data()), head.size());
  out.append(encoding).append(payload);
  return out;
}

}  // namespace server::foxglove
