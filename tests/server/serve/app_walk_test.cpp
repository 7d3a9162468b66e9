// tests/server/serve/app_walk_test.cpp: good and bad requests to every described operation: each
// status that occurs is documented, each failure is a problem document, and no answer reveals a
// folder of this machine.
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "tests/server/serve/app_fixture.hpp"

namespace server {
namespace {

using net::test::Answer;

const std::string kToken = "the-token-of-the-walk-0123";
const std::set<std::string> kMethods{"get", "put", "post", "delete", "patch"};

std::string upper_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(c));
  return text;
}

class AppWalk : public AppTest {
 protected:
  void SetUp() override {
    api_ = get("/openapi.json");
    const Answer accepted = ask("POST", "/runs", R"({"scenario":"case1","vehicle":"kinematic"})");
    ASSERT_EQ(accepted.status, 202) << accepted.body;
    const std::int64_t run = json::parse(accepted.body)["runs"][0];
    ASSERT_TRUE(comes_to(run, "finished"));
    runs_ = {std::to_string(run), "999999", "abc", "0", "99999999999999999999"};
  }

  const json& resolve(const json& part) const {
    if (!part.contains("$ref")) return part;
    return api_.at(json::json_pointer(part["$ref"].get<std::string>().substr(1)));
  }

  /// A body that the schema accepts, with existing names.
  json sample(const json& described, const std::string& name = "") const {
    const json& schema = resolve(described);
    const std::string ref = described.value("$ref", "");
    if (ref.ends_with("/Obstacle")) {
      return {{"type", "cylinder"}, {"x", 1.0}, {"y", 4.5}, {"radius", 0.1}};
    }
    if (ref.ends_with("/Request")) return {{"type", "set_goal"}, {"x", 3.0}, {"y", 3.0}};
    if (ref.ends_with("/Control")) return {{"action", "stop"}};
    if (name == "scenario") return "case1";
    if (schema.contains("enum")) return schema["enum"][0];
    const json type = schema.value("type", json("object"));
    if (type == "string") return "walked";
    if (type == "number" || type == "integer") return 1;
    if (type == "boolean") return true;
    if (type == "array") return json::array();
    json out = json::object();
    for (const std::string key : schema.value("required", json::array())) {
      out[key] = sample(schema.value("properties", json::object()).value(key, json::object()), key);
    }
    return out;
  }

  std::vector<std::string> targets(std::string path) const {
    if (const auto at = path.find("{session}"); at != std::string::npos)
      path.replace(at, 9, "main");
    const auto filled = [&](const std::string& hole, const std::vector<std::string>& values) {
      std::vector<std::string> out;
      for (const std::string& value : values) {
        std::string target = path;
        target.replace(target.find(hole), hole.size(), value);
        out.push_back(target);
      }
      return out;
    };
    if (path.find("{id}") != std::string::npos) return filled("{id}", runs_);
    if (path.find("{name}") != std::string::npos) {
      return filled("{name}", {"case1", "walked", "nothing", "Bad%20Name", "broken%zz", "%ff"});
    }
    return {path, path + "?limit=x&cursor=y&from=-1&status=z", path + "?limit=0&from=99999999999"};
  }

  /// Expects a status and form of answer that the operation documents.
  void expect_named(const json& operation, const Answer& answer, const std::string& what) {
    SCOPED_TRACE(what);
    seen_.insert(answer.status);
    const std::string status = std::to_string(answer.status);
    ASSERT_TRUE(operation["responses"].contains(status)) << status << ": " << answer.body;
    const json& described = resolve(operation["responses"][status]);
    const std::string type =
        answer.headers.count("Content-Type") > 0 ? answer.headers.at("Content-Type") : "";
    if (described.contains("content")) {
      EXPECT_TRUE(described["content"].contains(type.substr(0, type.find(';')))) << type;
    } else {
      EXPECT_EQ(type, "");
    }
    if (answer.status >= 400) expect_problem(answer, answer.status, "");
    if (answer.status == 429) {
      EXPECT_EQ(answer.headers.count("Retry-After"), 1u);
    }
    EXPECT_EQ(answer.body.find(folder_.string()), std::string::npos) << answer.body.substr(0, 2000);
  }

  std::string request(const std::string& method,
                      const std::string& target,
                      const std::string& headers,
                      const std::string& body = "",
                      const std::string& host = "localhost") const {
    std::string out = method + ' ' + target + " HTTP/1.1\r\nHost: " + host + "\r\n" + headers;
    if (!body.empty()) {
      out += "Content-Type: application/json\r\nContent-Length: " + std::to_string(body.size()) +
             "\r\n";
    }
    return out + "\r\n" + body;
  }

