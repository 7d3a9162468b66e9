// server/lab/reproduce/study.cpp: which runs are made.
#include "server/lab/reproduce/study.hpp"

namespace server::reproduce {

std::vector<RowJob> row_jobs(const PaperFile& file,
                             const Conditions& conditions,
                             std::size_t seeds,
                             std::uint64_t first_seed,
                             std::span<const std::string_view> controllers) {
  std::vector<RowJob> jobs;
  for (const Layout& layout : file.layouts) {
    for (const std::string_view reading : controllers) {
      jobs.push_back({layout.name,
                      std::string(reading),
                      make_run(file, layout, reading, conditions, first_seed),
                      seeds});
    }
  }
  return jobs;
}

Study run_study(const PaperFile& file, const StudyOptions& options) {
  check_layouts(file);
  const auto progress = [&](const char* what) -> Progress {
    if (!options.progress) return {};
    return [&options, what = std::string(what)](std::size_t done, std::size_t all) {
      options.progress(what, done, all);
    };
  };
  Study study{.seeds = options.seeds, .first_seed = options.first_seed};
  study.paper = run_rows(row_jobs(file, kPaper, options.seeds, options.first_seed),
                         options.threads,
                         progress("paper conditions"));
  PaperFile asked = file;  // without noise one run says all
  std::erase_if(asked.layouts, [](const Layout& each) { return each.accept_noise_free.empty(); });
  study.noise_free = run_rows(
      row_jobs(asked, kNoiseFree, 1, options.first_seed), options.threads, progress("noise-free"));
  study.strip =
      run_rows(row_jobs(file, kPaper, options.seeds, options.first_seed, std::span(&kFullStrip, 1)),
               options.threads,
               progress("the full strip"));
  study.least_depths = least_depths(file);
  study.checks = evaluate(file, study.paper, study.noise_free);
  study.claims = judge_claims(study.paper);
  if (options.full_simulator) {
    study.full = run_rows(row_jobs(file, kFullSimulator, options.seeds, options.first_seed),
                          options.threads,
                          progress("full simulator"));
    study.full_claims = judge_claims(study.full);
    study.strip_full = run_rows(
        row_jobs(
            file, kFullSimulator, options.seeds, options.first_seed, std::span(&kFullStrip, 1)),
        options.threads,
        progress("the full strip in the full simulator"));
    study.differences = explain_differences(file,
                                            study.paper,
                                            study.full,
                                            options.first_seed,
                                            options.threads,
                                            progress("what makes the difference"));
  }
  return study;
}

}  // namespace server::reproduce
