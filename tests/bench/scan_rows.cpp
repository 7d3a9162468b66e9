// tests/bench/scan_rows.cpp: the server's caster against Bullet's rays and the analytic oracle.
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "tests/bench/rooms.hpp"
#include "tests/bench/rows.hpp"
#include "tests/sim/bullet_room.hpp"
#include <benchmark/benchmark.h>
#include <fmt/core.h>

#include "sim/laser_model.hpp"

namespace bench {
namespace {

struct Bars {
  double floor = kNone;
  double stretch = kNone;
};
struct ScanCase {
  std::string row{};
  std::string name{};
  std::uint32_t obstacles = 0;
  double range_max = 0;
  Bars scan{};
};

std::vector<ScanCase> cases() {
  return {{"P1", "scan/20 8.191 m", 20, kNearRange, {100, 300}},
          {"P2", "scan/100 30 m", 100, kFarRange, {60, 150}},
          {"P3", "scan/1000 30 m", 1000, kFarRange, {15, 40}},
          {"P3", "scan/1000 8.191 m", 1000, kNearRange, {30, 90}}};
}

/// One world seen by our caster and by Bullet, from the same poses.
struct Bench {
  Bench(const ScanCase& about, std::size_t pose_count)
      : range_max(about.range_max),
        world(reference::room(about.obstacles)),
        poses(poses_in(world, about.obstacles, pose_count)),
        caster(caster_of(world)),
        bullet(world) {}

  void scan() {
    caster.cast(next(), half_turn(), range_max, ranges);
    benchmark::DoNotOptimize(ranges.data());
    benchmark::ClobberMemory();
  }
  void reference_scan() {
    const algo::Pose2& pose = next();
    for (std::size_t i = 0; i < kBeams; ++i) {
      ranges[i] = bullet.range(pose.position(), pose.heading + bearing(i), range_max);
    }
    benchmark::DoNotOptimize(ranges.data());
    benchmark::ClobberMemory();
  }
  const algo::Pose2& next() { return poses[turn = (turn + 1) % poses.size()]; }

  double range_max = 0;
  std::vector<algo::Obstacle> world;
  std::vector<algo::Pose2> poses;
  sim::RangeCaster caster;
  reference::BulletRoom bullet;
  std::vector<double> ranges = std::vector<double>(kBeams);
  std::size_t turn = 0;
};

/// Our beams and Bullet's agree to 0.1 mm; otherwise the oracle must agree with ours. Bullet adds
/// or misses a box about once in 7000 beams, and once in 800 where a beam passes dozens.
void check_against_bullet(Bench& bench, const std::string& row) {
  std::size_t off = 0;
  for (const algo::Pose2& pose : bench.poses) {
    bench.caster.cast(pose, half_turn(), bench.range_max, bench.ranges);
    for (std::size_t i = 0; i < kBeams; ++i) {
      const double angle = pose.heading + bearing(i);
      const double theirs = bench.bullet.range(pose.position(), angle, bench.range_max);
      if (std::abs(theirs - bench.ranges[i]) <= 1e-4) continue;
      ++off;
      require(reference::agrees(
                  bench.world, pose.position(), angle, bench.range_max, bench.ranges[i], 1e-4),
              fmt::format("{}: beam {} of a scan is {} m, Bullet says {}, the oracle neither",
                          row,
                          i,
                          bench.ranges[i],
                          theirs));
    }
  }
  const std::size_t beams = bench.poses.size() * kBeams;
  require(off <= 3 + beams / 200,
          fmt::format("{}: {} of {} beams differ from Bullet's", row, off, beams));
}

void time_scan(Pass& pass, const ScanCase& about) {
  Bench bench(about, pass.count<std::size_t>(256, 16));
  check_against_bullet(bench, about.row);
  const auto times =
      pass.time(about.row + about.name,
                {{"ours", [&] { bench.scan(); }}, {"bullet", [&] { bench.reference_scan(); }}});
  pass.add_ratio({.row = about.row,
                  .name = about.name,
                  .floor = about.scan.floor,
                  .stretch = about.scan.stretch},
                 times[0],
                 times[1]);
}

/// The sensor model's rolling, interlaced sweep with all its imperfections off, while the robot
/// drives a circle of 0.5 m; and the flat scan from the poses of the same circle.
class RollingScan {
 public:
  explicit RollingScan(const ScanCase& about)
      : bench_(about, 1), model_(laser(about.range_max), 1, 0), trail_(step(), 0.1) {
    for (const algo::Obstacle& obstacle : bench_.world) model_.add(obstacle);
    trail_.reset(at(0), 0);
    // The drive is not timed: its poses are made here, one after another.
    for (std::size_t k = 0; k < kAround; ++k)
      driven_.push_back(at(static_cast<double>(k + 1) * step()));
    drive();
    bench_.poses.clear();
    for (std::size_t i = 0; i < 256; ++i) {
      bench_.poses.push_back(at(kSweep * static_cast<double>(i)));
      aims_.push_back(aim(kSweep * static_cast<double>(i)));
    }
  }

