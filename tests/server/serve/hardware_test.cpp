// tests/server/serve/hardware_test.cpp: the program on fake devices: armed, driven, stopped.
#include "server/run/hardware.hpp"

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tests/server/serve/app_fixture.hpp"
#include <gtest/gtest.h>

#include "algo/diff_drive.hpp"
#include "drivers/serial_robot.hpp"
#include "server/serve/operator_watch.hpp"

namespace server {
namespace {

using net::test::eventually;

/// A scanner that sees nothing, at 40 Hz.
class OpenField final : public drivers::Scanner {
 public:
  bool take(algo::LaserScan& scan) override {
    const double now = drivers::steady_now();
    if (now - last_ < 0.025) return false;
    last_ = now;
    scan.stamp = now - 0.01;
    scan.range_max = 8.191;
    scan.angle_min = -std::numbers::pi / 2;
    scan.angle_increment = std::numbers::pi / 360;
    scan.resize(361);
    for (std::size_t i = 0; i < scan.size(); ++i) scan.set_free(i);
    return true;
  }
  drivers::ScannerState state() override {
    return {.running = true, .last_scan = drivers::steady_now(), .period = 0.0266};
  }
  algo::DeviceReport report() override {
    return {.name = "front laser", .port = "none", .well = true, .sentence = "Well."};
  }

 private:
  double last_ = 0;
};

/// A base that follows commands exactly.
class GoodBase final : public drivers::Base {
 public:
  explicit GoodBase(std::shared_ptr<std::atomic<bool>> button) : button_(std::move(button)) {}

  void enable(bool on) override {
    const std::lock_guard lock(mutex_);
    state_.motors_on = on && !*button_;
  }
  void cut() noexcept override { enable(false); }
  void drive(const algo::Twist2& twist) override {
    const std::lock_guard lock(mutex_);
    const double now = drivers::steady_now();
    if (state_.motors_on && state_.stamp > 0) {
      state_.pose = algo::integrate_arc(state_.pose, state_.twist, now - state_.stamp);
    }
    state_.stamp = now;
    state_.twist = twist;
  }
  void stop() noexcept override {
    const std::lock_guard lock(mutex_);
    state_.twist = {};
  }
  drivers::BaseState state() override {
    const std::lock_guard lock(mutex_);
    drivers::BaseState out = state_;
    out.running = true;
    out.set_ups = 1;
    out.stamp = drivers::steady_now();
    out.stop_button = *button_;
    return out;
  }
  double watchdog() const override { return 0.5; }
  algo::DeviceReport report() override {
    return {.name = "base",
            .port = "none",
            .well = !*button_,
            .sentence = *button_ ? "Its stop button is pressed." : "Well."};
  }

 private:
  std::shared_ptr<std::atomic<bool>> button_;  // the server outlives the test's own part
  std::mutex mutex_{};
  drivers::BaseState state_{};
};

class HardwareAppTest : public AppTest {
 protected:
  /// `published`: a process beside the robot publishes its inclination.
  explicit HardwareAppTest(bool published = false)
      : HardwareAppTest(std::make_shared<std::atomic<bool>>(false), published) {}

  json hardware() const { return get("/session").at("hardware"); }
  std::string disarmed_why() const { return hardware().at("disarmed").at("why"); }
  bool comes_to_halt(const std::string& halt) const {
    return eventually([&] {
      const json h = hardware();
      return h.is_object() && h.at("halt") == halt;
    });
  }
  /// The same with an operator: each poll is a sign of life.
  bool watched_until(const std::function<bool()>& condition) const {
    return eventually([&] {
      EXPECT_EQ(ask("POST", "/session/watch").status, 200);
      return condition();
    });
  }
  bool gets_beyond(double x) const {
    return watched_until([&] { return get("/session").at("pose").at("x") > x; });
  }
  /// [m] driven in a tenth of a second.
  double way() const {
    const double from = get("/session").at("pose").at("x");
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    return get("/session").at("pose").at("x").get<double>() - from;
  }
  void arm() const {
    ASSERT_TRUE(comes_to_halt("disarmed"));
    ASSERT_EQ(control("arm").status, 200);
    ASSERT_TRUE(comes_to_halt("none"));
  }
  net::test::Answer control(const char* action) const {
    return ask("POST", "/session/control", json({{"action", action}}).dump());
  }

  std::shared_ptr<std::atomic<bool>> button_;

 private:
  HardwareAppTest(std::shared_ptr<std::atomic<bool>> button, bool published)
      : AppTest(spec(button, published)), button_(std::move(button)) {}

