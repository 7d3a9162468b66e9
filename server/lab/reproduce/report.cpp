// server/lab/reproduce/report.cpp: columns and sentences.
#include "server/lab/reproduce/report.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "server/lab/reproduce/full_strip.hpp"

namespace server::reproduce {
namespace {

using nlohmann::json;

std::string cell(const Series& row, std::string_view column, int digits, double factor = 1) {
  const double value = figure(row, column) * factor;
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, digits) : "-";
}

json rows_json(std::span<const Series> rows) {
  json all = json::array();
  for (const Series& row : rows) {
    all.push_back({{"scenario", row.scenario},
                   {"reading", row.controller},
                   {"metrics", experiment::figures_json(row)}});
  }
  return all;
}

json claims_json(std::span<const Claim> claims) {
  json all = json::array();
  for (const Claim& claim : claims) {
    all.push_back({{"scenario", claim.scenario},
                   {"claim", claim.text},
                   {"verdict", name(claim.verdict)},
                   {"held_by", claim.held_by}});
  }
  return all;
}

}  // namespace

Table rows_table(std::span<const Series> rows) {
  return experiment::tabulated<Series>(
      rows,
      3,
      {{"scenario", [](const Series& row) { return row.scenario; }},
       {"reading", [](const Series& row) { return row.controller; }},
       {"outcome", experiment::outcomes_text},
       {"path mm", [](const Series& row) { return cell(row, "path_m", 0, kMillimetres); }},
       {"clearance mm",
        [](const Series& row) { return cell(row, "min_clearance_m", 0, kMillimetres); }},
       {"in circle s", [](const Series& row) { return cell(row, "safety_infringed_s", 1); }},
       {"depth mm", [](const Series& row) { return cell(row, "safety_depth_m", 0, kMillimetres); }},
       {"turning rad", [](const Series& row) { return cell(row, "turning_rad", 2); }},
       {"via points", [](const Series& row) { return cell(row, "via_points", 1); }},
       {"time s", [](const Series& row) { return cell(row, "time_s", 1); }}});
}

Table checks_table(std::span<const Check> checks) {
  Table table{.header = {"scenario", "reading", "asked", "found", ""}, .words = 5};
  for (const Check& check : checks) {
    table.rows.push_back(
        {check.scenario, check.subject, check.asked, check.figure, check.held ? "held" : "FAILED"});
  }
  return table;
}

Table claims_table(const Study& study) {
  const auto words = [](const Claim& claim) {
    return claim.held_by.empty()
               ? std::string(name(claim.verdict))
               : fmt::format("{}: {}", name(claim.verdict), fmt::join(claim.held_by, ", "));
  };
  Table table{.header = {"case", "claim", "by table A"}, .words = 4};
  if (!study.full_claims.empty()) table.header.emplace_back("by table B");
  for (std::size_t i = 0; i < study.claims.size(); ++i) {
    table.rows.push_back({study.claims[i].scenario, study.claims[i].text, words(study.claims[i])});
    if (!study.full_claims.empty()) table.rows.back().push_back(words(study.full_claims[i]));
  }
  return table;
}

Table differences_table(std::span<const Difference> differences) {
  Table table{.header = {"scenario", "reading", "A", "B", "why"}, .words = 5};
  for (const Difference& each : differences) {
    table.rows.push_back({each.scenario, each.controller, each.paper, each.full, each.explanation});
  }
  return table;
}

std::size_t collisions(std::span<const Series> rows) {
  std::size_t sum = 0;
  for (const Series& row : rows) sum += count(row, algo::Outcome::Collided);
  return sum;
}

std::size_t runs(std::span<const Series> rows) {
  std::size_t sum = 0;
  for (const Series& row : rows) sum += row.runs.size();
  return sum;
}

std::string checks_sentence(std::span<const Check> checks) {
  const auto held = std::ranges::count(checks, true, &Check::held);
  return fmt::format("{} of {} limits held.", held, checks.size());
}

