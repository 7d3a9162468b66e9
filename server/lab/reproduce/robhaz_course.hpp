// server/lab/reproduce/robhaz_course.hpp: the indoor course of Park et al. 2005, Fig. 10 and 11,
// driven by a simulated hand through the ordinary world and pipeline.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "algo/parameters.hpp"
#include "server/lab/reproduce/simulated_hand.hpp"
#include "sim/scenario.hpp"

namespace server {
/// server/lab/reproduce/robhaz.json, compiled in.
std::string_view embedded_robhaz();
}  // namespace server

namespace server::reproduce {

/// Everything that the study needs. The paper gives neither layout nor script: both are ours.
struct RobhazCourse {
  sim::Scenario scenario{};
  HandConfig hand{};
  std::vector<Intention> script{};  // by time
  double seconds = 30;              // [s] run clock
  std::uint64_t seed = 1;
};

/// Throws DocumentError saying which field is unknown or malformed, and why.
RobhazCourse robhaz_course_from_json(const nlohmann::json& document);
/// Reads a file. Throws std::runtime_error with the path and the fault.
RobhazCourse read_robhaz_course(const std::string& path);
/// The course compiled into the program.
RobhazCourse embedded_robhaz_course();

/// One sample of the quantities that the paper plots. Absent ones are NaN.
struct CourseSample {
  double stamp = 0;  // [s] run clock
  algo::Pose2 pose_W{};
  double clearance = 0;         // [m] true, hull to surface
  double nearest = 0;           // [m] min D_n
  double rho = 0;               // [m] of the wall model of this sample
  double theta = 0;             // [rad]
  double v_sprs = 0;            // [m/s]
  double v_cmd = 0;             // [m/s] the hand's
  double v = 0;                 // [m/s] the robot's command
  double w_cmd = 0;             // [rad/s]
  double w_d = 0;               // [rad/s] NaN unless a wall is followed
  double w = 0;                 // [rad/s]
  double q_offset_forward = 0;  // of full stick, as the following
  double q_offset_left = 0;
  double dead_band_left = 0;
  double force_forward = 0;  // of full force
  double force_left = 0;
};

/// The course with one reading of the equations and the force.
struct CourseRun {
  std::string reading{};  // "corrected"
  std::string means{};    // in words
  bool asserted = false;  // its findings decide the study's verdict
  double v_max = 0;       // [m/s] at full stick
  double w_max = 0;       // [rad/s]
  double d_ref = 0;       // [m]
  bool collided = false;
  std::vector<CourseSample> samples{};  // every T_s
};

/// Drives the course with the parameters `changed` in addition to the scenario's. The same
/// arguments give the same run bit for bit. Throws std::exception with a sentence if the course
/// cannot be driven.
CourseRun drive_course(const RobhazCourse& course, const algo::Parameters& changed);

}  // namespace server::reproduce
