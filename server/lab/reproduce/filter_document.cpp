// server/lab/reproduce/filter_document.cpp: the study as tables, for the terminal and as Markdown.
#include <algorithm>

#include <fmt/format.h>

#include "server/experiment/table.hpp"
#include "server/lab/reproduce/filter_study.hpp"
#include "server/lab/reproduce/marked.hpp"

namespace server {
namespace {

constexpr reproduce::Marks kMarks{"<!-- filter study: made by the program, not by hand -->\n",
                                  "<!-- end of the filter study -->\n"};

using experiment::Table;

std::string percent(double share) {
  return fmt::format("{:.1f} %", 100 * share);
}
std::string or_dash(const std::optional<double>& value, std::string_view format) {
  return value ? fmt::format(fmt::runtime(format), *value) : "-";
}

using Figures = FilterFigures;
using experiment::TitledCell;

const TitledCell<Figures> kShift{"edge shift [beams]",
                                 [](const Figures& f) { return or_dash(f.edge_shift, "{:.3f}"); }};
const TitledCell<Figures> kBlur{"edge blur [beams]",
                                [](const Figures& f) { return or_dash(f.edge_blur, "{:.2f}"); }};
const TitledCell<Figures> kOscillation{
    "oscillation", [](const Figures& f) { return or_dash(f.oscillation, "{:.2f}"); }};
const TitledCell<Figures> kFilter{"filter", [](const Figures& f) { return f.filter; }};
const TitledCell<Figures> kForeign{"not in window",
                                   [](const Figures& f) { return percent(f.not_in_window); }};

Table scene_table(const SceneResult& result) {
  return experiment::tabulated<Figures>(
      result.figures,
      1,
      {kFilter,
       {"values > 50 mm off", [](const Figures& f) { return fmt::format("{:.0f}", f.impulses); }},
       {"of a spike left",
        [](const Figures& f) { return f.height_left ? percent(*f.height_left) : "-"; }},
       kShift,
       kBlur,
       kOscillation,
       kForeign,
       {"not whole mm", [](const Figures& f) { return percent(f.not_whole); }},
       {"RMS off [mm]", [](const Figures& f) { return or_dash(f.rms_mm, "{:.1f}"); }}});
}

Table recording_table(const RecordingResult& result) {
  return experiment::tabulated<Figures>(
      result.figures,
      1,
      {kFilter,
       {"outliers per scan", [](const Figures& f) { return fmt::format("{:.2f}", f.impulses); }},
       kShift,
       kBlur,
       kOscillation,
       kForeign,
       {"no whole step", [](const Figures& f) { return percent(f.not_whole); }}});
}

Table signal_table(const FilterStudy& study) {
  using Signal = SignalResult;
  return experiment::tabulated<Signal>(
      study.signals,
      1,
      {{"filter, N", [](const Signal& s) { return fmt::format("{}, {}", s.filter, s.half_width); }},
       {"one impulse", [](const Signal& s) { return percent(s.single); }},
       {"two adjacent", [](const Signal& s) { return percent(s.adjacent); }},
       {"two, one apart", [](const Signal& s) { return percent(s.apart); }},
       {"step", [](const Signal& s) { return percent(s.step); }},
       {"ramp", [](const Signal& s) { return percent(s.ramp); }},
       {"oscillation 1-1", [](const Signal& s) { return percent(s.fastest); }},
       {"oscillation 2-2", [](const Signal& s) { return percent(s.slower); }}});
}

Table noise_table(const FilterStudy& study) {
  Table out{.header = {"filter, N"}};
  for (const NoiseResult& each : study.noise) {
    const std::string column = fmt::format("{:.0f} % spoiled", 100 * each.spoiled);
    if (std::ranges::find(out.header, column) == out.header.end()) out.header.push_back(column);
    const std::string row =
        each.half_width == 0 ? each.filter : fmt::format("{}, {}", each.filter, each.half_width);
    auto found = std::ranges::find_if(out.rows, [&](const auto& r) { return r[0] == row; });
    if (found == out.rows.end()) found = out.rows.insert(out.rows.end(), {row});
    found->push_back(fmt::format("{:.2f} %", 100 * each.off));
  }
  return out;
}

Table cost_table(const FilterStudy& study) {
  Table out{.header = {"N", "tuned", "plain"}};
  for (const CostResult& each : study.cost) {
    out.rows.push_back({fmt::format("{}", each.half_width),
                        fmt::format("{:.2f}", each.product),
                        fmt::format("{:.2f}", each.textbook)});
  }
  return out;
}

std::string beams_with_spikes(const FilterScene& scene) {
  if (scene.spikes.empty()) return "no spikes";
  std::vector<std::size_t> beams;
  beams.reserve(scene.spikes.size());
  for (const Spike& spike : scene.spikes) beams.push_back(spike.beam);
  return fmt::format("{} at {}", beams.size() == 1 ? "spike" : "spikes", fmt::join(beams, ", "));
}

std::string scene_title(const FilterScene& scene) {
  return fmt::format("{}: N = {}, {}", scene.title, scene.half_width, beams_with_spikes(scene));
}

std::string recording_title(const RecordingResult& each) {
  return fmt::format("{}: {} scans of {} values, steps of {:.0f} mm, N = {}",
                     each.name,
                     each.scans,
                     each.beams,
                     each.step_mm,
                     each.half_width);
}

std::string about_recordings(const FilterStudy& study) {
  return study.example.simulated
             ? "No folder of recordings was given (--logs DIR), so a recording of our own scanner "
               "model stands in: 200 scans, all its faults on, 1 % of the beams each far too long "
               "and too short."
             : "A beam that met nothing within range counts as the greatest range, as for the "
               "product's filters; any other code of the device is excluded. An outlier is a beam "
               "more than 300 mm off the mean of its neighbours, which are within 150 mm of each "
               "other.";
}

/// The beams at which the pseudomedian of the flat layout differs from the truth: "186: 850".
std::string flat_changes(const SceneResult& flat) {
  std::vector<std::string> out;
  const std::vector<double>& after = flat.after_mm.at(1);
  for (std::size_t i = 0; i < after.size(); ++i) {
    if (after[i] != flat.scene.truth_mm[i]) out.push_back(fmt::format("{}: {:g}", i, after[i]));
  }
  return fmt::format("{}", fmt::join(out, ", "));
}

/// The filtered near spike of the first scene, as a sentence.
std::string phantom(const SceneResult& first) {
  const auto near = std::ranges::min_element(first.scene.spikes, {}, &Spike::mm);
  return fmt::format(
      "The near spike at beam {} of the first scene, {:.0f} mm where the surface is at {:.0f} mm, "
      "becomes a phantom obstacle at {:.0f} mm.",
      near->beam,
      near->mm,
      first.scene.truth_mm[near->beam],
      first.after_mm.at(1)[near->beam]);
}

constexpr std::string_view kAboutTable2 =
    "Table 2 of the thesis lists obstacles, N and windows, as in the scenes above. It has no "
    "results to compare with.";
constexpr std::string_view kAboutSignals =
    "The share of an impulse or an oscillation that remains, and the largest error at a step (as "
    "a share of its height) or in a ramp (as a share of its rise per beam).";
constexpr std::string_view kAboutCost =
    "CPU time, pseudomedian / median, over 360 values, alternating in one run. Tuned: this "
    "program's filters. Plain: Eq. 1 as written, and a sliding sorted window. The figures vary a "
    "little between runs and machines.";

}  // namespace

std::string to_text(const FilterStudy& study) {
  std::string out = "Chapter 3: the pseudomedian filter\n";
  for (const SceneResult& each : study.scenes) {
    out += fmt::format("\n{}\n{}", scene_title(each.scene), to_text(scene_table(each)));
  }
  out += fmt::format(
      "\nThe spikes of the first scene on a flat layout, left after the pseudomedian: "
      "{} (beam: mm)\n",
      flat_changes(study.flat));
  out += fmt::format("{}\n{}\n", phantom(study.scenes.front()), kAboutTable2);
  out += fmt::format("\nTest signals. {}\n{}", kAboutSignals, to_text(signal_table(study)));
  out +=
      fmt::format("\nSalt and pepper: values more than 50 mm off\n{}", to_text(noise_table(study)));
  out += fmt::format("\nRecordings. {}\n", about_recordings(study));
  for (const RecordingResult& each : study.recordings) {
    out += fmt::format("\n{}\n{}", recording_title(each), to_text(recording_table(each)));
  }
  out += fmt::format("\nCost. {}\n{}", kAboutCost, to_text(cost_table(study)));
  out += "\nVerdicts\n";
  for (const Claim& each : study.claims) {
    out += fmt::format("  {}: {} [{}]\n    {}\n    Rule: {}\n",
                       name(each.verdict),
                       each.sentence,
                       each.source,
                       each.found,
                       each.rule);
  }
  return out;
}

std::string to_markdown(const FilterStudy& study, const std::string& pictures) {
  std::string out = "## Chapter 3: the pseudomedian filter\n\n";
  out +=
      "The effect of the filter on a scan, compared with the median, our `lulu`, the mean and the "
      "midrange. Scenes, noise and the height of the spikes are our choice where the thesis gives "
      "none: a wall 4 m ahead between walls 2 m to either side, cylinders, 5 mm of noise in whole "
      "millimetres, spikes of 8000 mm and, on the obstacle, 200 mm.\n\n";
  out +=
      "Two sentences, on impulses and on the noises of the figures, are quoted from the thesis by "
      "our notes. The others are in our words; they are the properties by which the chapter, like "
      "Schulze (*Mathematical Properties of the Pseudomedian Filter*, University of Texas 1990), "
      "distinguishes these filters.\n\n";
  out += "| sentence | source | verdict | figures | rule |\n| --- | --- | --- | --- | --- |\n";
  for (const Claim& each : study.claims) {
    out += fmt::format("| {} | {} | **{}** | {} | {} |\n",
                       each.sentence,
                       each.source,
                       name(each.verdict),
                       each.found,
                       each.rule);
  }
  out += "\n### Figures 8 to 10\n";
  for (const SceneResult& each : study.scenes) {
    out += fmt::format("\n**{}**\n\n![{}]({}/filter-{}.svg)\n\n{}",
                       scene_title(each.scene),
                       each.scene.title,
                       pictures,
                       each.scene.name,
                       to_markdown(scene_table(each)));
  }
  out += fmt::format(
      "\nOscillation: RMS of the second difference on quiet stretches, after / before. The values "
      "that remain of the first scene's spikes after the pseudomedian, on a flat layout (3000 mm, "
      "1500 mm at 150..210), as beam: mm: {}. {}\n",
      flat_changes(study.flat),
      phantom(study.scenes.front()));
  out += fmt::format("\n### Test signals\n\n{} {}\n\n{}",
                     kAboutSignals,
                     kAboutTable2,
                     to_markdown(signal_table(study)));
  out += fmt::format(
      "\nSalt (8000) and pepper (0) on the flat layout, 500 scans of 360 values: share "
      "of values more than 50 mm off.\n\n{}",
      to_markdown(noise_table(study)));
  out += fmt::format("\n### Recordings\n\n{}\n", about_recordings(study));
  out += fmt::format("\n![A scan before and after]({}/filter-recording.svg)\n", pictures);
  for (const RecordingResult& each : study.recordings) {
    out += fmt::format("\n**{}**\n\n{}", recording_title(each), to_markdown(recording_table(each)));
  }
  out += fmt::format("\n### Cost\n\n{}\n\n{}", kAboutCost, to_markdown(cost_table(study)));
  return out;
}

void write_markdown(const FilterStudy& study, const std::filesystem::path& file) {
  reproduce::write_study(file, kMarks, study, draw(study));
}

}  // namespace server
