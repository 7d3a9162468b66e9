// algo/terrain/ground_survey.hpp: how a robot approaches ground that is not flat: it looks, aligns
// with the edge, looks twenty times, and then drives over it or turns away.
//
// Source: Masuda et al. 2008, sections 5.2-5.4 and Fig. 8; equations.md H. A robot that a person
// drives by hand is slowed and stopped by the same findings, but never moved.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>

#include "algo/parameters.hpp"
#include "algo/robot.hpp"
#include "algo/terrain/ground_reader.hpp"
#include "algo/terrain/ground_trials.hpp"
#include "algo/terrain/ground_verdict.hpp"
#include "algo/terrain/refused_edges.hpp"

namespace algo {

inline constexpr ParameterInfo kGroundSpeed{
    .name = "ground.speed",
    .label = "Speed while looking",
    .unit = "m/s",
    .min = 0.03,
    .max = 1.0,
    .step = 0.01,
    .initial = 0.12,
    .help = "No faster with floor sensors: faster, a narrow trench passes between two readings."};
inline constexpr ParameterInfo kGroundCreep{
    .name = "ground.creep",
    .label = "Speed near an edge",
    .unit = "m/s",
    .min = 0.01,
    .max = 0.2,
    .step = 0.01,
    .initial = 0.05,
    .help = "While the ground ahead is not known: 2 mm from one reading to the next."};
inline constexpr ParameterInfo kGroundTurn{
    .name = "ground.turn",
    .label = "Turn rate while looking",
    .unit = "rad/s",
    .min = 0.05,
    .max = 3.0,
    .step = 0.05,
    .initial = 0.4,
    .help = "No faster: the wheels must not reach an edge before it was read."};
inline constexpr ParameterInfo kGroundSkew{
    .name = "ground.skew_time",
    .label = "Wait for the other side",
    .unit = "s",
    .min = 0.2,
    .max = 10,
    .step = 0.1,
    .initial = 2,
    .help = "An edge that one side sees so long alone is too oblique: the robot turns away."};
inline constexpr ParameterInfo kGroundBackOff{
    .name = "ground.back_off",
    .label = "Way back from a refused edge",
    .unit = "m",
    .min = 0.1,
    .max = 1,
    .step = 0.05,
    .initial = 0.25,
    .help = "So far the robot backs off before it goes round."};
inline constexpr ParameterInfo kGroundMemory{
    .name = "ground.memory",
    .label = "Memory of refused edges",
    .unit = "s",
    .min = 1,
    .max = 3600,
    .step = 1,
    .initial = 300,
    .help = "So long a refused edge counts as an obstacle."};

inline constexpr std::array<const ParameterInfo*, 10> kGroundParameters{&kGroundSpeed,
                                                                        &kGroundCreep,
                                                                        &kGroundTurn,
                                                                        &kGroundSkew,
                                                                        &kGroundBackOff,
                                                                        &kGroundMemory,
                                                                        &kStepMargin,
                                                                        &kUphillMargin,
                                                                        &kDownhillMargin,
                                                                        &kTrenchRatio};

enum class SurveyState : std::uint8_t {
  Watch,     // both near beams end on flat floor, as far as is known
  OneSide,   // creeps until the other side sees the edge too
  Align,     // reverses each wheel until its side sees flat floor again
  Approach,  // creeps back to the edge
  Trials,    // creeps over it with the beams, twenty readings long
  Measure,   // stands, and averages the readings of a slope down
  Cross,     // drives over what it found
  BackOff,   // backs off what it refused
  TurnAway,  // turns away from it
  Refused,   // a driver by hand must back off
};

/// Who wants the base to move.
enum class SurveyDriver : std::uint8_t { Nobody, Goal, Hand };

struct SurveyInput {
  double stamp = 0;                     // [s] run clock
  double dt = 0;                        // [s]
  Pose2 pose_W{};                       // of R, by odometry
  double pitch = 0;                     // [rad] nose down positive; 0 if not known
  const FloorRanges* ranges = nullptr;  // null: no new reading in this tick
  SurveyDriver driver = SurveyDriver::Nobody;
  /// [m] x in R of the nearest return of the scanner where the left beams look; infinite: none.
  double obstacle_left = std::numeric_limits<double>::infinity();
  double obstacle_right = std::numeric_limits<double>::infinity();
};

struct SurveyAnswer {
  std::optional<Twist2> twist{};  // the survey drives
  double v_max = std::numeric_limits<double>::infinity();
  double omega_min = -std::numeric_limits<double>::infinity();
  double omega_max = std::numeric_limits<double>::infinity();
  std::string_view why{};  // a sentence in static storage
};

class GroundSurvey {
 public:
  /// `spec` has floor sensors. One without limits on what it climbs refuses all that is not flat.
  explicit GroundSurvey(const RobotSpec& spec);
  GroundSurvey(const GroundSurvey&) = delete;
  GroundSurvey& operator=(const GroundSurvey&) = delete;
  GroundSurvey(GroundSurvey&&) = delete;
  GroundSurvey& operator=(GroundSurvey&&) = delete;
  ~GroundSurvey() = default;

