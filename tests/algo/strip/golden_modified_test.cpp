// tests/algo/strip/golden_modified_test.cpp: golden vectors of section E: the force laws and the
// side choice, through the controllers themselves.
#include <memory>
#include <string>

#include "tests/algo/golden.hpp"
#include "tests/algo/worlds.hpp"
#include <gtest/gtest.h>

#include "algo/perceive.hpp"
#include "algo/pipeline/controllers.hpp"
#include "algo/strip/elastic_strip_controller.hpp"
#include "algo/strip/strip.hpp"
#include "algo/strip/strip_law.hpp"
#include "algo/units.hpp"

namespace {

using golden::Json;
using namespace algo::units;

const Json& modified_vectors() {
  static const Json loaded = golden::load("E_modified.json");
  return loaded;
}
double modified_tolerance() {
  return golden::tolerance(modified_vectors());
}

TEST(ModifiedGolden, Factor) {
  ASSERT_FALSE(modified_vectors().at("factor").empty());
  for (const Json& vector : modified_vectors().at("factor")) {
    const double d = vector.at("d").get<double>() * golden::kMm;
    const double reach = vector.at("d_r").get<double>() * golden::kMm;
    const double step = vector.at("S").get<double>() * golden::kMm;
    const double k_r = vector.at("Kr");
    const auto expect = [&](const char* name, double actual) {
      EXPECT_TRUE(golden::close(actual / golden::kMm, vector.at(name), modified_tolerance()))
          << name << " of " << vector.dump();
    };
    expect("published_guard_eps10_cap1000", algo::published_factor(d, reach, k_r));
    expect("original", algo::original_factor(d, reach, k_r));
    // The file gives B; the law takes S and B = S / 2.
    expect("B", step / 2);
    expect("c1", algo::c1_factor(d, reach, k_r, step));
  }
}

struct Tick {
  algo::Scene scene{};
  algo::ControlOutput out{};
  algo::StripForces forces{};
};

Tick run(const std::string& controller, const Json& vector) {
  worlds::World world;
  for (const Json& circle : vector.at("circles")) {
    world.circles.push_back({golden::point_mm(circle), circle.at(2).get<double>() * golden::kMm});
  }
  Tick tick;
  algo::ControlInput in;
  in.odometry.pose = golden::pose_mm(vector.at("pose"));
  in.scene = &tick.scene;
  in.goal = algo::SetGoal{golden::point_mm(vector.at("goal")), std::nullopt};
  algo::RobotSpec spec;
  spec.radius = 350_mm;
  in.spec = &spec;
  in.dt = 0.05;
  algo::Parameters parameters;
  parameters.set(algo::kSafetyDistance, 1000_mm);
  parameters.set(algo::kRepulsionGain, vector.at("Kr"));
  parameters.set(algo::kStripStep, vector.at("S").get<double>() * golden::kMm);
  worlds::scan_world(in.odometry.pose, world, 8000_mm, tick.scene.scan);
  algo::perceive(in.odometry.pose, tick.scene);
  const auto subject = algo::builtin_controllers().at(controller).make();
  subject->reset(in.odometry.pose);
  subject->update(in, parameters, tick.out);
  tick.forces = dynamic_cast<const algo::ElasticStripController&>(*subject).forces();
  return tick;
}

void expect_part(const std::optional<algo::Nearest>& nearest,
                 const algo::Vec2& force,
                 const Json& part) {
  ASSERT_EQ(nearest.has_value(), !part.is_null());
  if (!nearest) {
    EXPECT_EQ(force, algo::Vec2(0, 0));
    return;
  }
  EXPECT_EQ(nearest->beam, part.at("beam").get<std::uint32_t>());
  EXPECT_TRUE(golden::close(nearest->distance / golden::kMm, part.at("d"), modified_tolerance()));
  EXPECT_TRUE(golden::close_mm(force, part.at("F"), modified_tolerance()));
}

void expect_tick(const std::string& controller, const Json& vector, const Json& expected) {
  SCOPED_TRACE(controller + " at " + vector.at("pose").dump());
  const Tick tick = run(controller, vector);
  expect_part(tick.scene.left, tick.forces.left_W, expected.at("parts").at("L"));
  expect_part(tick.scene.right, tick.forces.right_W, expected.at("parts").at("R"));
  EXPECT_TRUE(golden::close_mm(tick.forces.elastic_W, expected.at("F"), modified_tolerance()));
  ASSERT_TRUE(tick.out.pass_W);
  EXPECT_TRUE(golden::close_mm(*tick.out.pass_W, expected.at("pass"), modified_tolerance()));
  EXPECT_EQ(static_cast<int>(tick.forces.side), expected.at("side").get<int>());
  EXPECT_TRUE(golden::close(tick.forces.side_alpha, expected.at("alpha"), modified_tolerance()));
  const Json& beam = expected.at("blocked_beam");
  ASSERT_EQ(tick.forces.blocked_beam.has_value(), !beam.is_null());
  if (tick.forces.blocked_beam) {
    EXPECT_EQ(*tick.forces.blocked_beam, beam.get<std::size_t>());
  }
}

TEST(ModifiedGolden, Force) {
  ASSERT_FALSE(modified_vectors().at("force").empty());
  for (const Json& vector : modified_vectors().at("force")) {
    expect_tick("modified_published", vector, vector.at("published"));
    expect_tick("modified_c1", vector, vector.at("c1"));
    expect_tick("modified", vector, vector.at("c1_side_choice"));
  }
}

}  // namespace
