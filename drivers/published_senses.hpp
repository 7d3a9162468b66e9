// drivers/published_senses.hpp: readings that a process beside the robot publishes, for sensors
// that no driver of ours reads.
#pragma once

#include <cstddef>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "algo/ground_sense.hpp"
#include "algo/health.hpp"
#include "algo/robot.hpp"
#include "drivers/clock.hpp"

namespace drivers {

struct PublishedEntry;

/// Keeps the newest reading of each. A reading has its own stamp and is never made younger, so that
/// one whose publisher has died grows old, and the pipeline holds the robot. From any thread.
class PublishedSenses final : public algo::Publishing {
 public:
  static constexpr double kOldest = 10;             // [s] age of a reading that is still taken
  static constexpr double kRecent = 0.5;            // [s] age of one whose sensor counts as well
  static constexpr std::size_t kMostPixels = 4096;  // of an image's columns, and so of a line
  // Their names in reports.
  static constexpr const char* kInclinometer = "inclinometer";
  static constexpr const char* kCamera = "line camera";

  /// `clock` must outlive this object.
  PublishedSenses(const PublishedEntry& entry,
                  const std::optional<algo::LineCamera>& camera,
                  Clock& clock);

  /// Whether any sensor is published.
  bool any() const { return inclinometer_ || camera_; }
  static bool is_one_of(std::string_view device) {
    return device == kInclinometer || device == kCamera;
  }

  std::optional<std::string> publish_tilt(double roll, double pitch, double age) override;
  std::optional<std::string> publish_line(std::span<const algo::LinePixel> pixels,
                                          double age) override;

  /// Adds the newest inclination, however old, and a line that is new. `epoch` [s] is the run's
  /// time 0. Allocates nothing once the line has had all its points.
  void observe(double epoch, algo::Observation& observation);
  void report(std::vector<algo::DeviceReport>& devices) const;
  /// Whether the inclinometer is published, and no reading of the last kRecent has come.
  bool tilt_silent() const;

 private:
  struct Taken {
    double stamp = 0;         // [s] of the clock; 0: none yet
    std::uint64_t count = 0;  // readings
  };
  std::optional<std::string> take(bool expected, const char* what, double age, Taken& newest);
  bool recent(const Taken& newest) const;
  algo::DeviceReport report_of(const char* name, const Taken& newest) const;

  const bool inclinometer_;
  const std::optional<algo::LineCamera> camera_;
  Clock& clock_;

  mutable std::mutex mutex_{};  // guards what follows
  Taken tilt_{};
  double roll_ = 0;   // [rad]
  double pitch_ = 0;  // [rad]
  Taken line_{};
  std::vector<algo::LinePixel> pixels_{};
  bool line_fresh_ = false;
};

}  // namespace drivers
