// server/lab/reproduce/masuda_study.cpp: the paper's tables, and ours beside them.
#include "server/lab/reproduce/masuda_study.hpp"

#include <algorithm>
#include <cmath>

#include "algo/units.hpp"

namespace server::reproduce {
namespace {

using algo::GroundClass;
using algo::units::kRadiansPerDegree;

constexpr std::size_t kStaticTrials = 1000;
constexpr std::size_t kDrives = 100;
constexpr double kCm = 0.01;

/// A line as the paper prints it: true value, d1, mean, max, min, variance; d1 in cm.
struct Printed {
  double truth, d1, mean, max, min, variance;
  std::size_t window;
};

constexpr Printed kTable1[] = {
    {1.30, 0, 1.30, 1.45, 1.18, 0.0057, 5},
    {-1.30, 0, -1.33, -1.00, -1.56, 0.0019, 5},
};
constexpr Printed kTable2[] = {
    {20, 0, 17.00, 19.43, 15.87, 0.4648, 5},
    {20, 4, 18.90, 21.00, 17.49, 0.5608, 5},
    {20, 7, 20.47, 22.15, 17.39, 1.0129, 5},
    {15, 0, 14.70, 16.50, 13.01, 0.2176, 5},
    {15, 4, 15.29, 16.18, 14.24, 0.1210, 5},
    {15, 7, 16.09, 18.73, 12.80, 1.8943, 5},
    {10, 0, 9.68, 12.05, 7.74, 0.2426, 5},
    {10, 4, 10.29, 13.39, 7.84, 1.3552, 5},
    {10, 7, 10.82, 13.18, 9.26, 0.1617, 5},
    {20, 0, 16.90, 18.11, 16.46, 0.0951, 21},
    {20, 4, 19.69, 20.48, 18.85, 0.1100, 21},
    {20, 7, 19.25, 22.15, 18.44, 0.2841, 21},
    {15, 0, 14.57, 15.32, 12.96, 0.1041, 21},
    {15, 4, 14.76, 17.58, 13.54, 0.8732, 21},
    {15, 7, 15.46, 16.32, 14.83, 0.1287, 21},
    {10, 0, 9.80, 10.48, 9.11, 0.0630, 21},
    {10, 4, 9.89, 10.66, 8.21, 0.1137, 21},
    {10, 7, 9.40, 11.48, 8.59, 0.2549, 21},
};
/// A window of 0: NA in print.
constexpr Printed kTable3[] = {
    {-20, 10, -19.91, -13.72, -23.23, 2.0619, 21},
    {-20, 5, -18.90, -10.42, -25.41, 7.6875, 21},
    {-20, 2, -18.37, -10.35, -27.16, 10.2642, 21},
    {-15, 10, -14.56, -10.12, -18.02, 1.4096, 21},
    {-15, 5, -14.23, -10.02, -21.70, 3.7594, 21},
    {-15, 2, -14.46, -10.04, -19.76, 4.3537, 21},
    {-10, 10, -10.58, -7.55, -13.66, 1.4499, 21},
    {-10, 5, 0, 0, 0, 0, 0},
    {-10, 2, 0, 0, 0, 0, 0},
};

/// A line of Tables IV-VI, with the band of equations.md H.
struct PrintedDrive {
  const char* table;
  GroundClass kind;
  double truth;
  std::size_t success;
  double mean, max, min, variance;
  std::size_t least, most;
  double off;
};
constexpr PrintedDrive kTables4To6[] = {
    {"IV", GroundClass::SlopeDown, -20, 100, -20.00, -18.26, -24.06, 0.9255, 98, 100, 4},
    {"IV", GroundClass::SlopeDown, -10, 100, -12.71, -11.44, -13.98, 0.2614, 98, 100, 2.5},
    {"IV", GroundClass::SlopeUp, 10, 100, 10.27, 10.91, 9.52, 0.0748, 98, 100, 2.5},
    {"IV", GroundClass::SlopeUp, 20, 100, 21.35, 22.26, 20.09, 0.1678, 98, 100, 2.5},
    {"V", GroundClass::StepUp, 1.30, 100, 1.37, 1.47, 1.17, 0.0017, 98, 100, 0.2},
    {"V", GroundClass::StepDown, -1.30, 100, -1.21, -1.11, -1.33, 0.0022, 98, 100, 0.2},
    {"VI", GroundClass::Trench, 1.30, 55, -0.94, -0.85, -1.26, 0.0098, 30, 85, 0},
    {"VI", GroundClass::Trench, 2.00, 90, -1.67, -1.24, -2.32, 0.0310, 85, 100, 0},
};

bool is_slope(GroundClass kind) {
  return kind == GroundClass::SlopeUp || kind == GroundClass::SlopeDown;
}

/// SI to the paper's units, and back.
double unit_of(GroundClass kind) {
  return is_slope(kind) ? kRadiansPerDegree : kCm;
}

MasudaSpread in_paper_units(std::vector<double> values, GroundClass kind) {
  for (double& each : values) each /= unit_of(kind);
  return spread_of(values);
}

MasudaRow static_row(const char* table, GroundClass kind, const Printed& line) {
  MasudaRow row{.table = table,
                .ground = {.kind = kind, .size = line.truth * unit_of(kind)},
                .d1 = line.d1,
                .window = line.window == 0 ? 21 : line.window,
                .truth = line.truth};
  if (line.window != 0) {
    row.paper = MasudaSpread{kStaticTrials, line.mean, line.max, line.min, line.variance};
  }
  const auto run = [&](bool literal) {
    const MasudaReading reading{.literal = literal, .window = row.window};
    return in_paper_units(static_trials(row.ground, line.d1 * kCm, reading, kStaticTrials, 1),
                          kind);
  };
  row.ours = run(false);
  row.literal = run(true);
  return row;
}

MasudaRow driven_row(const PrintedDrive& line) {
  MasudaRow row{.table = line.table,
                .ground = {.kind = line.kind, .size = line.truth * unit_of(line.kind)},
                .truth = line.truth,
                .paper = MasudaSpread{line.success, line.mean, line.max, line.min, line.variance},
                .paper_success = line.success,
                .least = line.least,
                .most = line.most,
                .off = line.off};
  const auto run = [&](bool literal, std::size_t& success) {
    std::vector<double> values;
    for (std::uint64_t seed = 1; seed <= kDrives; ++seed) {
      const MasudaDrive drive = drive_over(row.ground, {.literal = literal}, seed);
      if (drive.found != line.kind) continue;
      ++success;
      values.push_back(drive.value);
    }
    return in_paper_units(std::move(values), line.kind);
  };
  row.ours = run(false, row.success);
  row.literal = run(true, row.literal_success);
  return row;
}

}  // namespace

bool MasudaRow::holds() const {
  if (!driven()) return true;
  if (success < least || success > most) return false;
  if (off == 0) return true;
  return std::abs(ours.max - truth) <= off && std::abs(ours.min - truth) <= off;
}

MasudaStudy study_masuda() {
  MasudaStudy study;
  for (const Printed& line : kTable1) {
    const GroundClass kind = line.truth > 0 ? GroundClass::StepUp : GroundClass::StepDown;
    study.rows.push_back(static_row("I", kind, line));
  }
  for (const Printed& line : kTable2) {
    study.rows.push_back(static_row("II", GroundClass::SlopeUp, line));
  }
  for (const Printed& line : kTable3) {
    study.rows.push_back(static_row("III", GroundClass::SlopeDown, line));
  }
  for (const PrintedDrive& line : kTables4To6) study.rows.push_back(driven_row(line));
  for (std::uint64_t seed = 1; seed <= kDrives; ++seed) {
    if (drive_over({}, {}, seed).alarm) ++study.flat_alarms;
  }
  study.step = trace_over({.kind = GroundClass::StepUp, .size = 0.018}, -0.25, 0.1, 1);
  study.slope =
      trace_over({.kind = GroundClass::SlopeDown, .size = -20 * kRadiansPerDegree}, -0.25, 0.1, 1);
  for (const double degrees : {10.0, 20.0, 30.0}) {
    const MasudaGround trench{
        .kind = GroundClass::Trench, .size = 0.02, .skew = degrees * kRadiansPerDegree};
    study.trenches.push_back(trace_over(trench, -0.25, 0.15, 1));
  }
  study.claims = judge_masuda(study);
  return study;
}

bool all_hold(const MasudaStudy& study) {
  return study.flat_alarms == 0 && std::ranges::all_of(study.rows, &MasudaRow::holds);
}

}  // namespace server::reproduce
