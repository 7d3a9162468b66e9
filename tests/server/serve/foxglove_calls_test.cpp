// tests/server/serve/foxglove_calls_test.cpp: parameters, services, roles and publishing of a
// hub.
#include <string>
#include <vector>

#include "tests/server/serve/foxglove_hub_fixture.hpp"
#include <gtest/gtest.h>

namespace server::foxglove {
namespace {

TEST_F(FoxgloveHub, ParametersAreReadWrittenAndWatched) {
  const auto setter = greeted(1);
  const auto watcher = greeted(2);
  const auto other = greeted(3);
  text(*watcher, {{"op", "subscribeParameterUpdates"}, {"parameterNames", json::array()}});
  text(*other, {{"op", "subscribeParameterUpdates"}, {"parameterNames", {"controller", "x"}}});

  text(*setter, {{"op", "getParameters"}, {"parameterNames", json::array()}, {"id", "all"}});
  ASSERT_EQ(1u, setter->texts.size());
  EXPECT_EQ(2u, setter->texts[0].at("parameters").size());
  EXPECT_EQ("all", setter->texts[0].at("id"));
  setter->texts.clear();

  text(*setter,
       {{"op", "setParameters"},
        {"parameters", json::array({{{"name", "k_r"}, {"value", 0.25}}})},
        {"id", "s"}});
  EXPECT_EQ(0.25, gains_.k_r);
  const json values = json::parse(R"([{"name":"k_r","value":0.25,"type":"float64"}])");
  ASSERT_EQ(1u, setter->texts.size());
  EXPECT_EQ(values, setter->texts[0].at("parameters"));
  EXPECT_EQ("s", setter->texts[0].at("id"));
  ASSERT_EQ(1u, watcher->texts.size());
  EXPECT_EQ(values, watcher->texts[0].at("parameters"));
  EXPECT_FALSE(watcher->texts[0].contains("id"));
  EXPECT_TRUE(other->texts.empty());

  text(*watcher, {{"op", "unsubscribeParameterUpdates"}, {"parameterNames", json::array()}});
  gains_.k_r = 0.5;
  hub_.parameters_changed();
  EXPECT_EQ(1u, watcher->texts.size());
  ASSERT_EQ(1u, other->texts.size());
  EXPECT_EQ("controller", other->texts[0].at("parameters").at(0).at("name"));
}

TEST_F(FoxgloveHub, ARefusedParameterIsASentenceAndTheOldValue) {
  const auto socket = greeted(1);
  const std::vector<std::pair<json, std::string>> cases{
      {{{"name", "k_r"}, {"value", 7}}, "k_r: must be from 0 to 1"},
      {{{"name", "k_r"}, {"value", "much"}}, "k_r: must be from 0 to 1"},
      {{{"name", "k_r"}}, "k_r: a parameter cannot be unset"},
      {{{"name", "nothing"}, {"value", 1}}, "nothing: is not a parameter"},
      {{{"name", "controller"}, {"value", "x"}}, "controller: is read only"}};
  for (const auto& [parameter, sentence] : cases) {
    text(*socket, {{"op", "setParameters"}, {"parameters", json::array({parameter})}});
    ASSERT_EQ(2u, socket->texts.size());
    EXPECT_EQ(sentence, socket->texts[0].at("message").get<std::string>());
    EXPECT_EQ(1, socket->texts[0].at("level"));
    EXPECT_EQ("parameterValues", socket->texts[1].at("op"));
    for (const json& value : socket->texts[1].at("parameters")) {
      EXPECT_TRUE(value.at("name") != "k_r" || value.at("value") == 0.6) << value;
    }
    socket->texts.clear();
  }
}

TEST_F(FoxgloveHub, ServicesAnswerNowOrLaterOrFailWithASentence) {
  const auto socket = greeted(1);
  endpoint_.on_binary(*socket, service_request(1, 8, R"({"value":21})"));
  ASSERT_EQ(1u, socket->binaries.size());
  EXPECT_EQ(service_response(1, 8, "json", R"({"ok":true,"value":42})"), socket->binaries[0]);

  endpoint_.on_binary(*socket, service_request(2, 9, ""));
  EXPECT_EQ(1u, socket->binaries.size());
  waiting_.at(0).success({{"ok", true}});
  waiting_.at(0).failure("only the first answer counts");
  waiting_.clear();
  EXPECT_EQ(2u, socket->binaries.size());
  EXPECT_TRUE(socket->texts.empty());

  const auto failure = [&](const std::string& request) -> std::string {
    socket->texts.clear();
    endpoint_.on_binary(*socket, request);
    if (socket->texts.size() != 1) return "";
    EXPECT_EQ("serviceCallFailure", socket->texts[0].at("op"));
    EXPECT_EQ(3, socket->texts[0].at("callId"));
    return socket->texts[0].at("message");
  };
  EXPECT_NE(std::string::npos, failure(service_request(77, 3, "{}")).find("no service with id 77"));
  EXPECT_NE(std::string::npos, failure(service_request(0, 3, "{}")).find("no service with id 0"));
  EXPECT_NE(std::string::npos, failure(service_request(1, 3, "{")).find("bad JSON"));
  EXPECT_NE("", failure(service_request(1, 3, "{}")));  // the handler misses 'value'
  std::string ros = service_response(1, 3, "ros1", "{}");
  ros[0] = 2;
  EXPECT_NE(std::string::npos, failure(ros).find("'ros1'"));

  socket->texts.clear();
  endpoint_.on_binary(*socket, service_request(2, 3, "{}"));
  waiting_.clear();
  ASSERT_EQ(1u, socket->texts.size());
  EXPECT_EQ("the service did not answer", socket->texts[0].at("message"));
}

TEST_F(FoxgloveHub, AViewerIsToldWhichRoleEachThingNeeds) {
  hub_.add_service(
      "/for_all",
      [](ClientId, const json&, const ServiceReply& reply) {
        reply.success({{"ok", true}});
      },
      net::Role::Viewer);
  const auto socket = viewer(1);
  const std::string sentence =
      "This needs the role operator; yours is viewer. Sign in with an operator's token.";
  endpoint_.on_binary(*socket, service_request(1, 3, R"({"value":21})"));
  ASSERT_EQ(1u, socket->texts.size());
  EXPECT_EQ(sentence, socket->texts[0].at("message").get<std::string>());
  EXPECT_TRUE(socket->binaries.empty());
  endpoint_.on_binary(*socket, service_request(3, 4, "{}"));
  EXPECT_EQ(1u, socket->binaries.size());

  socket->texts.clear();
  advertise_goal(*socket, 1, "/goal_pose");
  ASSERT_EQ(1u, socket->texts.size());
  EXPECT_EQ("advertise: " + sentence, socket->texts[0].at("message").get<std::string>());

  socket->texts.clear();
  const json parameter = {{"name", "k_r"}, {"value", 0.25}};
  text(*socket, {{"op", "setParameters"}, {"parameters", json::array({parameter})}});
  ASSERT_EQ(2u, socket->texts.size());
  EXPECT_EQ("k_r: " + sentence, socket->texts[0].at("message").get<std::string>());
  EXPECT_EQ(0.6, gains_.k_r);
}

TEST_F(FoxgloveHub, PublishedMessagesReachTheHandlerAndRefusalsComeBack) {
  const auto socket = greeted(4);
  advertise_goal(*socket, 1, "/goal_pose");
  EXPECT_TRUE(socket->texts.empty());
  endpoint_.on_binary(*socket, client_message(1, R"({"x":1})"));
  EXPECT_EQ(std::vector<std::string>{R"(4 {"x":1})"}, published_);
  EXPECT_TRUE(socket->texts.empty());
  endpoint_.on_binary(*socket, client_message(1, R"({"refuse":1})"));
  EXPECT_EQ("/goal_pose: the goal lies in an obstacle", status_of(*socket, 1));
  endpoint_.on_binary(*socket, client_message(1, "{"));
  EXPECT_NE(std::string::npos, status_of(*socket, 1).find("bad JSON"));
  hub_.warn(4, "found out later");
  EXPECT_EQ("found out later", status_of(*socket, 1));
  hub_.warn(5, "nobody");
}

TEST_F(FoxgloveHub, WrongAdvertisementsAreStatusMessages) {
  const auto socket = greeted(1);
  advertise_goal(*socket, 1, "/nowhere");
  EXPECT_NE(std::string::npos, status_of(*socket, 1).find("'/nowhere'; there are: /goal_pose"));
  text(*socket,
       {{"op", "advertise"},
        {"channels", json::array({{{"id", 1}, {"topic", "/goal_pose"}, {"encoding", "cdr"}}})}});
  EXPECT_NE(std::string::npos, status_of(*socket, 1).find("not 'cdr'"));
  advertise_goal(*socket, 1, "/goal_pose");
  advertise_goal(*socket, 1, "/goal_pose");
  EXPECT_NE(std::string::npos, status_of(*socket, 1).find("in use"));
  text(*socket, {{"op", "unadvertise"}, {"channelIds", {9}}});
  EXPECT_NE(std::string::npos, status_of(*socket, 1).find("no channel with id 9"));
  for (std::uint32_t id = 2; id <= 65; ++id) advertise_goal(*socket, id, "/goal_pose");
  EXPECT_NE(std::string::npos, status_of(*socket, 1).find("at most 64"));
}

TEST_F(FoxgloveHub, ReportsWhenAPublisherOrAClientIsGone) {
  const auto socket = greeted(3);
  advertise_goal(*socket, 1, "/goal_pose");
  advertise_goal(*socket, 2, "/goal_pose");
  text(*socket, {{"op", "unadvertise"}, {"channelIds", {1}}});
  EXPECT_EQ(std::vector<std::string>{"3 /goal_pose"}, gone_);
  endpoint_.on_close(*socket);
  EXPECT_EQ((std::vector<std::string>{"3 /goal_pose", "3 /goal_pose", "3"}), gone_);
  EXPECT_EQ(0u, hub_.clients());
}

}  // namespace
}  // namespace server::foxglove
