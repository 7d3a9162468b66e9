// server/serve/path_trail.hpp: the path of a robot, at constant cost per tick and in bounded
// memory.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "algo/types.hpp"

namespace server {

/// Poses of R in W, evenly spaced along the path. At kMost poses, every second one is dropped and
/// the spacing doubles, so that a path of any length keeps its whole shape. The text of each pose
/// is made once.
class PathTrail {
 public:
  static constexpr std::size_t kMost = 2000;
  static constexpr double kSpacing = 0.02;  // [m] at first

  /// Adds the robot's current pose if it is far enough from the last kept pose.
  void add(const algo::Pose2& pose_W);
  void clear() { *this = {}; }

  const std::vector<algo::Pose2>& poses_W() const { return poses_; }
  /// Number of poses ever kept: a path with the same count is unchanged.
  std::size_t changes() const { return changes_; }
  /// foxglove.PosesInFrame.
  std::string message(double stamp) const;

 private:
  void thin();
  void write(const algo::Pose2& pose);

  std::vector<algo::Pose2> poses_{};
  double spacing_ = kSpacing;
  std::size_t changes_ = 0;
  std::string text_{};  // the poses, separated by commas
};

}  // namespace server
