// server/lab/soak/contact_witness.hpp: what a driven robot touched, and whether it had seen it.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "algo/observation.hpp"
#include "algo/robot.hpp"
#include "sim/obstacle_set.hpp"
#include "sim/scenario.hpp"

namespace server::soak {

enum class Touch : std::uint8_t {
  Seen,    // the robot drove against what its sensors had returned: the one that must not happen
  Unseen,  // no sensor had returned it
  Came,    // a person came, whom the robot did not approach or had not seen for a second
  Pushed,  // a person had touched the robot just before
};
inline constexpr std::size_t kTouches = 4;
/// "seen"
std::string_view name(Touch touch);

/// Compares the true world with all that the sensors return. A contact lasts until nothing has been
/// touched for half a second; of its ticks, the worst counts.
class ContactWitness {
 public:
  ContactWitness(const sim::Scenario& scenario, const algo::RobotSpec& spec);

  /// Call once per tick, in order.
  void see(const algo::Observation& observation, const algo::GroundTruth& truth);

  int count(Touch touch) const {
    const int lasting = touching_ && worst_ == touch ? 1 : 0;
    return counts_.at(static_cast<std::size_t>(touch)) + lasting;
  }
  /// A text for each contact of the worst kind.
  const std::vector<std::string>& seen() const { return seen_; }

 private:
  struct Place {
    double stamp = 0;  // [s]
    algo::Pose2 pose_W{};
    algo::Pose2 odometry_W{};
  };
  enum class Motion : std::uint8_t { True, OfWheels };
  struct Mover {
    std::size_t index = 0;  // in the set
    algo::Vec2 at_W{0, 0};
    double radius = 0;             // [m]
    double since = -1, last = -1;  // [s] of sightings without a long gap
  };
  void take_returns(const algo::Observation& observation);
  void take_return(const algo::Vec2& point_W, double stamp);
  algo::Pose2 pose_at(double stamp) const;
  bool was_seen(const algo::Vec2& point_W, double now) const;
  double approach(std::size_t obstacle, const algo::Vec2& point_W, Motion motion) const;
  algo::Vec2 touched_point(std::size_t obstacle, const algo::Pose2& pose_W) const;
  void judge(double now, const algo::Pose2& pose_W);

  const sim::Scenario& scenario_;
  sim::Hull hull_{};
  double memory_ = 0;  // [s] for which the robot may remember a return
  sim::ObstacleSet set_{};
  std::vector<Mover> movers_{};
  std::vector<float> returned_{};  // [s] newest return of each cell
  std::deque<Place> trail_{};
  std::vector<algo::Vec2> rim_R_{};  // places on the outline

  bool touching_ = false;
  double touching_since_ = 0;    // [s]
  double free_since_ = 0;        // [s]
  double person_touched_ = -10;  // [s]
  Touch worst_ = Touch::Came;
  std::array<int, kTouches> counts_{};
  std::vector<std::string> seen_{};
};

}  // namespace server::soak
