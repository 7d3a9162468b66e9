// server/lab/reproduce/arm_document.cpp: the study of the arm as tables, for the terminal, as
// Markdown and as JSON.
#include <fmt/format.h>

#include "server/experiment/table.hpp"
#include "server/lab/reproduce/arm_study.hpp"
#include "server/lab/reproduce/marked.hpp"
#include "server/lab/reproduce/session_reach.hpp"
#include "server/run/text_file.hpp"

namespace server::reproduce {
namespace {

using experiment::Table;

constexpr Marks kArmMarks{"<!-- arm study: made by the program, not by hand -->\n",
                          "<!-- end of the arm study -->\n"};

std::string metres(double value) {
  return fmt::format("{:.3f}", value);
}

std::string counted(std::size_t value) {
  return fmt::format("{}", value);
}

Table strips_table(const ArmStudy& study) {
  return experiment::tabulated<BentStrip>(
      study.strips,
      2,
      {{"post before", [](const BentStrip& r) { return r.place; }},
       {"forces", [](const BentStrip& r) { return r.reading; }},
       {"clearance before [m]", [](const BentStrip& r) { return metres(r.before); }},
       {"after [m]", [](const BentStrip& r) { return metres(r.after); }},
       {"at configurations [m]", [](const BentStrip& r) { return metres(r.at_nodes); }},
       {"base along [m]", [](const BentStrip& r) { return metres(r.along); }},
       {"base across [m]", [](const BentStrip& r) { return metres(r.across); }},
       {"hand moved [m]", [](const BentStrip& r) { return fmt::format("{:.2f}", r.hand); }},
       {"returned to", [](const BentStrip& r) { return fmt::format("{:.0e}", r.returned); }},
       {"sweeps", [](const BentStrip& r) { return fmt::format("{}", r.sweeps); }}});
}

Table drives_table(const ArmStudy& study) {
  return experiment::tabulated<ArmDrive>(
      study.drives,
      3,
      {{"course", [](const ArmDrive& r) { return r.course; }},
       {"forces", [](const ArmDrive& r) { return r.reading; }},
       {"end", [](const ArmDrive& r) { return std::string(r.arrived ? "arrived" : "waits"); }},
       {"time [s]", [](const ArmDrive& r) { return fmt::format("{:.1f}", r.seconds); }},
       {"clearance [m]", [](const ArmDrive& r) { return metres(r.clearance); }},
       {"base across [m]", [](const ArmDrive& r) { return metres(r.across); }},
       {"hand moved [m]", [](const ArmDrive& r) { return fmt::format("{:.2f}", r.hand); }},
       {"waited [s]", [](const ArmDrive& r) { return fmt::format("{:.1f}", r.waits); }}});
}

Table trials_table(const ArmStudy& study) {
  return experiment::tabulated<ArmTrials>(
      study.trials,
      2,
      {{"things", [](const ArmTrials& r) { return r.kind; }},
       {"forces", [](const ArmTrials& r) { return r.reading; }},
       {"drives", [](const ArmTrials& r) { return fmt::format("{}", r.drives); }},
       {"arrived", [](const ArmTrials& r) { return fmt::format("{}", r.arrived); }},
       {"touched", [](const ArmTrials& r) { return fmt::format("{}", r.touched); }},
       {"under 0.05 m", [](const ArmTrials& r) { return fmt::format("{}", r.near); }},
       {"least clearance [m]", [](const ArmTrials& r) { return metres(r.clearance); }}});
}

Table reach_table(const ReachStudy& study) {
  std::vector<ReachTrials> rows = study.scenes;
  rows.push_back(study.all);
  return experiment::tabulated<ReachTrials>(
      rows,
      1,
      {{"goal", [](const ReachTrials& r) { return r.scene; }},
       {"worlds", [](const ReachTrials& r) { return counted(r.worlds); }},
       {"reached", [](const ReachTrials& r) { return counted(r.reached); }},
       {"touched", [](const ReachTrials& r) { return counted(r.touched); }},
       {"refused", [](const ReachTrials& r) { return counted(r.refused); }},
       {"given up", [](const ReachTrials& r) { return counted(r.given_up); }},
       {"straight motion touches",
        [](const ReachTrials& r) { return counted(r.straight_touched); }},
       {"least clearance [m]", [](const ReachTrials& r) { return metres(r.clearance); }},
       {"time [s]", [](const ReachTrials& r) { return fmt::format("{:.1f}", r.seconds); }},
       {"plans", [](const ReachTrials& r) { return fmt::format("{:.2f}", r.plans); }},
       {"hand off [m]", [](const ReachTrials& r) { return fmt::format("{:.4f}", r.hand_error); }}});
}

using Reason = std::pair<const std::string, std::size_t>;
Table reasons_table(const ReachStudy& study) {
  const std::vector<Reason> rows(study.why.begin(), study.why.end());
  return experiment::tabulated<Reason>(
      rows,
      1,
      {{"where the hand does not get there, the robot says",
        [](const Reason& r) { return r.first; }},
       {"worlds", [](const Reason& r) { return counted(r.second); }}});
}

Table arm_findings_table(const ArmStudy& study) {
  return experiment::tabulated<ArmFinding>(
      study.findings,
      3,
      {{"finding", [](const ArmFinding& f) { return f.claim; }},
       {"figures", [](const ArmFinding& f) { return f.figures; }},
       {"", [](const ArmFinding& f) { return std::string(f.holds ? "holds" : "FAILS"); }}});
}

}  // namespace

std::string to_text(const ReachStudy& study) {
  return fmt::format("{}\n{}\n",
                     experiment::to_text(reach_table(study)),
                     experiment::to_text(reasons_table(study)));
}

nlohmann::json to_json(const ReachStudy& study) {
  return {{"reaches", experiment::to_json(reach_table(study))},
          {"reasons", experiment::to_json(reasons_table(study))}};
}

std::string to_text(const ArmStudy& study) {
  return fmt::format(
      "An arm carried past posts: the elastic strip of arm and "
      "base\n\n{}\n{}\n{}\n{}\n{}\n{}\n{}\n",
      experiment::to_text(strips_table(study)),
      experiment::to_text(drives_table(study)),
      experiment::to_text(trials_table(study)),
      experiment::to_text(reach_table(study.reach)),
      experiment::to_text(reasons_table(study.reach)),
      experiment::to_text(arm_findings_table(study)),
      all_hold(study) ? "Each finding holds." : "A finding FAILS.");
}

nlohmann::json to_json(const ArmStudy& study) {
  return {{"all_hold", all_hold(study)},
          {"strips", experiment::to_json(strips_table(study))},
          {"drives", experiment::to_json(drives_table(study))},
          {"trials", experiment::to_json(trials_table(study))},
          {"reaches", experiment::to_json(reach_table(study.reach))},
          {"reasons", experiment::to_json(reasons_table(study.reach))},
          {"findings", experiment::to_json(arm_findings_table(study))}};
}

std::string to_markdown(const ArmStudy& study, const std::string& pictures) {
  std::string out =
      fmt::format("## A post half way\n\n{}", experiment::to_markdown(strips_table(study)));
  out += fmt::format("![Both strips from above]({}/{})\n", pictures, kArmPicture);
  out += fmt::format("\n## Courses\n\n{}", experiment::to_markdown(drives_table(study)));
  out += fmt::format("## At random\n\n{}", experiment::to_markdown(trials_table(study)));
  out += fmt::format("## A hand among things\n\n{}{}",
                     experiment::to_markdown(reach_table(study.reach)),
                     experiment::to_markdown(reasons_table(study.reach)));
  out += fmt::format("## Findings\n\n{}", experiment::to_markdown(arm_findings_table(study)));
  while (out.ends_with("\n\n")) out.pop_back();
  return out;
}

void write_markdown(const ArmStudy& study, const std::filesystem::path& file) {
  const std::filesystem::path pictures = folder_beside(file, "pictures/reproduction");
  write_text(pictures / kArmPicture, draw(study));
  put_marked(file, kArmMarks, to_markdown(study, "pictures/reproduction"));
}

}  // namespace server::reproduce
