// server/foxglove/protocol.cpp: parse and build the protocol's messages.
#include "server/foxglove/protocol.hpp"

#include <concepts>

#include "server/json_limits.hpp"
#include "server/json_reader.hpp"

namespace server::foxglove {
namespace {

using nlohmann::json;
constexpr std::size_t kMaxEntries = 1000;
constexpr std::uint64_t kMaxId = 0xFFFFFFFF;

std::uint32_t id_of(const JsonReader& in, std::string_view key) {
  return static_cast<std::uint32_t>(in.whole(key, kMaxId));
}

std::vector<std::uint32_t> ids_of(const JsonReader& in, std::string_view key) {
  std::vector<std::uint32_t> ids;
  for (const json& value : in.array(key, kMaxEntries)) {
    if (!value.is_number_unsigned() || value.get<std::uint64_t>() > kMaxId) {
      in.fail(key, "must hold whole numbers of 32 bit");
    }
    ids.push_back(value.get<std::uint32_t>());
  }
  return ids;
}

std::vector<std::string> names_of(const JsonReader& in, std::string_view key) {
  std::vector<std::string> names;
  if (!in.has(key)) return names;
  for (const json& value : in.array(key, kMaxEntries)) {
    if (!value.is_string()) in.fail(key, "must hold names");
    names.push_back(value.get<std::string>());
  }
  return names;
}

std::optional<std::string> request_id(const JsonReader& in) {
  return in.has("id") ? std::optional(in.text("id")) : std::nullopt;
}

template <typename Each>
void each_object(const JsonReader& in, std::string_view key, Each each) {
  std::size_t index = 0;
  for (const json& value : in.array(key, kMaxEntries)) {
    each(JsonReader(value, std::string(key) + "/" + std::to_string(index++)));
  }
}

ClientText read_operation(const JsonReader& in) {
  const std::string op = in.text("op", 64);
  if (op == "subscribe") {
    Subscribe out;
    each_object(in, "subscriptions", [&](const JsonReader& one) {
      out.subscriptions.push_back({id_of(one, "id"), id_of(one, "channelId")});
    });
    return out;
  }
  if (op == "unsubscribe") return Unsubscribe{ids_of(in, "subscriptionIds")};
  if (op == "advertise") {
    Advertise out;
    each_object(in, "channels", [&](const JsonReader& one) {
      out.channels.push_back({id_of(one, "id"), one.text("topic", 256), one.text("encoding", 64)});
    });
    return out;
  }
  if (op == "unadvertise") return Unadvertise{ids_of(in, "channelIds")};
  if (op == "getParameters") return GetParameters{names_of(in, "parameterNames"), request_id(in)};
  if (op == "setParameters") {
    SetParameters out;
    each_object(in, "parameters", [&](const JsonReader& one) {
      out.parameters.push_back(
          {one.text("name", 256), one.has("value") ? one.raw().at("value") : json(nullptr)});
    });
    out.id = request_id(in);
    return out;
  }
  if (op == "subscribeParameterUpdates") {
    return SubscribeParameters{names_of(in, "parameterNames")};
  }
  if (op == "unsubscribeParameterUpdates") {
    return UnsubscribeParameters{names_of(in, "parameterNames")};
  }
  throw ProtocolError("This server does not know the operation '" + op + "'.");
}

template <std::unsigned_integral T>
void put(std::string& out, T value) {
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    out.push_back(static_cast<char>(static_cast<std::uint64_t>(value) >> (8 * i)));
  }
}

std::uint32_t get_u32(std::string_view bytes, std::size_t at) {
  if (bytes.size() < at + 4) throw ProtocolError("The message is too short for its kind.");
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    value |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
  }
  return value;
}

}  // namespace

ClientText parse_text(std::string_view text) {
  try {
    const json document = parse_json(text);
    return read_operation({document, ""});
  } catch (const JsonError& e) {
    throw ProtocolError(std::string("This is not JSON: ") + e.what());
  } catch (const DocumentError& e) {
    throw ProtocolError(e.what());
  }
}

