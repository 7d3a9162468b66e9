// server/lab/reproduce/claims.cpp: one condition a sentence.
#include "server/lab/reproduce/claims.hpp"

#include <algorithm>
#include <array>

namespace server::reproduce {
namespace {

using algo::Outcome;

double value(const Row& row, std::string_view metric) {
  return figure(row, *find_metric(metric));
}

bool reaches(const Row& row) {
  return common_outcome(row) == Outcome::Reached;
}

/// `original` and one reading of the modified strip on the same layout.
using Condition = bool (*)(const Row& original, const Row& modified);

struct Statement {
  std::string_view layouts{};  // names, each between blanks
  const char* text = "";
  Condition holds = nullptr;
};

constexpr auto kStatements = std::to_array<Statement>({
    {" case1 ",
     "the original strip is stuck, the modified one reaches the goal",
     [](const Row& original, const Row& modified) {
       return common_outcome(original) == Outcome::Stuck && reaches(modified);
     }},
    {" case2 case3 case4 exp1 exp2 exp3 exp4 ",
     "both strips reach the goal",
     [](const Row& original, const Row& modified) {
       return reaches(original) && reaches(modified);
     }},
    {" case3 case4 exp2 exp3 exp4 ",
     "the original strip enters the safety circle, the modified one does not",
     [](const Row& original, const Row& modified) {
       return reaches(modified) && value(original, "safety_depth_mm") > 0 &&
              value(modified, "safety_depth_mm") <= 0;
     }},
    {" case2 case3 case4 ",
     "the modified strip's path is smoother: it reaches with less turning",
     [](const Row& original, const Row& modified) {
       return reaches(modified) && value(modified, "turning_rad") < value(original, "turning_rad");
     }},
    {" case3 case4 ",
     "the modified strip reaches with fewer control points",
     [](const Row& original, const Row& modified) {
       return reaches(modified) && value(modified, "via_points") < value(original, "via_points");
     }},
});

struct Reading {
  const char* name = "";
  bool as_printed = false;
};
constexpr std::array<Reading, 4> kModified{{{"modified_published", true},
                                            {"modified_linear", true},
                                            {"modified_c1", false},
                                            {"modified", false}}};

Claim judge(std::span<const Row> rows, const Row& original, const Statement& statement) {
  Claim claim{.layout = original.layout, .text = statement.text};
  for (const Reading& reading : kModified) {
    const Row* modified = find_row(rows, original.layout, reading.name);
    if (modified == nullptr || !statement.holds(original, *modified)) continue;
    claim.held_by.emplace_back(reading.name);
    if (reading.as_printed) {
      claim.verdict = Verdict::Reproduced;
    } else if (claim.verdict == Verdict::NotReproduced) {
      claim.verdict = Verdict::OnlyWithExtension;
    }
  }
  return claim;
}

}  // namespace

std::string_view name(Verdict verdict) {
  switch (verdict) {
    case Verdict::Reproduced:
      return "reproduced";
    case Verdict::OnlyWithExtension:
      return "only with our extension";
    case Verdict::NotReproduced:
      break;
  }
  return "not reproduced";
}

std::vector<Claim> judge_claims(std::span<const Row> rows) {
  std::vector<Claim> claims;
  for (const Row& row : rows) {
    if (row.reading != "original") continue;
    for (const Statement& statement : kStatements) {
      if (statement.layouts.find(" " + row.layout + " ") == std::string_view::npos) continue;
      claims.push_back(judge(rows, row, statement));
    }
  }
  return claims;
}

}  // namespace server::reproduce
