// server/lab/reproduce/filter_json.cpp: the study's figures as JSON.
#include "server/lab/reproduce/filter_study.hpp"

namespace server {
namespace {

using nlohmann::json;

json number(const std::optional<double>& value) {
  return value ? json(*value) : json(nullptr);
}

json figures(const std::vector<FilterFigures>& all) {
  json out = json::array();
  for (const FilterFigures& each : all) {
    out.push_back({{"filter", each.filter},
                   {"impulses", each.impulses},
                   {"height_left", number(each.height_left)},
                   {"edge_shift", number(each.edge_shift)},
                   {"edge_blur", number(each.edge_blur)},
                   {"oscillation", number(each.oscillation)},
                   {"not_in_window", each.not_in_window},
                   {"not_whole", each.not_whole},
                   {"rms_mm", number(each.rms_mm)}});
  }
  return out;
}

json scene(const SceneResult& each) {
  json spikes = json::array();
  for (const Spike& spike : each.scene.spikes) {
    spikes.push_back({{"beam", spike.beam}, {"mm", spike.mm}});
  }
  return {{"name", each.scene.name},
          {"half_width", each.scene.half_width},
          {"spikes", spikes},
          {"filters", figures(each.figures)}};
}

json recording(const RecordingResult& each) {
  return {{"name", each.name},
          {"scans", each.scans},
          {"beams", each.beams},
          {"step_mm", each.step_mm},
          {"simulated", each.simulated},
          {"half_width", each.half_width},
          {"filters", figures(each.figures)}};
}

}  // namespace

json to_json(const FilterStudy& study) {
  json out = {{"flat", scene(study.flat)},
              {"scenes", json::array()},
              {"as_printed_step", study.as_printed_step},
              {"signals", json::array()},
              {"noise", json::array()},
              {"recordings", json::array()},
              {"cost", json::array()},
              {"claims", json::array()}};
  for (const SceneResult& each : study.scenes) out["scenes"].push_back(scene(each));
  for (const RecordingResult& each : study.recordings) out["recordings"].push_back(recording(each));
  for (const SignalResult& each : study.signals) {
    out["signals"].push_back({{"filter", each.filter},
                              {"half_width", each.half_width},
                              {"single", each.single},
                              {"adjacent", each.adjacent},
                              {"apart", each.apart},
                              {"step", each.step},
                              {"ramp", each.ramp},
                              {"fastest", each.fastest},
                              {"slower", each.slower}});
  }
  for (const NoiseResult& each : study.noise) {
    out["noise"].push_back({{"spoiled", each.spoiled},
                            {"filter", each.filter},
                            {"half_width", each.half_width},
                            {"off", each.off}});
  }
  for (const CostResult& each : study.cost) {
    out["cost"].push_back({{"half_width", each.half_width},
                           {"tuned_over_median", each.product},
                           {"plain_over_median", each.textbook}});
  }
  for (const Claim& each : study.claims) {
    out["claims"].push_back({{"source", each.source},
                             {"sentence", each.sentence},
                             {"rule", each.rule},
                             {"found", each.found},
                             {"verdict", name(each.verdict)}});
  }
  return out;
}

}  // namespace server