  void reset();
  /// One tick. Does not allocate.
  SurveyAnswer step(const SurveyInput& in, const Parameters& p);

  SurveyState state() const { return state_; }
  /// The newest finding, or Flat where the floor is; Pending while the far beam alone is off it.
  const GroundFinding& finding() const { return finding_; }
  bool can_pass() const { return can_pass_; }
  /// The edge of the newest finding, left end first; none while the ground is flat.
  const std::optional<std::array<Vec2, 2>>& edge_W() const { return edge_W_; }
  const RefusedEdges& refused() const { return refused_; }
  const GroundReader& reader() const { return reader_; }

 private:
  /// One pair of sensors.
  struct Side {
    double y = 0;  // [m] in R
    GroundLook look{};
    int off = 0;         // readings in a row off the floor
    int level = 0;       // and on it
    bool seen = false;   // has met the edge in this approach,
    Vec2 seen_W{0, 0};   // there,
    double past = 0;     // [m] and its beam is so far past that place
    bool tried = false;  // its trials have begun
    GroundTrials trials{};
    double far_sum = 0;  // [m] of the readings at rest
    double near_sum = 0;
    int far_count = 0;
    int near_count = 0;
    double farthest_off = 0;  // [m] of the near beam from the floor, while one side saw an edge
  };

  void move(const SurveyInput& in);
  void read(const SurveyInput& in);
  void see(Side& side);
  void try_side(Side& side);
  void enter(SurveyState state, const SurveyInput& in);
  void forget_edge();
  bool wavers(const GroundLook& look) const;
  GroundFinding found(const Side& side) const;
  void decide(const SurveyInput& in, const Parameters& p);
  void refuse(const SurveyInput& in);
  void note_edge();
  Vec2 foot_W(const Side& side) const;
  bool still_ahead() const;
  bool meets_unknown(const Side& side) const;
  void begin_align(const SurveyInput& in);

  SurveyAnswer watch(const SurveyInput& in, const Parameters& p);
  SurveyAnswer one_side(const SurveyInput& in, const Parameters& p);
  SurveyAnswer align(const SurveyInput& in, const Parameters& p);
  SurveyAnswer approach(const SurveyInput& in, const Parameters& p);
  SurveyAnswer trials(const SurveyInput& in, const Parameters& p);
  SurveyAnswer measure(const SurveyInput& in, const Parameters& p);
  SurveyAnswer cross(const SurveyInput& in, const Parameters& p);
  SurveyAnswer back_off(const SurveyInput& in, const Parameters& p);
  SurveyAnswer turn_away(const SurveyInput& in, const Parameters& p);
  SurveyAnswer refused(const SurveyInput& in, const Parameters& p);

  RobotSpec spec_{};
  FloorSensors sensors_{};
  GroundReader reader_;
  double foot_ = 0;  // [m] x in R where the near beams meet a level floor
  ClimbLimits limits_{};
  Side left_{};
  Side right_{};
  SurveyState state_ = SurveyState::Watch;
  SurveyDriver driver_ = SurveyDriver::Nobody;
  std::optional<Pose2> last_W_{};
  Pose2 pose_W_{};
  double pitch_ = 0;                  // [rad] measured,
  std::optional<double> stood_at_{};  // [rad] and its mean over the way behind
  bool fresh_ = false;                // a reading came in this tick
  double way_ = 0;                    // [m] driven ahead since reset; back counts against it
  double entered_ = 0;                // [s] when the state began,
  double from_way_ = 0;               // [m] and where
  double from_heading_ = 0;
  double tried_at_ = 0;    // [m] way of the newest trial
  double creep_to_ = 0;    // [m] way up to which something far ahead was seen
  bool parallel_ = false;  // both sides met the edge at once
  double away_ = 0;        // [rad] heading to turn to
  bool to_left_ = true;    // it turns away
  double pitch_sum_ = 0;   // [rad] over the trials
  int pitches_ = 0;
  int levelled_ = 0;  // readings in a row with both wheels still
  GroundFinding finding_{};
  bool can_pass_ = true;
  std::optional<std::array<Vec2, 2>> edge_W_{};
  RefusedEdges refused_{};
};

}  // namespace algo
