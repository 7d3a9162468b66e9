// server/lab/reproduce/robhaz_study.hpp: reproduces Fig. 10 and 11 of Park et al. 2005: a hand on a
// stick drives an indoor course, and eight findings that the paper marks A to H in its plots. Fig.
// 12 and 13 stand beside them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "server/lab/reproduce/filter_study.hpp"
#include "server/lab/reproduce/robhaz_course.hpp"
#include "server/lab/reproduce/robhaz_turnover.hpp"

namespace server::reproduce {

/// One section of the paper's plots, judged on one run.
struct CourseFinding {
  std::string section{};  // "A"
  std::string claim{};
  bool holds = false;
  double from = 0, to = 0;  // [s] run clock; where it was looked for or found
  std::string figures{};
};

/// The findings A to H in order.
std::vector<CourseFinding> judge_course(const CourseRun& run);

struct RobhazStudy {
  RobhazCourse course{};
  std::vector<CourseRun> runs{};
  std::vector<std::vector<CourseFinding>> findings{};  // one list a run
  TurnoverStudy turnover{};
};

/// Drives `course` with every reading, and the path of Fig. 12. The same course gives the same
/// study bit for bit.
RobhazStudy study_robhaz(const RobhazCourse& course);

/// True if each finding holds in every run that asserts them, and all of Fig. 12 and 13.
bool all_hold(const RobhazStudy& study);

// ---- the study as a document ----
std::string to_text(const RobhazStudy& study);
nlohmann::json to_json(const RobhazStudy& study);
/// A section of Markdown that shows pictures from the folder `pictures` (relative to its file).
std::string to_markdown(const RobhazStudy& study, const std::string& pictures);
std::vector<Picture> draw(const RobhazStudy& study);
constexpr std::string_view kCoursePicture = "robhaz-course.svg";
/// The file of the picture of `run`: "robhaz-corrected.svg".
std::string picture_of(const CourseRun& run);

/// As for the filter study: the pictures beside `file`, and the section in it.
void write_markdown(const RobhazStudy& study, const std::filesystem::path& file);

}  // namespace server::reproduce
