// tests/server/serve/foxglove_protocol_test.cpp: the codec: vectors, every op, and malformed input.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "server/serve/foxglove/protocol.hpp"
#include "server/serve/foxglove/schemas.hpp"

namespace server::foxglove {
namespace {

using nlohmann::json;

template <std::size_t N>
std::string hex(const std::array<std::byte, N>& bytes) {
  std::string out;
  for (const std::byte b : bytes) {
    constexpr std::string_view kDigits = "0123456789abcdef";
    out.push_back(kDigits[std::to_integer<unsigned>(b) >> 4]);
    out.push_back(kDigits[std::to_integer<unsigned>(b) & 15]);
  }
  return out;
}

std::string text_error(const std::string& text) {
  try {
    parse_text(text);
  } catch (const ProtocolError& error) {
    return error.what();
  }
  return "";
}

std::string binary_error(std::string_view bytes) {
  try {
    parse_binary(bytes);
  } catch (const ProtocolError& error) {
    return error.what();
  }
  return "";
}

TEST(FoxgloveProtocol, MessageHeaderMatchesThePublishedVector) {
  // 1234567890123456789 = 0x112210f47de98115, little-endian 1581e97df4102211.
  EXPECT_EQ("01070000001581e97df4102211", hex(message_header(7, 1234567890123456789)));
}

TEST(FoxgloveProtocol, TimeIsOpcodeTwoAndNanoseconds) {
  EXPECT_EQ("020200000000000000", hex(time_message(2)));
  EXPECT_EQ("02ffffffffffffffff", hex(time_message(~std::uint64_t{0})));
}

TEST(FoxgloveProtocol, ServiceResponseCarriesIdsEncodingAndPayload) {
  EXPECT_EQ(std::string("\x03\x05\0\0\0\x09\x01\0\0\x04\0\0\0json{}", 19),
            service_response(5, 0x109, "json", "{}"));
}

TEST(FoxgloveProtocol, ReadsSubscriptions) {
  const auto op = std::get<Subscribe>(
      parse_text(R"({"op":"subscribe","subscriptions":[{"id":0,"channelId":3},{"id":4294967295,
                     "channelId":1}]})"));
  ASSERT_EQ(2u, op.subscriptions.size());
  EXPECT_EQ(3u, op.subscriptions[0].channel_id);
  EXPECT_EQ(4294967295u, op.subscriptions[1].id);
  EXPECT_EQ(std::vector<std::uint32_t>{7},
            std::get<Unsubscribe>(parse_text(R"({"op":"unsubscribe","subscriptionIds":[7]})"))
                .subscription_ids);
}

TEST(FoxgloveProtocol, ReadsClientChannels) {
  const auto op = std::get<ClientAdvertise>(parse_text(
      R"({"op":"advertise","channels":[{"id":1,"topic":"/cmd_vel","encoding":"json",
          "schemaName":"geometry_msgs/Twist","schema":"..","schemaEncoding":"jsonschema"}]})"));
  ASSERT_EQ(1u, op.channels.size());
  EXPECT_EQ("/cmd_vel", op.channels[0].topic);
  EXPECT_EQ("geometry_msgs/Twist", op.channels[0].schema_name);
  EXPECT_EQ(std::vector<std::uint32_t>{1},
            std::get<ClientUnadvertise>(parse_text(R"({"op":"unadvertise","channelIds":[1]})"))
                .channel_ids);
}

TEST(FoxgloveProtocol, ReadsParameterOps) {
  const auto get = std::get<GetParameters>(
      parse_text(R"({"op":"getParameters","parameterNames":[],"id":"get-all-params"})"));
  EXPECT_TRUE(get.names.empty());
  EXPECT_EQ("get-all-params", get.id);
  const auto set = std::get<SetParameters>(parse_text(
      R"({"op":"setParameters","parameters":[{"name":"k_r","value":0.5,"type":"float64"},
          {"name":"k_c"}]})"));
  ASSERT_EQ(2u, set.parameters.size());
  EXPECT_EQ(0.5, set.parameters[0].value);
  EXPECT_TRUE(set.parameters[1].value.is_null());
  EXPECT_FALSE(set.id);
  EXPECT_EQ(std::vector<std::string>{"a"},
            std::get<SubscribeParameterUpdates>(
                parse_text(R"({"op":"subscribeParameterUpdates","parameterNames":["a"]})"))
                .names);
  EXPECT_TRUE(std::holds_alternative<UnsubscribeParameterUpdates>(
      parse_text(R"({"op":"unsubscribeParameterUpdates","parameterNames":[]})")));
}

