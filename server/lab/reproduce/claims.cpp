// server/lab/reproduce/claims.cpp: one condition per claim.
#include "server/lab/reproduce/claims.hpp"

#include <array>

namespace server::reproduce {
namespace {

using algo::Outcome;

/// `original` and one reading of the modified strip on the same layout.
using Condition = bool (*)(const Series& original, const Series& modified);

struct Statement {
  std::string_view scenarios{};  // names, each with a blank before and after
  const char* text = "";
  Condition holds = nullptr;
};

constexpr auto kStatements = std::to_array<Statement>({
    {" case1 ",
     "the original strip is stuck, the modified one reaches the goal",
     [](const Series& original, const Series& modified) {
       return common_outcome(original) == Outcome::Stuck && all_reach(modified);
     }},
    {" case2 case3 case4 exp1 exp2 exp3 exp4 ",
     "both strips reach the goal",
     [](const Series& original, const Series& modified) {
       return all_reach(original) && all_reach(modified);
     }},
    {" case3 case4 exp2 exp3 exp4 ",
     "the original strip enters the safety circle, the modified one does not",
     [](const Series& original, const Series& modified) {
       return all_reach(modified) && figure(original, "safety_depth_m") > 0 &&
              figure(modified, "safety_depth_m") <= 0;
     }},
    {" case2 case3 case4 ",
     "the modified strip's path is smoother: it reaches with less turning",
     [](const Series& original, const Series& modified) {
       return all_reach(modified) &&
              figure(modified, "turning_rad") < figure(original, "turning_rad");
     }},
    {" case3 case4 ",
     "the modified strip reaches with fewer control points",
     [](const Series& original, const Series& modified) {
       return all_reach(modified) &&
              figure(modified, "via_points") < figure(original, "via_points");
     }},
});

struct ModifiedReading {
  const char* name = "";
  bool as_printed = false;
};
constexpr std::array<ModifiedReading, 4> kModified{{{"modified_published", true},
                                                    {"modified_linear", true},
                                                    {"modified_c1", false},
                                                    {"modified", false}}};

Claim judge(std::span<const Series> rows, const Series& original, const Statement& statement) {
  Claim claim{.scenario = original.scenario, .text = statement.text};
  for (const ModifiedReading& reading : kModified) {
    const Series* modified = find_series(rows, original.scenario, reading.name);
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
  constexpr std::array<std::string_view, 3> kNames{
      "reproduced", "only with our extension", "not reproduced"};
  return kNames.at(static_cast<std::size_t>(verdict));
}

std::vector<Claim> judge_claims(std::span<const Series> rows) {
  std::vector<Claim> claims;
  for (const Series& row : rows) {
    if (row.controller != "original") continue;
    for (const Statement& statement : kStatements) {
      if (statement.scenarios.find(" " + row.scenario + " ") == std::string_view::npos) continue;
      claims.push_back(judge(rows, row, statement));
    }
  }
  return claims;
}

}  // namespace server::reproduce
