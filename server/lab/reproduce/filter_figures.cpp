// server/lab/reproduce/filter_figures.cpp: the figures of the study, each from one pass over a
// scan.
#include "server/lab/reproduce/filter_figures.hpp"

#include <algorithm>
#include <cmath>

namespace server {
namespace {

/// Sums over many scans.
struct Tally {
  double edge_shift = 0, edge_blur = 0;
  std::size_t edges = 0;
  double wiggle_before = 0, wiggle_after = 0;  // squares of second differences
  std::size_t quiet = 0;
  std::size_t values = 0, foreign = 0, broken = 0;

  void write(FilterFigures& figures) const {
    if (edges > 0) {
      figures.edge_shift = edge_shift / static_cast<double>(edges);
      figures.edge_blur = edge_blur / static_cast<double>(edges);
    }
    if (quiet > 0 && wiggle_before > 0)
      figures.oscillation = std::sqrt(wiggle_after / wiggle_before);
    if (values > 0) {
      figures.not_in_window = static_cast<double>(foreign) / static_cast<double>(values);
      figures.not_whole = static_cast<double>(broken) / static_cast<double>(values);
    }
  }
};

double bend(std::span<const double> x, std::size_t i) {
  return x[i - 1] - 2 * x[i] + x[i + 1];
}

/// Counts values that are not in their window, and values between two steps of the device.
void count_made_up(std::span<const double> before,
                   std::span<const double> after,
                   std::span<const std::uint8_t> valid,
                   int half_width,
                   double step_mm,
                   Tally& tally) {
  for (std::ptrdiff_t c = 0; c < std::ssize(after); ++c) {
    const auto i = static_cast<std::size_t>(c);
    if (!valid.empty() && valid[i] == 0) continue;
    const std::ptrdiff_t from = std::max<std::ptrdiff_t>(0, c - half_width);
    const std::ptrdiff_t to = std::min(std::ssize(before), c + half_width + 1);
    ++tally.values;
    if (std::find(before.begin() + from, before.begin() + to, after[i]) == before.begin() + to) {
      ++tally.foreign;
    }
    const double steps = after[i] / step_mm;
    if (std::abs(steps - std::nearbyint(steps)) > kWholeTolerance) ++tally.broken;
  }
}

/// Judges the edge between samples i and i + 1 of `truth`; searches `reach` samples on either side.
void judge_edge(std::span<const double> truth,
                std::span<const double> after,
                std::size_t i,
                std::size_t reach,
                Tally& tally) {
  const double half = (truth[i] + truth[i + 1]) / 2;
  const double jump = std::abs(truth[i + 1] - truth[i]);
  const bool rises = truth[i + 1] > truth[i];
  const std::size_t first = i + 1 >= reach ? i + 1 - reach : 0;
  const std::size_t last = std::min(truth.size() - 1, i + reach);
  double shift = static_cast<double>(reach);  // if the edge is lost
  for (std::size_t k = first; k <= last; ++k) {
    if (std::abs(after[k] - truth[k]) > kEdgeTolerance * jump) tally.edge_blur += 1;
    if (k == last || (after[k] >= half) == rises || (after[k + 1] >= half) != rises) continue;
    const double crossing = static_cast<double>(k) + (half - after[k]) / (after[k + 1] - after[k]);
    shift = std::min(shift, std::abs(crossing - static_cast<double>(i) - 0.5));
  }
  tally.edge_shift += shift;
  ++tally.edges;
}

/// Samples whose window reaches no edge or corner of the truth.
std::vector<bool> smooth_samples(const FilterScene& scene, int half_width) {
  const std::vector<double>& truth = scene.truth_mm;
  std::vector<bool> smooth(truth.size(), true);
  const auto reach = 2 * static_cast<std::size_t>(half_width) + 1;
  for (std::size_t i = 1; i + 1 < truth.size(); ++i) {
    if (std::abs(bend(truth, i)) <= kImpulse_mm / 2) continue;
    for (std::size_t k = i - std::min(i, reach); k <= std::min(truth.size() - 1, i + reach); ++k) {
      smooth[k] = false;
    }
  }
  return smooth;
}

bool near_a_spike(const FilterScene& scene, std::size_t beam, int half_width) {
  return std::ranges::any_of(scene.spikes, [&](const Spike& spike) {
    const std::size_t away = std::max(beam, spike.beam) - std::min(beam, spike.beam);
    return away <= 2 * static_cast<std::size_t>(half_width) + 1;
  });
}

/// True if beams first .. first + count - 1 are valid and each is near the one before.
bool one_surface(const ScanValues& scan, std::size_t first, std::size_t count) {
  for (std::size_t k = first; k < first + count; ++k) {
    if (scan.valid[k] == 0) return false;
    if (k > first && std::abs(scan.mm[k] - scan.mm[k - 1]) > kLogFlat_mm) return false;
  }
  return true;
}

void judge_scan(const ScanValues& before, const ScanValues& after, int half_width, Tally& tally) {
  const std::size_t n = before.mm.size();
  // A second difference of the filtered scan depends on samples this far away.
  const auto reach = static_cast<std::size_t>(half_width) + 1;
  for (std::size_t i = 2; i + 2 < n; ++i) {
    if (i >= reach && i + reach < n && one_surface(before, i - reach, 2 * reach + 1)) {
      tally.wiggle_before += bend(before.mm, i) * bend(before.mm, i);
      tally.wiggle_after += bend(after.mm, i) * bend(after.mm, i);
      ++tally.quiet;
    }
    // Three beams on one surface, then three on another: an edge without an impulse.
    if (i + 3 < n && std::abs(before.mm[i + 1] - before.mm[i]) > kLogEdge_mm &&
        one_surface(before, i - 2, 3) && one_surface(before, i + 1, 3)) {
      judge_edge(before.mm, after.mm, i, 3, tally);
    }
  }
}

}  // namespace

FilterFigures judge_scene(const FilterScene& scene,
                          std::string_view filter,
                          std::span<const double> after_mm,
                          int half_width) {
  FilterFigures out{.filter = std::string(filter)};
  const std::vector<double>& truth = scene.truth_mm;
  const std::vector<bool> smooth = smooth_samples(scene, half_width);
  Tally tally;
  double squares = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const double off = after_mm[i] - truth[i];
    squares += off * off;
    if (smooth[i] && std::abs(off) > kImpulse_mm) out.impulses += 1;
    const bool inner = i > 0 && i + 1 < truth.size();
    if (inner && smooth[i] && !near_a_spike(scene, i, half_width)) {
      // The truth's own second difference is no oscillation.
      const double b = bend(scene.before_mm, i) - bend(truth, i);
      const double a = bend(after_mm, i) - bend(truth, i);
      tally.wiggle_before += b * b;
      tally.wiggle_after += a * a;
      ++tally.quiet;
    }
    if (i + 1 < truth.size() && std::abs(truth[i + 1] - truth[i]) > kEdge_mm) {
      judge_edge(truth, after_mm, i, 2 * static_cast<std::size_t>(half_width) + 1, tally);
    }
  }
  out.rms_mm = std::sqrt(squares / static_cast<double>(truth.size()));
  for (const Spike& spike : scene.spikes) {
    const double left = std::abs((after_mm[spike.beam] - truth[spike.beam]) /
                                 (scene.before_mm[spike.beam] - truth[spike.beam]));
    out.height_left = std::max(out.height_left.value_or(0), left);
  }
  count_made_up(scene.before_mm, after_mm, {}, half_width, 1, tally);
  tally.write(out);
  return out;
}

