// server/cli/doctor.cpp: checks port, permission, rate, type, status, scans and wheels in turn.
#include "server/cli/doctor.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <thread>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "algo/dazzle.hpp"
#include "algo/perceive.hpp"
#include "drivers/lms200_device.hpp"
#include "drivers/open_robot.hpp"
#include "drivers/published_senses.hpp"
#include "drivers/real_time.hpp"
#include "server/cli/doctor_floor.hpp"
#include "server/cli/doctor_notes.hpp"

namespace server {
namespace {

using doctor::Found;
using doctor::look_at_port;
using doctor::Notes;
using doctor::pause;
using drivers::steady_now;

/// Statistics of the scans of some seconds.
struct Tally {
  std::size_t scans = 0;
  std::size_t beams = 0;
  std::size_t readings = 0;  // beams with a distance
  std::size_t spikes = 0;
  std::size_t blinded = 0;  // scans with most beams dazzled
  std::size_t dazzled = 0;  // scans with a cone of dazzled beams
};

void add(const algo::LaserScan& scan, Tally& tally) {
  std::vector<double> ranges;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const bool ok = scan.status[i] == algo::Beam::Ok;
    ranges.push_back(ok ? scan.ranges[i] : scan.range_max);
    tally.readings += ok ? 1U : 0U;
  }
  const algo::BeamSpan cone = algo::widest_cone(scan);
  ++tally.scans;
  tally.beams += scan.size();
  tally.spikes += count_spikes(ranges);
  tally.blinded += algo::blinded(scan) ? 1U : 0U;
  tally.dazzled += cone.end > cone.begin ? 1U : 0U;
}

/// Checks whether a robot could drive by these scans.
bool look_at_dazzle(const Tally& tally, Notes& notes) {
  constexpr const char* kAdvice =
      "Keep the sun, lamps and other scanners out of its sight; look at its window.";
  if (tally.blinded > 0) {
    notes.bad(
        fmt::format(
            "It is blinded: {} of {} scans have almost no distances.", tally.blinded, tally.scans),
        kAdvice);
  } else if (tally.dazzled > 0) {
    notes.bad(fmt::format("It is dazzled: {} of {} scans have a cone without distances.",
                          tally.dazzled,
                          tally.scans),
              kAdvice);
  }
  return tally.blinded == 0 && tally.dazzled == 0;
}

void look_at_scans(drivers::lms200::Lms200Device& laser,
                   const DoctorOptions& options,
                   Notes& notes) {
  const drivers::lms200::LaserReport before = laser.details();
  algo::LaserScan scan;
  Tally tally;
  const double begun = steady_now();
  while (steady_now() < begun + options.measuring) {
    pause(options);
    if (laser.take(scan)) add(scan, tally);
  }
  const drivers::lms200::LaserReport after = laser.details();
  const double rate = static_cast<double>(after.scans - before.scans) / (steady_now() - begun);
  const double wanted = 1 / after.nominal_period;
  if (rate < 0.95 * wanted) {
    notes.bad(fmt::format("{:.1f} scans a second arrive instead of {:.1f}.", rate, wanted),
              "Look at the cable and its shield, and what else this computer does.");
  } else {
    notes.well(fmt::format("{:.1f} scans a second.", rate));
  }
  const std::uint64_t damaged =
      after.line.bad_checks + after.line.given_up - before.line.bad_checks - before.line.given_up;
  if (damaged > 0) {
    notes.note(
        fmt::format(
            "{} of {} telegrams were damaged.", damaged, damaged + after.scans - before.scans),
        "A longer or unshielded cable does that; so does a computer that is busy.");
  }
  if (tally.beams == 0 || !look_at_dazzle(tally, notes)) return;
  const double percent =
      100.0 * static_cast<double>(tally.readings) / static_cast<double>(tally.beams);
  if (percent < 5) {
    notes.note(fmt::format("Only {:.0f} % of the beams have a distance within range.", percent),
               "Is the window covered, or the room larger than the range?");
  } else {
    notes.well(fmt::format("{:.0f} % of the beams have a distance within range.", percent));
  }
  const double per_scan = static_cast<double>(tally.spikes) / static_cast<double>(tally.scans);
  if (per_scan > 2) {
    notes.note(fmt::format("{:.1f} beams per scan differ from both neighbours.", per_scan),
               "Clean the window; look for dust, sun and mirrors.");
  } else {
    notes.well(fmt::format("{:.1f} beams per scan differ from both neighbours.", per_scan));
  }
}

bool look_at_laser(const drivers::LaserEntry& entry,
                   const DoctorOptions& options,
                   const Found& found) {
  Notes notes(entry.name, found);
  if (!look_at_port(entry.port, entry.setup.baud, notes)) return false;
  drivers::lms200::Lms200Device laser(entry.name, entry.port, entry.setup);
  const bool runs = laser.comes_to_run(options.patience, options.interrupted);
  const drivers::lms200::LaserReport report = laser.details();
  pause(options);
  if (!runs) {
    notes.bad(report.trouble,
              fmt::format("After power-on a scanner takes up to 60 s: --patience 70 waits for it "
                          "(now {:.0f} s).",
                          options.patience));
    return false;
  }
  notes.well(fmt::format("{} found at {} bit/s, address {}, software {}.",
                         report.type,
                         report.baud,
                         report.address,
                         report.software));
  notes.well(fmt::format("{} degrees in steps of {:.2f}, {}, measuring mode {:02x}.",
                         report.variant.angle_degrees,
                         report.variant.step_centidegrees / 100.0,
                         report.in_millimetres ? "millimetres" : "centimetres",
                         report.measuring_mode));
  if (report.written > 0) notes.note("Its configuration differed and was written.");
  for (const std::string& remark : report.remarks) notes.note(remark);
  if (const std::string health = health_text(report.health); !health.empty()) {
    if (report.health.usable()) {
      notes.note(health, "Clean the window, then look again.");
    } else {
      notes.bad(health, "Switch it off and on; if it stays, read its error memory.");
    }
  }
  look_at_scans(laser, options, notes);
  return notes.all_well();
}

void look_at_published(const drivers::PublishedEntry& published, const Found& found) {
  const auto tell = [&](const char* name) {
    Notes(name, found)
        .note(
            "A process beside the robot publishes its readings to the server, where the page "
            "shows how old they are; they cannot be checked here.");
  };
  if (published.inclinometer) tell(drivers::PublishedSenses::kInclinometer);
  if (published.line) tell(drivers::PublishedSenses::kCamera);
}

/// [bit/s] 0 where the base has no serial line.
unsigned baud_of(const drivers::BaseEntry& entry) {
  if (const auto* pioneer = std::get_if<drivers::p2os::PioneerSetup>(&entry.setup)) {
    return pioneer->baud;
  }
  if (const auto* roboteq = std::get_if<drivers::roboteq::RoboteqSetup>(&entry.setup)) {
    return roboteq->baud;
  }
  return 0;
}

/// Distances commanded and reported [m], forward positive, and the turn reported [rad].
struct Drive {
  double told = 0;
  double came = 0;
  double turned = 0;
};

Drive drive_for_a_second(drivers::Base& base, double speed, const DoctorOptions& options) {
  const algo::Pose2 before = base.state().pose;
  const double begun = steady_now();
  while (steady_now() < begun + 1.0) {
    const drivers::BaseState state = base.state();
    if (state.stop_button || state.bumper_front || state.bumper_rear || !state.running) break;
    base.drive({speed, 0});
    pause(options);
  }
  base.drive({});  // brakes along the driving ramp
  const double told = speed * (steady_now() - begun);
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  const algo::Pose2 after = base.state().pose;
  const algo::Vec2 way = after.position() - before.position();
  return {.told = told,
          .came = way.dot(algo::direction(before.heading)),
          .turned = algo::wrap_angle(after.heading - before.heading)};
}

}  // namespace

