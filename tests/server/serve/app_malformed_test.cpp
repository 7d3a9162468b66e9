// tests/server/serve/app_malformed_test.cpp: bad requests and bad frames each get an answer, and
// other clients are not affected.
#include <string>
#include <vector>

#include "tests/server/serve/app_fixture.hpp"
#include "tests/server/serve/viewer.hpp"
#include <gtest/gtest.h>

namespace server {
namespace {

using net::test::Answer;

struct Bad {
  const char* method;
  std::string path;
  std::string body;
  int status;
  const char* word;  // part of the detail
};

TEST_F(AppTest, MalformedRequestsGetTheirStatusAndASentence) {
  ASSERT_EQ(post("/session/control", {{"action", "pause"}}), 200);
  const json pose = get("/session")["pose"];
  json on_robot = {{"type", "cylinder"}, {"radius", 0.2}, {"x", pose["x"]}, {"y", pose["y"]}};
  const std::vector<Bad> cases{
      {"PUT", "/session/goal", R"({"x":1,)", 400, "line 1"},
      {"PUT", "/session/goal", R"({"x":NaN,"y":0})", 400, "line 1"},
      {"PUT", "/session/goal", R"({"x":1e999,"y":0})", 400, "1e999"},
      {"PUT", "/session/goal", "[1,2]", 422, "object"},
      {"PUT", "/session/goal", R"({"x":"1","y":0})", 422, "x: must be a number"},
      {"PUT", "/session/goal", R"({"x":1,"y":0,"z":0})", 422, "unknown field 'z'"},
      {"PUT", "/session/goal", R"({"x":1e8,"y":0})", 422, "x: is 1e+08"},
      {"POST", "/session/requests", std::string(200'000, '['), 400, "nested deeper"},
      {"POST", "/session/requests", "\xff\xfe", 400, "line 1"},
      {"POST", "/session/requests", "", 400, "empty"},
      {"POST", "/session/requests", R"({"type":"fly"})", 422, "'fly' is unknown"},
      {"POST", "/session/requests", R"({"type":"clear_goal","x":1})", 422, "unknown field 'x'"},
      {"POST", "/session/requests", R"({"type":"remove_obstacle","id":99})", 409, "99"},
      {"POST", "/session/requests", R"({"type":"joystick","forward":9,"turn":0})", 422, "forward"},
      {"POST",
       "/session/requests",
       R"({"type":"joystick","forward":1,"turn":0,"mode":"wild"})",
       422,
       "known are guarded, wall, raw"},
      {"POST", "/session/obstacles", R"({"type":"cylinder","x":9,"y":9})", 422, "radius"},
      {"POST",
       "/session/obstacles",
       R"({"id":1,"type":"cylinder","x":9,"y":9,"radius":1})",
       409,
       "obstacle 1 already"},
      {"POST", "/session/obstacles", on_robot.dump(), 409, "overlap the robot"},
      {"PUT", "/session/obstacles/99", R"({"x":9,"y":9})", 409, "no obstacle 99"},
      {"PUT", "/session/obstacles/abc", R"({"x":9,"y":9})", 422, "'abc'"},
      {"DELETE", "/session/obstacles/4294967297", "", 422, "4294967297"},
      {"PATCH", "/session/parameters", R"({"k_r":5})", 422, "k_r must be"},
      {"PATCH", "/session/parameters", R"({"gravity":5})", 422, "gravity"},
      {"PATCH", "/session/parameters", R"({"strip_step":0.6,"k_r":0.5})", 422, "strip_step"},
      {"PATCH", "/session/parameters", "[]", 422, "object"},
      {"POST", "/session/control", R"({"action":"dance"})", 422, "'dance'"},
      {"POST", "/session/control", R"({"action":"stop","hard":true})", 422, "unknown field 'hard'"},
      {"POST", "/session/control", R"({"action":"reset","seed":3})", 422, "unknown field 'seed'"},
      {"POST", "/session/control", R"({"action":"speed","speed":-1})", 422, "speed"},
      {"POST", "/session/control", R"({"action":"step","ticks":1.5})", 422, "ticks"},
      {"POST", "/session/control", R"({"action":"load","scenario":"nowhere"})", 404, "nowhere"},
      {"POST",
       "/session/control",
       R"({"action":"load","scenario":"../../etc/passwd"})",
       404,
       "passwd"},
      {"POST", "/session/scenario", R"({"name":"../x"})", 422, "../x"},
      {"POST", "/session/scenario", R"({"name":"case1"})", 409, "case1"},
      {"POST", "/runs", R"({"scenario":"case1","repeats":0})", 422, "repeats"},
      {"POST", "/runs", R"({"scenario":"case1","repeats":10001})", 422, "repeats"},
      {"POST", "/runs", R"({"scenario":"case1","controller":"x"})", 422, "controller"},
      {"POST", "/runs", R"({"scenario":5})", 422, "scenario"},
      {"POST", "/runs", R"({"scenario":"case1","seed":-1})", 422, "seed"},
      {"POST", "/runs", R"({"scenario":"case1","seed":9007199254740992})", 422, "seed"},
      {"POST",
       "/runs",
       R"({"scenario":"case1","seed":9007199254740991,"repeats":3})",
       422,
       "repeats: the last run's seed: is 9007199254740993, must be at most 9007199254740991"},
      {"GET", "/runs?limit=0", "", 422, "limit"},
      {"GET", "/runs?limit=501", "", 422, "limit"},
      {"GET", "/runs?cursor=abc", "", 422, "cursor"},
      {"GET", "/runs?status=happy", "", 422, "'happy'"},
      {"GET", "/runs/12345", "", 404, "12345"},
      {"GET", "/runs/-1", "", 422, "'-1'"},
      {"GET", "/runs/1/ticks?from=x", "", 422, "from"},
      {"DELETE", "/runs/12345", "", 404, "12345"},
      {"POST", "/runs/12345/cancel", "", 404, "12345"},
      {"GET", "/nothing", "", 404, "/nothing"},
  };
  for (const Bad& bad : cases) {
    SCOPED_TRACE(std::string(bad.method) + " " + bad.path + " " + bad.body.substr(0, 60));
    expect_problem(ask(bad.method, bad.path, bad.body), bad.status, bad.word);
    EXPECT_EQ(ask("GET", "/healthz").status, 200);
  }
  EXPECT_EQ(get("/healthz")["status"], "ok");
}

TEST_F(AppTest, BadHeadsAreRefusedBeforeAnyHandlerSeesThem) {
  const std::string goal = R"({"x":1,"y":1})";
  expect_problem(ask("PUT", "/session/goal", goal, "Content-Type: text/plain\r\n"), 415, "json");
  expect_problem(ask("PUT", "/session/goal", goal, ""), 415, "json");
  const Answer method = ask("PATCH", "/session/goal", goal);
  expect_problem(method, 405, "PATCH");
  EXPECT_EQ(method.headers.at("Allow"), "PUT, POST, DELETE");
  expect_problem(ask("GET", "/healthz", "", "", "evil.example"), 421, "evil.example");
  expect_problem(ask("PUT",
                     "/session/goal",
                     goal,
                     "Content-Type: application/json\r\nOrigin: http://evil.example\r\n"),
                 403,
                 "evil.example");
  expect_problem(
      net::test::ask(port_,
                     "PUT /api/v1/session/goal HTTP/1.1\r\nHost: localhost\r\n"
                     "Content-Type: application/json\r\nContent-Length: 2000000\r\n\r\n"),
      413,
      "bytes");
  EXPECT_EQ(get("/session")["goal"]["x"], 3.5);
}

std::string u32(std::uint32_t value) {
  std::string out;
  for (unsigned shift = 0; shift < 32; shift += 8) {
    out.push_back(static_cast<char>(value >> shift & 0xFF));
  }
  return out;
}

TEST_F(AppTest, MalformedFramesAreAnsweredAndTheOthersGoOn) {
  Viewer healthy(port_);
  ASSERT_TRUE(healthy.channels.contains("/telemetry"));
  healthy.subscribe("/telemetry");
  ASSERT_TRUE(healthy.receives());

  Viewer bad(port_);
  bad.client.send_text(
      R"({"op":"advertise","channels":[{"id":1,"topic":"/goal_pose","encoding":"json",)"
      R"("schemaName":"geometry_msgs/PoseStamped"},{"id":2,"topic":"/edits","encoding":"json",)"
      R"("schemaName":"x"}]})");
  const auto call = [&](const std::string& service, const std::string& body) {
    return "\x02" + u32(bad.services.at(service)) + u32(5) + u32(4) + "json" + body;
  };
  const std::vector<std::pair<int, std::string>> frames{
      {1, "{"},
      {1, R"({"op":"dance"})"},
      {1, std::string(200'000, '[')},
      {1, R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":9999}]})"},
      {1, R"({"op":"subscribe","subscriptions":7})"},
      {1, R"({"op":"setParameters","parameters":[{"name":"k_r","value":99}]})"},
      {1, R"({"op":"setParameters","parameters":[{"name":"gravity","value":1}]})"},
      {2, "\x7f"},
      {2, "\x01" + u32(77) + "{}"},
      {2, "\x01" + u32(1) + R"({"pose":{"position":{"x":"far"}}})"},
      {2, "\x01" + u32(2) + R"({"type":"remove_obstacle","id":99})"},
      {2, "\x02" + u32(9999) + u32(5) + u32(4) + "json{}"},
      {2, "\x02" + u32(1) + u32(5) + u32(0xFFFFFFFF)},
      {2, call("/load", R"({"scenario":"nowhere"})")},
      {2, call("/speed", R"({"speed":"fast"})")},
      {2, call("/step", R"({"tick":10})")},
      {2, call("/reset", R"({"seed":10})")},
      {2, call("/clock", "[]")},
      {2, call("/request", "not json")},
  };
  for (const auto& [opcode, payload] : frames) {
    SCOPED_TRACE(payload.substr(0, 80));
    bad.client.send(opcode, payload);
    EXPECT_GT(bad.complaint().size(), 8u);
    EXPECT_TRUE(healthy.receives());
  }
}

TEST_F(AppTest, BrokenWebSocketFramesEndInACleanClose) {
  Viewer healthy(port_);
  healthy.subscribe("/telemetry");
  const std::vector<std::pair<std::string, int>> cases{
      {WsTestClient::encode(1, "\xff\xfe"), 1007},                            // not UTF-8
      {std::string("\x81\x02{}"), 1002},                                      // not masked
      {WsTestClient::encode(3, "x"), 1002},                                   // reserved opcode
      {std::string("\xC1\x80\x01\x02\x03\x04"), 1002},                        // reserved bit
      {std::string("\x82\xFF\0\0\0\0\x7F\0\0\0\x01\x02\x03\x04", 14), 1009},  // 2 GB announced
  };
  for (const auto& [bytes, code] : cases) {
    SCOPED_TRACE(code);
    Viewer bad(port_);
    bad.client.socket.send(bytes);
    EXPECT_EQ(bad.client.close_code(), code);
    EXPECT_TRUE(healthy.receives());
  }
}

TEST_F(AppTest, ABrokenConnectionDisturbsNoOther) {
  Viewer healthy(port_);
  healthy.subscribe("/telemetry");
  for (int i = 0; i < 10; ++i) {
    Viewer gone(port_);
    gone.subscribe("/state");
    gone.client.socket.close();
  }
  EXPECT_TRUE(healthy.receives());
  EXPECT_EQ(get("/healthz")["status"], "ok");
}

}  // namespace
}  // namespace server
