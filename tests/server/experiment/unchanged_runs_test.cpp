// tests/server/experiment/unchanged_runs_test.cpp: the check that behaviour is unchanged: a hash
// over the observation, requests, command and hold of every tick, in each built-in scenario with
// each controller and two seeds.
//
// The hash covers values, not their encoding, so moving code or changing the wire format does not
// change it. An intended change is a commit of its own with new hashes: TAUTLINE_WRITE_HASHES=1
// rewrites tests/golden/run_hashes.json.
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "tests/folders.hpp"
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "algo/driving.hpp"
#include "algo/pipeline/controllers.hpp"
#include "algo/telemetry.hpp"
#include "server/experiment/arithmetic.hpp"
#include "server/experiment/pool.hpp"
#include "server/run/run_spec.hpp"
#include "server/run/runner.hpp"
#include "server/run/scenario_library.hpp"

namespace {

/// FNV-1a over values, each with a fixed width.
class Hash {
 public:
  void add(std::uint64_t value) {
    for (int shift = 0; shift < 64; shift += 8) {
      value_ ^= (value >> shift) & 0xFF;
      value_ *= 0x100000001b3ULL;
    }
  }
  void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }
  void add(bool value) { add(std::uint64_t{value ? 1U : 0U}); }
  void add(std::string_view text) {
    for (const char c : text) add(static_cast<std::uint64_t>(c));
    add(std::uint64_t{text.size()});
  }
  void add(const algo::Pose2& pose) {
    add(pose.x);
    add(pose.y);
    add(pose.heading);
  }
  void add(const algo::Vec2& v) {
    add(v.x());
    add(v.y());
  }
  void add(const algo::Twist2& twist) {
    add(twist.v);
    add(twist.omega);
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325ULL;
};

void add(Hash& hash, const algo::LaserScan& scan) {
  hash.add(scan.mount_R);
  hash.add(scan.stamp);
  hash.add(scan.angle_min);
  hash.add(scan.angle_increment);
  hash.add(scan.range_max);
  for (std::size_t i = 0; i < scan.size(); ++i) {
    hash.add(scan.ranges[i]);
    hash.add(static_cast<std::uint64_t>(scan.status[i]) << 8 |
             static_cast<std::uint64_t>(scan.codes[i]));
  }
}

void add(Hash& hash, const algo::RangeReading& reading) {
  hash.add(reading.mount_R);
  hash.add(reading.stamp);
  hash.add(reading.status == algo::Beam::Ok ? reading.range : 0.0);
  hash.add(reading.range_max);
  hash.add(static_cast<std::uint64_t>(reading.status));
}

void add(Hash& hash, const algo::Observation& o) {
  hash.add(o.stamp);
  hash.add(algo::name(o.halt));
  hash.add(o.odometry.stamp);
  hash.add(o.odometry.pose);
  hash.add(o.odometry.twist);
  for (const algo::LaserScan& scan : o.scans) add(hash, scan);
  for (const algo::RangeReading& reading : o.sonar) add(hash, reading);
  for (const algo::RangeReading& reading : o.infrared) add(hash, reading);
  for (const algo::BumperReading& bumper : o.bumpers) {
    hash.add(bumper.mount_R);
    hash.add(bumper.stamp);
    hash.add(bumper.pressed);
  }
  if (o.gyro) {
    hash.add(o.gyro->stamp);
    hash.add(o.gyro->rate);
  }
  if (o.inclinometer) {
    hash.add(o.inclinometer->stamp);
    hash.add(o.inclinometer->roll);
    hash.add(o.inclinometer->pitch);
  }
  if (o.encoders) {
    hash.add(o.encoders->stamp);
    hash.add(std::uint64_t{o.encoders->left});
    hash.add(std::uint64_t{o.encoders->right});
  }
}

void add(Hash& hash, const algo::SetGoal& goal) {
  hash.add(goal.position_W);
  hash.add(goal.heading.has_value());
  if (goal.heading) hash.add(*goal.heading);
}

/// The requests that these runs contain.
void add(Hash& hash, const algo::Request& request) {
  if (const auto* goal = std::get_if<algo::SetGoal>(&request)) {
    hash.add(std::string_view("set_goal"));
    add(hash, *goal);
  } else if (const auto* added = std::get_if<algo::AddGoal>(&request)) {
    hash.add(std::string_view("add_goal"));
    add(hash, added->goal);
  } else if (const auto* obstacle = std::get_if<algo::AddObstacle>(&request)) {
    hash.add(std::string_view("add_obstacle"));
    hash.add(obstacle->obstacle.pose_W);
  } else if (const auto* stick = std::get_if<algo::Joystick>(&request)) {
    hash.add(std::string_view("joystick"));
    hash.add(stick->forward);
    hash.add(stick->turn);
  } else if (const auto* stop = std::get_if<algo::Stop>(&request)) {
    hash.add(std::string_view("stop"));
    hash.add(stop->engaged);
  } else if (const auto* set = std::get_if<algo::SetParameter>(&request)) {
    hash.add(std::string_view("set_parameter"));
    hash.add(set->value);
  } else {
    FAIL() << "a request that this hash does not know";
  }
}

void add(Hash& hash, const algo::Telemetry& t) {
  hash.add(t.tick);
  for (const algo::Request& request : t.requests) add(hash, request);
  add(hash, t.observation);
  hash.add(t.goal.has_value());
  if (t.goal) add(hash, *t.goal);
  hash.add(t.command.base);
  hash.add(algo::name(t.hold));
  hash.add(algo::name(t.mission));
}

constexpr double kSpan = 18;  // [s] of each run

/// An operator's requests during the run, so that the hash covers gate, stick and edits too.
std::vector<std::pair<double, algo::Request>> script(const algo::Pose2& start_W) {
  algo::Obstacle post{.id = 9000, .shape = algo::Cylinder{.radius = 0.1}};
  post.pose_W = algo::compose(start_W, {.x = 2.0, .y = 1.5});
  return {{3.0, algo::AddObstacle{post}},
          {4.0, algo::Stop{true}},
          {4.5, algo::Stop{false}},
          {5.0, algo::SetParameter{&algo::kMaxSpeed, 0.35}},
          {15.0, algo::Joystick{.forward = 0.5, .turn = -0.4}},
          {15.5, algo::Joystick{}}};
}

std::uint64_t hash_of(const server::RunSpec& spec) {
  const auto robot = server::make_robot(spec);
  algo::Pipeline pipeline(server::pipeline_config(spec), robot->spec());
  const auto pool = server::FramePool::make(68);  // one more than the stream's ring takes
  server::Rings rings;
  server::RunLinks links;
  links.pool = pool.get();
  links.rings = &rings;
  Hash hash;
  std::uint64_t ticket = 1;
  auto todo = script(spec.scenario.start);
  links.listeners.push_back([&](const server::Frame& frame) {
    add(hash, frame.telemetry);
    rings.stream.reset();
    rings.replies.reset();
    while (!todo.empty() && frame.telemetry.observation.stamp >= todo.front().first) {
      rings.requests.push({ticket++, todo.front().second});
      todo.erase(todo.begin());
    }
  });
  std::stop_source stop;
  const auto result = server::run(*robot,
                                  pipeline,
                                  server::first_requests(spec),
                                  {.until_outcome = true, .time_limit = kSpan},
                                  links,
                                  stop.get_token());
  EXPECT_NE(result.outcome, algo::Outcome::Failed) << result.reason;
  return hash.value();
}

std::string golden_file() {
  return (tests::folder() / "golden" / "run_hashes.json").string();
}

TEST(UnchangedRuns, SenseAskCommandAndHoldWhatTheyDid) {
  const server::ScenarioLibrary library({}, {});
  struct Job {
    std::string scenario{};
    std::string controller{};
  };
  std::vector<Job> jobs;
  for (const auto& entry : library.list()) {
    // Tasks of an arm drive without the controller; tests/server/record/arm_run_test.cpp.
    if (library.load(entry.name).robot.arm) continue;
    for (const auto& controller : algo::builtin_controllers().entries()) {
      jobs.push_back({entry.name, std::string(controller.name)});
    }
  }
  ASSERT_GT(jobs.size(), 100U);
  std::mutex mutex;
  nlohmann::json found = nlohmann::json::object();
  server::experiment::for_each(jobs.size(), {}, [&](std::size_t i, const std::stop_token&) {
    const Job& job = jobs[i];
    std::string text;
    for (const std::uint64_t seed : {1U, 2U}) {
      server::RunOverrides overrides;
      overrides.controller = job.controller;
      overrides.seed = seed;
      server::RunSpec spec;
      try {
        spec = server::make_spec(library.load(job.scenario), overrides);
      } catch (const std::exception& e) {
        text = e.what();  // a refusal to drive this robot is compared too
        break;
      }
      text += fmt::format("{}{:016x}", text.empty() ? "" : " ", hash_of(spec));
    }
    const std::lock_guard lock(mutex);
    found[job.scenario][job.controller] = text;
  });
  found["arithmetic"] = server::experiment::arithmetic();
  if (std::getenv("TAUTLINE_WRITE_HASHES") != nullptr) {
    std::ofstream(golden_file()) << found.dump(1) << '\n';
    return;
  }
  std::ifstream file(golden_file());
  const nlohmann::json golden = nlohmann::json::parse(file);
  if (golden.at("arithmetic") != found["arithmetic"]) {
    GTEST_SKIP() << "The hashes were written where sines have other last bits.";
  }
  for (const Job& job : jobs) {
    EXPECT_EQ(found[job.scenario][job.controller],
              golden.value(job.scenario, nlohmann::json::object()).value(job.controller, "absent"))
        << job.scenario << ", " << job.controller;
  }
}

}  // namespace
