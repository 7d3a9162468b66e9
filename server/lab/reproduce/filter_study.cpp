// server/lab/reproduce/filter_study.cpp: runs every filter on the scenes and recordings.
#include "server/lab/reproduce/filter_study.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace server {
namespace {

SceneResult study(FilterScene scene) {
  SceneResult out;
  for (const StudyFilter& filter : study_filters_table()) {
    out.after_mm.push_back(filtered(filter, scene.before_mm, scene.half_width));
    out.figures.push_back(judge_scene(scene, filter.name, out.after_mm.back(), scene.half_width));
  }
  out.scene = std::move(scene);
  return out;
}

RecordingResult study(const Recording& recording, int half_width) {
  RecordingResult out{.name = recording.name,
                      .scans = recording.scans.size(),
                      .beams = recording.scans.front().mm.size(),
                      .step_mm = recording.step_mm,
                      .simulated = recording.simulated,
                      .half_width = half_width};
  for (const StudyFilter& filter : study_filters_table()) {
    out.figures.push_back(judge_recording(recording, filter, half_width));
  }
  return out;
}

Example pick_example(const Recording& recording, int half_width) {
  Example out{.name = recording.name, .simulated = recording.simulated, .half_width = half_width};
  out.before = *std::ranges::max_element(recording.scans, {}, outliers);
  for (const StudyFilter& filter : study_filters_table()) {
    ScanValues after = out.before;
    algo::FilterScratch scratch;
    filter.apply(out.before.mm, out.before.valid, half_width, scratch, after.mm, after.valid);
    out.after.push_back(std::move(after));
  }
  return out;
}

double as_printed_step() {
  std::vector<double> step(40, 0.0);
  std::fill(step.begin() + 20, step.end(), 1.0);
  const std::vector<double> after = pseudomedian_as_printed(step, 1);
  double worst = 0;
  for (std::size_t i = 0; i < step.size(); ++i) {
    worst = std::max(worst, std::abs(after[i] - step[i]));
  }
  return worst;
}

}  // namespace

FilterStudy study_filters(const FilterStudyOptions& options) {
  const std::vector<Recording> recordings =
      options.logs ? read_recordings(*options.logs) : std::vector{simulated_recording()};
  FilterStudy out;
  out.flat = study(flat_scene());
  for (FilterScene& scene : chapter_3_scenes()) out.scenes.push_back(study(std::move(scene)));
  out.as_printed_step = as_printed_step();
  out.signals = study_signals();
  out.noise = study_noise();
  for (const Recording& recording : recordings) {
    for (const int half_width : {1, 2}) out.recordings.push_back(study(recording, half_width));
  }
  out.example = pick_example(recordings.front(), 1);
  out.cost = study_cost();
  out.claims = judge_claims(out);
  return out;
}

std::string_view name(Verdict verdict) {
  constexpr std::array<std::string_view, 3> kNames{"reproduced", "only in part", "not reproduced"};
  return kNames.at(static_cast<std::size_t>(verdict));
}

}  // namespace server
