// algo/terrain/tilt_prediction.hpp: the roll and pitch that the robot will have on the ground
// ahead, from the laser's line and the measured roll and pitch.
//
// Source: Park et al. 2005, Eq. 13-19, 27; equations.md G.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "algo/ground_sense.hpp"
#include "algo/terrain/attitude.hpp"
#include "algo/terrain/laser_line.hpp"
#include "algo/types.hpp"

namespace algo {

/// The equations as equations.md corrects them, or as printed.
enum class TiltLaw : std::uint8_t { Corrected, Literal };

/// Eq. 13: the roll of the ground on the line against the robot's, atan2(z_L - z_R, D_track) [rad].
double roll_change(double z_left, double z_right, double track);

/// Eq. 16: the pitch of the ground between two lines against the robot's. `older`, `newer`: x and z
/// of the lines in R. The print, +atan(Dz/Dx), is nose up positive, while Eq. 18 and k_X take nose
/// down as positive: the corrected form is -atan2(Dz, Dx).
double pitch_change(const Vec2& older, const Vec2& newer, TiltLaw law = TiltLaw::Corrected);

/// Eq. 18: a point that was at `p` in R, in R after the robot has moved by `way` [m] straight
/// ahead. The robot's attitude was `then` and is `now`; it moved along `then`. The print subtracts
/// the way, which is known in the level frame, from a point in the robot's frame; the corrected
/// form turns both into the level frame first, and the difference back.
Vec3 moved_into(const Vec3& p,
                const Attitude& then,
                const Attitude& now,
                double way,
                TiltLaw law = TiltLaw::Corrected);

/// The attitude that one line predicts.
struct PredictedTilt {
  Attitude attitude{};
  double ahead = 0;  // [m] from R's origin to the line, along the robot's way
};

/// Remembers the lines that the robot has not passed yet. Each predicts the attitude for its own
/// place once, when it is seen (Eq. 15, 19): the measured attitude plus Eq. 13 and 16. Eq. 14 and
/// 27 count samples until the robot comes near; ours measures the way left instead, so that a turn
/// counts too: a line that no longer lies ahead of the tracks is left out.
class TiltPrediction {
 public:
  explicit TiltPrediction(const Stance& stance);
  void reset();

  /// The robot has moved for `dt` [s] by `twist`, with `attitude` at its end.
  void move(const Twist2& twist, double heading, const Attitude& attitude, double dt);
  /// A new line, seen from where the robot is. Lines on something upright, which is no ground, are
  /// left out. Where the robot has hardly moved since the last line, this one replaces it.
  void take(const TrackPoints& line_R);

  /// Calls `use(const PredictedTilt&)` for each line at most `distance` [m] ahead, D_tp in Eq. 27.
  template <typename Use>
  void within(double distance, Use&& use) const {
    for (std::size_t age = count_; age-- > 0;) {
      const Line& line = at(age);
      const double ahead = way_to(line);
      if (line.ground && ahead >= 0 && ahead <= distance) use({line.predicted, ahead});
    }
  }
  /// [m] Of R above the ground where it started, by the way driven and its pitch.
  double height() const { return place_.z(); }
  /// The newest line's prediction.
  std::optional<PredictedTilt> newest() const;

 private:
  struct Line {
    Vec3 left{0, 0, 0};  // in the level frame of the start
    Vec3 right{0, 0, 0};
    bool ground = false;
    Attitude predicted{};
    Vec3 middle() const { return (left + right) / 2; }
  };
  static constexpr std::size_t kLines = 128;

  const Line& at(std::size_t age) const { return lines_[(next_ + kLines - 1 - age) % kLines]; }
  Vec3 in_robot(const Vec3& p) const;
  double way_to(const Line& line) const;
  bool upright(const Line& line) const;
  Vec2 rear_of(double front) const;

  Stance stance_{};
  std::vector<Line> lines_{};  // a ring
  std::size_t next_ = 0;
  std::size_t count_ = 0;
  Vec3 place_{0, 0, 0};  // of R, in the level frame of the start
  double heading_ = 0;   // [rad]
  Attitude attitude_{};
};

}  // namespace algo
