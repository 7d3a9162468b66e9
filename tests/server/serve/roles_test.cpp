// tests/server/serve/roles_test.cpp: what viewers, operators and admins may do over REST and
// WebSocket, and that others read who did it.
#include <string>

#include "tests/server/serve/app_fixture.hpp"
#include "tests/server/serve/viewer.hpp"
#include <gtest/gtest.h>

#include "server/serve/foxglove/protocol.hpp"
#include "server/serve/net/visitor.hpp"

namespace server {
namespace {

const std::string kAdmin = "the-token-of-the-admins-01";
const std::string kOperator = "the-token-of-operators-012";
const std::string kViewer = "the-token-of-the-viewers-0";

net::AccessOptions tokens() {
  return {.token = kAdmin, .operator_token = kOperator, .viewer_token = kViewer};
}

/// The whole program with a token for each role.
class RolesTest : public AppTest {
 protected:
  RolesTest() : AppTest(kinematic_case1(), tokens()) {}

  net::test::Answer as(const std::string& token,
                       std::string_view method,
                       std::string_view path,
                       const json& body = nullptr,
                       const std::string& more = "") const {
    std::string headers = "Authorization: Bearer " + token + "\r\n" + more;
    if (!body.is_null()) headers += "Content-Type: application/json\r\n";
    return ask(method, path, body.is_null() ? "" : body.dump(), headers);
  }
  json seen(std::string_view path, const std::string& token) const {
    return json::parse(as(token, "GET", path).body);
  }
  json session() const { return seen("/session", kViewer); }
};

TEST_F(RolesTest, AViewerReadsAndChangesNothing) {
  for (const char* path : {"/session", "/runs", "/scenarios", "/sessions", "/catalog", "/system"}) {
    EXPECT_EQ(as(kViewer, "GET", path).status, 200) << path;
  }
  const json goal = {{"x", 1}, {"y", 1}};
  const json scenario = {{"scenario", "case1"}};
  for (const auto& [method, path, body] :
       {std::tuple{"PUT", "/session/goal", goal},
        {"DELETE", "/session/goal", json()},
        {"POST", "/session/control", json{{"action", "pause"}}},
        {"POST", "/session/control", json{{"action", "release"}}},
        {"POST", "/session/requests", json{{"type", "stop"}, {"engaged", false}}},
        {"POST", "/session/requests", json{{"type", "clear_goal"}}},
        {"PATCH", "/session/parameters", json{{"k_r", 0.5}}},
        {"POST", "/session/watch", json()},
        {"POST", "/session/published", json{{"inclinometer", {{"roll", 0}, {"pitch", 0}}}}},
        {"POST", "/runs", scenario},
        {"POST", "/sessions", scenario},
        {"GET", "/view_link", json()},
        {"DELETE", "/runs/1", json()}}) {
    expect_problem(as(kViewer, method, path, body), 403, "yours is viewer");
  }
  EXPECT_EQ(session().at("pace").at("paused"), false);
}

TEST_F(RolesTest, EverybodyWhoSeesTheRobotMayStopItAndOperatorsReleaseIt) {
  const std::string ann = "X-Tautline-Name: Ann%20%C3%96\r\n";
  EXPECT_EQ(as(kViewer, "POST", "/session/control", {{"action", "stop"}}, ann).status, 200);
  EXPECT_EQ(session().at("stop"), true);
  EXPECT_EQ(session().at("by").at("stop"), "Ann Ö");
  // Another Stop changes nothing, so the first one keeps the credit.
  EXPECT_EQ(as(kOperator, "POST", "/session/control", {{"action", "stop"}}).status, 200);
  EXPECT_EQ(session().at("by").at("stop"), "Ann Ö");
  EXPECT_EQ(as(kOperator, "POST", "/session/control", {{"action", "release"}}).status, 200);
  EXPECT_EQ(session().at("by").at("stop"), nullptr);
}

TEST_F(RolesTest, AnOperatorDrivesAndAnAdminDeletes) {
  EXPECT_EQ(as(kOperator, "PUT", "/session/goal", {{"x", 1}, {"y", 1}}).status, 200);
  EXPECT_EQ(session().at("by").at("goal"), "127.0.0.1");
  EXPECT_EQ(as(kOperator, "POST", "/session/control", {{"action", "pause"}}).status, 200);
  EXPECT_EQ(session().at("by").at("pause"), "127.0.0.1");
  EXPECT_EQ(as(kOperator, "POST", "/session/scenario", {{"name", "mine"}}).status, 201);
  expect_problem(as(kOperator, "DELETE", "/scenarios/mine"), 403, "needs the role admin");
  EXPECT_EQ(as(kAdmin, "DELETE", "/scenarios/mine").status, 204);
  const json document = {{"name", "short"},
                         {"scenarios", {{{"name", "near"}, {"goal", {{"x", 1}, {"y", 0}}}}}},
                         {"controllers", {"go_to_goal"}},
                         {"physics", "kinematic"}};
  const auto posted = as(kOperator, "POST", "/experiments", document);
  ASSERT_LT(posted.status, 300) << posted.body;
  const std::string experiment =
      "/experiments/" + json::parse(posted.body).at("id").get<std::string>();
  expect_problem(as(kOperator, "DELETE", experiment), 403, "needs the role admin");
  EXPECT_EQ(as(kAdmin, "DELETE", experiment).status, 204);
}

TEST_F(RolesTest, EachRoleReadsItsShareOfTheSystem) {
  EXPECT_EQ(seen("/me", kViewer).at("role"), "viewer");
  EXPECT_EQ(seen("/me", kAdmin).at("role"), "admin");
  const json viewer = seen("/system", kViewer);
  EXPECT_EQ(viewer.at("clients"), nullptr);
  EXPECT_EQ(viewer.at("log"), nullptr);
  EXPECT_GT(viewer.at("limits").at("connections").at("most"), 0);
  const json oper = seen("/system", kOperator);
  EXPECT_EQ(oper.at("clients"), nullptr);
  EXPECT_TRUE(oper.at("log").is_array());
  EXPECT_TRUE(seen("/system", kAdmin).at("clients").is_array());
}

TEST_F(RolesTest, AViewOnlyLinkMakesAViewerAndNoMore) {
  const std::string token = seen("/view_link", kOperator).at("token");
  EXPECT_EQ(token, kViewer);
  const auto login = ask("POST", "/login", json({{"token", token}}).dump());
  ASSERT_EQ(login.status, 204);
  const std::string cookie = login.headers.at("Set-Cookie");
  const std::string header = "Cookie: " + cookie.substr(0, cookie.find(';')) + "\r\n";
  EXPECT_EQ(json::parse(ask("GET", "/me", "", header).body).at("role"), "viewer");
  expect_problem(ask("DELETE", "/session/goal", "", header), 403, "needs the role operator");
}

TEST(ViewOnlyLink, WithoutATokenForViewersOneIsMadeAtTheStart) {
  EXPECT_EQ(net::Access({.token = kAdmin}).viewer_token().size(), 32U);
  EXPECT_EQ(net::Access({}).viewer_token(), "");
}

TEST(Tokens, EachRoleHasItsOwnAndAdminsHaveOne) {
  EXPECT_THROW(net::Access({.viewer_token = kViewer}), std::invalid_argument);
  EXPECT_THROW(net::Access({.token = kAdmin, .operator_token = kAdmin}), std::invalid_argument);
  EXPECT_THROW(net::Access({.token = kAdmin, .operator_token = kViewer, .viewer_token = kViewer}),
               std::invalid_argument);
  EXPECT_THROW(net::Access({.token = kAdmin, .viewer_token = "short"}), std::invalid_argument);
  EXPECT_NO_THROW(net::Access{tokens()});
}

TEST(CleanName, HidesNothingAndStaysShort) {
  EXPECT_EQ(net::clean_name("  Ann B.  "), "Ann B.");
  EXPECT_EQ(net::clean_name("Ångström"), "Ångström");
  EXPECT_EQ(net::clean_name("a\tb\r\nc\x7f"), "abc");
  EXPECT_EQ(net::clean_name("a\u202Ebc\u200B\uFEFF"), "abc");  // turns text round, no width
  EXPECT_EQ(net::clean_name("\xff"), "");
  EXPECT_EQ(net::clean_name(std::string(500, 'x')).size(), 32U);
  EXPECT_EQ(net::clean_name(""), "");
}

}  // namespace
}  // namespace server
