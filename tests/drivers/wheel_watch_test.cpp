// tests/drivers/wheel_watch_test.cpp: obedient wheels raise no fault in ten hours; disobedient ones
// are detected within 0.3 s. The clock is a variable.
#include "drivers/wheel_watch.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>
#include <random>

#include <gtest/gtest.h>

namespace drivers {
namespace {

constexpr double kHalfTrack = 0.165;  // [m]
constexpr double kTick = 0.05;        // [s]
const WheelDynamics kPioneer{.ramp_of_wheels = false, .ramps = {0.3, 1.0}, .checked = true};
const WheelDynamics kRoboteq{.ramp_of_wheels = true, .ramps = {0.465, 0.465}, .checked = false};

/// The faults of the wheels.
struct Wrong {
  double runaway = 0;         // [m/s] of both
  bool encoder_dead = false;  // of the left one
  double gain = 1;            // times as fast as told
};

/// A base with ramps, slipping wheels and varying line delay, and a watch over it.
class Driven {
 public:
  Driven(const WheelDynamics& dynamics, std::uint64_t seed)
      : dynamics_(dynamics), watch_(dynamics, kHalfTrack), random_(seed) {}

  Wrong wrong{};
  double now = 100;

  /// One tick with `wanted`; true when the watch reports a fault.
  bool tick(const algo::Twist2& wanted, bool braking = false) {
    const double felt = now + uniform(0.02, 0.12);
    if (orders_.empty() || felt > orders_.back().time) orders_.push_back({felt, wanted, braking});
    watch_.command(now, wanted, braking);
    bool found = false;
    for (const double end = now + kTick; now < end - 1e-9; now += kStep) {
      move();
      report();
      // The newest report to arrive, once per tick, as in the control loop.
    }
    if (arrived_) found = watch_.report(arrived_->stamp, arrived_->twist);
    return found;
  }

 private:
  static constexpr double kStep = 0.005;  // [s]
  struct Order {
    double time = 0;  // [s]
    algo::Twist2 twist{};
    bool braking = false;
  };
  struct Report {
    double arrives = 0;  // [s]
    double stamp = 0;
    algo::Twist2 twist{};
  };

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  static double towards(double from, double to, double most) {
    return from + std::clamp(to - from, -most, most);
  }

  void move() {
    while (orders_.size() > 1 && orders_[1].time <= now) orders_.pop_front();
    const bool any = !orders_.empty() && orders_.front().time <= now;
    const Order order = any ? orders_.front() : Order{};
    const double share = 0.8;  // of the ramp that a loaded base reaches
    if (dynamics_.ramp_of_wheels) {
      const double turn = order.twist.omega * kHalfTrack;
      const double ramp = order.braking ? 2.0 : share * dynamics_.ramps[0];
      left_ = towards(left_, order.twist.v - turn, ramp * kStep);
      right_ = towards(right_, order.twist.v + turn, ramp * kStep);
      return;
    }
    v_ = towards(v_, order.twist.v, (order.braking ? 2.0 : share * dynamics_.ramps[0]) * kStep);
    omega_ = towards(
        omega_, order.twist.omega, (order.braking ? 10.0 : share * dynamics_.ramps[1]) * kStep);
    left_ = v_ - omega_ * kHalfTrack;
    right_ = v_ + omega_ * kHalfTrack;
  }

  /// Intermittent slip of 10 % per wheel, and noise of a few mm/s.
  double measured(double speed, double phase) {
    const double slip = 1 + 0.1 * std::sin(now / 3 + phase);
    const double noise = speed == 0 ? 0 : uniform(-0.003, 0.003);
    return std::round(1000 * (speed * slip + noise)) / 1000;
  }

  void report() {
    if (now >= next_report_) {
      next_report_ += dynamics_.checked ? 0.1 : 0.035;
      double left = measured(wrong.gain * left_, 0);
      double right = measured(wrong.gain * right_, 1);
      if (wrong.runaway != 0) left = right = wrong.runaway;
      if (wrong.encoder_dead) left = 0;
      // Some reports are delayed on the line, and so are those behind them.
      const double late = uniform(0, 1) < 0.02 ? uniform(0, 0.12) : uniform(0, 0.02);
      const double arrives = std::max(now + late, pending_.empty() ? 0 : pending_.back().arrives);
      pending_.push_back(
          {arrives, arrives, {(left + right) / 2, (right - left) / (2 * kHalfTrack)}});
    }
    while (!pending_.empty() && pending_.front().arrives <= now) {
      arrived_ = pending_.front();
      pending_.pop_front();
    }
  }

