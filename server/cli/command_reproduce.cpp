// server/cli/command_reproduce.cpp: `tautline reproduce`: checks the claims of the sources by their
// scenarios, their filter chapter, their drive by hand and their tables of the ground.
#include <algorithm>
#include <memory>

#include <fmt/format.h>

#include "server/cli/cli.hpp"
#include "server/cli/output_files.hpp"
#include "server/cli/pool_options.hpp"
#include "server/lab/reproduce/arm_study.hpp"
#include "server/lab/reproduce/filter_study.hpp"
#include "server/lab/reproduce/markdown.hpp"
#include "server/lab/reproduce/masuda_study.hpp"
#include "server/lab/reproduce/robhaz_study.hpp"
#include "server/lab/reproduce/session_reach.hpp"

namespace server {
namespace {

struct ReproduceCommand {
  std::string scenarios{};
  bool as_json = false;
  bool paper_only = false;
  bool sweeps = false;
  std::string markdown{};
  reproduce::StudyOptions study{};
  bool filter = false;
  std::string logs{};
  bool robhaz = false;
  bool masuda = false;
  bool arm = false;
  std::size_t reaches = 0;  // of each scene, as runs
  std::string course{};
};

/// Prints a study as text or JSON, and writes its document if one is asked for.
template <typename StudyType>
void report(const StudyType& study, const ReproduceCommand& options) {
  if (options.as_json) {
    fmt::print("{}\n", to_json(study).dump(2));
  } else {
    fmt::print("{}", to_text(study));
  }
  if (!options.markdown.empty()) write_markdown(study, options.markdown);
}

/// Only chapter 3. Its verdicts are findings, not limits.
int execute_filter_study(const ReproduceCommand& options) {
  FilterStudyOptions wanted;
  if (!options.logs.empty()) wanted.logs = options.logs;
  const FilterStudy study = study_filters(wanted);
  report(study, options);
  return kReached;
}

/// Only Park et al.'s course. A finding of the corrected reading that fails is a failure.
int execute_robhaz_study(const ReproduceCommand& options) {
  const reproduce::RobhazCourse course = options.course.empty()
                                             ? reproduce::embedded_robhaz_course()
                                             : reproduce::read_robhaz_course(options.course);
  const reproduce::RobhazStudy study = reproduce::study_robhaz(course);
  report(study, options);
  return all_hold(study) ? kReached : kNotHeld;
}

/// Only Masuda et al.'s tables. A value outside its band is a failure.
int execute_masuda_study(const ReproduceCommand& options) {
  const reproduce::MasudaStudy study = reproduce::study_masuda();
  report(study, options);
  return all_hold(study) ? kReached : kNotHeld;
}

/// Only the arm of the sibling thesis. A finding that fails is a failure.
int execute_arm_study(const ReproduceCommand& options) {
  if (options.reaches > 0) {
    ProgressLine progress;
    const auto show = [&](std::size_t done, std::size_t all) {
      progress.show(fmt::format("reaches: {} of {} runs", done, all));
    };
    const reproduce::ReachStudy study = reproduce::study_session_reach(
        options.reaches, {.threads = options.study.threads, .progress = show});
    fmt::print("{}", options.as_json ? to_json(study).dump(2) + "\n" : to_text(study));
    return study.all.touched == 0 ? kReached : kNotHeld;
  }
  const reproduce::ArmStudy study = reproduce::study_arm();
  report(study, options);
  return all_hold(study) ? kReached : kNotHeld;
}

/// More seeds would take an hour and change no verdict.
constexpr std::size_t kSweepSeeds = 3;

int execute(ReproduceCommand options) {
  const reproduce::StudyFile file = options.scenarios.empty()
                                        ? reproduce::embedded_study_file()
                                        : reproduce::read_study_file(options.scenarios);
  options.study.full_simulator = !options.paper_only;
  const std::size_t sweep_seeds = std::min(options.study.seeds, kSweepSeeds);
  reproduce::Study study;
  std::vector<reproduce::Sweep> sweeps;
  {
    ProgressLine progress;
    options.study.progress = [&](const std::string& what, std::size_t done, std::size_t all) {
      progress.show(fmt::format("{}: {} of {} runs", what, done, all));
    };
    study = reproduce::run_study(file, options.study);
    if (options.sweeps) {
      sweeps = reproduce::run_sweeps(
          file,
          sweep_seeds,
          options.study.first_seed,
          {.threads = options.study.threads, .progress = [&](std::size_t done, std::size_t all) {
             options.study.progress("sweeps", done, all);
           }});
    }
  }
  if (options.as_json) {
    nlohmann::json out = reproduce::to_json(study);
    if (options.sweeps) out["sweeps"] = reproduce::to_json(sweeps);
    fmt::print("{}\n", out.dump(2));
  } else {
    fmt::print("{}{}\n{}\n",
               reproduce::to_text(study),
               reproduce::to_text(sweeps),
               reproduce::checks_sentence(study.checks));
  }
  if (!options.markdown.empty()) {
    std::vector<reproduce::Section> sections =
        reproduce::study_sections(file, study, reproduce::kPictures);
    if (options.sweeps) sections.push_back(reproduce::sweeps_section(sweeps, sweep_seeds));
    reproduce::write_reproduction(options.markdown, file, study, sections);
  }
  return reproduce::all_held(study.checks) ? kReached : kNotHeld;
}

}  // namespace

void add_reproduce_command(Command app, int& status) {
  auto options = std::make_shared<ReproduceCommand>();
  const Command command = app.add_subcommand(
      "reproduce", "Run the papers' scenarios with every reading and say which claims hold");
  command.add_option("--scenarios", options->scenarios, "Another file of scenarios and limits")
      .type_name("FILE");
  command.add_option("--seeds", options->study.seeds, "Runs per row (default 10)").range(1, 1000);
  add_first_seed_option(command, options->study.first_seed);
  add_threads_option(command, options->study.threads);
  command.add_flag("--paper-only", options->paper_only, "Leave out the full simulator");
  command.add_flag("--sweeps", options->sweeps, "Also sweep K_c, K_r, d_safe and N");
  command
      .add_option("--markdown",
                  options->markdown,
                  "Also write the report to this file, and pictures/reproduction/ beside it")
      .check(refuse_unwritable_document)
      .type_name("FILE");
  const Option filter = command.add_flag(
      "--filter", options->filter, "Run the filter chapter instead: scenes, recordings, verdicts");
  command.add_option("--logs", options->logs, "Folder of CARMEN logs of a real scanner")
      .type_name("DIR")
      .needs(filter);
  const Option robhaz = command.add_flag(
      "--robhaz",
      options->robhaz,
      "Drive the course of Park et al. 2005 (Fig. 10, 11) by a simulated hand instead");
  command.add_option("--course", options->course, "Another file with course, script and hand")
      .type_name("FILE")
      .needs(robhaz);
  robhaz.excludes(filter);
  const Option masuda = command.add_flag(
      "--masuda",
      options->masuda,
      "Detect the slopes, steps and trenches of Masuda et al. 2008 (Tables I to VI) instead");
  masuda.excludes(filter);
  masuda.excludes(robhaz);
  const Option arm = command.add_flag(
      "--arm",
      options->arm,
      "Carry the sibling thesis' arm of seven joints past posts, and let it reach, instead");
  command
      .add_option("--reaches",
                  options->reaches,
                  "Only the reaches, as runs in Bullet: so many worlds of each of four kinds")
      .range(1, 10000)
      .needs(arm)
      .excludes(command.get_option("--markdown"));
  for (const Option& other : {filter, robhaz, masuda}) arm.excludes(other);
  for (const char* tables :
       {"--scenarios", "--seeds", "--first-seed", "--paper-only", "--sweeps"}) {
    filter.excludes(command.get_option(tables));
    robhaz.excludes(command.get_option(tables));
    masuda.excludes(command.get_option(tables));
    arm.excludes(command.get_option(tables));
  }
  command.add_flag("--json", options->as_json, "Print JSON");
  command.footer("Exit status: 0 every limit or asserted finding held, 1 bad input, 3 one failed.");
  command.callback([options, &status] {
    refuse_shared_files({{"--scenarios", options->scenarios}, {"--course", options->course}},
                        {{"--markdown", options->markdown}});
    status = options->filter   ? execute_filter_study(*options)
             : options->robhaz ? execute_robhaz_study(*options)
             : options->masuda ? execute_masuda_study(*options)
             : options->arm    ? execute_arm_study(*options)
                               : execute(*options);
  });
}

}  // namespace server
