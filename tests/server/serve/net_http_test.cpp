// tests/server/serve/net_http_test.cpp: plain HTTP values, routing, and untrusted JSON.
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "server/run/json_limits.hpp"
#include "server/serve/net/compression.hpp"
#include "server/serve/net/http.hpp"
#include "server/serve/net/router.hpp"

namespace server::net {
namespace {

TEST(NetHttp, DecodesPathAndQueryOnce) {
  Request request;
  EXPECT_FALSE(parse_target("/a%20b/%252e+c?x=1+2&y=%26&empty=&flag&x=3", request));
  EXPECT_EQ("/a b/%2e+c", request.path);
  const std::map<std::string, std::string> query{
      {"x", "3"}, {"y", "&"}, {"empty", ""}, {"flag", ""}};
  EXPECT_EQ(query, request.query);
}

TEST(NetHttp, SplitsCommaListsOverSeveralHeaders) {
  Request request;
  request.headers = {{"Sec-WebSocket-Protocol", " c ,\tb "}, {"sec-websocket-protocol", "a"}};
  EXPECT_EQ((std::vector<std::string_view>{"c", "b", "a"}),
            request.elements("Sec-WebSocket-Protocol"));
}

TEST(NetHttp, RefusesBrokenTargets) {
  for (const char* target : {"",
                             "x",
                             "*",
                             "http://h/",
                             "/%",
                             "/%4",
                             "/%g0",
                             "/%00",
                             "/?%00",
                             "/%ff",
                             "/%c0%af",
                             "/%ed%a0%80"}) {
    Request request;
    EXPECT_TRUE(parse_target(target, request)) << target;
  }
}

TEST(NetHttp, KnowsWellFormedUtf8) {
  for (const char* text : {"",
                           "abc",
                           "\xc3\xa9",
                           "\xe2\x82\xac",
                           "\xf0\x9f\xa4\x96",
                           "\xed\x9f\xbf",
                           "\xf4\x8f\xbf\xbf"}) {
    EXPECT_TRUE(valid_utf8(text)) << text;
  }
  // Lone continuation, overlong '/' in two and three bytes, surrogate, beyond U+10FFFF, cut short.
  for (const char* text : {"\x80",
                           "\xc0\xaf",
                           "\xe0\x80\xaf",
                           "\xf0\x80\x80\xaf",
                           "\xed\xa0\x80",
                           "\xf4\x90\x80\x80",
                           "\xf5\x80\x80\x80",
                           "\xe2\x82",
                           "\xff"}) {
    EXPECT_FALSE(valid_utf8(text)) << text;
  }
}

TEST(NetHttp, FindsHeadersAndCookies) {
  Request request;
  request.headers = {{"Content-Type", "text/plain"}, {"COOKIE", "a=1; bb=2;c="}};
  EXPECT_EQ("text/plain", request.header("content-type"));
  EXPECT_EQ("", request.header("Content"));
  EXPECT_EQ("1", request.cookie("a"));
  EXPECT_EQ("2", request.cookie("bb"));
  EXPECT_EQ("", request.cookie("b"));
  EXPECT_EQ("", request.cookie("c"));
}

TEST(NetHttp, AHeaderValueCannotAddAHeader) {
  Response response;
  response.headers = {{"Location", "/x\r\nSet-Cookie: a=b"}};
  const std::string head = response_head(response, 0, true);
  EXPECT_EQ(std::string::npos, head.find("\r\nSet-Cookie"));
  EXPECT_NE(std::string::npos, head.find("Location: /x  Set-Cookie: a=b\r\n"));
}

TEST(NetHttp, AProblemFollowsRfc9457) {
  const Response response = problem(422, "Unfit", "two things");
  EXPECT_EQ(422, response.status);
  EXPECT_EQ("application/problem+json", response.content_type);
  const auto body = nlohmann::json::parse(*response.body);
  EXPECT_EQ("about:blank", body.at("type"));
  EXPECT_EQ("Unfit", body.at("title"));
  EXPECT_EQ(422, body.at("status"));
  EXPECT_EQ("two things", body.at("detail"));
}

TEST(NetHttp, AProblemMayQuoteBrokenText) {
  EXPECT_NO_THROW(nlohmann::json::parse(*problem(400, "bad: \xff").body));
}

TEST(NetHttp, AResponderAnswersExactlyOnce) {
  std::vector<int> statuses;
  const auto send = [&](const Response& response) { statuses.push_back(response.status); };
  {
    const Responder once(send);
    once(json_response(200, "{}"));
    once(json_response(201, "{}"));
  }
  {
    const Responder first(send);
    const Responder copy = first;  // NOLINT(performance-unnecessary-copy-initialization)
    copy(json_response(202, "{}"));
  }
  { const Responder forgotten(send); }
  EXPECT_EQ((std::vector<int>{200, 202, 500}), statuses);
}

TEST(NetCompression, JsonOfSomeSizeIsSentAsGzip) {
  Request request;
  request.headers = {{"Accept-Encoding", "gzip"}};
  const std::string text = "[" + std::string(5000, '1') + "]";
  Response response = json_response(200, text);
  compress_json(request, response);
  EXPECT_LT(response.body->size(), 100U);
  EXPECT_EQ("\x1f\x8b", response.body->substr(0, 2));
  const auto byte = [&](std::size_t i) {
    return static_cast<unsigned char>((*response.body)[response.body->size() - 4 + i]);
  };
  EXPECT_EQ(text.size(), byte(0) + 256U * byte(1)) << "the length at its end";
  const auto untouched = [&](Response plain, const Request& from) {
    const std::string before = *plain.body;
    compress_json(from, plain);
    return *plain.body == before;
  };
  EXPECT_TRUE(untouched(json_response(200, "{}"), request));
  EXPECT_TRUE(untouched(json_response(200, text), Request()));
  EXPECT_TRUE(untouched(text_response(200, "text/csv", text), request));
  EXPECT_TRUE(untouched(json_response(200, std::string(1 << 20, ' ')), request));
}

class NetRouter : public testing::Test {
 protected:
  Response go(const std::string& method,
              const std::string& path,
              std::map<std::string, std::string> query = {}) {
    Request request;
    request.method = method;
    request.path = path;
    request.query = std::move(query);
    request.role = role_;
    Response out;
    failure_ = router_.dispatch(request, Responder([&](Response response) { out = response; }));
    return out;
  }
  static SyncHandler says(const std::string& text) {
    return [text](const Request& r) {
      std::string all = text;
      for (const auto& [name, value] : r.params) all.append(" ").append(name + "=" + value);
      return text_response(200, "text/plain", all);
    };
  }
  Router router_{};
  Role role_ = Role::Operator;
  std::string failure_{};
};

TEST_F(NetRouter, ARouteNeedsItsRole) {
  router_.add("GET", "/runs", says("list"));
  router_.add("POST", "/runs", says("started"));
  router_.add("DELETE", "/runs/{id}", says("gone"));
  router_.need("DELETE", "/runs/{id}", Role::Admin);
  EXPECT_THROW(router_.need("PUT", "/runs", Role::Admin), std::invalid_argument);
  const auto statuses = [&](Role role) {
    role_ = role;
    return std::vector<int>{
        go("GET", "/runs").status, go("POST", "/runs").status, go("DELETE", "/runs/3").status};
  };
  EXPECT_EQ((std::vector<int>{200, 403, 403}), statuses(Role::Viewer));
  EXPECT_EQ((std::vector<int>{200, 200, 403}), statuses(Role::Operator));
  EXPECT_EQ((std::vector<int>{200, 200, 200}), statuses(Role::Admin));
}

TEST_F(NetRouter, MatchesSegmentsAndParameters) {
  router_.add("GET", "/runs", says("list"));
  router_.add("GET", "/runs/{id}", says("one"));
  router_.add("GET", "/runs/{id}/ticks", says("ticks"));
  router_.add("DELETE", "/runs/{id}", says("gone"));
  EXPECT_EQ("list", *go("GET", "/runs").body);
  EXPECT_EQ("one id=12", *go("GET", "/runs/12").body);
  EXPECT_EQ("ticks id=12", *go("GET", "/runs/12/ticks").body);
  EXPECT_EQ("gone id=12", *go("DELETE", "/runs/12").body);
  EXPECT_EQ("one id=12", *go("HEAD", "/runs/12").body);
  for (const char* path : {"/", "/run", "/runs/", "/runs/1/2", "/runs/1/ticks/", "/runs//ticks"}) {
    EXPECT_EQ(404, go("GET", path).status) << path;
  }
}

TEST_F(NetRouter, ANamedPathIsNoParameter) {
  router_.add("DELETE", "/runs/{id}", says("gone"));
  router_.add("POST", "/runs/delete", says("many"));
  EXPECT_EQ("many", *go("POST", "/runs/delete").body);
  EXPECT_EQ(405, go("DELETE", "/runs/delete").status);
  EXPECT_EQ("gone id=delete_it", *go("DELETE", "/runs/delete_it").body);
}

TEST_F(NetRouter, RefusesAQueryThatARouteDoesNotTake) {
  router_.add("GET", "/runs", says("list"));
  router_.add("GET", "/free", says("free"));
  router_.take_queries("GET", "/runs", {"limit", "q"});
  EXPECT_EQ(200, go("GET", "/runs", {{"q", "a"}}).status);
  EXPECT_EQ(200, go("GET", "/free", {{"colour", "red"}}).status);
  const Response refused = go("GET", "/runs", {{"colour", "red"}, {"limit", "5"}});
  EXPECT_EQ(400, refused.status);
  EXPECT_NE(std::string::npos, refused.body->find("'colour'; it takes limit, q")) << *refused.body;
}

TEST_F(NetRouter, AnotherMethodGetsTheAllowedOnes) {
  router_.add("GET", "/goal", says("get"));
  router_.add("PUT", "/goal", says("put"));
  const Response response = go("POST", "/goal");
  EXPECT_EQ(405, response.status);
  EXPECT_EQ("Allow", response.headers.at(0).name);
  EXPECT_EQ("GET, HEAD, PUT", response.headers.at(0).value);
}

TEST_F(NetRouter, ExceptionsBecomeStatuses) {
  router_.add("GET", "/teapot", SyncHandler([](const Request&) -> Response {
                throw HttpError(409, "the robot is busy");
              }));
  router_.add("GET", "/bug", SyncHandler([](const Request&) -> Response {
                throw std::runtime_error("bug");
              }));
  EXPECT_EQ(409, go("GET", "/teapot").status);
  EXPECT_EQ("", failure_);
  EXPECT_EQ(500, go("GET", "/bug").status);
  EXPECT_EQ("bug", failure_);
}

TEST_F(NetRouter, ListsItsRoutesAndRefusesDoubles) {
  router_.add("GET", "/b", says(""));
  router_.add("GET", "/a", says(""));
  ASSERT_EQ(2u, router_.routes().size());
  EXPECT_EQ("/b", router_.routes()[0].pattern);
  EXPECT_THROW(router_.add("GET", "/a", says("")), std::invalid_argument);
  EXPECT_THROW(router_.add("GET", "a", says("")), std::invalid_argument);
  EXPECT_TRUE(router_.knows("/a"));
  EXPECT_FALSE(router_.knows("/c"));
}

std::string json_error(const std::string& text, const JsonLimits& limits = {}) {
  try {
    parse_json(text, limits);
  } catch (const JsonError& error) {
    return error.what();
  }
  return "";
}

TEST(JsonLimits, AcceptsTheSameTextsAsTheLibrary) {
  const std::string text =
      R"({"a":[1,-2,3.5,true,null,"x\u00e9"],"b":{"c":{}},"d":[[],[{}]],"e":18446744073709551615})";
  EXPECT_EQ(nlohmann::json::parse(text), parse_json(text));
  EXPECT_EQ(3, parse_json(" 3 "));
}

TEST(JsonLimits, TheLastOfARepeatedKeyCounts) {
  EXPECT_EQ(2, parse_json(R"({"a":1,"a":2})").at("a"));
  EXPECT_EQ(nlohmann::json::parse(R"({"a":{"c":1}})"), parse_json(R"({"a":{"b":1},"a":{"c":1}})"));
}

TEST(JsonLimits, DepthIsBounded) {
  const auto nested = [](std::size_t n) { return std::string(n, '[') + std::string(n, ']'); };
  EXPECT_EQ("", json_error(nested(64)));
  EXPECT_NE(std::string::npos, json_error(nested(65)).find("deeper than 64"));
  EXPECT_NE(std::string::npos, json_error(nested(200'000)).find("deeper than 64"));
  std::string objects;
  for (int i = 0; i < 100; ++i) objects += R"({"a":)";
  EXPECT_NE(std::string::npos, json_error(objects).find("deeper than 64"));
}

TEST(JsonLimits, SizeIsBounded) {
  EXPECT_EQ("", json_error("[1]", {.max_bytes = 3}));
  EXPECT_NE(std::string::npos, json_error("[12]", {.max_bytes = 3}).find("4 bytes"));
}

TEST(JsonLimits, NamesTheErrorAndItsPlace) {
  EXPECT_EQ(0u, json_error("{\"a\":1,\n \"b\":}").find("bad JSON at line 2, column 6"))
      << json_error("{\"a\":1,\n \"b\":}");
  for (const char* text : {"",
                           "{",
                           "[1,]",
                           "{'a':1}",
                           "nan",
                           "[1 2]",
                           "{\"a\"}",
                           "\"\xff\"",
                           "\"\xc0\xaf\"",
                           "[1e999]",
                           "[-1e999]",
                           "\"\\ud800\"",
                           "01",
                           "[1]x",
                           "\"\n\""}) {
    EXPECT_EQ(0u, json_error(text).find("bad JSON at line ")) << text << ": " << json_error(text);
  }
  EXPECT_NE(std::string::npos, json_error(R"({"x":1e999})").find("1e999"));
}

TEST(JsonLimits, WritesBrokenTextAsAReplacement) {
  EXPECT_EQ("\"\xef\xbf\xbd\"", dump_json(std::string("\xff")));
}

}  // namespace
}  // namespace server::net
