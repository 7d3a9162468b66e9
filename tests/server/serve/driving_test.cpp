// tests/server/serve/driving_test.cpp: one driver at a time, over REST and WebSocket, through the
// whole program.
#include "server/serve/driving.hpp"

#include <string>

#include "tests/server/serve/app_fixture.hpp"
#include "tests/server/serve/foxglove_hub_fixture.hpp"
#include "tests/server/serve/viewer.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace server {
namespace {

using testing::HasSubstr;

/// The program without a token: everybody is an admin.
class DrivingTest : public AppTest {
 protected:
  json driving() const { return get("/session").at("driving"); }
  /// The answer of `action`; `key`: of the lease that the script holds.
  net::test::Answer lease(const json& action, const std::string& key = "") const {
    return ask("POST", "/session/lease", action.dump(), headers(key));
  }
  net::test::Answer goal(const std::string& key = "") const {
    return ask("PUT", "/session/goal", R"({"x":1,"y":1})", headers(key));
  }
  net::test::Answer stick(const json& more, const std::string& key = "") const {
    json body = {{"type", "joystick"}, {"forward", 0.2}, {"turn", 0}};
    body.update(more);
    return ask("POST", "/session/requests", body.dump(), headers(key));
  }
  static std::string headers(const std::string& key) {
    return "Content-Type: application/json\r\n" +
           (key.empty() ? "" : "X-Tautline-Lease: " + key + "\r\n");
  }
  double now() const { return get("/session/clock").at("now"); }
};

/// A WebSocket client that calls services and publishes a Twist.
class Driver : public Viewer {
 public:
  using Viewer::Viewer;
  void call(const std::string& service, const json& body) {
    client.send_binary(foxglove::service_request(services.at(service), ++calls_, body.dump()));
  }
  /// The answer of the last call, or its failure's sentence.
  json answer() {
    for (int i = 0; i < 2000; ++i) {
      const net::test::Frame frame = client.read(2s);
      if (frame.opcode < 0 || frame.opcode == 8) return nullptr;
      if (frame.opcode == 1) {
        const json message = json::parse(frame.payload);
        if (message["op"] == "serviceCallFailure") return message["message"];
      }
      constexpr std::size_t kHeader = 17;  // opcode, service, call, length of "json", "json"
      if (frame.opcode == 2 && !frame.payload.empty() && frame.payload[0] == 3) {
        return json::parse(frame.payload.substr(kHeader));
      }
    }
    return nullptr;
  }
  json ask(const std::string& service, const json& body) {
    call(service, body);
    return answer();
  }
  void advertise_twist() {
    const json op = {{"op", "advertise"},
                     {"channels",
                      {{{"id", 9},
                        {"topic", "/cmd_vel"},
                        {"encoding", "json"},
                        {"schemaName", "geometry_msgs/Twist"}}}}};
    client.send_text(op.dump());
  }
  void publish(double v) {
    const json twist = {{"linear", {{"x", v}, {"y", 0}, {"z", 0}}},
                        {"angular", {{"x", 0}, {"y", 0}, {"z", 0}}}};
    client.send_binary(foxglove::client_message(9, twist.dump()));
  }

