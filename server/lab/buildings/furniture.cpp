// server/lab/buildings/furniture.cpp: places things one by one.
#include "server/lab/buildings/furniture.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

namespace server::buildings {
namespace {

using algo::Vec2;

constexpr double kLeastRoom = 2.4;       // [m] edge of a room with furniture
constexpr double kFloorPerThing = 6.0;   // [m2]
constexpr std::size_t kMostThings = 40;  // in a room
constexpr int kThingTries = 20;          // places for one thing
constexpr double kBeforeDoor = 1.0;      // [m] around a door's middle that stays free
constexpr double kAtWall = 0.03;         // [m] behind a thing at a wall

struct Thing {
  enum class Form : std::uint8_t { OnLegs, Box, Round };
  Form form = Form::Box;
  Vec2 size{0, 0};  // [m] along its x and y axes
};

Thing draw_thing(sim::Random& random) {
  const std::size_t kind = random.below(5);
  const double a = random.uniform();
  const double b = random.uniform();
  switch (kind) {
    case 0:  // a table
      return {Thing::Form::OnLegs, {0.8 + a, 0.6 + 0.4 * b}};
    case 1:  // a chair
      return {Thing::Form::OnLegs, {0.38 + 0.08 * a, 0.38 + 0.08 * b}};
    case 2:  // a cupboard
      return {Thing::Form::Box, {0.6 + a, 0.35 + 0.3 * b}};
    case 3:
      return {Thing::Form::Box, {0.2 + 0.6 * a, 0.2 + 0.6 * b}};
    default: {
      const double width = 0.1 + 0.5 * a;
      return {Thing::Form::Round, {width, width}};
    }
  }
}

class Room {
 public:
  Room(const FloorPlan& plan, CellPlace cell)
      : low_(plan.low(cell)), high_(plan.high(cell)), doors_(plan.doors_of(cell)) {}

  Vec2 size() const { return high_ - low_; }

  /// A pose for a thing of `size`; its width is `x` if it is not turned.
  std::optional<algo::Pose2> place(const Vec2& size, sim::Random& random) {
    for (int k = 0; k < kThingTries; ++k) {
      const std::size_t side = random.below(8);  // 0 to 3: at that wall
      const double heading = side < 4 ? static_cast<double>(side) * std::numbers::pi / 2
                                      : random.uniform(-std::numbers::pi, std::numbers::pi);
      const double u = random.uniform();
      const double v = random.uniform();
      const double circle = size.norm() / 2;
      Vec2 middle = low_ + (high_ - low_).cwiseProduct(Vec2(u, v));
      double gap = kThingGap;
      if (side < 4) {
        const Vec2 half = side % 2 == 0 ? Vec2(size / 2) : Vec2(size.y() / 2, size.x() / 2);
        const int axis = side % 2 == 0 ? 1 : 0;
        const bool high = side == 1 || side == 2;
        middle[axis] =
            high ? high_[axis] - half[axis] - kAtWall : low_[axis] + half[axis] + kAtWall;
        const int other = 1 - axis;
        if (!inside(middle[other], other, half[other] + kThingGap)) continue;
      } else if (!inside(middle.x(), 0, circle + gap) || !inside(middle.y(), 1, circle + gap)) {
        continue;
      }
      if (!clear(middle, circle)) continue;
      taken_.push_back({middle, circle});
      return algo::Pose2{middle.x(), middle.y(), algo::wrap_angle(heading)};
    }
    return std::nullopt;
  }

 private:
  struct Circle {
    Vec2 middle{0, 0};
    double radius = 0;
  };
  bool inside(double at, int axis, double margin) const {
    return at > low_[axis] + margin && at < high_[axis] - margin;
  }
  bool clear(const Vec2& middle, double circle) const {
    const bool before_door = std::ranges::any_of(
        doors_, [&](const Vec2& door) { return (door - middle).norm() < kBeforeDoor + circle; });
    return !before_door && std::ranges::none_of(taken_, [&](const Circle& other) {
      return (other.middle - middle).norm() < other.radius + circle + kThingGap;
    });
  }

  Vec2 low_;
  Vec2 high_;
  std::vector<Vec2> doors_;
  std::vector<Circle> taken_{};
};

void add_thing(const Thing& thing, const algo::Pose2& pose_W, std::vector<algo::Obstacle>& out) {
  const auto add = [&](const algo::Pose2& at_W, algo::Shape shape) {
    algo::Obstacle obstacle;
    obstacle.id = static_cast<std::uint32_t>(out.size() + 1);
    obstacle.pose_W = at_W;
    obstacle.shape = std::move(shape);
    out.push_back(obstacle);
  };
  switch (thing.form) {
    case Thing::Form::Box:
      add(pose_W, algo::Box{thing.size.x(), thing.size.y()});
      return;
    case Thing::Form::Round:
      add(pose_W, algo::Cylinder{thing.size.x() / 2});
      return;
    default:
      for (const double x : {-0.5, 0.5}) {
        for (const double y : {-0.5, 0.5}) {
          const Vec2 corner = (thing.size - Vec2(kLeg, kLeg)).cwiseProduct(Vec2(x, y));
          const Vec2 at_W = algo::to_parent(pose_W, corner);
          add({at_W.x(), at_W.y(), 0}, algo::Cylinder{kLeg / 2});
        }
      }
  }
}

}  // namespace

void furnish(const FloorPlan& plan, sim::Random& random, std::vector<algo::Obstacle>& obstacles) {
  for (int j = 0; j < plan.rows(); ++j) {
    for (int i = 0; i < plan.columns(); ++i) {
      Room room(plan, {i, j});
      const Vec2 size = room.size();
      if (size.minCoeff() < kLeastRoom) continue;
      const double share = random.uniform(0.3, 1);
      const auto things = static_cast<std::size_t>(share * size.prod() / kFloorPerThing);
      for (std::size_t k = 0; k < std::min(things, kMostThings); ++k) {
        const Thing thing = draw_thing(random);
        if (const auto pose_W = room.place(thing.size, random))
          add_thing(thing, *pose_W, obstacles);
      }
    }
  }
}

}  // namespace server::buildings
