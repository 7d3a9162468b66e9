// algo/full_strip/maneuver.hpp: plans moves to and fro, with the hull's true outline, where a place
// is too narrow to turn in.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "algo/full_strip/motion.hpp"
#include "algo/recycled.hpp"
#include "algo/types.hpp"

namespace algo {

/// One piece of a manoeuvre: an arc of constant curvature, forward or backward, or a turn in place
/// if `length` is 0.
struct Piece {
  Pose2 end_W{};
  double length = 0;  // [m] negative: backwards
  double turn = 0;    // [rad]
};

/// A* over (x, y, heading) around the robot, in bounded portions.
class ManeuverSearch {
 public:
  enum class State : std::uint8_t { Idle, Searching, Found, NoWay };

  ManeuverSearch();
  void reset() { state_ = State::Idle; }
  State state() const { return state_; }

  /// Searches for a way from `start_W` to a pose that `arrived` accepts. `target_W` is roughly
  /// where such poses are. The hull keeps `margin` [m] all the way.
  void start(const Pose2& start_W, const Vec2& target_W, double margin);
  State search(const LocalMap& map,
               const HullCheck& hull,
               const std::function<bool(const Pose2&)>& arrived,
               int budget);
  /// The pieces of the way found, first one first.
  const Recycled<Piece>& pieces() const { return pieces_; }

 private:
  static constexpr int kCells = 72;      // along an edge: 3.6 m
  static constexpr double kCell = 0.05;  // [m]
  static constexpr int kHeadings = 32;
  struct Node {
    float x = 0, y = 0, heading = 0;
    float g = 0;
    std::uint32_t parent = 0;
    std::uint32_t opened = 0, closed = 0;  // rounds
    std::uint8_t action = 0;
  };
  struct Entry {
    float f = 0;
    std::uint32_t node = 0;
  };
  std::optional<std::uint32_t> node_at(const Pose2& pose_W) const;
  bool free(const LocalMap& map,
            const HullCheck& hull,
            const Pose2& from,
            const Piece& piece) const;
  void push(std::uint32_t node, float g, const Pose2& pose_W);
  void expand(const LocalMap& map, const HullCheck& hull, std::uint32_t node);
  void trace(std::uint32_t node);

  State state_ = State::Idle;
  Pose2 start_W_{};
  Vec2 target_W_{0, 0};
  double margin_ = 0;
  std::uint32_t round_ = 0;
  std::vector<Node> nodes_;
  std::vector<Entry> heap_;
  Recycled<Piece> pieces_{};
};

/// Drives the pieces one by one.
class ManeuverDrive {
 public:
  ManeuverDrive();
  void reset() { pieces_.clear(); }
  bool active() const { return next_ < pieces_.size(); }
  void start(const Recycled<Piece>& pieces);
  /// The command at `pose_W`; nothing once the last piece is done.
  std::optional<Twist2> next(const Pose2& pose_W, const MotionLimits& limits);

 private:
  Recycled<Piece> pieces_{};
  std::size_t next_ = 0;
};

}  // namespace algo