/// The distance lost on the ramp at the start is regained on the ramp at the end.
bool drove_as_told(double told, double came) {
  constexpr double kTolerance = 0.2;  // of the distance; a wrong gear or wheel differs by more
  return std::abs(came - told) <= kTolerance * std::abs(told);
}

namespace {

void look_at_wheels(drivers::Base& base,
                    const drivers::RobotFile& file,
                    const DoctorOptions& options,
                    Notes& notes) {
  base.enable(true);
  const double until = steady_now() + 2.0;
  while (!base.state().motors_on && steady_now() < until) {
    base.stop();  // an analog base's relay closes only while ticks come
    pause(options);
  }
  if (!base.state().motors_on) {
    notes.bad("The motors do not switch on.", "Release the stop button; look at the motor power.");
    base.enable(false);
    return;
  }
  const double speed = std::min(0.05, file.limits.speed);
  const Drive ahead = drive_for_a_second(base, speed, options);
  const Drive back = drive_for_a_second(base, -speed, options);
  base.enable(false);
  const std::string ways =
      fmt::format("Commanded {:.0f} mm ahead and {:.0f} back, it reports {:.0f} and {:.0f} mm.",
                  1000 * ahead.told,
                  -1000 * back.told,
                  1000 * ahead.came,
                  -1000 * back.came);
  if (drove_as_told(ahead.told, ahead.came) && drove_as_told(back.told, back.came)) {
    notes.well(ways);
  } else {
    notes.bad(ways,
              "If the sign is wrong: reverse_left, reverse_right. If the size is wrong: "
              "wheel_radius, gear "
              "and encoder keys. If it reports no motion: the encoders' plugs.");
  }
  constexpr double kStraight = 0.05;  // [rad]
  if (std::max(std::abs(ahead.turned), std::abs(back.turned)) > kStraight) {
    notes.bad(fmt::format("Commanded to go straight, it turned by {:.2f} and {:.2f} rad.",
                          ahead.turned,
                          back.turned),
              "One wheel does not turn, or the two wheels' counts differ in scale.");
  }
}

bool look_at_base(const drivers::RobotFile& file,
                  const DoctorOptions& options,
                  const Found& found) {
  Notes notes("base", found);
  const drivers::BaseEntry& entry = file.base;
  const unsigned baud = baud_of(entry);
  if (baud != 0 && !look_at_port(entry.port, baud, notes)) return false;
  const std::unique_ptr<drivers::Base> opened = drivers::open_base(entry);
  drivers::Base& base = *opened;
  const double until = steady_now() + options.patience;
  while (!base.state().running && steady_now() < until) pause(options);
  const algo::DeviceReport report = base.report();
  const drivers::BaseState state = base.state();
  if (!state.running) {
    notes.bad(report.sentence,
              baud != 0 ? "Is it switched on? Is it the right cable, at the right port?"
                        : "`ls /dev/comedi*` shows the cards; docs/hardware.md has the keys of "
                          "their channels.");
    return false;
  }
  std::string facts;
  for (const auto& [name, value] : report.facts) {
    facts.append(facts.empty() ? "" : ", ").append(name).append(" ").append(value);
  }
  notes.well("Found: " + facts + ".");
  for (const std::string& remark : report.remarks) notes.note(remark);
  if (!report.well) notes.bad(report.sentence, "Clear its cause, then look again.");
  if (state.bumper_front || state.bumper_rear) {
    notes.bad("A bumper is pressed.", "Free it, or check its switch and plug.");
  }
  if (entry.battery_low > 0 && state.volts && *state.volts < entry.battery_low) {
    notes.bad(
        fmt::format("The battery has {:.1f} V, less than {:.1f}.", *state.volts, entry.battery_low),
        "Charge it.");
  }
  if (!options.move) {
    notes.note("The wheels were not turned.",
               "With the wheels off the floor: --move turns them for two seconds.");
  } else if (notes.all_well()) {
    look_at_wheels(base, file, options, notes);
  }
  return notes.all_well();
}

void look_at_system(const Found& found) {
  Notes notes("system", found);
  const drivers::RealTimeCheck check = drivers::check_real_time();
  if (check.priority) {
    notes.well("Real-time priority is permitted.");
  } else {
    notes.note("The control loop gets no real-time priority.", drivers::priority_advice());
  }
  if (!check.memory) notes.note("The memory cannot be locked.", drivers::memory_advice());
  if (!check.preemptible_kernel) {
    notes.note(
        "This kernel is not PREEMPT_RT: a tick may be some milliseconds late.",
        "`apt install linux-image-rt-amd64` installs one; the page shows how late ticks are.");
  }
}

}  // namespace

std::size_t count_spikes(const std::vector<double>& ranges) {
  constexpr double kAgree = 0.1;  // [m]
  constexpr double kAlone = 0.3;  // [m]
  std::size_t spikes = 0;
  for (std::size_t i = 1; i + 1 < ranges.size(); ++i) {
    const double left = ranges[i - 1];
    const double right = ranges[i + 1];
    if (std::abs(left - right) > kAgree) continue;
    if (std::abs(ranges[i] - (left + right) / 2) > kAlone) ++spikes;
  }
  return spikes;
}

bool examine(const drivers::RobotFile& file, const DoctorOptions& options, const Found& found) {
  for (const std::string& warning : file.warnings)
    found({Finding::Verdict::Note, "file", warning, ""});
  look_at_system(found);
  bool well = true;
  for (const drivers::LaserEntry& laser : file.lasers) {
    well = look_at_laser(laser, options, found) && well;
  }
  if (file.floor) well = doctor::look_at_floor_sensors(file, options, found) && well;
  look_at_published(file.published, found);
  return look_at_base(file, options, found) && well;
}

}  // namespace server
