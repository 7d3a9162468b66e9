// server/lab/compare/document.cpp: the text around the tables, for the terminal and for Markdown.
#include <fmt/format.h>

#include "server/experiment/layouts.hpp"
#include "server/lab/compare/report.hpp"
#include "server/lab/reproduce/marked.hpp"
#include "server/run/text_file.hpp"

namespace server::compare {
namespace {

/// Marks the table of the worlds in controllers.md.
constexpr reproduce::Marks kWorlds{"<!-- worlds: made by tautline compare -->\n",
                                   "<!-- end of the worlds -->\n"};

std::string seeds_text(const Options& options, std::size_t seeds) {
  if (seeds == 1) return fmt::format("seed {}", options.first_seed);
  return fmt::format("seeds {} to {}", options.first_seed, options.first_seed + seeds - 1);
}

std::string worlds_text(const Options& options) {
  return fmt::format(
      "Bullet vehicle, rolling LMS200, the scenarios' own settings, {} of each row; rows by sonar "
      "have a ring of 24 instead of the scanner. A cell is mean seconds / least clearance of the "
      "hull in metres if every run reached the goal, otherwise the outcomes of the runs.",
      seeds_text(options, options.seeds));
}

constexpr const char* kDetails =
    "Time, path and rest are means, the clearance is the least of all runs. Standing is time at "
    "rest, neither driving nor turning, including the end of a stuck run. A pause is a rest of "
    "0.1 s or more after which the robot drives on.";

std::string bottlenecks_text(const Options& options) {
  return fmt::format(
      "A closed hall, 10 m by 8 m, divided by a wall with one gap in the middle of the straight "
      "path of 6 m to the goal; hull 0.7 m, at most 0.3 m/s, K_r 0.6, {} of each row. Unlike "
      "posts, a wall leaves no way around: a run that reaches the goal has passed the gap. r "
      "reached, s stuck, t out of time, C collided; one letter if every run ends so. *Passes "
      "from*: the narrowest gap such that it and every wider one is passed in every run. The line "
      "to the goal is free, so go_to_goal shows what obstacle avoidance costs here.",
      seeds_text(options, options.seeds));
}

std::string layouts_text(const Options& options) {
  return fmt::format(
      "Layouts with free gaps of {:g} m and more between surfaces and {:g} m around start and "
      "goal; {} layouts of each kind, {} of each. Their distribution is our choice: start, goal "
      "(5 m, 4 m) and 0.1 m/s of case 3; cylinders of 0.25 to 0.4 m radius and boxes of 0.5 to "
      "0.8 m at any heading, equally likely, with centres up to 2 m from the line; at least one "
      "stands in the robot's straight path. Paper conditions as in the reproduction; `strip` also "
      "in the full simulator.",
      experiment::kFreeGap,
      experiment::kFreeRoom,
      options.layouts,
      seeds_text(options, options.layout_seeds));
}

constexpr const char* kBeside =
    "Layouts that the original strip and the other controller both reach with every seed. Among "
    "them, those where the original enters the safety circle, and those where the other keeps out "
    "of it, turns less, or is faster:";

std::string set_title(const LayoutSet& set) {
  return fmt::format("{} obstacles, K_r {:g}", set.obstacles, set.repulsion_gain);
}

std::string strip_sentence(const std::vector<LayoutSet>& sets) {
  const LayoutResult strip = strip_on_layouts(sets);
  return fmt::format(
      "`strip`: {} of {} runs reached, {} collided. At least 99 % and no collision: {}.",
      strip.reached,
      strip.runs,
      strip.collided,
      strip.held() ? "held" : "NOT held");
}

}  // namespace

std::string to_text(const Comparison& comparison) {
  std::string text;
  if (!comparison.worlds.empty()) {
    text += fmt::format("The papers' worlds. {}\n\n{}\n{}\n\n{}\n",
                        worlds_text(comparison.options),
                        to_text(worlds_table(comparison)),
                        kDetails,
                        to_text(details_table(comparison)));
  }
  if (!comparison.bottlenecks.empty()) {
    text += fmt::format("Bottlenecks. {}\n\n{}\n",
                        bottlenecks_text(comparison.options),
                        to_text(bottlenecks_table(comparison)));
  }
  for (const Finding& each : comparison.findings) {
    text += fmt::format(
        "{}\n  {}. {}\n  Rule: {}\n\n", each.claim, name(each.verdict), each.because, each.rule);
  }
  if (!comparison.layouts.empty()) {
    text += fmt::format("Random layouts. {}\n\n", layouts_text(comparison.options));
  }
  for (const LayoutSet& set : comparison.layouts) {
    text += fmt::format("{}\n\n{}\n{}\n\n{}\n",
                        set_title(set),
                        to_text(layouts_table(set)),
                        kBeside,
                        to_text(beside_original_table(set)));
  }
  if (!comparison.layouts.empty()) text += strip_sentence(comparison.layouts) + "\n";
  return text;
}

std::string to_markdown(const Comparison& comparison) {
  std::string text =
      "# Comparison\n\nWritten by `tautline compare --markdown`; do not edit. Every controller on "
      "the papers' worlds and at bottlenecks, the claims of section 1.1 of the thesis about other "
      "methods, and the strips on random layouts. The controllers are described in "
      "[controllers.md](controllers.md).\n";
  if (!comparison.findings.empty()) {
    text += "\n## Claims of the thesis about other methods\n";
    for (const Finding& each : comparison.findings) {
      text += fmt::format("\n*{}* **Verdict: {}.** {}\n\nRule: {}\n",
                          each.claim,
                          name(each.verdict),
                          each.because,
                          each.rule);
    }
  }
  if (!comparison.worlds.empty()) {
    text += fmt::format("\n## The papers' worlds\n\n{}\n\n{}",
                        worlds_text(comparison.options),
                        to_markdown(worlds_table(comparison)));
  }
  if (!comparison.bottlenecks.empty()) {
    text += fmt::format("\n## Bottlenecks\n\n{}\n\n{}",
                        bottlenecks_text(comparison.options),
                        to_markdown(bottlenecks_table(comparison)));
  }
  if (!comparison.layouts.empty()) {
    text += fmt::format("\n## Random layouts\n\n{}\n\n{}\n",
                        layouts_text(comparison.options),
                        strip_sentence(comparison.layouts));
  }
  for (const LayoutSet& set : comparison.layouts) {
    text += fmt::format("\n### {}\n\n{}{}\n\n{}",
                        set_title(set),
                        to_markdown(layouts_table(set)),
                        kBeside,
                        to_markdown(beside_original_table(set)));
  }
  if (!comparison.worlds.empty()) {
    text += fmt::format("\n## The papers' worlds in detail\n\n{}\n\n{}",
                        kDetails,
                        to_markdown(details_table(comparison)));
  }
  while (text.ends_with("\n\n")) text.pop_back();
  for (std::size_t at = text.find("\n\n\n"); at != std::string::npos; at = text.find("\n\n\n")) {
    text.erase(at, 1);  // a table ends with a blank line, and the next heading begins with one
  }
  return text;
}

void write_markdown(const Comparison& comparison, const std::filesystem::path& folder) {
  make_folder(folder);
  write_text(folder / "comparison.md", to_markdown(comparison));
  const std::filesystem::path controllers = folder / "controllers.md";
  if (comparison.worlds.empty() || !std::filesystem::exists(controllers)) return;
  std::string text = read_text(controllers);
  const std::string section = fmt::format("{}{}\n\n{}{}",
                                          kWorlds.begin,
                                          worlds_text(comparison.options),
                                          to_markdown(worlds_table(comparison)),
                                          kWorlds.end);
  if (reproduce::replace_marked(text, kWorlds, section)) write_text(controllers, text);
}

}  // namespace server::compare
