#include "server/lab/reproduce/arm_study.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "server/lab/reproduce/arm_course.hpp"

namespace server::reproduce {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr int kSweepsToRest = 6000;
constexpr int kBetween = 10;         // parts of the motion from one configuration to the next
constexpr double kArmTick = 0.05;    // [s]
constexpr double kDriveEnd = 60;     // [s]
constexpr double kAfterGoal = 5;     // [s] that the arm stays at its goal
constexpr double kEnough = 0.2;      // [m]
constexpr double kNoContact = 0.05;  // [m]
constexpr double kBaseStays = 0.01;  // [m]
constexpr double kComesBack = 0.01;  // [m, rad]
constexpr double kMostReached = 0.97;
constexpr double kHandThere = 0.005;  // [m]

/// The post's centre, in metres from the hand towards the base.
struct PostPlace {
  const char* name = "";
  double inside = 0;
};
constexpr PostPlace kPlaces[] = {{"hand", 0}, {"wrist", 0.15}, {"forearm", 0.25}};
constexpr std::string_view kPictured = "wrist";

double nodes_clearance(const algo::MobileArm& body,
                       const algo::BodyStrip& strip,
                       std::span<const algo::Solid> solids) {
  double least = kInfinite;
  for (const auto& frames : strip.frames()) {
    least = std::min(least, clearance(body, frames, solids).smallest());
  }
  return least;
}

/// Of the whole motion along the strip.
double motion_clearance(const algo::MobileArm& body,
                        const algo::BodyStrip& strip,
                        std::span<const algo::Solid> solids) {
  const auto q = strip.configurations();
  double least = kInfinite;
  for (std::size_t i = 0; i + 1 < q.size(); ++i) {
    for (int k = 0; k <= kBetween; ++k) {
      const algo::BodyJoints between = q[i] + (q[i + 1] - q[i]) * k / kBetween;
      least = std::min(least, clearance(body, body_frames(body, between), solids).smallest());
    }
  }
  return least;
}

algo::Vec3 hand_at(const algo::MobileArm& body, const algo::BodyJoints& q) {
  return body_frames(body, q).hand();
}

BentStrip bend(const ArmCarried& carried,
               const PostPlace& place,
               const ArmReading& reading,
               algo::BodyStrip& strip) {
  const std::array post{post_at({ArmCarried::kWay / 2, carried.hand_y + place.inside})};
  BentStrip row{.place = place.name, .reading = std::string(reading.name)};
  strip.lay(carried.path);
  row.before = motion_clearance(carried.body, strip, post);
  row.sweeps = strip.relax(post, kSweepsToRest);
  row.after = motion_clearance(carried.body, strip, post);
  row.at_nodes = nodes_clearance(carried.body, strip, post);
  for (std::size_t i = 0; i < strip.size(); ++i) {
    const algo::BodyJoints shift = strip.configurations()[i] - carried.path[i];
    row.along = std::max(row.along, std::abs(shift[0]));
    row.across = std::max(row.across, std::abs(shift[1]));
    row.hand = std::max(row.hand,
                        (strip.frames()[i].hand() - hand_at(carried.body, carried.path[i])).norm());
  }
  algo::BodyStrip freed = strip;
  freed.relax({}, kSweepsToRest);
  for (std::size_t i = 0; i < freed.size(); ++i) {
    const algo::BodyJoints off = freed.configurations()[i] - carried.path[i];
    row.returned = std::max(row.returned, off.cwiseAbs().maxCoeff());
  }
  return row;
}

ArmDrive drive(const ArmCarried& carried,
               std::vector<algo::Solid> solids,
               const ArmReading& reading) {
  ArmDrive row{.reading = std::string(reading.name), .clearance = kInfinite};
  // The courses compare forces: nobody gives way otherwise.
  algo::BodyFollower follower(carried.body, {}, reading.gains, {.gives_way = false});
  follower.begin(carried.path);
  algo::BodyJoints q = carried.path.front();
  double end = kDriveEnd;
  for (double time = 0; time < end; time += kArmTick) {
    const algo::BodyCommand command = follower.update(q, solids, kArmTick);
    if (command.state == algo::FollowState::Arrived && !row.arrived) {
      row.arrived = true;
      row.seconds = time;
      end = std::min(end, time + kAfterGoal);
    }
    if (command.state == algo::FollowState::Waits) row.waits += kArmTick;
    q = moved(q, command, kArmTick);
    for (algo::Solid& solid : solids) solid = solid.after(kArmTick);
    const auto frames = body_frames(carried.body, q);
    row.clearance = std::min(row.clearance, clearance(carried.body, frames, solids).smallest());
    row.across = std::max(row.across, std::abs(q[1]));
    algo::BodyJoints straight = carried.path.front();
    straight[0] = q[0];
    row.hand = std::max(row.hand, (frames.hand() - hand_at(carried.body, straight)).norm());
  }
  if (!row.arrived) row.seconds = kDriveEnd;
  return row;
}

ArmTrials try_random(const ArmCarried& carried,
                     ArmTrialKind kind,
                     const ArmReading& reading,
                     std::size_t drives) {
  ArmTrials row{.kind = std::string(words(kind)),
                .reading = std::string(reading.name),
                .drives = drives,
                .clearance = kInfinite};
  for (std::size_t k = 0; k < drives; ++k) {
    const ArmDrive one = drive(carried, random_solids(carried, kind, k), reading);
    if (one.arrived) ++row.arrived;
    if (one.clearance < 0) {
      ++row.touched;
    } else if (one.clearance < kNoContact) {
      ++row.near;
    }
    row.clearance = std::min(row.clearance, one.clearance);
  }
  return row;
}

bool ours(const std::string& reading) {
  return reading == arm_readings().back().name;
}

void judge_reach(const ReachTrials& all, std::vector<ArmFinding>& findings) {
  findings.push_back(
      {"The hand reaches at least 97 % of its goals",
       fmt::format("{} of {}", all.reached, all.worlds),
       static_cast<double>(all.reached) >= kMostReached * static_cast<double>(all.worlds)});
  findings.push_back({"No link touches anything on the way to them",
                      fmt::format("{} of {} touched", all.touched, all.worlds),
                      all.touched == 0});
  findings.push_back({"In half of these worlds the joints' straight motion touches something",
                      fmt::format("in {} of {}", all.straight_touched, all.worlds),
                      2 * all.straight_touched >= all.worlds});
  findings.push_back({"The hand is within 5 mm of the goals it reaches",
                      fmt::format("{:.4f} m at most", all.hand_error),
                      all.hand_error <= kHandThere});
}

void judge(ArmStudy& study) {
  double cleared = kInfinite;
  double printed = -kInfinite;
  double base = 0;
  double back = 0;
  for (const BentStrip& row : study.strips) {
    if (row.reading == arm_readings().front().name) printed = std::max(printed, row.after);
    if (!ours(row.reading)) continue;
    cleared = std::min(cleared, row.after);
    back = std::max(back, row.returned);
    if (row.place == kPlaces[0].name) base = std::max(row.along, row.across);
  }
  double moving = kInfinite;
  double touching = kInfinite;
  bool all_arrived = true;
  for (const ArmDrive& row : study.drives) {
    if (ours(row.reading)) {
      moving = std::min(moving, row.clearance);
      all_arrived = all_arrived && row.arrived;
    } else {
      touching = std::min(touching, row.clearance);
    }
  }
  std::size_t touched = 0;
  std::size_t drives = 0;
  for (const ArmTrials& row : study.trials) {
    if (!ours(row.reading)) continue;
    touched += row.touched;
    drives += row.drives;
  }
  study.findings = {
      {"Ours clears a post before hand, wrist and forearm by 0.2 m, also between configurations",
       fmt::format("at least {:.3f} m", cleared),
       cleared >= kEnough},
      {"Before a post at the hand the base moves by 1 cm at most",
       fmt::format("{:.4f} m", base),
       base <= kBaseStays},
      {"The strip returns once the post is gone",
       fmt::format("to {:.1e}", back),
       back <= kComesBack},
      {"Ours passes each course without a contact, by 0.05 m or more, and arrives",
       fmt::format("at least {:.3f} m", moving),
       moving >= kNoContact && all_arrived},
      {"Ours touches nothing at random",
       fmt::format("{} of {} drives touched", touched, drives),
       touched == 0},
      {"As printed, the post passes through the arm between configurations",
       fmt::format("at most {:.3f} m", printed),
       printed < 0},
      {"As printed, the arm touches something on a course",
       fmt::format("{:.3f} m", touching),
       touching < 0},
  };
  judge_reach(study.reach.all, study.findings);
}

}  // namespace

