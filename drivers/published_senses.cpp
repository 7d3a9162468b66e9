// drivers/published_senses.cpp: checks readings, keeps the newest, and tells their ages.
#include "drivers/published_senses.hpp"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "drivers/robot_file.hpp"

namespace drivers {

PublishedSenses::PublishedSenses(const PublishedEntry& entry,
                                 const std::optional<algo::LineCamera>& camera,
                                 Clock& clock)
    : inclinometer_(entry.inclinometer),
      camera_(entry.line ? camera : std::nullopt),
      clock_(clock) {
  if (camera_) pixels_.reserve(kMostPixels);
}

/// Call with the lock. Notes a reading in `newest`, or returns the reason for a refusal.
std::optional<std::string> PublishedSenses::take(bool expected,
                                                 const char* what,
                                                 double age,
                                                 Taken& newest) {
  if (!expected)
    return fmt::format("The robot's file does not say that its {} is published.", what);
  if (!(age >= 0 && age <= kOldest)) {
    return fmt::format("The age of a reading must be 0 to {:g} s, not {:g}.", kOldest, age);
  }
  const double stamp = clock_.now() - age;
  if (newest.count > 0 && stamp <= newest.stamp) {
    return fmt::format("A newer reading of the {} has come already.", what);
  }
  newest.stamp = stamp;
  ++newest.count;
  return std::nullopt;
}

std::optional<std::string> PublishedSenses::publish_tilt(double roll, double pitch, double age) {
  constexpr double kMost = std::numbers::pi / 2;
  if (!(std::abs(roll) <= kMost && std::abs(pitch) <= kMost)) {
    return "Roll and pitch must be from -pi/2 to pi/2.";
  }
  const std::lock_guard lock(mutex_);
  if (auto refusal = take(inclinometer_, "inclinometer", age, tilt_)) return refusal;
  roll_ = roll;
  pitch_ = pitch;
  return std::nullopt;
}

std::optional<std::string> PublishedSenses::publish_line(std::span<const algo::LinePixel> pixels,
                                                         double age) {
  if (pixels.size() > kMostPixels) {
    return fmt::format("A line may have {} points at most.", kMostPixels);
  }
  const std::lock_guard lock(mutex_);
  for (const algo::LinePixel& pixel : pixels) {
    if (!camera_) break;
    if (std::abs(pixel.u) <= static_cast<float>(camera_->columns) / 2 &&
        std::abs(pixel.v) <= static_cast<float>(camera_->rows) / 2) {
      continue;
    }
    return fmt::format("The point ({:g}, {:g}) is outside of the image.", pixel.u, pixel.v);
  }
  if (auto refusal = take(camera_.has_value(), "laser line", age, line_)) return refusal;
  pixels_.assign(pixels.begin(), pixels.end());
  line_fresh_ = true;
  return std::nullopt;
}

void PublishedSenses::observe(double epoch, algo::Observation& observation) {
  if (!any()) return;
  const std::lock_guard lock(mutex_);
  if (tilt_.count > 0) observation.inclinometer = {tilt_.stamp - epoch, roll_, pitch_};
  if (!line_fresh_) return;
  line_fresh_ = false;
  observation.line.fresh = true;
  observation.line.stamp = line_.stamp - epoch;
  for (const algo::LinePixel& pixel : pixels_) observation.line.pixels.push_back(pixel);
}

/// Call with the lock, as report_of().
bool PublishedSenses::recent(const Taken& newest) const {
  return newest.count > 0 && clock_.now() - newest.stamp < kRecent;
}

bool PublishedSenses::tilt_silent() const {
  const std::lock_guard lock(mutex_);
  return inclinometer_ && !recent(tilt_);
}

algo::DeviceReport PublishedSenses::report_of(const char* name, const Taken& newest) const {
  const double age = clock_.now() - newest.stamp;
  algo::DeviceReport out;
  out.name = name;
  out.port = "published";
  out.well = recent(newest);
  out.sentence = newest.count == 0 ? "Nobody has published a reading yet."
                 : out.well        ? "Well."
                                   : fmt::format("Its newest reading is {:.1f} s old.", age);
  out.facts = {{"readings", std::to_string(newest.count)}};
  return out;
}

void PublishedSenses::report(std::vector<algo::DeviceReport>& devices) const {
  const std::lock_guard lock(mutex_);
  if (inclinometer_) devices.push_back(report_of(kInclinometer, tilt_));
  if (camera_) devices.push_back(report_of(kCamera, line_));
}

}  // namespace drivers
