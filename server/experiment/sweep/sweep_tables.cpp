// server/experiment/sweep/sweep_tables.cpp: cells for people; runs in full.
#include "server/experiment/sweep/sweep_tables.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "server/experiment/judge.hpp"

namespace server::sweep {
namespace {

using experiment::Summary;
using experiment::Table;

int digits_of(std::string_view column) {
  const experiment::Column* const found = experiment::find_column(column);
  return found == nullptr ? 2 : found->digits;
}

/// "7/10, 0.70 [0.40, 0.89]"
std::string rate_cell(const Rate& rate) {
  if (!rate.interval) return "";
  const auto [low, high] = rate.interval->bounds;
  return fmt::format(
      "{}/{}, {:.2f} [{:.2f}, {:.2f}]", rate.count, rate.runs, rate.value(), low, high);
}

std::string mean_cell(const Summary& summary, int digits) {
  if (!summary.mean_interval) return "";  // no mean without its interval
  const auto [low, high] = *summary.mean_interval;
  return fmt::format("{:.{}f} [{:.{}f}, {:.{}f}]", summary.mean, digits, low, digits, high, digits);
}

std::string quartiles_cell(const Summary& summary, int digits) {
  return fmt::format(
      "{:.{}f} to {:.{}f}", summary.lower_quartile, digits, summary.upper_quartile, digits);
}

/// "0.034", "0.2", "< 0.0001"
std::string p_cell(double p) {
  return p < 1e-4 ? "< 0.0001" : fmt::format("{:.2g}", p);
}

/// A column for each judge's figure, also of a run that broke before it had any.
experiment::Row with_all_figures(experiment::Row row) {
  if (!row.figures.empty()) return row;
  for (const std::string_view column : Rows::columns()) {
    row.figures.emplace_back(column, std::nan(""));
  }
  return row;
}

/// "+0.10 [-0.02, 0.20]"
std::string difference_cell(const PairedTest& test, int digits) {
  if (!test.differences) return "";
  std::string text = fmt::format("{:+.{}f}", test.differences->mean, digits);
  if (!test.differences->mean_interval) return text;
  const auto [low, high] = *test.differences->mean_interval;
  return text + fmt::format(" [{:+.{}f}, {:+.{}f}]", low, digits, high, digits);
}

void add_test(Table& table,
              const std::vector<std::string>& labels,
              const char* figure,
              const PairedTest& test) {
  const bool any = test.differences.has_value();
  std::vector<std::string>& row = table.rows.emplace_back(labels);
  row.insert(row.end(),
             {figure,
              test.mcnemar ? "McNemar" : "Wilcoxon",
              fmt::format("{}", test.pairs),
              fmt::format("{}", test.signed_rank.pairs),
              difference_cell(test, 2),
              any ? fmt::format("{:+.2f}", test.signed_rank.rank_biserial) : "",
              any ? p_cell(test.p()) : "",
              any ? p_cell(test.p_holm) : ""});
}

}  // namespace

Table runs_table(const Plan& plan, const Rows& rows) {
  return runs_table(plan, rows, 0, rows.size());
}

Table runs_table(const Plan& plan, const Rows& rows, std::size_t first, std::size_t last) {
  Table table;
  const std::vector<std::string> titles{"run", "scenario", "controller", "seed", "command"};
  for (std::size_t i = first; i < last; ++i) {
    const RunPlace at = plan.place(i);
    add_run(table,
            titles,
            {fmt::format("{}", i),
             plan.document().scenarios[at.scenario].name,
             plan.arms()[at.arm].label,
             fmt::format("{}", plan.seed(i)),
             plan.command(i)},
            with_all_figures(rows.row(i)));
    if (!rows.has(i)) table.rows.back()[titles.size()] = "missing";
  }
  return table;
}

Table rates_table(const Plan& plan, const Results& results) {
  Table table{.header = {"controller", "runs"}};
  for (const Rate& rate : results.arms.front().rates) {
    table.header.emplace_back(algo::name(rate.outcome));
  }
  for (const Group& group : results.arms) {
    auto& row = table.rows.emplace_back();
    row = {plan.arms()[group.arm].label, fmt::format("{}", group.runs)};
    for (const Rate& rate : group.rates) row.push_back(rate_cell(rate));
  }
  return table;
}

Table figures_table(const Plan& plan, const Results& results) {
  Table table{
      .header =
          {"controller", "figure", "n", "median", "quartiles", "least", "largest", "mean [95 %]"},
      .words = 2};
  for (const Group& group : results.arms) {
    for (std::size_t f = 0; f < figures().size(); ++f) {
      if (!group.figures[f]) continue;
      const Summary& summary = *group.figures[f];
      const int digits = digits_of(figures()[f].column) + 1;
      table.rows.push_back({plan.arms()[group.arm].label,
                            std::string(figures()[f].column),
                            fmt::format("{}", summary.n),
                            fmt::format("{:.{}f}", summary.median, digits),
                            quartiles_cell(summary, digits),
                            fmt::format("{:.{}f}", summary.least, digits),
                            fmt::format("{:.{}f}", summary.largest, digits),
                            mean_cell(summary, digits)});
    }
  }
  return table;
}

Table scenarios_table(const Plan& plan, const Results& results) {
  Table table{
      .header = {"scenario", "controller", "reached", "collided", "median time_s", "quartiles"},
      .words = 2};
  for (const Group& group : results.scenarios) {
    const std::optional<Summary>& time = group.figures.front();
    table.rows.push_back({plan.document().scenarios[*group.scenario].name,
                          plan.arms()[group.arm].label,
                          rate_cell(group.rates[0]),
                          fmt::format("{}/{}", group.rates[1].count, group.runs),
                          time ? fmt::format("{:.2f}", time->median) : "",
                          time ? quartiles_cell(*time, 2) : ""});
  }
  return table;
}

Table rankings_table(const Plan& plan, const Results& results) {
  constexpr std::size_t kNamed = 6;  // arms named, best first
  Table table{.header = {"runs", "order", "best first (rate of success)", "swapped"}, .words = 3};
  for (const Ranking& each : results.rankings) {
    const bool first = &each == &results.rankings.front();
    std::string names;
    for (std::size_t k = 0; k < std::min(kNamed, each.order.size()); ++k) {
      const std::size_t arm = each.order[k];
      const std::string rate =
          std::isnan(each.rates[arm]) ? "no runs" : fmt::format("{:.2f}", each.rates[arm]);
      names += fmt::format("{}{} ({})", names.empty() ? "" : " > ", plan.arms()[arm].label, rate);
    }
    if (each.order.size() > kNamed) names += " > ...";
    table.rows.push_back({each.reading,
                          first          ? ""
                          : each.holds() ? "holds"
                                         : "changes",
                          names,
                          first ? "" : fmt::format("{} of {} pairs", each.swapped, each.pairs)});
  }
  return table;
}

Table pairings_table(const Plan& plan, const Results& results) {
  const bool over_scenarios = plan.document().scenarios.size() > 1;
  Table table{.header = {"controller",
                         "against",
                         "figure",
                         "test",
                         "pairs",
                         over_scenarios ? "scenarios" : "seeds",
                         "mean difference [95 %]",
                         "effect",
                         "p",
                         "p (Holm)"},
              .words = 4};
  for (const Pairing& each : results.pairings) {
    const std::vector<std::string> labels{plan.arms()[each.arm].label,
                                          plan.arms()[each.baseline].label};
    add_test(table, labels, "reached", each.reached);
    add_test(table, labels, "collided", each.collided);
    add_test(table, labels, "time_s", each.time);
  }
  return table;
}

}  // namespace server::sweep
