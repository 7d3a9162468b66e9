// server/lab/compare/comparison.cpp: which runs are made.
#include "server/lab/compare/comparison.hpp"

#include <array>

#include "server/experiment/batch.hpp"
#include "server/lab/compare/layouts.hpp"
#include "server/lab/reproduce/conditions.hpp"

namespace server::compare {
namespace {

using reproduce::RowJob;

struct Kind {
  std::size_t obstacles = 0;
  double repulsion_gain = 0;
};
constexpr std::array<Kind, 3> kKinds{{{2, 0.6}, {3, 0.3}, {4, 0.3}}};

/// On the random layouts: the full strip beside the readings of the one via point.
constexpr std::array<const char*, 5> kStrips{
    {"strip", "original", "original_side", "modified", "modified_published"}};

std::vector<Row> run_scenes(const std::vector<sim::Scenario>& scenes,
                            const std::vector<Contestant>& all,
                            const Options& options,
                            const char* what) {
  std::vector<RowJob> jobs;
  for (const Contestant& contestant : all) {
    for (const sim::Scenario& scene : scenes) {
      jobs.push_back({scene.name,
                      label(contestant),
                      make_run(scene, contestant, options.first_seed),
                      options.seeds});
    }
  }
  return run_rows(jobs, options.threads, [&](std::size_t done, std::size_t count) {
    if (options.progress) options.progress(what, done, count);
  });
}

LayoutSet run_layouts(const Kind& kind, const Options& options) {
  const reproduce::PaperFile file = reproduce::embedded_paper_file();
  std::vector<RowJob> paper;
  std::vector<RowJob> full;
  for (const char* const name : kStrips) {
    const std::string controller(name);
    for (std::size_t i = 1; i <= options.layouts; ++i) {
      const reproduce::Layout layout = random_layout(kind.obstacles, kind.repulsion_gain, i);
      const auto job = [&](const reproduce::Conditions& conditions) -> RowJob {
        return {layout.name,
                controller,
                reproduce::make_run(file, layout, controller, conditions, options.first_seed),
                options.layout_seeds};
      };
      paper.push_back(job(reproduce::kPaper));
      if (controller == kStrips.front()) full.push_back(job(reproduce::kFullSimulator));
    }
  }
  const auto progress = [&](std::size_t done, std::size_t count) {
    if (options.progress) options.progress("random layouts", done, count);
  };
  return {kind.obstacles,
          kind.repulsion_gain,
          run_rows(paper, options.threads, progress),
          run_rows(full, options.threads, progress)};
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

std::vector<const Row*> rows_of(const std::vector<Row>& rows, const std::string& label) {
  std::vector<const Row*> own;
  for (const Row& row : rows) {
    if (row.reading == label) own.push_back(&row);
  }
  return own;
}

LayoutResult strip_on_layouts(const std::vector<LayoutSet>& sets) {
  LayoutResult result;
  for (const LayoutSet& set : sets) {
    for (const std::vector<Row>* rows : {&set.paper, &set.full}) {
      for (const Row* row : rows_of(*rows, kStrips.front())) {
        result.runs += row->runs.size();
        result.reached += count(*row, algo::Outcome::Reached);
        result.collided += count(*row, algo::Outcome::Collided);
      }
    }
  }
  return result;
}

}  // namespace server::compare