FilterFigures judge_recording(const Recording& recording,
                              const StudyFilter& filter,
                              int half_width) {
  FilterFigures out{.filter = std::string(filter.name)};
  algo::FilterScratch scratch;
  ScanValues after;
  Tally tally;
  std::size_t found = 0;
  for (const ScanValues& before : recording.scans) {
    after.mm.resize(before.mm.size());
    after.valid.resize(before.mm.size());
    filter.apply(before.mm, before.valid, half_width, scratch, after.mm, after.valid);
    found += outliers(after);
    judge_scan(before, after, half_width, tally);
    count_made_up(before.mm, after.mm, after.valid, half_width, recording.step_mm, tally);
  }
  out.impulses = static_cast<double>(found) / static_cast<double>(recording.scans.size());
  tally.write(out);
  return out;
}

std::size_t outliers(const ScanValues& scan) {
  std::size_t found = 0;
  for (std::size_t i = 1; i + 1 < scan.mm.size(); ++i) {
    if (scan.valid[i - 1] + scan.valid[i] + scan.valid[i + 1] != 3) continue;
    const double left = scan.mm[i - 1];
    const double right = scan.mm[i + 1];
    if (std::abs(left - right) > kLogAgree_mm) continue;
    if (std::abs(scan.mm[i] - (left + right) / 2) > kLogImpulse_mm) ++found;
  }
  return found;
}

}  // namespace server
