// server/lab/reproduce/robhaz_study.cpp: the readings, and the course with each.
#include "server/lab/reproduce/robhaz_study.hpp"

#include <algorithm>
#include <utility>

#include "algo/teleop/teleop_parameters.hpp"

namespace server::reproduce {
namespace {

/// Eq. 8-10 as printed, a bang-bang force, and one of the paper's two forces ahead.
algo::Parameters literal_reading(algo::ForwardForce force) {
  return {{&algo::kWallLaw, static_cast<double>(algo::WallLaw::Literal)},
          {&algo::kForwardForce, static_cast<double>(force)},
          {&algo::kForceRamp, 0}};
}

}  // namespace

RobhazStudy study_robhaz(const RobhazCourse& course) {
  RobhazStudy study{.course = course};
  const auto add = [&study](CourseRun run, const char* reading, const char* means, bool asserted) {
    run.reading = reading;
    run.means = means;
    run.asserted = asserted;
    study.findings.push_back(judge_course(run));
    study.runs.push_back(std::move(run));
  };
  add(drive_course(course, {}),
      "corrected",
      "Eq. 8-10 corrected, a force that rises along a ramp, ahead above Eq. 4's speed at full "
      "stick",
      true);
  add(drive_course(course, literal_reading(algo::ForwardForce::Sparseness)),
      "literal, 2.3",
      "Eq. 8-10 as printed, bang-bang, force ahead above v_sprs (section 2.3)",
      false);
  add(drive_course(course, literal_reading(algo::ForwardForce::Executed)),
      "literal, 3",
      "Eq. 8-10 as printed, bang-bang, force ahead whenever v_cmd > v (section 3)",
      false);
  RobhazCourse stiff = course;
  stiff.hand.forward_compliance = 0;
  stiff.hand.turn_compliance = 0;
  add(drive_course(stiff, {}),
      "stiff hand",
      "as corrected, by a hand that does not give way: the force alone moves the hand in G",
      false);
  study.turnover = study_turnover();
  return study;
}

bool all_hold(const RobhazStudy& study) {
  for (std::size_t k = 0; k < study.runs.size(); ++k) {
    if (study.runs[k].asserted && !std::ranges::all_of(study.findings[k], &CourseFinding::holds)) {
      return false;
    }
  }
  return all_hold(study.turnover);
}

}  // namespace server::reproduce