  /// A sweep's time of driving, then the sweep.
  void rolling() {
    drive();
    benchmark::DoNotOptimize(model_.sense(time(), trail_, scan_));
    benchmark::ClobberMemory();
  }
  /// The cast alone, of rays aimed beforehand.
  void cast() {
    const Aim& aim = aims_[next_ = (next_ + 1) % aims_.size()];
    bench_.caster.cast_rolling(
        aim.reference_W, half_turn(), aim.rays, aim.spread, bench_.range_max, bench_.ranges);
    benchmark::DoNotOptimize(bench_.ranges.data());
    benchmark::ClobberMemory();
  }
  void flat() { bench_.scan(); }
  void bullet() { bench_.reference_scan(); }

  /// Every beam against the oracle from where the robot was when the beam left.
  void check(int sweeps, const std::string& row) {
    for (std::size_t k = 0; k < aims_.size(); k += aims_.size() / 4) check(aims_[k], row);
    for (int sweep = 0; sweep < sweeps; ++sweep) {
      drive();
      require(model_.sense(time(), trail_, scan_), row + ": no sweep after a sweep's time");
      for (std::size_t i = 0; i < scan_.size(); ++i) {
        const algo::Pose2 pose = trail_.at(scan_.beam_time(i));
        require(reference::agrees(bench_.world,
                                  pose.position(),
                                  pose.heading + scan_.angle(i),
                                  bench_.range_max,
                                  scan_.ranges[i],
                                  0.00051),
                fmt::format("{}: beam {} of rolling sweep {} is {} m, the oracle says otherwise",
                            row,
                            i,
                            sweep,
                            scan_.ranges[i]));
      }
    }
  }

 private:
  struct Aim {
    algo::Pose2 reference_W{};
    sim::Rays rays{};
    sim::RaySpread spread{};
  };
  static constexpr double kSweep = 2.0 / 75;    // [s]
  static constexpr std::uint64_t kSteps = 7;    // a sweep
  static constexpr std::size_t kAround = 1650;  // steps, 6.29 s
  static double step() { return kSweep / static_cast<double>(kSteps); }
  void check(const Aim& aim, const std::string& row) {
    std::vector<double> ranges(kBeams);
    bench_.caster.cast_rolling(
        aim.reference_W, half_turn(), aim.rays, aim.spread, bench_.range_max, ranges);
    for (std::size_t i = 0; i < kBeams; ++i) {
      const algo::Vec2 origin = algo::to_parent(aim.reference_W, {aim.rays.x[i], aim.rays.y[i]});
      const double angle = aim.reference_W.heading + std::atan2(aim.rays.uy[i], aim.rays.ux[i]);
      require(reference::agrees(bench_.world, origin, angle, bench_.range_max, ranges[i], 1e-4),
              fmt::format("{}: beam {} of a rolling cast is {} m, the oracle says otherwise",
                          row,
                          i,
                          ranges[i]));
    }
  }
  static sim::LaserConfig laser(double range_max) {
    sim::LaserConfig laser = sim::LaserConfig::ideal(0.5);
    laser.rolling = true;
    laser.height = kPlane;
    laser.range_max = range_max;
    return laser;
  }
  /// The pose on the circle, which takes kAround steps.
  static algo::Pose2 at(double time) {
    const double turned = 2 * std::numbers::pi * time / (static_cast<double>(kAround) * step());
    return {0.5 * std::sin(turned), 0.5 - 0.5 * std::cos(turned), algo::wrap_angle(turned)};
  }
  double time() const { return static_cast<double>(pushed_) * step(); }
  /// The rays of the sweep that begins at `begin`, in the frame of its middle.
  static Aim aim(double begin) {
    Aim aim;
    aim.reference_W = at(begin + kSweep / 2);
    aim.rays.resize(kBeams);
    const double c = std::cos(aim.reference_W.heading);
    const double s = std::sin(aim.reference_W.heading);
    for (std::size_t i = 0; i < kBeams; ++i) {
      const double turns =
          static_cast<double>(i % 2) + (bearing(i) + std::numbers::pi / 2) / (2 * std::numbers::pi);
      const algo::Pose2 pose = at(begin + turns * kSweep / 2);
      const algo::Vec2 d = pose.position() - aim.reference_W.position();
      const double turn = algo::wrap_angle(pose.heading - aim.reference_W.heading);
      const algo::Vec2 u = algo::direction(turn + bearing(i));
      aim.rays.x[i] = c * d.x() + s * d.y();
      aim.rays.y[i] = c * d.y() - s * d.x();
      aim.rays.ux[i] = u.x();
      aim.rays.uy[i] = u.y();
      aim.spread.shift = std::max(aim.spread.shift, d.norm());
      aim.spread.turn = std::max(aim.spread.turn, std::abs(turn));
    }
    return aim;
  }
  void drive() {
    for (std::uint64_t i = 0; i < kSteps; ++i) trail_.push(driven_[pushed_++ % kAround]);
  }

