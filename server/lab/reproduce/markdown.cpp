// server/lab/reproduce/markdown.cpp: the text of docs/reproduction.md.
#include "server/lab/reproduce/markdown.hpp"

#include <fmt/format.h>

#include "server/lab/reproduce/full_strip.hpp"
#include "server/lab/reproduce/marked.hpp"
#include "server/lab/reproduce/pictures.hpp"
#include "server/run/text_file.hpp"

namespace server::reproduce {
namespace {

std::string conditions_text(const PaperConditions& common, const Study& study) {
  std::string text = fmt::format(
      "{} runs a row, seeds {} to {}. The published obstacle positions are lost; the layouts were "
      "designed so that the text of the thesis can hold. They show that a consistent reading "
      "exists, not that the claims hold for every layout.\n\n",
      study.seeds,
      study.first_seed,
      study.first_seed + study.seeds - 1);
  text += fmt::format(
      "**A, paper conditions.** Kinematic robot of 350 mm, one exact arc a tick; tick {:g} s{}; "
      "361 beams of 0.5 degree fired at once from the robot's centre, {:g} mm reach, uniform "
      "noise of +-{:g} mm on returns only, beams 31 to 329 used; {} filter, N = {}, replicated "
      "border; S = {:g} mm, d_safe = {:g} mm, heading gain {:g} /s, at most {:g} rad/s, arrival "
      "within {:g} mm, time limit {:g} x straight line / v_max. One condition differs from the "
      "file: ranges are whole millimetres, as the device gives them.\n\n",
      common.period,
      common.slow
          ? fmt::format(" ({:g} s at {:g} mm/s)", common.slow->period, common.slow->v_max * 1000)
          : "",
      common.range_max * kMillimetres,
      common.noise * kMillimetres,
      common.filter,
      common.filter_half_width,
      common.strip_step * kMillimetres,
      common.safety_distance * kMillimetres,
      common.heading_gain,
      common.max_turn_rate,
      common.arrival_radius * kMillimetres,
      common.time_limit_factor);
  if (!study.full.empty()) {
    text +=
        "**B, full simulator.** The same layouts and gains with the Bullet base (acceleration "
        "limits, wheels, odometry from encoders), the rolling LMS200 model and a tick of 26 ms. "
        "Nothing was tuned for it.\n\n";
  }
  return text +
         "Columns: outcomes over the runs; path, turning, via points and time are means; clearance "
         "is the least of all runs, hull to surface; *in circle* and *depth* are the longest time "
         "and the deepest intrusion of any run into the circle of d_safe about the robot's "
         "centre.\n";
}

std::string claims_text(const Study& study) {
  return "*Reproduced*: with Eq. 13-14 as printed (`modified_published`, or `modified_linear` "
         "without the second branch). *Only with our extension*: only with our continuous law "
         "(`modified_c1`) or our side choice (`modified`). *Not reproduced*: with no reading. "
         "Reaching means in every run; keeping the circle means without one tick inside it.\n\n" +
         to_markdown(claims_table(study));
}

std::string strip_text(const Study& study) {
  std::string text =
      "`strip`, our extension with many nodes, under the same conditions and with the same gains "
      "and top speeds. Cells: turning [rad] / bending [1e-3 rad2/mm] / time [s] as means, or the "
      "outcomes of the runs.\n\n";
  text += fmt::format("**A, paper conditions.** {}\n\n{}",
                      strip_sentences(strip_beside(study.strip, study.paper, study.least_depths)),
                      to_markdown(strip_table(study.strip, study.paper)));
  if (study.full.empty()) return text;
  return text + fmt::format(
                    "**B, full simulator.** {}\n\n{}",
                    strip_sentences(strip_beside(study.strip_full, study.full, study.least_depths)),
                    to_markdown(strip_table(study.strip_full, study.full)));
}

std::string pictures_text(const StudyFile& file, const std::string& folder) {
  std::string text = "Paths of the first run of each row of table A.\n\n";
  for (const sim::Scenario& scenario : file.scenarios) {
    text += fmt::format("**{}.** {}\n\n![The path of each reading in {}]({}/{}.svg)\n\n",
                        scenario.name,
                        scenario.description,
                        scenario.name,
                        folder,
                        scenario.name);
  }
  return text;
}

}  // namespace

std::vector<Section> study_sections(const StudyFile& file,
                                    const Study& study,
                                    const std::string& pictures) {
  std::vector<Section> sections;
  sections.push_back({"Conditions", conditions_text(file.conditions, study)});
  if (!study.claims.empty()) {
    sections.push_back({"Claims of the sources", claims_text(study)});
  }
  sections.push_back({"Table A: paper conditions", to_markdown(rows_table(study.paper))});
  if (!study.noise_free.empty()) {
    sections.push_back(
        {"Table A without noise, one run each", to_markdown(rows_table(study.noise_free))});
  }
  if (!study.full.empty()) {
    sections.push_back({"Table B: full simulator",
                        fmt::format("{} collisions in {} runs; none is expected.\n\n{}",
                                    collisions(study.full),
                                    runs(study.full),
                                    to_markdown(rows_table(study.full)))});
    sections.push_back({"Outcomes that differ between A and B",
                        study.differences.empty()
                            ? std::string("Nowhere.\n")
                            : to_markdown(differences_table(study.differences))});
  }
  sections.push_back({"The full strip compared with the readings", strip_text(study)});
  sections.push_back(
      {"Limits", checks_sentence(study.checks) + "\n\n" + to_markdown(checks_table(study.checks))});
  sections.push_back({"Pictures", pictures_text(file, pictures)});
  return sections;
}

Section sweeps_section(std::span<const Sweep> sweeps, std::size_t seeds) {
  Section section{.title = "Effect of the parameters"};
  section.body = fmt::format(
      "One parameter at a time under the conditions of table A, {} runs each.\n\n", seeds);
  for (const Sweep& sweep : sweeps) {
    section.body +=
        fmt::format("### {}\n\n*{}* **Verdict: {}.** {}\n\nRule: {}\n\nCells: {}.\n\n{}",
                    sweep.parameter,
                    sweep.claim,
                    sweep.verdict,
                    sweep.because,
                    sweep.rule,
                    sweep.legend,
                    to_markdown(sweep.table));
  }
  return section;
}

std::string to_markdown(std::span<const Section> sections) {
  std::string text =
      "# Reproduction\n\nWritten by `tautline reproduce --markdown`; do not edit. Which claims of "
      "the sources hold here, with which reading of their equations, and with which figures.\n";
  for (const Section& section : sections) {
    text += fmt::format("\n## {}\n\n{}", section.title, section.body);
    while (text.ends_with("\n\n")) text.pop_back();
  }
  return text;
}

void write_reproduction(const std::string& path,
                        const StudyFile& file,
                        const Study& study,
                        std::span<const Section> sections) {
  const std::filesystem::path pictures = folder_beside(path, kPictures);
  for (const sim::Scenario& scenario : file.scenarios) {
    write_text(pictures / (scenario.name + ".svg"),
               draw_paths(file.conditions, scenario, study.paper));
  }
  write_text(path, to_markdown(sections));
}

}  // namespace server::reproduce
