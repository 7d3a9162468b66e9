// server/lab/reproduce/robhaz_turnover.hpp: reproduces Fig. 12 and 13 of Park et al. 2005: a robot
// turns on a slope, with its centre of mass low and high, with the turnover guard and without.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "server/experiment/table.hpp"

namespace server::reproduce {

/// One sample of the quantities of Fig. 13. Absent ones are NaN.
struct TurnoverSample {
  double stamp = 0;  // [s] run clock
  double x = 0, y = 0, heading = 0;
  double roll = 0, pitch = 0;                      // [rad] true
  double roll_predicted = 0, pitch_predicted = 0;  // [rad] D_tp ahead
  double v = 0;                                    // [m/s] commanded to the base
  double w_cmd = 0;                                // [rad/s] the operator's
  double w = 0;                                    // [rad/s] commanded to the base
  double w_lb = 0, w_ub = 0;                       // [rad/s]
  double q_offset = 0, dead_band = 0;              // of full stick: Eq. 28, 29
  double force_left = 0;                           // of full force, about X
  double force_forward = 0;                        // about Y
};

/// The robots of Fig. 12 by name: the centre of mass at 0.25 and at 0.90 m.
constexpr std::string_view kLowRobot = "robhaz";
constexpr std::string_view kTallRobot = "robhaz_tall";

/// One drive along the path of Fig. 12.
struct TurnoverRun {
  std::string robot{};  // "robhaz_tall"
  double mass_height = 0;
  bool with_guard = false;
  bool overturned = false;
  double seconds = 0;                     // [s] run clock at its end
  double w_max = 0;                       // [rad/s] at full stick
  double steepest = 0;                    // [rad] the largest roll or pitch
  std::vector<TurnoverSample> samples{};  // every T_s
};

struct TurnoverFinding {
  std::string claim{};
  bool holds = false;
  std::string figures{};
};

struct TurnoverStudy {
  double slope = 0;  // [rad]
  std::vector<TurnoverRun> runs{};
  std::vector<TurnoverFinding> findings{};
};

/// Drives the path on a slope of `slope` [rad] with both robots, with the guard and without. The
/// same argument gives the same study bit for bit.
TurnoverStudy study_turnover(double slope);
/// The slope of physics.md 4; the paper does not give its own.
TurnoverStudy study_turnover();

bool all_hold(const TurnoverStudy& study);
experiment::Table runs_table(const TurnoverStudy& study);
experiment::Table findings_table(const TurnoverStudy& study);
nlohmann::json to_json(const TurnoverStudy& study);
/// The section of Markdown, with the picture from the folder `pictures`.
std::string to_markdown(const TurnoverStudy& study, const std::string& pictures);
constexpr std::string_view kTurnoverPicture = "robhaz-turnover.svg";
/// Fig. 13: the run with the centre of mass high and the guard.
std::string draw(const TurnoverStudy& study);

}  // namespace server::reproduce