  /// Malformed variants of any request, and of one that changes something.
  std::vector<std::string> bad_requests(const std::string& method,
                                        const std::string& target) const {
    const std::string json_type = "Content-Type: application/json\r\n";
    std::vector<std::string> out{
        request(method, target, "", "", "evil.example"),
        request(method, target, "Host: twice\r\n"),
        request(method, target, "X-Long: " + std::string(9000, 'x') + "\r\n"),
        request(method, target, json_type + "Content-Length: 4000000\r\n"),
        request(method, target, json_type + "Content-Length: 1\r\nTransfer-Encoding: chunked\r\n"),
        request(method, target, json_type + "Transfer-Encoding: gzip, chunked\r\n", ""),
        request(method, target, json_type + "Transfer-Encoding: chunked\r\n") + "zz\r\n",
        request(method, target, "Authorization: Bearer nonsense\r\n"),
    };
    if (method == "GET") return out;
    out.push_back(request(method, target, "Origin: http://evil.example\r\n"));
    out.push_back(request(method, target, "Content-Type: text/plain\r\nContent-Length: 2\r\n") +
                  "{}");
    for (const char* body : {"{",
                             "[]",
                             "{}",
                             "null",
                             "\"text\"",
                             "{\"unknown\":1}",
                             "\xff",
                             "{\"action\":\"dance\"}",
                             "{\"name\":\"Bad Name\"}",
                             "{\"scenario\":\"nothing\",\"action\":\"load\"}"}) {
      out.push_back(request(method, target, "", body));
    }
    return out;
  }

  json api_{};
  std::vector<std::string> runs_{};
  std::set<int> seen_{};
};

TEST_F(AppWalk, EveryStatusThatOccursIsDocumented) {
  for (const auto& [path, methods] : api_.at("paths").items()) {
    for (const auto& [name, operation] : methods.items()) {
      const std::string method = upper_case(name);
      std::string body;
      if (operation.contains("requestBody")) {
        body = sample(operation["requestBody"]["content"]["application/json"]["schema"]).dump();
      }
      for (const std::string& target : targets(path)) {
        const std::string what = method + ' ' + target;
        expect_named(operation, net::test::ask(port_, request(method, target, "", body)), what);
        // Again: the first request may have created or removed the thing.
        expect_named(operation, net::test::ask(port_, request(method, target, "", body)), what);
        for (const std::string& bad : bad_requests(method, target)) {
          expect_named(operation, net::test::ask(port_, bad), bad.substr(0, 300));
        }
      }
    }
  }
  for (const int status : {200, 201, 202, 204, 400, 403, 404, 409, 413, 415, 421, 422, 431}) {
    EXPECT_EQ(seen_.count(status), 1u) << "the walk never met " << status;
  }
}

TEST_F(AppWalk, WhatHasNoOperationIsNamedBesideThem) {
  const json& named = api_.at("components").at("responses");
  const auto expect = [&](const Answer& answer, int status) {
    expect_problem(answer, status, "");
    EXPECT_TRUE(named.contains(std::to_string(status))) << status;
  };
  for (const auto& [path, methods] : api_.at("paths").items()) {
    for (const std::string& method : kMethods) {
      if (methods.contains(method)) continue;
      SCOPED_TRACE(method + ' ' + path);
      const Answer answer =
          net::test::ask(port_, request(upper_case(method), targets(path)[0], ""));
      expect(answer, 405);
      ASSERT_EQ(answer.headers.count("Allow"), 1u);
      for (const auto& [there, unused] : methods.items()) {
        EXPECT_NE(answer.headers.at("Allow").find(upper_case(there)), std::string::npos);
      }
    }
  }
  expect(ask("GET", "/nothing"), 404);
  expect(net::test::ask(port_, request("GET", "/ws", "")), 426);
}

/// The same on a server with a token, which the requests lack.
class AppWalkOutside : public AppTest {
 protected:
  AppWalkOutside() : AppTest(kinematic_case1(), kToken) {}
};

TEST_F(AppWalkOutside, ARequestWithoutATokenLearnsNothing) {
  const auto known = net::test::ask(
      port_,
      "GET /api/v1/openapi.json HTTP/1.1\r\nHost: localhost\r\nAuthorization: Bearer " + kToken +
          "\r\n\r\n");
  ASSERT_EQ(known.status, 200);
  const json api = json::parse(known.body);
  for (const auto& [path, methods] : api.at("paths").items()) {
    for (const auto& [name, operation] : methods.items()) {
      SCOPED_TRACE(upper_case(name) + ' ' + path);
      const bool open = operation.contains("security") && operation["security"].empty();
      const Answer answer = net::test::ask(
          port_, upper_case(name) + ' ' + path + " HTTP/1.1\r\nHost: localhost\r\n\r\n");
      EXPECT_EQ(answer.status == 401, !open);
      EXPECT_TRUE(operation["responses"].contains(std::to_string(answer.status))) << answer.status;
      EXPECT_EQ(answer.body.find(folder_.string()), std::string::npos) << answer.body;
    }
  }
  int status = 0;
  for (int i = 0; i < 20 && status != 429; ++i) {
    const Answer answer = net::test::ask(
        port_,
        "GET /api/v1/session HTTP/1.1\r\nHost: localhost\r\nAuthorization: Bearer wrong\r\n\r\n");
    status = answer.status;
    EXPECT_EQ(answer.headers.count("Retry-After"), status == 429 ? 1u : 0u);
  }
  EXPECT_EQ(status, 429);
  EXPECT_TRUE(api.at("paths").at("/api/v1/session").at("get").at("responses").contains("429"));
}

}  // namespace
}  // namespace server
