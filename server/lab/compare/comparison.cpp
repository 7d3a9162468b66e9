// server/lab/compare/comparison.cpp: which runs are made.
#include "server/lab/compare/comparison.hpp"

#include <algorithm>
#include <array>

#include "server/experiment/layouts.hpp"
#include "server/lab/reproduce/conditions.hpp"

namespace server::compare {
namespace {

using experiment::SeriesPlan;

struct Kind {
  std::size_t obstacles = 0;
  double repulsion_gain = 0;
};
constexpr std::array<Kind, 3> kKinds{{{2, 0.6}, {3, 0.3}, {4, 0.3}}};

/// Controllers on the random layouts: the full strip, and the readings with one via point.
constexpr std::array<const char*, 5> kStrips{
    {"strip", "original", "original_side", "modified", "modified_published"}};

std::vector<experiment::JudgeChoice> judges_of(const Options& options) {
  std::vector<experiment::JudgeChoice> judges = experiment::common_judges();
  for (const std::string& name : options.judges) {
    const bool there = std::ranges::count(judges, name, &experiment::JudgeChoice::name) > 0;
    if (!there) judges.push_back({.name = name});
  }
  return judges;
}

std::vector<Series> run_scenes(const std::vector<sim::Scenario>& scenes,
                               const std::vector<Contestant>& all,
                               const Options& options,
                               const char* what) {
  std::vector<SeriesPlan> plans;
  for (const Contestant& contestant : all) {
    for (const sim::Scenario& scene : scenes) {
      plans.push_back({scene.name,
                       label(contestant),
                       make_run(scene, contestant, options.first_seed),
                       options.seeds});
    }
  }
  return run_series(
      plans, judges_of(options), experiment::part_of(what, options.threads, options.progress));
}

LayoutSet run_layouts(const Kind& kind, const Options& options) {
  const reproduce::PaperConditions conditions = reproduce::embedded_study_file().conditions;
  std::vector<SeriesPlan> paper;
  std::vector<SeriesPlan> full;
  for (const char* const name : kStrips) {
    const std::string controller(name);
    for (std::size_t i = 1; i <= options.layouts; ++i) {
      const sim::Scenario layout =
          experiment::random_layout({kind.obstacles, kind.repulsion_gain}, i);
      const auto plan = [&](const reproduce::Conditions& under) -> SeriesPlan {
        return {layout.name,
                controller,
                reproduce::make_run(conditions, layout, controller, under, options.first_seed),
                options.layout_seeds};
      };
      paper.push_back(plan(reproduce::kPaper));
      if (controller == kStrips.front()) full.push_back(plan(reproduce::kFullSimulator));
    }
  }
  const auto run = [&](const std::vector<SeriesPlan>& plans) {
    return run_series(plans,
                      experiment::common_judges(),
                      experiment::part_of("random layouts", options.threads, options.progress));
  };
  return {kind.obstacles, kind.repulsion_gain, run(paper), run(full)};
}

}  // namespace

Comparison compare(const Options& options) {
  const std::vector<Contestant> all = contestants(options.only);
  Comparison out{.options = options};
  for (const Contestant& contestant : all) out.labels.push_back(label(contestant));
  if (options.worlds) {
    out.worlds = run_scenes(canonical_scenes(), all, options, "the papers' worlds");
  }
  if (options.bottlenecks) {
    std::vector<sim::Scenario> scenes;
    for (const double gap : bottleneck_gaps()) scenes.push_back(bottleneck(gap));
    out.bottlenecks = run_scenes(scenes, all, options, "bottlenecks");
  }
  if (options.random_layouts) {
    for (const Kind& kind : kKinds) out.layouts.push_back(run_layouts(kind, options));
  }
  out.findings = judge(out.worlds, out.bottlenecks);
  return out;
}

std::vector<const Series*> rows_of(const std::vector<Series>& rows, const std::string& label) {
  std::vector<const Series*> own;
  for (const Series& row : rows) {
    if (row.controller == label) own.push_back(&row);
  }
  return own;
}

LayoutResult strip_on_layouts(const std::vector<LayoutSet>& sets) {
  LayoutResult result;
  for (const LayoutSet& set : sets) {
    for (const std::vector<Series>* rows : {&set.paper, &set.full}) {
      for (const Series* row : rows_of(*rows, kStrips.front())) {
        result.runs += row->runs.size();
        result.reached += count(*row, algo::Outcome::Reached);
        result.collided += count(*row, algo::Outcome::Collided);
      }
    }
  }
  return result;
}

}  // namespace server::compare
