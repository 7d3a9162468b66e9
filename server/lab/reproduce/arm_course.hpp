// server/lab/reproduce/arm_course.hpp: what an arm is carried past: posts and beams that stand or
// move.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "algo/arm/mobile_arm.hpp"

namespace server::reproduce {

/// The base drives along x; the arm reaches out to its right.
struct ArmCarried {
  static constexpr double kWay = 4;  // [m]
  static constexpr std::size_t kConfigurations = 21;
  static constexpr double kReach = 0.70;  // [m] shoulder to hand, of at most 0.73

  algo::MobileArm body{};
  std::vector<algo::BodyJoints> path{};
  double hand_y = 0;  // [m]
};
ArmCarried carried_arm(double reach = ArmCarried::kReach);

constexpr double kPostRadius = 0.10;  // [m]
constexpr double kPostTop = 1.6;      // [m] above the arm
algo::Solid post_at(const algo::Vec2& centre_W, const algo::Vec2& velocity_W = algo::Vec2::Zero());

struct ArmCourse {
  std::string name{};
  std::vector<algo::Solid> solids{};
};
/// Posts that stand, come towards the arm, are overtaken, and cross its way at 0.3 m/s.
std::vector<ArmCourse> arm_courses(const ArmCarried& carried);

enum class ArmTrialKind : std::uint8_t { Standing, Along, Anywhere };
std::string_view words(ArmTrialKind kind);
/// One to three posts, low posts or beams beside the base's way; their speeds lie below 0.3 m/s.
/// None is near the arm at the start, or at the goal when the arm may be there.
std::vector<algo::Solid> random_solids(const ArmCarried& carried,
                                       ArmTrialKind kind,
                                       std::uint64_t seed);

}  // namespace server::reproduce
