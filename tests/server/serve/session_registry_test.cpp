// tests/server/serve/session_registry_test.cpp: many sessions in one program: ids, limits, ends and
// isolation.
#include "server/serve/session_registry.hpp"

#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "tests/server/serve/app_fixture.hpp"
#include <gtest/gtest.h>

namespace server {
namespace {

using net::test::Answer;
using net::test::Client;
using net::test::eventually;

class SessionsTest : public AppTest {
 protected:
  SessionsTest() : SessionsTest(SessionRules{.sessions = 3, .runs = 3}) {}
  explicit SessionsTest(const SessionRules& rules) : AppTest(kinematic_case1(), "", rules) {}

  std::string open(const json& body = json::object()) const {
    const Answer answer = ask("POST", "/sessions", body.dump());
    EXPECT_EQ(answer.status, 201) << answer.body;
    const json made = json::parse(answer.body, nullptr, false);
    const std::string id = made.value("id", "");
    EXPECT_EQ(answer.headers.at("Location"), "/api/v1/sessions/" + id);
    return id;
  }
  static std::string at(const std::string& id, const std::string& path = "") {
    return "/sessions/" + id + path;
  }
  net::test::WsTestClient viewer(const std::string& query) const {
    return net::test::WsTestClient(port_, "foxglove.websocket.v1", 0, "/ws" + query);
  }
  /// The server's first message on the WebSocket: a text, or a close code and its reason.
  std::string first_words(const std::string& query) const {
    const net::test::Frame frame = viewer(query).read();
    if (frame.opcode != 8 || frame.payload.size() < 2) return frame.payload;
    const int code = static_cast<unsigned char>(frame.payload[0]) << 8 |
                     static_cast<unsigned char>(frame.payload[1]);
    return std::to_string(code) + ' ' + frame.payload.substr(2);
  }
};

TEST_F(SessionsTest, EachSessionHasAUniqueNonNumericId) {
  std::set<std::string> ids;
  for (int i = 0; i < 3; ++i) ids.insert(open());
  ASSERT_EQ(ids.size(), 3U);
  for (const std::string& id : ids) {
    EXPECT_EQ(id.size(), 32U);
    EXPECT_EQ(id.find_first_not_of("0123456789abcdef"), std::string::npos) << id;
    EXPECT_EQ(get(at(id)).at("scenario").at("name"), "case1");
  }
  EXPECT_EQ(get("/sessions").at("items").size(), 4U);
  EXPECT_EQ(get(at("main")).at("run"), get("/session").at("run"));
}

TEST_F(SessionsTest, SessionsAreLimitedAndAnEndedOneMakesRoom) {
  const std::string first = open();
  open();
  open();
  expect_problem(ask("POST", "/sessions", "{}"), 503, "as many as this server has room for");
  expect_problem(ask("POST", "/sessions"), 503, "as many as this server has room for");
  EXPECT_EQ(ask("DELETE", at(first)).status, 204);
  EXPECT_FALSE(open().empty());
}

TEST_F(SessionsTest, AMissingSessionIsASentence) {
  for (const std::string& id : {std::string("nothing"), std::string(32, '0')}) {
    expect_problem(ask("GET", at(id)), 404, "There is no such session");
    expect_problem(ask("POST", at(id, "/control"), R"({"action":"stop"})"), 404, "no such session");
    expect_problem(ask("DELETE", at(id)), 404, "There is no such session");
  }
  expect_problem(ask("DELETE", at("main")), 409, "as long as the server is");
  expect_problem(ask("POST", "/sessions", R"({"scenario":"nothing"})"), 404, "nothing");
  expect_problem(ask("POST", "/sessions", R"({"speed":1})"), 422, "speed");
  EXPECT_EQ(get("/sessions").at("count"), 0);
}

TEST_F(SessionsTest, ASessionCanEndWhileDrivingOrLoading) {
  for (int i = 0; i < 6; ++i) {
    const std::string id = open({{"scenario", "demo"}});
    ASSERT_EQ(ask("PUT", at(id, "/goal"), R"({"x":3,"y":1})").status, 200);
    const std::int64_t run = get(at(id)).at("run").at("id");
    Client loads(port_);  // its answer is not awaited
    if (i % 2 == 1) {
      loads.send(net::test::post_request("/api/v1" + at(id, "/control"), R"({"action":"reset"})"));
    }
    EXPECT_EQ(ask("DELETE", at(id)).status, 204);
    expect_problem(ask("GET", at(id)), 404, "");
    EXPECT_TRUE(comes_to(run, "finished"));
  }
}

TEST_F(SessionsTest, RunsOfASessionAreLimitedAndThoseOfMainAreNot) {
  const std::string id = open();  // its first
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(ask("POST", at(id, "/control"), R"({"action":"reset"})").status, 200);
  }
  expect_problem(ask("POST", at(id, "/control"), R"({"action":"reset"})"), 409, "had its 3 runs");
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(ask("POST", "/session/control", R"({"action":"reset"})").status, 200);
  }
}

TEST_F(SessionsTest, TheSocketShowsTheSessionItNames) {
  const std::string id = open({{"seed", 77}});
  EXPECT_NE(first_words("").find("serverInfo"), std::string::npos);
  EXPECT_NE(first_words("?session=" + id).find("serverInfo"), std::string::npos);
  EXPECT_NE(first_words("?session=main").find("serverInfo"), std::string::npos);
  EXPECT_NE(first_words("?session=nothing").find("4404 There is no such session"),
            std::string::npos);
}

class PerVisitorTest : public SessionsTest {
 protected:
  PerVisitorTest()
      : SessionsTest({.sessions = 8, .idle = std::chrono::seconds(1), .per_visitor = true}) {}
};

