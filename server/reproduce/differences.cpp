// server/reproduce/differences.cpp: one change at a time.
#include "server/reproduce/differences.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

namespace server::reproduce {
namespace {

using algo::Outcome;

struct Change {
  const char* name = "";
  Conditions conditions{};
};
// Base and scanner need the short tick; it goes with them, and is tried alone first.
constexpr std::array<Change, 3> kChanges{{
    {"the 26 ms tick", {.fast_period = true}},
    {"the base (Bullet: ramps, wheels, encoder odometry)", {.base = true, .fast_period = true}},
    {"the scanner (rolling LMS200 model)", {.scanner = true, .fast_period = true}},
}};

/// The outcome of most runs; the better one of equals.
Outcome usual(const Row& row) {
  Outcome best = Outcome::Reached;
  for (const Outcome outcome : {Outcome::Stuck, Outcome::OutOfTime, Outcome::Collided}) {
    if (count(row, outcome) > count(row, best)) best = outcome;
  }
  return best;
}

bool same_outcomes(const Row& a, const Row& b) {
  const auto same = [&](Outcome outcome) { return count(a, outcome) == count(b, outcome); };
  return same(Outcome::Reached) && same(Outcome::Stuck) && same(Outcome::OutOfTime) &&
         same(Outcome::Collided);
}

/// `tried`: the row under each of kChanges.
std::string explain(const Row& paper, const Row& full, std::span<const Row> tried) {
  std::string figures;
  std::string causes;
  for (std::size_t i = 0; i < kChanges.size(); ++i) {
    figures += fmt::format(
        "{}{}: {}", figures.empty() ? "" : "; ", kChanges[i].name, outcomes_text(tried[i]));
    if (usual(tried[i]) == usual(full) && usual(full) != usual(paper)) {
      causes += fmt::format("{}{}", causes.empty() ? "" : " and so does ", kChanges[i].name);
    }
  }
  std::string verdict;
  if (usual(full) == usual(paper)) {
    verdict = "A matter of single seeds: most runs end alike.";
  } else if (causes.empty()) {
    verdict = "No single change does it; they do it together.";
  } else {
    verdict = fmt::format(
        "{}{} alone turns it.", static_cast<char>(std::toupper(causes.front())), causes.substr(1));
  }
  return fmt::format("{} With one change at a time, {}.", verdict, figures);
}

}  // namespace

std::vector<Difference> explain_differences(const PaperFile& file,
                                            std::span<const Row> paper,
                                            std::span<const Row> full,
                                            std::uint64_t first_seed,
                                            unsigned threads,
                                            const Progress& progress) {
  std::vector<std::size_t> differing;
  std::vector<RowJob> jobs;
  for (std::size_t i = 0; i < std::min(paper.size(), full.size()); ++i) {
    if (same_outcomes(paper[i], full[i])) continue;
    differing.push_back(i);
    const Layout& layout = *std::ranges::find(file.layouts, paper[i].layout, &Layout::name);
    for (const Change& change : kChanges) {
      jobs.push_back({layout.name,
                      paper[i].reading,
                      make_run(file, layout, paper[i].reading, change.conditions, first_seed),
                      paper[i].runs.size()});
    }
  }
  const std::vector<Row> tried = run_rows(jobs, threads, progress);
  std::vector<Difference> differences;
  for (std::size_t k = 0; k < differing.size(); ++k) {
    const Row& a = paper[differing[k]];
    const Row& b = full[differing[k]];
    const auto own = std::span(tried).subspan(k * kChanges.size(), kChanges.size());
    differences.push_back(
        {a.layout, a.reading, outcomes_text(a), outcomes_text(b), explain(a, b, own)});
  }
  return differences;
}

}  // namespace server::reproduce