TEST(FoxgloveProtocol, MalformedTextIsASentence) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"", "bad JSON"},
      {"nonsense", "bad JSON"},
      {"[]", "must be an object"},
      {"{}", "lacks 'op'"},
      {R"({"op":1})", "must be a text"},
      {R"({"op":"dance"})", "'dance' is unknown"},
      {R"({"op":"fetchAsset"})", "capabilities"},
      {R"({"op":"subscribeConnectionGraph"})", "capabilities"},
      {R"({"op":"subscribe"})", "lacks 'subscriptions'"},
      {R"({"op":"subscribe","subscriptions":{}})", "must be a list"},
      {R"({"op":"subscribe","subscriptions":[1]})", "must be an object"},
      {R"({"op":"subscribe","subscriptions":[{"id":1}]})", "lacks 'channelId'"},
      {R"({"op":"subscribe","subscriptions":[{"id":-1,"channelId":1}]})", "integer from 0"},
      {R"({"op":"subscribe","subscriptions":[{"id":1.5,"channelId":1}]})", "integer from 0"},
      {R"({"op":"subscribe","subscriptions":[{"id":4294967296,"channelId":1}]})", "integer from 0"},
      {R"({"op":"unsubscribe","subscriptionIds":["x"]})", "integer from 0"},
      {R"({"op":"advertise","channels":[{"id":1}]})", "lacks 'topic'"},
      {R"({"op":"advertise","channels":[{"id":1,"topic":2,"encoding":"json"}]})", "'topic' must"},
      {R"({"op":"getParameters","parameterNames":[1]})", "must be a text"},
      {R"({"op":"getParameters","parameterNames":[],"id":7})", "'id' must be a text"},
      {R"({"op":"setParameters","parameters":[{"value":1}]})", "lacks 'name'"},
      {R"({"op":"setParameters","parameters":"x"})", "must be a list"},
      {std::string(100'000, '['), "deeper than 64"}};
  for (const auto& [text, part] : cases) {
    EXPECT_NE(std::string::npos, text_error(text).find(part)) << text_error(text);
  }
}

TEST(FoxgloveProtocol, ReadsBinaryMessages) {
  const auto message =
      std::get<ClientMessage>(parse_binary(std::string_view("\x01\x02\x01\0\0{}", 7)));
  EXPECT_EQ(0x102u, message.channel_id);
  EXPECT_EQ("{}", message.payload);
  const auto call = std::get<ServiceRequest>(
      parse_binary(std::string_view("\x02\x01\0\0\0\x02\0\0\0\x04\0\0\0json[]", 19)));
  EXPECT_EQ(1u, call.service_id);
  EXPECT_EQ(2u, call.call_id);
  EXPECT_EQ("json", call.encoding);
  EXPECT_EQ("[]", call.payload);
}

TEST(FoxgloveProtocol, ABinaryMessageCutAnywhereInItsHeadIsASentence) {
  const std::string_view call("\x02\x01\0\0\0\x02\0\0\0\x04\0\0\0json", 17);
  for (std::size_t size = 0; size < call.size(); ++size) {
    EXPECT_NE("", binary_error(call.substr(0, size))) << size;
  }
  EXPECT_EQ("", binary_error(call));
  for (std::size_t size = 1; size < 5; ++size) {
    EXPECT_NE("", binary_error(std::string_view("\x01\0\0\0\0", size))) << size;
  }
  EXPECT_NE(std::string::npos,
            binary_error(std::string_view("\x02\x01\0\0\0\x02\0\0\0\xff\xff\xff\xffjson", 17))
                .find("4294967295 bytes"));
  EXPECT_NE(std::string::npos, binary_error("\x7f").find("opcode 127"));
}

TEST(FoxgloveProtocol, ServerInfoHasWhatViewersLookFor) {
  const json info = json::parse(server_info("s1"));
  EXPECT_EQ("serverInfo", info.at("op"));
  EXPECT_EQ("s1", info.at("sessionId"));
  EXPECT_EQ(json::parse(R"(["json"])"), info.at("supportedEncodings"));
  EXPECT_EQ(
      json::parse(R"(["clientPublish","time","parameters","parametersSubscribe","services"])"),
      info.at("capabilities"));
  EXPECT_EQ("humble", info.at("metadata").at("ROS_DISTRO"));
}

TEST(FoxgloveProtocol, BuildsTheOtherTexts) {
  const std::vector<Channel> channels{
      {3, "/scan", "json", "foxglove.LaserScan", "{}", "jsonschema"}};
  EXPECT_EQ(json::parse(R"({"op":"advertise","channels":[{"id":3,"topic":"/scan","encoding":"json",
                "schemaName":"foxglove.LaserScan","schema":"{}","schemaEncoding":"jsonschema"}]})"),
            json::parse(advertise(channels)));
  EXPECT_EQ(json::parse(R"({"op":"status","level":1,"message":"m"})"),
            json::parse(status(StatusLevel::Warning, "m")));
  EXPECT_EQ(json::parse(R"({"op":"parameterValues","id":"q","parameters":[
                {"name":"k_r","value":0.6,"type":"float64"},{"name":"none"}]})"),
            json::parse(parameter_values(
                std::vector<Parameter>{{"k_r", 0.6, "float64"}, {"none", nullptr, ""}}, "q")));
  EXPECT_EQ(json::parse(R"({"op":"serviceCallFailure","serviceId":1,"callId":2,"message":"m"})"),
            json::parse(service_call_failure(1, 2, "m")));
}

