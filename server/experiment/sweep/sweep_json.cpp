// server/experiment/sweep/sweep_json.cpp: results.json: the results with every digit.
#include <cmath>

#include <nlohmann/json.hpp>

#include "server/experiment/sweep/sweep_tables.hpp"
#include "server/run/version.hpp"

namespace server::sweep {
namespace {

using nlohmann::json;

json json_of(const experiment::Interval& interval) {
  return {interval.low, interval.high};
}

json json_of(const Rate& rate) {
  json out = {{"count", rate.count}, {"runs", rate.runs}};
  if (rate.runs == 0) return out;
  out["rate"] = rate.value();
  out["interval"] = json_of(rate.interval->bounds);
  out["interval_method"] = experiment::name(rate.interval->basis);
  return out;
}

json json_of(const std::optional<experiment::Summary>& summary) {
  if (!summary) return {{"n", 0}};
  json out = {{"n", summary->n},
              {"median", summary->median},
              {"lower_quartile", summary->lower_quartile},
              {"upper_quartile", summary->upper_quartile},
              {"least", summary->least},
              {"largest", summary->largest},
              {"mean", summary->mean}};
  out["mean_interval"] = summary->mean_interval ? json_of(*summary->mean_interval) : json(nullptr);
  return out;
}

json json_of(const Plan& plan, const Group& group) {
  const Arm& arm = plan.arms()[group.arm];
  const ControllerChoice& controller = plan.document().controllers[arm.controller];
  json out = {{"label", arm.label},
              {"controller", controller.name},
              {"parameters", arm.parameters},
              {"runs", group.runs},
              {"missing", group.missing}};
  if (group.scenario) out["scenario"] = plan.document().scenarios[*group.scenario].name;
  for (const Rate& rate : group.rates) {
    out["rates"][std::string(algo::name(rate.outcome))] = json_of(rate);
  }
  for (std::size_t f = 0; f < figures().size(); ++f) {
    out["figures"][std::string(figures()[f].column)] = json_of(group.figures[f]);
  }
  return out;
}

json json_of(const PairedTest& test) {
  const experiment::Wilcoxon& ranks = test.signed_rank;
  json out = {{"test", test.mcnemar ? "mcnemar_exact" : "wilcoxon_signed_rank"},
              {"pairs", test.pairs},
              {"units", ranks.pairs},
              {"nonzero", ranks.nonzero},
              {"w_plus", ranks.w_plus},
              {"w_minus", ranks.w_minus},
              {"exact", ranks.exact},
              {"rank_biserial", ranks.rank_biserial},
              {"differences", json_of(test.differences)},
              {"p", test.p()},
              {"p_holm", test.p_holm}};
  if (!test.mcnemar) return out;
  out["exact"] = true;
  out["only_baseline"] = test.mcnemar->only_baseline;
  out["only_other"] = test.mcnemar->only_other;
  return out;
}

json json_of(const Plan& plan, const Pairing& pairing) {
  return {{"label", plan.arms()[pairing.arm].label},
          {"baseline", plan.arms()[pairing.baseline].label},
          {"unit", pairing.over_scenarios ? "scenario" : "seed"},
          {"reached", json_of(pairing.reached)},
          {"collided", json_of(pairing.collided)},
          {"time_s", json_of(pairing.time)}};
}

json json_of(const Plan& plan, const Ranking& ranking) {
  json order = json::array();
  for (const std::size_t arm : ranking.order) {
    const double rate = ranking.rates[arm];
    order.push_back(
        {{"label", plan.arms()[arm].label}, {"rate", std::isnan(rate) ? json() : json(rate)}});
  }
  return {{"reading", ranking.reading},
          {"holds", ranking.holds()},
          {"swapped", ranking.swapped},
          {"pairs", ranking.pairs},
          {"order", order}};
}

}  // namespace

json results_json(const Plan& plan, const Results& results) {
  const json identity = identity_of(plan.document());
  json out = {{"name", plan.document().name},
              {"tautline", kVersion},
              {"hash", hash_of(identity)},
              {"document", plan.document().source},
              {"complete", results.complete()},
              {"runs", results.runs},
              {"missing", results.missing},
              {"failed", results.failed},
              {"arms", json::array()},
              {"scenarios", json::array()},
              {"comparisons", json::array()},
              {"robustness", json::array()}};
  for (const Group& group : results.arms) out["arms"].push_back(json_of(plan, group));
  for (const Group& group : results.scenarios) out["scenarios"].push_back(json_of(plan, group));
  for (const Pairing& each : results.pairings) out["comparisons"].push_back(json_of(plan, each));
  for (const Ranking& each : results.rankings) out["robustness"].push_back(json_of(plan, each));
  return out;
}

}  // namespace server::sweep
