// server/lab/compare/findings.cpp: one judgement per claim, with its rule in words.
#include "server/lab/compare/findings.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "server/lab/compare/scenes.hpp"

namespace server::compare {
namespace {

using algo::Outcome;
using experiment::count;
using experiment::find_series;
using experiment::Row;
using experiment::Series;

/// A method that the thesis names, with each of its sensors. Edge detection has no sonar version
/// here.
struct Method {
  const char* words = "";
  std::vector<std::string> labels{};
};
const std::array<Method, 4>& methods() {
  static const std::array<Method, 4> kMethods{
      {{"edge detection", {"edge_detection"}},
       {"the certainty grid", {"certainty_grid", "certainty_grid by sonar"}},
       {"the potential field", {"potential_field", "potential_field by sonar"}},
       {"VFF", {"vff", "vff by sonar"}}}};
  return kMethods;
}

bool is_trapped(const Row& run) {
  return run.outcome == Outcome::Stuck || run.outcome == Outcome::OutOfTime;
}

/// Sums of time, pauses and the like over many runs.
struct Pausing {
  std::size_t runs = 0;
  std::size_t paused_runs = 0;
  double time = 0;        // [s]
  double pause_time = 0;  // [s]
  double pauses = 0;
  double share() const { return time > 0 ? pause_time / time : 0; }
  void add(const Row& run) {
    ++runs;
    paused_runs += run["pauses"] > 0 ? 1U : 0U;
    time += run["time_s"];
    pause_time += run["pause_s"];
    pauses += run["pauses"];
  }
};

/// Worlds in which the straight way to the goal hits an obstacle.
std::vector<std::string> blocked_worlds(std::span<const Series> worlds) {
  std::vector<std::string> names;
  for (const Series& row : worlds) {
    const bool blocked = count(row, Outcome::Collided) == row.runs.size();
    if (row.controller == "go_to_goal" && blocked) names.push_back(row.scenario);
  }
  return names;
}

/// The runs of one contestant in the worlds `names` that were not trapped.
Pausing pausing_in(std::span<const Series> worlds,
                   const std::vector<std::string>& names,
                   const std::string& contestant) {
  Pausing sum;
  for (const std::string& name : names) {
    const Series* row = find_series(worlds, name, contestant);
    if (row == nullptr) continue;
    for (const Row& run : row->runs) {
      if (!is_trapped(run)) sum.add(run);
    }
  }
  return sum;
}

void judge_edge_detection(std::span<const Series> worlds, std::vector<Finding>& findings) {
  const std::vector<std::string> names = blocked_worlds(worlds);
  const Pausing own = pausing_in(worlds, names, "edge_detection");
  if (own.runs == 0) return;
  double most = 0;
  std::string others;
  for (const Method& method : methods()) {
    for (const std::string& contestant : method.labels) {
      const Pausing other = pausing_in(worlds, names, contestant);
      if (contestant == "edge_detection" || other.runs == 0) continue;
      most = std::max(most, other.share());
      others +=
          fmt::format("{}{} {:.2f} %", others.empty() ? "" : ", ", contestant, 100 * other.share());
    }
  }
  Finding finding{.claim = "Edge detection has to stop before an obstacle to take its scan."};
  finding.rule =
      "Counts the worlds with a blocked straight path (go_to_goal collides there) and the runs "
      "that were not trapped. Reproduced if edge detection paused in each of its runs, and for a "
      "larger share of its time than every other method; in part if it paused in some. A pause is "
      "a rest of 0.1 s or more, without turning, after which the robot drives on.";
  finding.because = fmt::format(
      "It paused in {} of {} runs, {:.1f} times a run, {:.2f} s each: {:.2f} % of its time. The "
      "others' shares: {}.",
      own.paused_runs,
      own.runs,
      own.pauses / static_cast<double>(own.runs),
      own.pauses > 0 ? own.pause_time / own.pauses : 0.0,
      100 * own.share(),
      others.empty() ? "none was run" : others);
  if (own.paused_runs == own.runs && own.share() > most) {
    finding.verdict = Verdict::Reproduced;
  } else if (own.paused_runs > 0) {
    finding.verdict = Verdict::InPart;
  }
  findings.push_back(std::move(finding));
}

void judge_vff(std::span<const Series> worlds, std::vector<Finding>& findings) {
  std::size_t runs = 0;
  std::size_t on_the_move = 0;
  std::size_t stuck = 0;
  Pausing sum;
  for (const Series& row : worlds) {
    if (row.controller != "vff" && row.controller != "vff by sonar") continue;
    stuck += count(row, Outcome::Stuck);
    for (const Row& run : row.runs) {
      ++runs;
      on_the_move += run["pauses"] == 0 && run.outcome != Outcome::Stuck ? 1U : 0U;
      sum.add(run);
    }
  }
  if (runs == 0) return;
  Finding finding{.claim = "VFF does not have to stop."};
  finding.rule =
      "Counts all worlds, by laser and by sonar. Reproduced if no run of VFF paused or ended "
      "stuck; in part if some did not.";
  finding.because = fmt::format(
      "{} of {} runs did not stop; {} paused, {} ended stuck; {:.2f} % of the time was spent in "
      "pauses. This is VFF with our change: as printed, its speed law halts the robot for good "
      "when a push comes from straight ahead, so ours always keeps a tenth of the top speed.",
      on_the_move,
      runs,
      sum.paused_runs,
      stuck,
      100 * sum.share());
  if (on_the_move == runs) {
    finding.verdict = Verdict::Reproduced;
  } else if (on_the_move > 0) {
    finding.verdict = Verdict::InPart;
  }
  findings.push_back(std::move(finding));
}

std::string gaps_text(const std::vector<double>& gaps) {
  std::string text;
  for (const double gap : gaps) text += fmt::format("{}{:.1f}", text.empty() ? "" : ", ", gap);
  return text;
}

/// "vff: trapped in every run at 0.8, 1.0 m; passes from 1.2 m on; of 27 runs 20 passed, ...".
std::string passage_text(const std::string& contestant, const Passage& passage) {
  std::string text = contestant + ": ";
  text += passage.traps.empty() ? "no gap traps every run; "
                                : "trapped in every run at " + gaps_text(passage.traps) + " m; ";
  text += passage.smallest ? fmt::format("passes from {:.1f} m on", *passage.smallest)
                           : std::string("passes none up to the widest");
  return text + fmt::format("; of {} runs {} passed, {} stuck, {} out of time, {} collided.",
                            passage.runs,
                            passage.passed,
                            passage.stuck,
                            passage.out_of_time,
                            passage.collided);
}

void judge_bottlenecks(std::span<const Series> bottlenecks,
                       const Method& method,
                       std::vector<Finding>& findings) {
  std::size_t sensors = 0;
  std::size_t always = 0;
  std::size_t sometimes = 0;
  Finding finding{.claim = fmt::format("Bottlenecks trap {}.", method.words)};
  for (const std::string& contestant : method.labels) {
    const Passage passage = passage_of(bottlenecks, contestant);
    if (passage.runs == 0) continue;
    ++sensors;
    always += passage.traps.empty() ? 0U : 1U;
    sometimes += passage.trapped_sometimes() ? 1U : 0U;
    finding.because += (finding.because.empty() ? "" : " ") + passage_text(contestant, passage);
  }
  if (sensors == 0) return;
  finding.rule =
      "Trapped means stuck or out of time at a gap wider than the hull; a collision does not "
      "count. Reproduced if, with each tested sensor, some gap traps every run; in part if some "
      "run is trapped.";
  if (always == sensors) {
    finding.verdict = Verdict::Reproduced;
  } else if (sometimes > 0) {
    finding.verdict = Verdict::InPart;
  }
  findings.push_back(std::move(finding));
}

}  // namespace

std::string_view name(Verdict verdict) {
  constexpr std::array<std::string_view, 3> kNames{"reproduced", "in part", "not reproduced"};
  return kNames.at(static_cast<std::size_t>(verdict));
}

Passage passage_of(std::span<const Series> bottlenecks, std::string_view contestant) {
  const std::vector<double> gaps = bottleneck_gaps();
  Passage passage;
  for (const Series& row : bottlenecks) {
    if (row.controller != contestant) continue;
    const auto gap = std::ranges::find(gaps, row.scenario, bottleneck_name);
    if (gap == gaps.end()) continue;
    const std::size_t reached = count(row, Outcome::Reached);
    const std::size_t trapped = count(row, Outcome::Stuck) + count(row, Outcome::OutOfTime);
    passage.runs += row.runs.size();
    passage.passed += reached;
    passage.stuck += count(row, Outcome::Stuck);
    passage.out_of_time += count(row, Outcome::OutOfTime);
    passage.collided += count(row, Outcome::Collided);
    if (trapped == row.runs.size()) passage.traps.push_back(*gap);
    if (reached < row.runs.size()) {
      passage.smallest.reset();
    } else if (!passage.smallest) {
      passage.smallest = *gap;
    }
  }
  return passage;
}

std::vector<Finding> judge(std::span<const Series> worlds, std::span<const Series> bottlenecks) {
  std::vector<Finding> findings;
  judge_edge_detection(worlds, findings);
  judge_vff(worlds, findings);
  for (const Method& method : methods()) judge_bottlenecks(bottlenecks, method, findings);
  return findings;
}

}  // namespace server::compare