ClientBinary parse_binary(std::string_view bytes) {
  if (bytes.empty()) throw ProtocolError("The message is empty.");
  if (bytes[0] == 0x01) return ClientMessage{get_u32(bytes, 1), bytes.substr(5)};
  if (bytes[0] == 0x02) {
    ServiceRequest out;
    out.service = get_u32(bytes, 1);
    out.call = get_u32(bytes, 5);
    const std::size_t length = get_u32(bytes, 9);
    if (length > bytes.size() - 13) {
      throw ProtocolError("The service request's encoding is longer than the message.");
    }
    out.encoding = bytes.substr(13, length);
    out.payload = bytes.substr(13 + length);
    return out;
  }
  throw ProtocolError("This server does not know the binary opcode " +
                      std::to_string(static_cast<unsigned char>(bytes[0])) + ".");
}

std::string server_info(const std::string& session_id) {
  return dump_json({{"op", "serverInfo"},
                    {"name", "Tautline"},
                    {"capabilities",
                     {"clientPublish", "time", "parameters", "parametersSubscribe", "services"}},
                    {"supportedEncodings", {"json"}},
                    // Viewers show their goal tool only to a distribution they know.
                    {"metadata", {{"ROS_DISTRO", "humble"}}},
                    {"sessionId", session_id}});
}

std::string advertise(const std::vector<Channel>& channels) {
  json list = json::array();
  for (const Channel& c : channels) {
    list.push_back({{"id", c.id},
                    {"topic", c.topic},
                    {"encoding", c.encoding},
                    {"schemaName", c.schema_name},
                    {"schema", c.schema},
                    {"schemaEncoding", c.schema_encoding}});
  }
  return dump_json({{"op", "advertise"}, {"channels", std::move(list)}});
}

std::string advertise_services(const std::vector<Service>& services) {
  // Older viewers read requestSchema and responseSchema, newer ones request and response.
  const char* schema = R"({"type":"object"})";
  json list = json::array();
  for (const Service& s : services) {
    const auto side = [&](const char* suffix) {
      return json{{"encoding", "json"},
                  {"schemaName", s.type + suffix},
                  {"schemaEncoding", "jsonschema"},
                  {"schema", schema}};
    };
    list.push_back({{"id", s.id},
                    {"name", s.name},
                    {"type", s.type},
                    {"request", side("Request")},
                    {"response", side("Response")},
                    {"requestSchema", schema},
                    {"responseSchema", schema}});
  }
  return dump_json({{"op", "advertiseServices"}, {"services", std::move(list)}});
}

std::string status(StatusLevel level, const std::string& message) {
  return dump_json({{"op", "status"}, {"level", static_cast<int>(level)}, {"message", message}});
}

std::string parameter_values(const json& parameters, const std::optional<std::string>& id) {
  json out = {{"op", "parameterValues"}, {"parameters", parameters}};
  if (id) out["id"] = *id;
  return dump_json(out);
}

std::string service_failure(std::uint32_t service, std::uint32_t call, const std::string& message) {
  return dump_json({{"op", "serviceCallFailure"},
                    {"serviceId", service},
                    {"callId", call},
                    {"message", message}});
}

std::array<std::byte, 13> message_header(std::uint32_t subscription, std::uint64_t time_ns) {
  std::array<std::byte, 13> out{std::byte{0x01}};
  for (std::size_t i = 0; i < 4; ++i) out[1 + i] = static_cast<std::byte>(subscription >> (8 * i));
  for (std::size_t i = 0; i < 8; ++i) out[5 + i] = static_cast<std::byte>(time_ns >> (8 * i));
  return out;
}

std::string time_message(std::uint64_t time_ns) {
  std::string out(1, '\x02');
  put(out, time_ns);
  return out;
}

std::string service_response(std::uint32_t service, std::uint32_t call, std::string_view body) {
  std::string out(1, '\x03');
  put(out, service);
  put(out, call);
  put(out, std::uint32_t{4});
  out += "json";
  out += body;
  return out;
}

}  // namespace server::foxglove