  Bench bench_;
  sim::LaserModel model_;
  sim::PoseTrail trail_;
  std::vector<algo::Pose2> driven_{};
  std::uint64_t pushed_ = 0;
  algo::LaserScan scan_{};
  std::vector<Aim> aims_{};
  std::size_t next_ = 0;
};

void time_rolling(Pass& pass, const ScanCase& about) {
  RollingScan scan(about);
  scan.check(about.obstacles > 100 ? pass.count(40, 2) : pass.count(200, 8), "P1r");
  const auto times = pass.time("P1r" + about.name,
                               {{"cast", [&] { scan.cast(); }},
                                {"sense", [&] { scan.rolling(); }},
                                {"flat", [&] { scan.flat(); }},
                                {"bullet", [&] { scan.bullet(); }}});
  Figure cast{.row = "P1r", .name = "rolling cast over flat, " + about.name, .floor = 0.4};
  cast.note = fmt::format("{:.0f}x Bullet's rays", times[3].seconds / times[0].seconds);
  pass.add_ratio(cast, times[0], times[2]);
  Figure sense{.row = "P1r", .name = "aimed and rounded too, " + about.name, .floor = 0.4};
  sense.note = fmt::format("{:.0f}x Bullet's rays", times[3].seconds / times[1].seconds);
  pass.add_ratio(sense, times[1], times[2]);
}

/// Moves one obstacle to and fro by 0.3 m and scans.
void time_edit(Pass& pass) {
  const ScanCase about{"P5", "scan after an edit, 100", 100, kFarRange, {40, 120}};
  Bench bench(about, pass.count<std::size_t>(256, 16));
  algo::Obstacle moved = bench.world[0];
  const double home = moved.pose_W.x;
  const auto shift = [&] { moved.pose_W.x = moved.pose_W.x == home ? home + 0.3 : home; };
  const auto edit = [&] { bench.caster.move(moved.id, moved.pose_W); };
  const auto reference_edit = [&] { bench.bullet.move(0, moved); };

  shift();
  edit();
  reference_edit();
  bench.world[0] = moved;
  check_against_bullet(bench, about.row);
  const auto times = pass.time(about.row,
                               {{"ours",
                                 [&] {
                                   shift();
                                   edit();
                                   bench.scan();
                                 }},
                                {"bullet", [&] {
                                   shift();
                                   reference_edit();
                                   bench.reference_scan();
                                 }}});
  pass.add_ratio({.row = about.row,
                  .name = about.name,
                  .floor = about.scan.floor,
                  .stretch = about.scan.stretch},
                 times[0],
                 times[1]);
}

/// Errors against the oracle: the beams that pass a silhouette closer than 0.01 degree may take
/// either side of it, every other one counts.
void accuracy(Pass& pass) {
  double worst = 0;
  std::size_t beams = 0;
  std::size_t within = 0;  // 1 mm
  std::size_t edges = 0;
  for (const std::uint32_t obstacles : {20U, 100U, 1000U}) {
    const auto world = reference::room(obstacles);
    sim::RangeCaster caster = caster_of(world);
    std::vector<double> ranges(kBeams);
    for (const algo::Pose2& pose : poses_in(world, obstacles, pass.count<std::size_t>(200, 8))) {
      caster.cast(pose, half_turn(), kFarRange, ranges);
      for (std::size_t i = 0; i < kBeams; ++i) {
        const double angle = pose.heading + bearing(i);
        const double truth = reference::range(world, pose.position(), angle, kFarRange);
        const double error = std::abs(truth - ranges[i]);
        ++beams;
        if (error > 1e-3 &&
            reference::agrees(world, pose.position(), angle, kFarRange, ranges[i], 1e-3)) {
          ++edges;
          continue;
        }
        worst = std::max(worst, error);
        if (error <= 1e-3) ++within;
      }
    }
  }
  const double share = 100 * static_cast<double>(within + edges) / static_cast<double>(beams);
  require(share >= 99.9, fmt::format("P4: only {:.3f} % of the beams are within 1 mm", share));
  pass.add(
      {.row = "P4",
       .name = "worst beam, W(20) W(100) W(1000)",
       .value = 1e3 * worst,
       .unit = "mm",
       .better = Better::Lower,
       .floor = 1,
       .stretch = 0.1,
       .note = fmt::format("{} beams, {:.4f} % within 1 mm, {} at a silhouette, none missed or "
                           "invented elsewhere",
                           beams,
                           share,
                           edges)});
}

}  // namespace

void scans(Pass& pass) {
  for (const ScanCase& about : cases()) time_scan(pass, about);
  for (const ScanCase& about : cases()) time_rolling(pass, about);
  accuracy(pass);
  time_edit(pass);
}

}  // namespace bench