std::vector<ArmReading> arm_readings() {
  algo::BodyStripGains across;
  across.external_force = algo::ExternalForce::AcrossThePath;
  return {
      {"as printed", "forces at the joints, K_c 0.8, K_r 0.6", algo::printed_gains()},
      {"across", "forces at each link's nearest point, without the part along the path", across},
      {"ours", "forces out of the shadow along the path", algo::BodyStripGains{}}};
}

ArmStudy study_arm(std::size_t drives, std::size_t worlds) {
  ArmStudy study;
  const ArmCarried carried = carried_arm();
  const std::vector<ArmReading> readings = arm_readings();
  for (const PostPlace& place : kPlaces) {
    for (const ArmReading& reading : readings) {
      algo::BodyStrip strip(carried.body, reading.gains);
      study.strips.push_back(bend(carried, place, reading, strip));
      if (place.name != kPictured || reading.name == "across") continue;
      auto& pictured = study.pictured[ours(study.strips.back().reading) ? 1 : 0];
      pictured.assign(strip.frames().begin(), strip.frames().end());
    }
  }
  for (const ArmReading* reading : {&readings.front(), &readings.back()}) {
    for (const ArmCourse& course : arm_courses(carried)) {
      study.drives.push_back(drive(carried, course.solids, *reading));
      study.drives.back().course = course.name;
    }
    for (const ArmTrialKind kind :
         {ArmTrialKind::Standing, ArmTrialKind::Along, ArmTrialKind::Anywhere}) {
      study.trials.push_back(try_random(carried, kind, *reading, drives));
    }
  }
  study.reach = study_reach(worlds);
  judge(study);
  return study;
}

bool all_hold(const ArmStudy& study) {
  return std::ranges::all_of(study.findings, [](const ArmFinding& each) { return each.holds; });
}

}  // namespace server::reproduce
