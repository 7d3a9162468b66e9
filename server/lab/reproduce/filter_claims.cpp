// server/lab/reproduce/filter_claims.cpp: tests each claim of chapter 3 against the figures, by a
// rule that is printed with the verdict.
#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

#include "server/lab/reproduce/filter_study.hpp"

namespace server {
namespace {

constexpr double kKept = 0.05;     // [beams] with less shift or blur an edge counts as kept
constexpr double kBlocked = 0.05;  // of an amplitude: below it blocked, above 1 - kBlocked passed
constexpr double kCheaper = 0.9;   // of the other filter's CPU time

const FilterFigures& figures_of(const std::vector<FilterFigures>& figures,
                                std::string_view filter) {
  const auto found = std::ranges::find(figures, filter, &FilterFigures::filter);
  if (found == figures.end()) throw std::logic_error("no figures of " + std::string(filter));
  return *found;
}

const SignalResult& signal_of(const FilterStudy& study, std::string_view filter, int half_width) {
  const auto found = std::ranges::find_if(study.signals, [&](const SignalResult& each) {
    return each.filter == filter && each.half_width == half_width;
  });
  if (found == study.signals.end()) throw std::logic_error("no signals of " + std::string(filter));
  return *found;
}

Verdict verdict(bool whole, bool part) {
  if (whole) return Verdict::Reproduced;
  return part ? Verdict::InPart : Verdict::NotReproduced;
}

/// A filter's results on a test signal for N = 1 and N = 2.
struct Pair {
  double n1 = 0, n2 = 0;
  double most() const { return std::max(n1, n2); }
  double least() const { return std::min(n1, n2); }
};

Pair both(const FilterStudy& study, std::string_view filter, double SignalResult::*figure) {
  return {signal_of(study, filter, 1).*figure, signal_of(study, filter, 2).*figure};
}

Claim reading_of_equation_1(const FilterStudy& study) {
  const double text = both(study, "pseudomedian", &SignalResult::step).n1;
  return {.source = "Nong 2008, Eq. 1",
          .sentence =
              "Equation 1 as printed (groups [i..N+1], i = 1..N) is the filter that the text "
              "describes (N+1 sliding groups of N+1).",
          .rule = "Reproduced when both give the same at a step, N = 1.",
          .found = fmt::format("At a step the printed form errs by {:.0f} % of its height, the "
                               "text's by {:.0f} %. We follow the text.",
                               100 * study.as_printed_step,
                               100 * text),
          .verdict = verdict(study.as_printed_step == text, false)};
}

Claim impulses_stay(const FilterStudy& study) {
  const Pair left = both(study, "pseudomedian", &SignalResult::single);
  const Pair median = both(study, "median", &SignalResult::single);
  return {
      .source = "Nong 2008, chapter 3",
      .sentence = "The pseudomedian filter does not completely remove impulses.",
      .rule = "Reproduced when something of a single impulse is left for N = 1 and 2.",
      .found = fmt::format("Left of a single impulse: {:.0f} % (N = 1), {:.0f} % (N = 2); by the "
                           "median {:.0f} %, {:.0f} %.",
                           100 * left.n1,
                           100 * left.n2,
                           100 * median.n1,
                           100 * median.n2),
      .verdict = verdict(left.least() > 0, left.most() > 0)};
}

Claim noises_removed_in_scenes(const FilterStudy& study) {
  double before = 0;
  double after = 0;
  double median = 0;
  for (const SceneResult& each : study.scenes) {
    before += figures_of(each.figures, "before").impulses;
    after += figures_of(each.figures, "pseudomedian").impulses;
    median += figures_of(each.figures, "median").impulses;
  }
  return {
      .source = "Nong 2008, Figs. 8-10",
      .sentence = "After the filter the noises have been removed (simulated scenes).",
      .rule = fmt::format("Values off the truth by more than {:.0f} mm: none left is reproduced, "
                          "at most half of them is in part.",
                          kImpulse_mm),
      .found = fmt::format("{:.0f} before, {:.0f} after the pseudomedian, {:.0f} after the median.",
                           before,
                           after,
                           median),
      .verdict = verdict(after == 0, after <= before / 2)};
}

Claim noises_removed_in_recordings(const FilterStudy& study) {
  std::string found;
  bool none_left = true;
  bool half_left = true;
  bool simulated = false;
  for (const RecordingResult& each : study.recordings) {
    const double before = figures_of(each.figures, "before").impulses;
    const double after = figures_of(each.figures, "pseudomedian").impulses;
    none_left = none_left && after == 0;
    half_left = half_left && after <= before / 2;
    simulated = simulated || each.simulated;
    found += fmt::format("{}{} N = {}: {:.2f} to {:.2f}",
                         found.empty() ? "" : "; ",
                         each.name,
                         each.half_width,
                         before,
                         after);
  }
  return {.source = "Nong 2008, Figs. 8-10",
          .sentence = fmt::format("After the filter the noises have been removed ({}).",
                                  simulated ? "simulated recording, no real ones given"
                                            : "recordings of a real scanner"),
          .rule =
              "Single-beam outliers per scan: none left is reproduced, at most half of them "
              "everywhere is in part.",
          .found = found + ".",
          .verdict = verdict(none_left, half_left)};
}

Claim edges_are_kept(const FilterStudy& study) {
  double shift = 0;
  double blur = 0;
  for (const SceneResult& each : study.scenes) {
    const FilterFigures& figures = figures_of(each.figures, "pseudomedian");
    shift = std::max(shift, figures.edge_shift.value_or(0));
    blur = std::max(blur, figures.edge_blur.value_or(0));
  }
  const Pair step = both(study, "pseudomedian", &SignalResult::step);
  return {
      .source = "chapter 3, Schulze 1990; our words",
      .sentence = "The pseudomedian filter preserves edges.",
      .rule = fmt::format("Reproduced when a step comes out exactly and the scenes' edges shift "
                          "and blur by less than {} beam; in part when only one holds.",
                          kKept),
      .found = fmt::format("Error at a step {:.0f} %; in the scenes edges shift by at most "
                           "{:.3f} beam and blur over {:.2f}.",
                           100 * step.most(),
                           shift,
                           blur),
      .verdict = verdict(step.most() == 0 && shift < kKept && blur < kKept,
                         step.most() == 0 || (shift < kKept && blur < kKept))};
}

Claim averages_do_neither(const FilterStudy& study) {
  bool all = true;
  bool some = false;
  std::string found;
  for (const std::string_view filter : {"mean", "midrange"}) {
    const Pair step = both(study, filter, &SignalResult::step);
    const Pair single = both(study, filter, &SignalResult::single);
    const bool neither = step.least() > 0 && single.least() > 0;
    all = all && neither;
    some = some || neither;
    found +=
        fmt::format("{}{}: {:.0f}, {:.0f} % of a step's height, {:.0f}, {:.0f} % of an impulse's",
                    found.empty() ? "" : "; ",
                    filter,
                    100 * step.n1,
                    100 * step.n2,
                    100 * single.n1,
                    100 * single.n2);
  }
  return {.source = "Schulze 1990, abstract",
          .sentence = "Mean and midrange neither preserve edges nor remove impulses.",
          .rule = "Reproduced when both err at a step and leave something of an impulse.",
          .found = found + " (N = 1, 2).",
          .verdict = verdict(all, some)};
}

Claim fast_oscillation_is_blocked(const FilterStudy& study) {
  const Pair ours = both(study, "pseudomedian", &SignalResult::fastest);
  const Pair median = both(study, "median", &SignalResult::fastest);
  const Pair slower = both(study, "pseudomedian", &SignalResult::slower);
  return {
      .source = "chapter 3, Schulze 1990; our words",
      .sentence = "The pseudomedian filter blocks a fast oscillation that the median lets pass.",
      .rule = fmt::format("An oscillation from beam to beam: less than {:.0f} % left and, by the "
                          "median, more than {:.0f} %; in part when only the first holds.",
                          100 * kBlocked,
                          100 * (1 - kBlocked)),
      .found = fmt::format("Left {:.0f}, {:.0f} % (N = 1, 2); by the median {:.0f}, {:.0f} %. Of "
                           "one half as fast {:.0f}, {:.0f} %.",
                           100 * ours.n1,
                           100 * ours.n2,
                           100 * median.n1,
                           100 * median.n2,
                           100 * slower.n1,
                           100 * slower.n2),
      .verdict =
          verdict(ours.most() < kBlocked && median.least() > 1 - kBlocked, ours.most() < kBlocked)};
}

Claim output_may_be_new(const FilterStudy& study) {
  double foreign = 0;
  double broken = 0;
  double median = 0;
  for (const SceneResult& each : study.scenes) {
    const FilterFigures& figures = figures_of(each.figures, "pseudomedian");
    foreign = std::max(foreign, figures.not_in_window);
    broken = std::max(broken, figures.not_whole);
    const FilterFigures& other = figures_of(each.figures, "median");
    median = std::max({median, other.not_in_window, other.not_whole});
  }
  return {
      .source = "chapter 3; our words",
      .sentence =
          "The result need not be one of the window's values nor an integer, as the "
          "median's is.",
      .rule =
          "Reproduced when some values are in no window and some are not whole millimetres, "
          "and none of the median's; in part when only some of it holds.",
      .found = fmt::format("In the worst scene {:.0f} % of the values are in no window, {:.0f} % "
                           "not whole millimetres; of the median's {:.0f} %.",
                           100 * foreign,
                           100 * broken,
                           100 * median),
      .verdict = verdict(foreign > 0 && broken > 0 && median == 0, foreign > 0 || broken > 0)};
}

Claim cheaper_than_a_median(const FilterStudy& study) {
  std::string found;
  std::size_t cheaper = 0;
  for (const CostResult& each : study.cost) {
    if (each.product < kCheaper) ++cheaper;
    if (each.textbook < kCheaper) ++cheaper;
    found += fmt::format("{}N = {}: {:.2f} tuned, {:.2f} plain",
                         found.empty() ? "" : "; ",
                         each.half_width,
                         each.product,
                         each.textbook);
  }
  return {
      .source = "chapter 3, Schulze 1990; our words",
      .sentence = "The pseudomedian filter costs less than a running median.",
      .rule = fmt::format("CPU time, pseudomedian / median, this program's tuned code and plain "
                          "textbook code: below {} everywhere is reproduced, somewhere in part.",
                          kCheaper),
      .found = found + ".",
      .verdict = verdict(cheaper == 2 * study.cost.size(), cheaper > 0)};
}

}  // namespace

std::vector<Claim> judge_claims(const FilterStudy& study) {
  return {reading_of_equation_1(study),
          impulses_stay(study),
          noises_removed_in_scenes(study),
          noises_removed_in_recordings(study),
          edges_are_kept(study),
          averages_do_neither(study),
          fast_oscillation_is_blocked(study),
          output_may_be_new(study),
          cheaper_than_a_median(study)};
}

}  // namespace server