 private:
  std::uint32_t calls_ = 0;
};

TEST_F(DrivingTest, WithoutAHolderScriptsWorkAsBefore) {
  EXPECT_EQ(driving().at("driver"), nullptr);
  EXPECT_EQ(goal().status, 200);
  EXPECT_EQ(stick(json::object()).status, 200);
}

TEST_F(DrivingTest, OnlyTheKeyOfTheLeaseControls) {
  const net::test::Answer taken = lease({{"action", "take"}});
  ASSERT_EQ(taken.status, 200) << taken.body;
  const std::string key = json::parse(taken.body).at("key");
  expect_problem(goal(), 409, "has the controls");
  expect_problem(stick(json::object()), 409, "has the controls");
  expect_problem(ask("PATCH", "/session/parameters", R"({"k_r":0.5})"), 409, "has the controls");
  expect_problem(ask("POST", "/session/control", R"({"action":"reset"})"), 409, "controls");
  expect_problem(ask("PUT", "/session/start", R"({"x":0,"y":0})"), 409, "controls");
  EXPECT_EQ(goal(key).status, 200);
  EXPECT_EQ(stick(json::object(), key).status, 200);
  // WHEN anybody presses Stop THEN it holds.
  EXPECT_EQ(post("/session/control", {{"action", "stop"}}), 200);
  EXPECT_EQ(get("/session").at("stop"), true);
  EXPECT_EQ(lease({{"action", "release"}}, key).status, 200);
  EXPECT_EQ(driving().at("driver"), nullptr);
  EXPECT_EQ(goal().status, 200);
}

TEST_F(DrivingTest, MistakesAreNamed) {
  expect_problem(lease({{"action", "steal"}}), 422, "take, ask, give, release");
  expect_problem(lease({{"action", "release"}}), 409, "You do not have the controls");
  expect_problem(lease({{"action", "give"}, {"to", -1}}), 409, "You do not have the controls");
  expect_problem(lease({{"act", "take"}}), 422, "act");
  EXPECT_EQ(lease(json::object()).status, 200);
}

TEST_F(DrivingTest, APageHandsOverToOneThatAsksAndLosesThemWithItsLink) {
  Driver bob(port_);
  std::uint32_t bobs = 0;
  {
    Driver ann(port_);
    const json anns = ann.ask("/lease", {{"action", "take"}});
    ASSERT_TRUE(anns.is_object()) << anns;
    EXPECT_THAT(bob.ask("/lease", {{"action", "take"}}).dump(), HasSubstr("5 s"));
    const json asked = bob.ask("/lease", {{"action", "ask"}});
    ASSERT_TRUE(asked.is_object()) << asked;
    EXPECT_FALSE(asked.contains("key"));
    bobs = asked.at("you");
    EXPECT_EQ(ann.ask("/lease", json::object()).at("driving").at("asking").size(), 1U);
    EXPECT_THAT(bob.ask("/request", {{"type", "clear_goal"}}).dump(), HasSubstr("controls"));
    EXPECT_TRUE(ann.ask("/lease", {{"action", "give"}, {"to", bobs}}).is_object());
    EXPECT_TRUE(bob.ask("/request", {{"type", "clear_goal"}}).is_object());
    EXPECT_THAT(ann.ask("/pause", json::object()).dump(), HasSubstr("controls"));
    EXPECT_TRUE(ann.ask("/lease", {{"action", "take"}, {"force", true}}).is_object());
    EXPECT_THAT(bob.ask("/reset", json::object()).dump(), HasSubstr("controls"));
  }
  EXPECT_TRUE(net::test::eventually([&] { return driving().at("driver").is_null(); }));
}

TEST_F(DrivingTest, AStickThatIsLateOrUnreadableIsCountedAndNotObeyed) {
  const double at = now();
  EXPECT_EQ(stick({{"sent", at}, {"sequence", 1}}).status, 200);
  expect_problem(stick({{"sent", at - 2}, {"sequence", 2}}), 409, "old");
  expect_problem(stick({{"sent", at + 10}}), 409, "clock");
  expect_problem(stick({{"forward", nullptr}}), 422, "forward");
  expect_problem(stick({{"round_trip", 0.6}}), 409, "only Stop");
  EXPECT_EQ(stick({{"forward", 0}, {"round_trip", 0.6}}).status, 200);
  EXPECT_EQ(driving().at("dropped").at("late"), 2);
  EXPECT_EQ(driving().at("dropped").at("unreadable"), 1);
}

TEST_F(DrivingTest, ATwistTakesFreeControlsAfterTheMiddleAndTwoSecondsOfSilenceFreeThem) {
  Driver foxglove(port_);
  foxglove.advertise_twist();
  foxglove.publish(0.2);
  EXPECT_THAT(foxglove.complaint(), HasSubstr("middle"));
  EXPECT_TRUE(net::test::eventually([&] { return driving().at("driver").is_object(); }));
  foxglove.publish(0);
  for (int i = 0; i < 5; ++i) foxglove.publish(0.2);
  EXPECT_TRUE(net::test::eventually(
      [&] { return get("/session").at("command").at("v").get<double>() > 0; }));
  expect_problem(goal(), 409, "has the controls");
  EXPECT_TRUE(net::test::eventually([&] { return driving().at("driver").is_null(); }));
  EXPECT_EQ(get("/session").at("command").at("v"), 0);
}

TEST_F(DrivingTest, ATwistOfAnotherIsIgnoredWithAReasonAndStopsNobody) {
  const std::string key = json::parse(lease({{"action", "take"}}).body).at("key");
  Driver foxglove(port_);
  foxglove.advertise_twist();
  foxglove.publish(0);
  EXPECT_THAT(foxglove.complaint(), HasSubstr("has the controls"));
  EXPECT_EQ(stick(json::object(), key).status, 200);
}

TEST_F(DrivingTest, TheRecordSaysWhoGaveTheStick) {
  const net::test::Answer pushed = ask("POST",
                                       "/session/requests",
                                       R"({"type":"joystick","forward":0.5,"turn":0})",
                                       headers("") + "X-Tautline-Name: Ann\r\n");
  ASSERT_EQ(pushed.status, 200) << pushed.body;
  const std::string run = std::to_string(get("/session").at("run").at("id").get<int>());
  EXPECT_TRUE(net::test::eventually([&] {
    const net::test::Answer csv = ask("GET", "/runs/" + run + "/csv");
    return csv.body.find("Ann") != std::string::npos;
  }));
}

}  // namespace
}  // namespace server
