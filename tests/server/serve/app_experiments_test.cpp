// tests/server/serve/app_experiments_test.cpp: documents of experiments that REST refuses.
#include <algorithm>
#include <array>
#include <chrono>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "tests/server/serve/app_fixture.hpp"
#include <gtest/gtest.h>

namespace server {
namespace {

class AppExperiments : public AppTest {};

TEST_F(AppExperiments, FiftyMalformedExperimentsAreRefusedByField) {
  const json good = json::parse(
      R"({"name":"good","scenarios":["case1"],"controllers":["strip","original"],"repeats":2})");
  // JSON pointer, value, what the refusal names.
  const std::vector<std::tuple<const char*, const char*, const char*>> cases{
      {"/name", "1", "name"},
      {"/name", R"("")", "name"},
      {"/name", R"("Two Words")", "name"},
      {"/name", R"("../up")", "name"},
      {"/name", "null", "name"},
      {"/scenarios", "null", "scenarios"},
      {"/scenarios", "[]", "scenarios"},
      {"/scenarios", R"("case1")", "scenarios"},
      {"/scenarios", "[1]", "scenarios/0"},
      {"/scenarios", R"(["case1", "case0"])", "scenarios/1"},
      {"/scenarios", R"(["/etc/passwd"])", "scenarios/0"},
      {"/scenarios", R"(["../../secret"])", "scenarios/0"},
      {"/scenarios", R"(["case1", "case1"])", "scenarios"},
      {"/scenarios", R"([{"name":"x","obstacles":[{"type":"ball"}]}])", "scenarios/0"},
      {"/scenarios", R"([{"name":"x","goal":{"x":"far","y":0}}])", "scenarios/0"},
      {"/scenarios", R"([{"random_layouts":{}}])", "scenarios/0"},
      {"/scenarios", R"([{"random_layouts":{"count":0}}])", "scenarios/0/random_layouts/count"},
      {"/scenarios", R"([{"random_layouts":{"count":-1}}])", "scenarios/0/random_layouts/count"},
      {"/scenarios", R"([{"random_layouts":{"count":1e9}}])", "scenarios/0/random_layouts/count"},
      {"/scenarios", R"([{"random_layouts":{"count":2,"obstacles":13}}])", "obstacles"},
      {"/scenarios", R"([{"random_layouts":{"count":2,"gap":-1}}])", "gap"},
      {"/scenarios", R"([{"random_layouts":{"count":2,"crowd":1}}])", "crowd"},
      {"/scenarios", R"([{"random_layouts":{"count":2,"density":9}}])", "density"},
      {"/controllers", R"([{"name":"strip","repeats":0}])", "controllers/0/repeats"},
      {"/controllers", R"([{"name":"strip","scenarios":["case9"]}])", "controllers/0/scenarios"},
      {"/controllers", "null", "controllers"},
      {"/controllers", "[]", "controllers"},
      {"/controllers", R"("strip")", "controllers"},
      {"/controllers", "[7]", "controllers/0"},
      {"/controllers", R"(["strip", "strp"])", "controllers/1"},
      {"/controllers", R"(["strip", "strip"])", "controllers"},
      {"/controllers", R"(["python3 mine.py"])", "controllers/0"},
      {"/controllers", R"([{"label":"mine"}])", "controllers/0"},
      {"/controllers", R"([{"name":"strip","parameters":{"k_r":99}}])", "k_r"},
      {"/controllers", R"([{"name":"strip","parameters":{"wings":2}}])", "wings"},
      {"/controllers", R"([{"name":"strip","parameters":{"k_r":"much"}}])", "k_r"},
      {"/controllers", R"([{"name":"strip","colour":"red"}])", "colour"},
      {"/repeats", "0", "repeats"},
      {"/repeats", "-3", "repeats"},
      {"/repeats", "1.5", "repeats"},
      {"/repeats", R"("two")", "repeats"},
      {"/repeats", "1000000", "repeats"},
      {"/seed", "-1", "seed"},
      {"/seed", R"("lucky")", "seed"},
      {"/physics", R"("moon")", "physics"},
      {"/filter", R"("magic")", "filter"},
      {"/time_limit", "-5", "time_limit"},
      {"/time_limit", R"("long")", "time_limit"},
      {"/colour", R"("red")", "unknown field 'colour'"},
      {"/sweep", "[]", "sweep"},
      {"/sweep", "{}", "sweep"},
      {"/sweep", R"({"grid":{}})", "sweep/grid"},
      {"/sweep", R"({"grid":{"wings":[1]}})", "wings"},
      {"/sweep", R"({"grid":{"k_r":[0.3,99]}})", "k_r"},
      {"/sweep", R"({"grid":{"k_r":[]}})", "k_r"},
      {"/sweep", R"({"random":{"count":3,"parameters":{"k_r":[0.9,0.3]}}})", "k_r"},
      {"/sweep", R"({"grid":{"k_r":[0.3]},"list":[{"k_r":0.3}]})", "sweep"},
      {"/comparisons", R"({"baseline":"nobody"})", "baseline"},
      {"/comparisons", R"({"baseline":"strip","others":["nobody"]})", "others"},
      {"/comparisons", R"({"others":["strip"]})", "baseline"},
  };
  EXPECT_GE(cases.size(), 50U);
  for (const auto& [field, value, word] : cases) {
    json document = good;
    document[json::json_pointer(field)] = json::parse(value);
    SCOPED_TRACE(document.dump());
    expect_problem(ask("POST", "/experiments", document.dump()), 422, word);
    expect_problem(ask("POST", "/experiments/estimate", document.dump()), 422, word);
  }
  json large = good;
  large["repeats"] = 10'000;
  large["scenarios"] = {{{"random_layouts", {{"count", 1000}}}}};
  expect_problem(ask("POST", "/experiments", large.dump()), 422, "20000000");
  expect_problem(ask("POST", "/experiments", "{"), 400, "");
  EXPECT_TRUE(get("/experiments")["items"].empty());
}

TEST_F(AppExperiments, ChecksOfLargeOnesKeepNoOtherAnswerWaiting) {
  using net::test::Client;
  std::array<Client, 4> clients{Client(port_), Client(port_), Client(port_), Client(port_)};
  json large = json::parse(R"({"controllers":["go_to_goal"],"physics":"kinematic"})");
  large["scenarios"] = {{{"random_layouts", {{"count", 500}}}}};
  for (std::size_t i = 0; i < clients.size(); ++i) {
    large["name"] = "large-" + std::to_string(i);
    clients.at(i).send(net::test::post_request("/api/v1/experiments", large.dump()));
  }
  std::set<const Client*> heard;
  const auto answered = [&](Client& client) {
    if (client.receive(std::chrono::milliseconds(1))) heard.insert(&client);
    return heard.contains(&client);
  };
  int answers = 0;  // while all the checks go on
  for (; std::ranges::none_of(clients, answered); ++answers) get("/runs?limit=1");
  EXPECT_GT(answers, 5);
  for (Client& client : clients) {
    // 100 s, since the checks give way to whatever keeps the processors busy.
    for (int tries = 0; tries < 100'000 && !answered(client); ++tries) {
    }
    EXPECT_EQ(net::test::read_answer(client).status, 202);
  }
}

}  // namespace
}  // namespace server
