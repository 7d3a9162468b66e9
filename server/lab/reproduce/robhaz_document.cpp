// server/lab/reproduce/robhaz_document.cpp: the study as tables, for the terminal, as Markdown and
// as JSON.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "algo/teleop/speed_limit.hpp"
#include "algo/teleop/teleop_parameters.hpp"
#include "server/experiment/table.hpp"
#include "server/lab/reproduce/marked.hpp"
#include "server/lab/reproduce/robhaz_study.hpp"

namespace server::reproduce {
namespace {

using experiment::Table;
using nlohmann::json;

constexpr Marks kRobhazMarks{"<!-- robhaz study: made by the program, not by hand -->\n",
                             "<!-- end of the robhaz study -->\n"};

constexpr std::string_view kRule =
    "A wall is left, in front or right by the foot of the model, 45 degrees either side being in "
    "front. A, B, C, E, F, G and H hold over 1 s or more. D: four changes between more than 15 "
    "degrees left and right within 3 s. E: v_sprs loses a fifth. F: from 0.2 v_max to 0.05 v_max, "
    "no sample dropping by more than 0.1 v_max. G: w is w_d exactly, |w_d| reaches 0.1 w_max, and "
    "the hand is off by less than half of |w_d| on average. H: no sample at v_cmd <= 0.9 v_max has "
    "a w_d or a force about X, and 1 s of them is beside a wall within 2 D_ref.";

Table findings_table(const CourseRun& run, const std::vector<CourseFinding>& findings) {
  Table out{.header = {"section", "finding", "", "from s", "to s", "figures"}, .words = 6};
  for (const CourseFinding& each : findings) {
    const char* const verdict = each.holds ? "holds" : run.asserted ? "FAILS" : "does not hold";
    out.rows.push_back({each.section,
                        each.claim,
                        verdict,
                        fmt::format("{:.1f}", each.from),
                        fmt::format("{:.1f}", each.to),
                        each.figures});
  }
  return out;
}

Table verdicts_table(const RobhazStudy& study) {
  Table out{.header = {"section", "finding"}, .words = 2};
  for (const CourseRun& run : study.runs) out.header.push_back(run.reading);
  out.words = out.header.size();
  for (std::size_t row = 0; row < study.findings.front().size(); ++row) {
    const CourseFinding& first = study.findings.front()[row];
    std::vector<std::string>& line = out.rows.emplace_back();
    line = {first.section, first.claim};
    for (const auto& findings : study.findings) {
      line.push_back(findings[row].holds ? "holds" : "does not");
    }
  }
  return out;
}

/// What the hand felt in one run.
struct Feeling {
  double pushed = 0;     // share of the time with a force about Y
  double hardest = 0;    // of full force, about Y
  double sideways = 0;   // share of the time with a force about X
  double reversals = 0;  // [1/s] of that force while a wall is followed
};

Feeling feeling_of(const CourseRun& run) {
  Feeling out;
  double followed = 0;
  double last = 0;
  for (const CourseSample& s : run.samples) {
    if (s.force_forward != 0) ++out.pushed;
    out.hardest = std::max(out.hardest, std::abs(s.force_forward));
    if (s.force_left != 0) ++out.sideways;
    if (std::isfinite(s.w_d)) ++followed;
    if (s.force_left * last < 0) ++out.reversals;
    if (s.force_left != 0) last = s.force_left;
  }
  const double n = static_cast<double>(run.samples.size());
  out.pushed /= n;
  out.sideways /= n;
  if (followed > 0) out.reversals /= followed * algo::kTeleopPeriod;
  return out;
}

double least_clearance(const CourseRun& run) {
  return std::ranges::min_element(run.samples, {}, &CourseSample::clearance)->clearance;
}

Table force_table(const RobhazStudy& study) {
  Table out{.header = {"reading",
                       "force about Y, % of the time",
                       "hardest, of full",
                       "about X, % of the time",
                       "reversals about X in G [1/s]",
                       "least clearance [m]"}};
  for (const CourseRun& run : study.runs) {
    const Feeling felt = feeling_of(run);
    out.rows.push_back({run.reading,
                        fmt::format("{:.0f}", 100 * felt.pushed),
                        fmt::format("{:.2f}", felt.hardest),
                        fmt::format("{:.0f}", 100 * felt.sideways),
                        fmt::format("{:.1f}", felt.reversals),
                        fmt::format("{:.2f}", least_clearance(run))});
  }
  return out;
}

Table constants_table(const RobhazCourse& course) {
  Table out{.header = {"constant", "value"}, .words = 2};
  for (const algo::ParameterInfo* each : algo::kTeleopParameters) {
    const std::string unit = each->unit.empty() ? "" : fmt::format(" {}", each->unit);
    out.rows.push_back({std::string(each->name),
                        fmt::format("{:.4g}{}", course.scenario.parameters[*each], unit)});
  }
  const HandConfig& hand = course.hand;
  out.rows.push_back({"hand: time constant", fmt::format("{:g} s", hand.time_constant)});
  out.rows.push_back({"hand: gives way ahead",
                      fmt::format("{:g} of the travel at full force", hand.forward_compliance)});
  out.rows.push_back({"hand: gives way sideways", fmt::format("{:g}", hand.turn_compliance)});
  return out;
}

Table script_table(const RobhazCourse& course) {
  Table out{.header = {"from s", "forward", "turn"}};
  for (const Intention& each : course.script) {
    out.rows.push_back({fmt::format("{:g}", each.stamp),
                        fmt::format("{:g}", each.forward),
                        fmt::format("{:g}", each.turn)});
  }
  return out;
}

json sample_json(const CourseSample& s) {
  const auto number = [](double value) {
    return std::isfinite(value) ? json(value) : json(nullptr);
  };
  return {{"stamp", s.stamp},
          {"x", s.pose_W.x},
          {"y", s.pose_W.y},
          {"heading", s.pose_W.heading},
          {"clearance", number(s.clearance)},
          {"nearest", number(s.nearest)},
          {"rho", number(s.rho)},
          {"theta", number(s.theta)},
          {"v_sprs", number(s.v_sprs)},
          {"v_cmd", s.v_cmd},
          {"v", s.v},
          {"w_cmd", s.w_cmd},
          {"w_d", number(s.w_d)},
          {"w", s.w},
          {"q_offset_forward", number(s.q_offset_forward)},
          {"q_offset_left", number(s.q_offset_left)},
          {"dead_band_left", number(s.dead_band_left)},
          {"force_forward", number(s.force_forward)},
          {"force_left", number(s.force_left)}};
}

}  // namespace

std::string to_text(const RobhazStudy& study) {
  std::string out = "Park et al. 2005, Fig. 10 and 11: the indoor course\n";
  for (std::size_t k = 0; k < study.runs.size(); ++k) {
    const CourseRun& run = study.runs[k];
    out += fmt::format("\n{}: {}{}\n{}",
                       run.reading,
                       run.means,
                       run.asserted ? " (asserted)" : "",
                       to_text(findings_table(run, study.findings[k])));
  }
  out += fmt::format("\nThe hand\n{}", to_text(force_table(study)));
  out += fmt::format("\nFig. 12 and 13: turnover on a slope\n{}\n{}",
                     to_text(runs_table(study.turnover)),
                     to_text(findings_table(study.turnover)));
  out += all_hold(study) ? "\nEach asserted finding holds.\n" : "\nAn asserted finding FAILS.\n";
  return out;
}

json to_json(const RobhazStudy& study) {
  json out = {{"all_hold", all_hold(study)}, {"runs", json::array()}};
  for (std::size_t k = 0; k < study.runs.size(); ++k) {
    const CourseRun& run = study.runs[k];
    json findings = json::array();
    for (const CourseFinding& each : study.findings[k]) {
      findings.push_back({{"section", each.section},
                          {"claim", each.claim},
                          {"holds", each.holds},
                          {"from", each.from},
                          {"to", each.to},
                          {"figures", each.figures}});
    }
    json samples = json::array();
    for (const CourseSample& each : run.samples) samples.push_back(sample_json(each));
    out["runs"].push_back({{"reading", run.reading},
                           {"means", run.means},
                           {"asserted", run.asserted},
                           {"v_max", run.v_max},
                           {"w_max", run.w_max},
                           {"collided", run.collided},
                           {"findings", std::move(findings)},
                           {"samples", std::move(samples)}});
  }
  out["turnover"] = to_json(study.turnover);
  return out;
}

std::string to_markdown(const RobhazStudy& study, const std::string& pictures) {
  std::string out = fmt::format(
      "## Findings\n\n{}\n\n{}\nThe readings: ", kRule, to_markdown(verdicts_table(study)));
  for (const CourseRun& run : study.runs) {
    out += fmt::format(
        "*{}*: {}{}", run.reading, run.means, &run == &study.runs.back() ? ".\n" : "; ");
  }
  out += fmt::format("\n![The course and the paths]({}/{})\n", pictures, kCoursePicture);
  for (std::size_t k = 0; k < study.runs.size(); ++k) {
    const CourseRun& run = study.runs[k];
    out += fmt::format("\n### {}\n\n{}\n![The quantities of Fig. 10 and 11]({}/{})\n",
                       run.reading,
                       to_markdown(findings_table(run, study.findings[k])),
                       pictures,
                       picture_of(run));
  }
  out += fmt::format("\n### The hand\n\n{}\n### Constants\n\n{}\n{}",
                     to_markdown(force_table(study)),
                     to_markdown(constants_table(study.course)),
                     to_markdown(script_table(study.course)));
  out += "\n" + to_markdown(study.turnover, pictures);
  while (out.ends_with("\n\n")) out.pop_back();
  return out;
}

void write_markdown(const RobhazStudy& study, const std::filesystem::path& file) {
  write_study(file, kRobhazMarks, study, draw(study));
}

}  // namespace server::reproduce