std::string to_text(const Study& study) {
  std::string text = fmt::format(
      "A. Paper conditions: kinematic robot, flat-time noisy scan; "
      "{} seeds from {}\n\n",
      study.seeds,
      study.first_seed);
  text += to_text(rows_table(study.paper));
  if (!study.noise_free.empty()) {
    text += "\nA, noise-free, one run each\n\n" + to_text(rows_table(study.noise_free));
  }
  text += "\nWhat the file asks for\n\n" + to_text(checks_table(study.checks));
  if (!study.full.empty()) {
    text += "\nB. Full simulator: Bullet base, rolling LMS200, 26 ms tick; the same seeds\n\n";
    text += to_text(rows_table(study.full));
    text += fmt::format("\n{} collisions in {} runs; none is expected.\n",
                        collisions(study.full),
                        runs(study.full));
    text += study.differences.empty() ? "\nEvery row ends as under A.\n"
                                      : "\nRows that end otherwise than under A\n\n";
    for (const Difference& each : study.differences) {
      text += fmt::format("{}, {}: A {}, B {}. {}\n",
                          each.scenario,
                          each.controller,
                          each.paper,
                          each.full,
                          each.explanation);
    }
  }
  text += fmt::format("\nThe full strip compared with the readings, paper conditions. {}\n\n{}",
                      strip_sentences(strip_beside(study.strip, study.paper, study.least_depths)),
                      to_text(strip_table(study.strip, study.paper)));
  if (!study.full.empty()) {
    text +=
        fmt::format("\nThe same in the full simulator. {}\n\n{}",
                    strip_sentences(strip_beside(study.strip_full, study.full, study.least_depths)),
                    to_text(strip_table(study.strip_full, study.full)));
  }
  if (!study.claims.empty()) {
    text += "\nClaims of the sources, and the readings for which they hold\n\n";
    text += to_text(claims_table(study));
  }
  return text;
}

json to_json(const Study& study) {
  json checks = json::array();
  for (const Check& check : study.checks) {
    checks.push_back({{"scenario", check.scenario},
                      {"subject", check.subject},
                      {"asked", check.asked},
                      {"found", check.figure},
                      {"held", check.held}});
  }
  json differences = json::array();
  for (const Difference& each : study.differences) {
    differences.push_back({{"scenario", each.scenario},
                           {"reading", each.controller},
                           {"paper", each.paper},
                           {"full", each.full},
                           {"explanation", each.explanation}});
  }
  return {{"seeds", study.seeds},
          {"first_seed", study.first_seed},
          {"paper_conditions", rows_json(study.paper)},
          {"noise_free", rows_json(study.noise_free)},
          {"accept", checks},
          {"all_held", all_held(study.checks)},
          {"claims", claims_json(study.claims)},
          {"full_simulator_claims", claims_json(study.full_claims)},
          {"full_simulator", rows_json(study.full)},
          {"full_strip", rows_json(study.strip)},
          {"full_strip_full_simulator", rows_json(study.strip_full)},
          {"full_simulator_collisions", collisions(study.full)},
          {"differences", differences}};
}

std::string to_text(std::span<const Sweep> sweeps) {
  std::string text;
  for (const Sweep& sweep : sweeps) {
    text += fmt::format("\n{}. {}\nVerdict: {}. {}\nRule: {}\nCells: {}\n\n{}",
                        sweep.parameter,
                        sweep.claim,
                        sweep.verdict,
                        sweep.because,
                        sweep.rule,
                        sweep.legend,
                        to_text(sweep.table));
  }
  return text;
}

json to_json(std::span<const Sweep> sweeps) {
  json all = json::array();
  for (const Sweep& sweep : sweeps) {
    json lines = json::array();
    for (const SweepLine& line : sweep.lines) {
      lines.push_back({{"scenario", line.scenario},
                       {"reading", line.reading},
                       {"refused", line.refused},
                       {"rows", rows_json(line.rows)}});
    }
    all.push_back({{"parameter", sweep.parameter},
                   {"values", sweep.values},
                   {"claim", sweep.claim},
                   {"rule", sweep.rule},
                   {"verdict", sweep.verdict},
                   {"because", sweep.because},
                   {"lines", lines}});
  }
  return all;
}

}  // namespace server::reproduce