  static RunSpec spec(const std::shared_ptr<std::atomic<bool>>& button, bool published) {
    drivers::RobotFile file;
    file.spec.name = "made-up";
    file.spec.period = 0.05;
    file.spec.radius = 0.3;
    file.spec.half_track = 0.25;
    file.spec.drives = true;
    file.spec.max_v = file.limits.speed = 0.3;
    file.spec.max_omega = file.limits.turn = 1;
    file.spec.max_acceleration = file.spec.max_angular_acceleration = 1;
    file.lasers.push_back({.name = "front laser", .port = "none"});
    file.published.inclinometer = file.spec.inclinometer = published;
    std::vector<std::unique_ptr<drivers::Scanner>> scanners;
    scanners.push_back(std::make_unique<OpenField>());
    return hardware_spec(
        describe(std::make_shared<drivers::SerialRobot>(std::move(file),
                                                        std::move(scanners),
                                                        std::make_unique<GoodBase>(button),
                                                        std::make_unique<drivers::SteadyClock>())),
        {});
  }
};

TEST_F(HardwareAppTest, DrivesOnceItIsArmedAndStopsForAPerson) {
  const json state = get("/session");
  EXPECT_EQ(state.at("source"), "hardware");
  EXPECT_EQ(state.at("vehicle"), "hardware");
  EXPECT_EQ(state.at("emulated"), false);
  EXPECT_EQ(state.at("hardware").at("disarmed"), nullptr) << "it has not been armed yet";
  EXPECT_FALSE(state.at("robot").at("paceable"));
  ASSERT_TRUE(comes_to_halt("disarmed"));
  EXPECT_EQ(get("/session").at("hold"), "halted");
  EXPECT_NEAR(get("/session").at("pose").at("x").get<double>(), 0, 1e-9);

  // WHEN the goal follows the arming at once THEN it is accepted: no tick has to pass between.
  ASSERT_EQ(control("arm").status, 200);
  EXPECT_EQ(ask("PUT", "/session/goal", R"({"x":5,"y":0})").status, 200);
  EXPECT_TRUE(gets_beyond(0.1));

  *button_ = true;
  ASSERT_TRUE(comes_to_halt("stop_button"));
  EXPECT_FALSE(hardware().at("armed"));
  expect_problem(control("arm"), 409, "stop button");
  *button_ = false;
  ASSERT_TRUE(comes_to_halt("disarmed"));
  // The cause is still named when it is over.
  EXPECT_NE(disarmed_why().find("stop button"), std::string::npos) << disarmed_why();
  ASSERT_EQ(control("arm").status, 200);
  ASSERT_TRUE(comes_to_halt("none"));
  EXPECT_EQ(hardware().at("disarmed"), nullptr);
  EXPECT_EQ(get("/session").at("by").at("arming"), "127.0.0.1");
  EXPECT_EQ(control("disarm").status, 200);
  EXPECT_FALSE(hardware().at("armed"));
  EXPECT_EQ(disarmed_why(), "127.0.0.1 has disarmed it.");
  EXPECT_EQ(hardware().at("disarmed").at("at").get<std::string>().back(), 'Z');
}

TEST_F(HardwareAppTest, AGoalIsRefusedWithASentenceUntilTheRobotIsArmed) {
  ASSERT_TRUE(comes_to_halt("disarmed"));
  const std::string goal = R"({"x":5,"y":0})";
  expect_problem(ask("PUT", "/session/goal", goal), 409, "Arm the robot first");
  expect_problem(ask("POST", "/session/goal", goal), 409, "Arm the robot first");
  expect_problem(ask("POST", "/session/requests", R"({"type":"joystick","forward":1,"turn":0})"),
                 409,
                 "Arm the robot first");
  arm();
  EXPECT_EQ(control("stop").status, 200);
  expect_problem(ask("PUT", "/session/goal", goal), 409, "Release Stop first");
  EXPECT_EQ(control("release").status, 200);
  EXPECT_EQ(ask("PUT", "/session/goal", goal).status, 200);
  EXPECT_TRUE(gets_beyond(0.05));
}

TEST_F(HardwareAppTest, NeitherArmingNorAReleaseDrivesToAnEarlierGoal) {
  arm();
  for (const auto& [end, begin] :
       {std::pair("stop", "release"), std::pair("disarm", "arm"), std::pair("button", "arm")}) {
    const double from = get("/session").at("pose").at("x");
    ASSERT_EQ(ask("PUT", "/session/goal", R"({"x":50,"y":0})").status, 200);
    EXPECT_EQ(ask("POST", "/session/goal", R"({"x":60,"y":0})").status, 200);
    ASSERT_TRUE(gets_beyond(from + 0.05));
    if (end == std::string("button")) {
      *button_ = true;
      ASSERT_TRUE(comes_to_halt("stop_button"));
      *button_ = false;
      ASSERT_TRUE(comes_to_halt("disarmed"));
    } else {
      ASSERT_EQ(control(end).status, 200);
    }
    ASSERT_TRUE(watched_until([&] { return get("/session").at("goal").is_null(); })) << end;
    EXPECT_TRUE(get("/session").at("goals_ahead").empty());
    ASSERT_EQ(control(begin).status, 200);
    ASSERT_TRUE(comes_to_halt("none"));
    ASSERT_TRUE(watched_until([&] { return way() == 0; }));
    EXPECT_EQ(way(), 0) << begin;
  }
}

TEST_F(HardwareAppTest, AGoalOnAnObstacleOrInUnknownSpaceIsReported) {
  arm();
  ASSERT_TRUE(eventually([&] { return get("/session").at("watchers") == 0; }));
  // Goal checks may take a tenth of the time, so one request may have to be repeated.
  const auto told = [&](const char* goal) {
    auto reply = ask("POST", "/session/goal/check", goal);
    EXPECT_TRUE(eventually([&] {
      if (reply.status == 503) reply = ask("POST", "/session/goal/check", goal);
      return reply.status == 200;
    })) << reply.body;
    const json answer = json::parse(reply.body);
    return answer.at("trouble").is_null() ? "" : answer.at("trouble").get<std::string>();
  };
  EXPECT_EQ(told(R"({"x":5,"y":0})"), "");
  EXPECT_NE(told(R"({"x":-5,"y":0})").find("does not look that way"), std::string::npos);
  EXPECT_TRUE(get("/session").at("goal").is_null());
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_EQ(get("/session").at("watchers"), 0);  // a question is no sign of life
  EXPECT_TRUE(eventually([&] {
    const json answer = json::parse(ask("PUT", "/session/goal", R"({"x":50,"y":0})").body);
    return answer.value("warning", "").find("nothing is known") != std::string::npos;
  }));
}

TEST_F(HardwareAppTest, StopsWithoutAnOperatorWhoCouldStopIt) {
  arm();
  // WHEN it stands without requests THEN it stays armed.
  std::this_thread::sleep_for(OperatorWatch::kPatience + std::chrono::milliseconds(500));
  EXPECT_TRUE(hardware().at("armed"));
  // WHEN it moves and a script only reads THEN it is disarmed.
  EXPECT_EQ(ask("PUT", "/session/goal", R"({"x":50,"y":0})").status, 200);
  ASSERT_TRUE(gets_beyond(0.1));
  const auto last = OperatorWatch::Clock::now();
  EXPECT_TRUE(eventually([&] { return !hardware().at("armed").get<bool>(); }));
  const auto after = OperatorWatch::Clock::now() - last;
  EXPECT_GT(after, std::chrono::milliseconds(1000));
  EXPECT_TRUE(eventually([&] { return hardware().at("trouble") == OperatorWatch::kGone; }));
  EXPECT_TRUE(eventually([&] { return way() == 0; }));
}

struct LeaningAppTest : HardwareAppTest {
  LeaningAppTest() : HardwareAppTest(true) {}
};

TEST_F(LeaningAppTest, AProcessBesideTheRobotPublishesItsInclination) {
  const auto publish = [&](const std::string& body) {
    return ask("POST", "/session/published", body);
  };
  const auto inclinometer = [&] {
    const json all = hardware();
    for (const json& device : all.at("devices")) {
      if (device.at("name") == "inclinometer") return device;
    }
    return json();
  };
  ASSERT_TRUE(comes_to_halt("disarmed"));
  ASSERT_TRUE(eventually([&] { return inclinometer().is_object(); }));
  EXPECT_EQ(inclinometer().at("sentence"), "Nobody has published a reading yet.");
  EXPECT_EQ(publish(R"({"inclinometer":{"roll":0.1,"pitch":-0.2,"age":0.01}})").status, 200);
  EXPECT_TRUE(eventually([&] {
    EXPECT_EQ(publish(R"({"inclinometer":{"roll":0.1,"pitch":-0.2}})").status, 200);
    return inclinometer().at("well") == true;
  }));
  EXPECT_EQ(get("/session").at("watchers"), 0) << "it is no sign of life";
  EXPECT_TRUE(eventually([&] { return inclinometer().at("well") == false; }));
  expect_problem(control("arm"), 409, "The inclinometer: Its newest reading is");

  expect_problem(publish(R"({"inclinometer":{"roll":0.1,"pitch":0,"age":5}})"), 409, "newer");
  expect_problem(publish(R"({"line":{"pixels":[[1,2]]}})"), 409, "laser line is published");
  expect_problem(publish(R"({"inclinometer":{"roll":2,"pitch":0}})"), 409, "Roll and pitch");
  expect_problem(publish(R"({"inclinometer":{"roll":0}})"), 422, "pitch");
  expect_problem(publish(R"({"inclinometer":{"roll":0,"pitch":0,"age":-1}})"), 409, "age");
  expect_problem(publish(R"({"line":{"pixels":[[1]]}})"), 422, "pixels");
  expect_problem(publish(R"({"line":{"pixels":[[1,1e300]]}})"), 422, "pixels");
  expect_problem(publish("{}"), 422, "missing");
}

TEST_F(HardwareAppTest, ViewersAreCounted) {
  const auto watchers = [&] { return get("/session").at("watchers").get<int>(); };
  ASSERT_TRUE(comes_to_halt("disarmed"));
  EXPECT_TRUE(eventually([&] { return watchers() == 0; }));
  EXPECT_EQ(ask("POST", "/session/watch").status, 200);
  EXPECT_TRUE(eventually([&] { return watchers() == 1; }));
  EXPECT_TRUE(get("/session").at("watched_by_script"));
  EXPECT_TRUE(eventually([&] { return watchers() == 0; }));
  EXPECT_EQ(ask("POST", "/session/watch", "{}").status, 200);
  expect_problem(ask("POST", "/session/watch", R"({"for":9})"), 422, "for");
}

TEST_F(HardwareAppTest, AResetDisarmsAndASimulationCannotReplaceIt) {
  ASSERT_TRUE(comes_to_halt("disarmed"));
  ASSERT_EQ(control("arm").status, 200);
  EXPECT_EQ(control("reset").status, 200);
  ASSERT_TRUE(comes_to_halt("disarmed"));
  EXPECT_FALSE(hardware().at("armed"));
  expect_problem(ask("POST", "/session/control", R"({"action":"load","scenario":"case1"})"),
                 422,
                 "real hardware");
  EXPECT_EQ(ask("POST", "/session/control", R"({"action":"load","controller":"original"})").status,
            200);
  EXPECT_EQ(get("/session").at("controller"), "original");
  EXPECT_EQ(get("/session").at("source"), "hardware");
}

TEST_F(HardwareAppTest, ItHasNoPhysicsToChoose) {
  for (const char* key : {"physics", "vehicle"}) {
    const json load = {{"action", "load"}, {key, "kinematic"}};
    expect_problem(ask("POST", "/session/control", load.dump()), 422, "real hardware");
  }
}

TEST_F(HardwareAppTest, ItsTimeCannotBePausedSteppedOrSpedUp) {
  for (const char* body :
       {R"({"action":"pause"})", R"({"action":"step"})", R"({"action":"speed","speed":2})"}) {
    expect_problem(ask("POST", "/session/control", body), 409, "Press Stop");
  }
  EXPECT_FALSE(get("/session").at("pace").at("paused"));
}

TEST_F(HardwareAppTest, ObstaclesAreNotPlaced) {
  expect_problem(
      ask("POST", "/session/obstacles", R"({"type":"cylinder","x":1,"y":1,"radius":0.2})"),
      409,
      "by hand");
}

TEST_F(AppTest, ASimulatedRobotAcceptsAGoalInAnObstacleWithAWarning) {
  const auto told = [&](const char* goal) {
    const net::test::Answer answer = ask("PUT", "/session/goal", goal);
    EXPECT_EQ(answer.status, 200) << answer.body;
    return json::parse(answer.body).value("warning", "");
  };
  EXPECT_EQ(told(R"({"x":1.75,"y":2.5})"), "The goal lies inside an obstacle.");
  EXPECT_EQ(get("/session").at("goal").at("x"), 1.75);
  EXPECT_EQ(told(R"({"x":3.5,"y":5})"), "");
  // Stop keeps a simulated robot's goal: after the release it drives on.
  EXPECT_EQ(ask("POST", "/session/control", R"({"action":"stop"})").status, 200);
  EXPECT_EQ(told(R"({"x":3.5,"y":4})"), "");
  EXPECT_EQ(get("/session").at("goal").at("y"), 4);
}

TEST_F(AppTest, ASimulatedRobotCannotBeArmed) {
  expect_problem(ask("POST", "/session/control", R"({"action":"arm"})"), 409, "simulated");
  EXPECT_TRUE(get("/session").at("hardware").is_null());
}

}  // namespace
}  // namespace server