  WheelDynamics dynamics_;
  WheelWatch watch_;
  std::mt19937_64 random_;
  std::deque<Order> orders_{};
  std::deque<Report> pending_{};
  std::optional<Report> arrived_{};
  double next_report_ = 100;
  double v_ = 0, omega_ = 0;
  double left_ = 0, right_ = 0;
};

/// [s] until the watch reports a fault; nullopt if none within 4 s.
std::optional<double> found_after(Driven& base, const algo::Twist2& wanted) {
  const double began = base.now;
  while (base.now < began + 4) {
    if (base.tick(wanted)) return base.now - began;
  }
  return std::nullopt;
}

TEST(WheelWatch, TenHoursOfRampsSlipAndJitterRaiseNoFault) {
  for (const WheelDynamics& dynamics : {kPioneer, kRoboteq}) {
    Driven base(dynamics, 7);
    std::mt19937_64 random(11);
    const auto uniform = [&](double low, double high) {
      return std::uniform_real_distribution<double>(low, high)(random);
    };
    algo::Twist2 wanted;
    bool braking = false;
    int faults = 0;
    const double end = base.now + 10 * 3600;
    double until = 0;
    double wave = 0;
    while (base.now < end) {
      if (base.now >= until) {  // another manner of driving
        until = base.now + uniform(0.05, 6);
        braking = uniform(0, 1) < 0.05;
        wave = uniform(0, 1) < 0.3 ? uniform(0, 0.8) : 0;
        wanted = {uniform(-0.6, 0.6), uniform(0, 1) < 0.5 ? 0 : uniform(-1, 1)};
        if (uniform(0, 1) < 0.2) wanted = {};
        if (uniform(0, 1) < 0.2) wanted.v = 0.04;
      }
      algo::Twist2 now = wanted;
      now.omega += wave * std::sin(5 * base.now);
      if (base.tick(braking ? algo::Twist2{} : now, braking)) ++faults;
    }
    EXPECT_EQ(faults, 0) << (dynamics.checked ? "Pioneer" : "Roboteq");
  }
}

TEST(WheelWatch, WheelsThatTurnWithoutACommandAreDetectedInTime) {
  for (const WheelDynamics& dynamics : {kPioneer, kRoboteq}) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      Driven base(dynamics, seed);
      for (int i = 0; i < 40; ++i) ASSERT_FALSE(base.tick({}));
      base.wrong.runaway = 0.2;  // twice the limit of a robot that creeps
      const auto after = found_after(base, {});
      ASSERT_TRUE(after);
      EXPECT_LE(*after, 0.3);
    }
  }
}

TEST(WheelWatch, WheelsFasterThanCommandedAreDetectedInTime) {
  for (const WheelDynamics& dynamics : {kPioneer, kRoboteq}) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      Driven base(dynamics, seed);
      for (int i = 0; i < 100; ++i) ASSERT_FALSE(base.tick({0.1, 0}));
      base.wrong.runaway = 0.2;
      const auto after = found_after(base, {0.1, 0});
      ASSERT_TRUE(after);
      EXPECT_LE(*after, 0.3);
    }
  }
}

/// A command of the same moment excuses only speeds that its ramp can have reached.
TEST(WheelWatch, WheelsFasterThanCommandedAreDetectedInATurn) {
  for (const WheelDynamics& dynamics : {kPioneer, kRoboteq}) {
    for (std::uint64_t seed = 1; seed < 20; ++seed) {
      Driven base(dynamics, seed);
      for (int i = 0; i < 60; ++i) ASSERT_FALSE(base.tick({0.08, 0}));
      base.wrong.gain = 2;
      bool found = false;
      const double began = base.now;
      while (!found && base.now < began + 1) {
        found =
            base.tick(base.now < began + 0.15 ? algo::Twist2{0.08, 0} : algo::Twist2{0.07, 0.8});
      }
      EXPECT_LE(base.now - began, 0.4) << seed;
    }
  }
}

TEST(WheelWatch, EncoderThatDiesWhileDrivingIsDetectedInTime) {
  for (const double speed : {0.04, 0.1, 0.5}) {
    for (const WheelDynamics& dynamics : {kPioneer, kRoboteq}) {
      for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        Driven base(dynamics, seed);
        for (int i = 0; i < 100; ++i) ASSERT_FALSE(base.tick({speed, 0}));
        base.wrong.encoder_dead = true;
        const auto after = found_after(base, {speed, 0});
        ASSERT_TRUE(after);
        EXPECT_LE(*after, 0.3) << speed << (dynamics.checked ? " Pioneer" : " Roboteq");
      }
    }
  }
}

// No detection is possible before the ramp must have moved the wheel: 0.3 s until it is seen, and
// at half a ramp of 0.3 m/s2 another 0.2 s to 0.03 m/s.
TEST(WheelWatch, EncoderDeadFromTheStartIsDetectedAfterTheRamp) {
  for (const WheelDynamics& dynamics : {kPioneer, kRoboteq}) {
    Driven base(dynamics, 3);
    base.wrong.encoder_dead = true;
    for (int i = 0; i < 40; ++i) ASSERT_FALSE(base.tick({}));
    const auto after = found_after(base, {0.3, 0});
    ASSERT_TRUE(after);
    EXPECT_LE(*after, 0.8);
  }
}

TEST(WheelWatch, RobotRollingAtArmingMayCoastToRest) {
  WheelWatch watch(kPioneer, kHalfTrack);
  double now = 10;
  for (double speed = 0.3; speed > -0.3; speed -= 0.03, now += 0.1) {
    watch.command(now, {});
    EXPECT_FALSE(watch.report(now, {std::max(0.0, speed), 0}));
  }
  // Rolling on without slowing is a fault.
  watch.restart();
  bool found = false;
  for (int i = 0; i < 40 && !found; ++i, now += 0.1) {
    watch.command(now, {});
    found = watch.report(now, {0.3, 0});
  }
  EXPECT_TRUE(found);
}

TEST(WheelWatch, CreepSpeedRoundedToZeroRaisesNoFault) {
  for (const WheelDynamics& dynamics : {kPioneer, kRoboteq}) {
    WheelWatch watch(dynamics, kHalfTrack);
    double now = 10;
    for (int i = 0; i < 2000; ++i, now += 0.05) {
      watch.command(now, {0.0004, 0.008});
      EXPECT_FALSE(watch.report(now, {}));
    }
  }
}

TEST(WheelWatch, OneDamagedAnswerWithoutCheckValueRaisesNoFault) {
  WheelWatch watch(kRoboteq, kHalfTrack);
  double now = 10;
  for (int i = 0; i < 100; ++i, now += 0.05) {
    watch.command(now, {});
    EXPECT_FALSE(watch.report(now, {i % 10 == 9 ? 0.5 : 0.0, 0}));
  }
}

}  // namespace
}  // namespace drivers
