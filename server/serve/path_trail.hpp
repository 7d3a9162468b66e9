// server/serve/path_trail.hpp: where a robot has been, at a constant cost a tick and in bounded
// memory.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "algo/types.hpp"

namespace server {

/// Poses of R in W, evenly spaced along the way. When there are kMost, every second one goes and
/// the spacing doubles, so that a path of any length keeps its whole shape. The text of each pose
/// is made once.
class PathTrail {
 public:
  static constexpr std::size_t kMost = 2000;
  static constexpr double kSpacing = 0.02;  // [m] at first

  /// The robot is at `pose` now. Keeps it when it is far enough from the last one kept.
  void add(const algo::Pose2& pose_W);
  void clear() { *this = {}; }

  const std::vector<algo::Pose2>& poses_W() const { return poses_; }
  /// How many poses were ever kept: a path with the same count is the same.
  std::size_t changes() const { return changes_; }
  /// foxglove.PosesInFrame.
  std::string message(double stamp) const;

 private:
  void thin();
  void write(const algo::Pose2& pose);

  std::vector<algo::Pose2> poses_{};
  double spacing_ = kSpacing;
  std::size_t changes_ = 0;
  std::string text_{};  // of the poses, between commas
};

}  // namespace server