TEST_F(PerVisitorTest, IdsAreUniqueAndTheSocketNeedsOne) {
  const std::string id = open();
  const json list = get("/sessions");
  EXPECT_EQ(list.at("count"), 1);
  EXPECT_EQ(list.at("items").size(), 1U);
  EXPECT_EQ(list.dump().find(id), std::string::npos);
  EXPECT_NE(first_words("").find("4404 Here each visitor has a session"), std::string::npos);
  EXPECT_NE(first_words("?session=main").find("serverInfo"), std::string::npos);
}

TEST_F(PerVisitorTest, AnUnusedSessionEndsAndAUsedOneStays) {
  const std::string left = open();
  const std::string asked = open();
  const std::string watched = open();
  const net::test::WsTestClient looks_on = viewer("?session=" + watched);
  EXPECT_TRUE(eventually([&] {
    EXPECT_EQ(ask("GET", at(asked)).status, 200);
    return get("/sessions").at("count") == 2;
  }));
  EXPECT_EQ(ask("GET", at(left)).status, 404);
  EXPECT_EQ(ask("GET", at(watched)).status, 200);
}

/// Edits, stops, resets and ends two sessions at random: the state of each depends only on its own
/// requests.
TEST_F(SessionsTest, NoneEverSeesAnothersState) {
  struct Known {
    std::string id{};
    std::set<std::uint32_t> obstacles{};
    bool stop = false;
    double k_r = 0;
    double goal_y = -1;  // none
    double mark = 0;     // y of all its goals and obstacles lies in [mark, mark + 1)
  };
  const auto number_of = [](const json& o) { return o.at("id").get<std::uint32_t>(); };
  std::mt19937 random(20261124);
  const auto number = [&](double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(random);
  };
  const auto anew = [&](double mark) {
    Known made{.id = open({{"seed", static_cast<int>(mark)}}), .mark = mark};
    const json state = get(at(made.id));
    for (const json& o : state.at("obstacles")) made.obstacles.insert(number_of(o));
    made.k_r = state.at("parameters").at("k_r");
    if (!state.at("goal").is_null()) made.goal_y = state.at("goal").at("y");
    return made;
  };
  const auto check = [&](const Known& known) {
    const json state = get(at(known.id));
    std::set<std::uint32_t> obstacles;
    for (const json& o : state.at("obstacles")) obstacles.insert(number_of(o));
    EXPECT_EQ(obstacles, known.obstacles);
    EXPECT_EQ(state.at("stop"), known.stop);
    EXPECT_EQ(state.at("seed"), known.mark);
    EXPECT_NEAR(state.at("parameters").at("k_r").get<double>(), known.k_r, 1e-12);
    const double goal_y = state.at("goal").is_null() ? -1 : state.at("goal").at("y").get<double>();
    EXPECT_NEAR(goal_y, known.goal_y, 1e-12);
  };
  std::vector<Known> sessions{anew(20), anew(30)};
  const json before = get("/session");
  const char* const longer = std::getenv("TAUTLINE_ISOLATION_SECONDS");  // by hand: 600
  const auto end = std::chrono::steady_clock::now() +
                   std::chrono::seconds(longer == nullptr ? 4 : std::atoi(longer));
  int acts = 0;
  while (std::chrono::steady_clock::now() < end && !HasFailure()) {
    Known& one = sessions[random() % 2];
    const double y = one.mark + number(0, 1);
    switch (random() % 8) {
      case 0: {
        const json body{{"type", "cylinder"}, {"x", number(10, 20)}, {"y", y}, {"radius", 0.1}};
        const Answer answer = ask("POST", at(one.id, "/obstacles"), body.dump());
        if (answer.status == 201) one.obstacles.insert(number_of(json::parse(answer.body)));
        break;
      }
      case 1:
        if (!one.obstacles.empty()) {
          const std::uint32_t id = *one.obstacles.rbegin();
          EXPECT_EQ(ask("DELETE", at(one.id, "/obstacles/" + std::to_string(id))).status, 200);
          one.obstacles.erase(id);
        }
        break;
      case 2:
        one.stop = random() % 2 == 0;
        EXPECT_EQ(ask("POST",
                      at(one.id, "/control"),
                      json({{"action", one.stop ? "stop" : "release"}}).dump())
                      .status,
                  200);
        break;
      case 3:
        one.k_r = number(0.4, 0.6);
        EXPECT_EQ(ask("PATCH", at(one.id, "/parameters"), json({{"k_r", one.k_r}}).dump()).status,
                  200);
        break;
      case 4:
        one.goal_y = y;
        EXPECT_EQ(ask("PUT", at(one.id, "/goal"), json({{"x", 30}, {"y", y}}).dump()).status, 200);
        break;
      case 5:
        EXPECT_EQ(ask("DELETE", at(one.id, "/goal")).status, 200);
        one.goal_y = -1;
        break;
      case 6:
        if (random() % 4 == 0) {
          EXPECT_EQ(ask("DELETE", at(one.id)).status, 204);
          one = anew(one.mark);
        }
        break;
      default:
        break;
    }
    for (const Known& known : sessions) check(known);
    ++acts;
  }
  EXPECT_GT(acts, 5);
  const json after = get("/session");
  for (const char* key : {"obstacles", "stop", "parameters", "goal", "seed"}) {
    EXPECT_EQ(before.at(key), after.at(key)) << key;
  }
  EXPECT_EQ(before.at("run").at("id"), after.at("run").at("id"));  // it may have come to its end
}

}  // namespace
}  // namespace server