TEST(FoxgloveProtocol, AdvertisesServicesInBothForms) {
  const std::vector<Service> services{{1, "/reset", "tautline.reset", "{}", "{\"a\":1}"}};
  const json service = json::parse(advertise_services(services)).at("services").at(0);
  EXPECT_EQ("/reset", service.at("name"));
  EXPECT_EQ("json", service.at("request").at("encoding"));
  EXPECT_EQ("jsonschema", service.at("request").at("schemaEncoding"));
  EXPECT_EQ("{\"a\":1}", service.at("response").at("schema"));
  EXPECT_EQ("{\"a\":1}", service.at("responseSchema"));
}

TEST(FoxgloveSchemas, EveryAdvertisedSchemaIsThere) {
  for (const char* name : {"LaserScan",
                           "FrameTransforms",
                           "Odometry",
                           "SceneUpdate",
                           "PoseInFrame",
                           "PosesInFrame",
                           "Log"}) {
    const Schema& found = schema(std::string("foxglove.") + name);
    EXPECT_EQ("jsonschema", found.encoding);
    const json text = json::parse(found.text);
    EXPECT_EQ("object", text.at("type"));
    EXPECT_EQ(std::string("foxglove.") + name, text.at("title").get<std::string>());
  }
  const json state = json::parse(schema("tautline.State").text);
  EXPECT_EQ("object", state.at("type"));
  EXPECT_TRUE(state.at("properties").contains("obstacles"));
  EXPECT_THROW(schema("foxglove.Nothing"), std::out_of_range);
}

TEST(FoxgloveSchemas, TheTelemetrySchemaIsABinaryFlatbuffersSchema) {
  const Schema& found = schema("tautline.wire.Frame");
  EXPECT_EQ("flatbuffer", found.encoding);
  // Bytes 4 to 7 of a .bfbs are "BFBS". Base64 characters 8 to 11 stand for bytes 6 to 8:
  // 'B' = 0x42, 'S' = 0x53 are the bits 010000 100101 0011.., so "Ql" whatever follows.
  EXPECT_EQ("Ql", found.text.substr(8, 2));
  EXPECT_EQ(std::string_view::npos,
            found.text.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz"
                                         "0123456789+/="));
}

}  // namespace
}  // namespace server::foxglove
