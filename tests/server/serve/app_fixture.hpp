// tests/server/serve/app_fixture.hpp: the whole program on a free port, in temporary folders.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include "tests/server/serve/net_client.hpp"
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "server/run/scenario_library.hpp"
#include "server/serve/app.hpp"

namespace server {

using nlohmann::json;

class AppTest : public ::testing::Test {
 protected:
  AppTest() : AppTest(kinematic_case1()) {}
  explicit AppTest(RunSpec first, const std::string& token = "", const SessionRules& rules = {})
      : AppTest(std::move(first), net::AccessOptions{.token = token}, rules) {}
  AppTest(RunSpec first, const net::AccessOptions& access, const SessionRules& rules = {}) {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() /
              ("tautline_" + std::string(test->name()) + "_" + std::to_string(::getpid()));
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
    AppOptions options;
    options.net.port = 0;
    options.net.access = access;
    options.database = folder_ / "runs.db";
    options.scenarios = folder_ / "scenarios";
    options.robots = folder_ / "robots";
    options.first = std::move(first);
    options.sessions = rules;
    app_.emplace(std::move(options));
    const std::string url = app_->url();
    port_ = static_cast<std::uint16_t>(std::stoi(url.substr(url.rfind(':') + 1)));
    thread_ = std::thread([this] { app_->run(); });
    const std::string authorization =
        access.token.empty() ? "" : "Authorization: Bearer " + access.token + "\r\n";
    EXPECT_TRUE(net::test::eventually([&] {
      return ask("GET", "/session", "", authorization).body.find("\"pose\"") != std::string::npos;
    }));
  }
  ~AppTest() override {
    app_->stop();
    thread_.join();
    app_.reset();
    std::filesystem::remove_all(folder_);
  }

  /// One request on a connection of its own; a body makes it JSON unless `more` says otherwise.
  net::test::Answer ask(std::string_view method,
                        std::string_view path,
                        std::string_view body = "",
                        std::string_view more = "Content-Type: application/json\r\n",
                        std::string_view host = "localhost") const {
    std::string request(method);
    request.append(" /api/v1").append(path).append(" HTTP/1.1\r\nHost: ").append(host);
    request.append("\r\n");
    if (!body.empty()) {
      request.append("Content-Length: ").append(std::to_string(body.size())).append("\r\n");
    }
    request.append(more).append("\r\n").append(body);
    return net::test::ask(port_, request);
  }
  json get(std::string_view path) const {
    const net::test::Answer answer = ask("GET", path);
    EXPECT_EQ(answer.status, 200) << path << ' ' << answer.body;
    return json::parse(answer.body, nullptr, false);
  }
  int post(std::string_view path, const json& body) const {
    return ask("POST", path, body.dump()).status;
  }
  /// The answer is a problem document with `status` whose detail holds `word`.
  static void expect_problem(const net::test::Answer& answer, int status, std::string_view word) {
    EXPECT_EQ(answer.status, status) << answer.body;
    const auto type = answer.headers.find("Content-Type");
    ASSERT_NE(type, answer.headers.end());
    EXPECT_EQ(type->second, "application/problem+json");
    const json body = json::parse(answer.body, nullptr, false);
    ASSERT_TRUE(body.is_object()) << answer.body;
    EXPECT_EQ(body.value("status", 0), status);
    EXPECT_FALSE(body.value("title", "").empty());
    EXPECT_NE(body.value("detail", "").find(word), std::string::npos)
        << "no '" << word << "' in " << answer.body;
  }
  /// Waits until run `id` is in `status`.
  bool comes_to(std::int64_t id,
                const std::string& status,
                std::chrono::milliseconds patience = std::chrono::seconds(60)) const {
    const std::string path = "/runs/" + std::to_string(id);
    // The recorder writes a run's row some time after the run has its number.
    const auto has_status = [&] {
      const auto answer = ask("GET", path);
      return answer.status == 200 &&
             nlohmann::json::parse(answer.body).value("status", "") == status;
    };
    return net::test::eventually(has_status, patience);
  }

  static RunSpec kinematic_case1() {
    RunOverrides kinematic;
    kinematic.physics = sim::PhysicsKind::Kinematic;
    return make_spec(ScenarioLibrary({}, {}).load("case1"), kinematic);
  }

  std::filesystem::path folder_{};
  std::optional<App> app_{};
  std::uint16_t port_ = 0;

 private:
  std::thread thread_{};
};

}  // namespace server
