// server/lab/reproduce/study.cpp: chooses and makes the runs.
#include "server/lab/reproduce/study.hpp"

#include <algorithm>

namespace server::reproduce {

using experiment::SeriesPlan;

std::vector<SeriesPlan> series_plans(const StudyFile& file,
                                     const Conditions& conditions,
                                     std::size_t seeds,
                                     std::uint64_t first_seed,
                                     std::span<const std::string_view> controllers) {
  std::vector<SeriesPlan> plans;
  for (const sim::Scenario& scenario : file.scenarios) {
    for (const std::string_view reading : controllers) {
      plans.push_back({scenario.name,
                       std::string(reading),
                       make_run(file.conditions, scenario, reading, conditions, first_seed),
                       seeds});
    }
  }
  return plans;
}

Study run_study(const StudyFile& file, const StudyOptions& options) {
  check_scenarios(file);
  const auto pool = [&](const char* part) {
    return experiment::part_of(part, options.threads, options.progress);
  };
  const auto run = [&](const std::vector<SeriesPlan>& plans, const char* what) {
    return run_series(plans, experiment::common_judges(), pool(what));
  };
  const std::span<const std::string_view> strip(&kFullStrip, 1);
  Study study{.seeds = options.seeds, .first_seed = options.first_seed};
  study.paper =
      run(series_plans(file, kPaper, options.seeds, options.first_seed), "paper conditions");
  StudyFile asked = file;  // one run is enough without noise
  std::erase_if(asked.scenarios, [&](const sim::Scenario& scenario) {
    return std::ranges::none_of(file.limits, [&](const Limit& limit) {
      return limit.noise_free && limit.scenario == scenario.name;
    });
  });
  study.noise_free = run(series_plans(asked, kNoiseFree, 1, options.first_seed), "noise-free");
  study.strip =
      run(series_plans(file, kPaper, options.seeds, options.first_seed, strip), "the full strip");
  study.least_depths = least_depths(file);
  study.checks = evaluate(file, study.paper, study.noise_free);
  study.claims = judge_claims(study.paper);
  if (options.full_simulator) {
    study.full = run(series_plans(file, kFullSimulator, options.seeds, options.first_seed),
                     "full simulator");
    study.full_claims = judge_claims(study.full);
    study.strip_full =
        run(series_plans(file, kFullSimulator, options.seeds, options.first_seed, strip),
            "the full strip in the full simulator");
    study.differences = explain_differences(
        file, study.paper, study.full, options.first_seed, pool("what makes the difference"));
  }
  return study;
}

}  // namespace server::reproduce
