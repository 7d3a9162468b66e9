// sim/replay.cpp: loads a log and hands out its scans.
#include "sim/replay.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <stdexcept>

#include "sim/robot_model.hpp"

namespace sim {
namespace {

constexpr double kShortestPause = 1e-3;  // [s] no scanner is faster: a shorter pause is invalid
constexpr double kLongestPause = 3600;   // [s] a longer one means that the clock was set
constexpr double kFarthestMount = 1.0;   // [m] a laser farther from its robot: unrelated poses

std::ifstream open(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream || std::filesystem::is_directory(file)) {
    throw std::runtime_error("The log " + file.filename().string() + " cannot be opened.");
  }
  return stream;
}

/// The scanner's mount on its robot, from the two poses of a line. In files with a corrected path
/// the two poses may be from different maps; the scanner is then assumed to be at the centre.
algo::Pose2 mount_of(const CarmenScan& scan) {
  algo::Pose2 mount = algo::pose_step(scan.robot_W, scan.laser_W);
  if ((scan.laser_W.position() - scan.robot_W.position()).norm() > kFarthestMount) mount = {};
  const bool looks_back = std::abs(mount.heading) > std::numbers::pi / 2;
  if (looks_back != (scan.laser == CarmenLaser::Rear)) {
    mount.heading = algo::wrap_angle(mount.heading + std::numbers::pi);
  }
  return mount;
}

}  // namespace

Replay::Replay(const std::filesystem::path& file) : name_(file.string()) {
  std::ifstream stream = open(file);
  read(stream);
}

Replay::Replay(std::istream& log, const std::string& name) : name_(name) {
  read(log);
}

std::string Replay::damage() const {
  if (unreadable_ == 0) return {};
  return std::to_string(unreadable_) + " unreadable (" + first_unreadable_ + ")";
}

void Replay::read(std::istream& log) {
  std::vector<std::uint32_t> readings_mm;
  std::size_t odometries = 0;
  std::string line;
  while (std::getline(log, line)) {
    ++lines_;
    const CarmenLine parsed = parse_carmen_line(line);
    if (const auto* scan = std::get_if<CarmenScan>(&parsed)) {
      keep(*scan, readings_mm);
    } else if (const auto* error = std::get_if<CarmenError>(&parsed)) {
      if (unreadable_++ == 0) {
        first_unreadable_ = "line " + std::to_string(lines_) + ": " + error->reason;
      }
    } else if (std::holds_alternative<CarmenOdometry>(parsed)) {
      ++odometries;
    }
  }
  if (scans_.empty()) {
    if (lines_ == 0) throw std::runtime_error("The log " + name_ + " is empty.");
    std::string found =
        std::to_string(lines_) + " lines, " + std::to_string(odometries) + " of them odometry";
    if (unreadable_ > 0) found += ", " + damage();
    throw std::runtime_error("The log " + name_ +
                             " holds no scan (FLASER, RLASER or ROBOTLASER1): " + found + ".");
  }
  CarmenUnitGuess guess;
  for (const std::uint32_t reading : readings_mm) guess.see(reading);
  unit_ = guess.unit();
  wire_.reserve(readings_mm.size());
  for (const std::uint32_t reading : readings_mm) wire_.push_back(pack_carmen(reading, unit_));
  time_scans();
  describe();
}

void Replay::keep(const CarmenScan& scan, std::vector<std::uint32_t>& readings_mm) {
  const auto earlier = std::find_if(
      scans_.begin(), scans_.end(), [&scan](const Scan& kept) { return kept.laser == scan.laser; });
  const algo::Pose2 mount_R = earlier == scans_.end() ? mount_of(scan) : earlier->mount_R;
  scans_.push_back({.laser = scan.laser,
                    .stamp = scan.stamp,
                    .recorded = scan.stamp,
                    .pose_W = scan.robot_W,
                    .mount_R = mount_R,
                    .angle_min = scan.angle_min,
                    .angle_increment = scan.angle_increment,
                    .first = readings_mm.size(),
                    .beams = scan.readings.size()});
  for (const double reading : scan.readings) {
    readings_mm.push_back(static_cast<std::uint32_t>(std::nearbyint(reading * 1000)));
  }
}

/// Converts recorded stamps to run-clock times.
void Replay::time_scans() {
  double recorded = scans_.front().stamp;
  double now = 0;
  for (Scan& scan : scans_) {
    const double passed = scan.stamp - recorded;
    recorded = scan.stamp;
    if (&scan != &scans_.front()) {
      now += passed > kShortestPause && passed < kLongestPause ? passed : kFallbackPeriod;
    }
    scan.stamp = now;
  }
}

/// The recording robot is unknown: assumes a Silvermate.
void Replay::describe() {
  std::vector<double> periods;
  for (std::size_t i = 1; i < scans_.size(); ++i) {
    periods.push_back(scans_[i].stamp - scans_[i - 1].stamp);
  }
  double period = kFallbackPeriod;
  if (!periods.empty()) {
    const auto middle = periods.begin() + static_cast<std::ptrdiff_t>(periods.size() / 2);
    std::nth_element(periods.begin(), middle, periods.end());
    period = *middle;
  }
  spec_ = spec_of(RobotModel(), period);
  spec_.name = "log";
}

void Replay::reset(algo::Observation& observation) {
  current_ = 0;
  deliver(observation);
}

bool Replay::step(const algo::Command& /*command*/, algo::Observation& observation) {
  if (current_ + 1 == scans_.size()) return false;
  ++current_;
  deliver(observation);
  return true;
}

double Replay::next_period() const {
  if (current_ + 1 == scans_.size()) return 0;
  return scans_[current_ + 1].stamp - scans_[current_].stamp;
}

void Replay::deliver(algo::Observation& observation) const {
  const Scan& source = scans_[current_];
  observation.clear_sensors();
  observation.stamp = source.stamp;
  observation.odometry = {.stamp = source.stamp, .pose = source.pose_W};
  if (current_ > 0) {
    const Scan& before = scans_[current_ - 1];
    const double dt = source.stamp - before.stamp;
    const double turned = algo::wrap_angle(source.pose_W.heading - before.pose_W.heading);
    const algo::Vec2 ahead = algo::direction(before.pose_W.heading + turned / 2);
    const algo::Vec2 moved = source.pose_W.position() - before.pose_W.position();
    observation.odometry.twist = {moved.dot(ahead) / dt, turned / dt};
  }
  algo::LaserScan& scan = observation.scans.append();
  scan.mount_R = source.mount_R;
  scan.stamp = source.stamp;
  scan.angle_min = source.angle_min;
  scan.angle_increment = source.angle_increment;
  scan.range_max = carmen_range_max(unit_);
  scan.turn_period = 0;  // the log gives one pose for all beams
  scan.turns = 1;
  scan.resize(source.beams);
  for (std::size_t i = 0; i < source.beams; ++i) {
    algo::unpack_beam(scan, i, wire_[source.first + i]);
  }
}

}  // namespace sim
