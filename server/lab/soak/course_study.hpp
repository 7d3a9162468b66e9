// server/lab/soak/course_study.hpp: `tautline soak --courses`: what a robot with floor sensors
// drives over, and what it refuses, on random courses.
#pragma once

#include <cstdint>
#include <vector>

#include "server/experiment/pool.hpp"
#include "server/experiment/table.hpp"
#include "server/lab/soak/ground_courses.hpp"

namespace server::soak {

struct CourseOptions {
  std::uint64_t worlds = 50;
  std::uint64_t first_seed = 1;
  double seconds = 240;  // of each drive at most
  experiment::PoolOptions pool{};
};

struct CourseRow {
  std::uint64_t seed = 0;
  CourseEnd end{};
};

/// Drives `masuda` over each course. The same options give the same rows with any number of
/// threads.
std::vector<CourseRow> run_courses(const CourseOptions& options);

/// The pieces that the robot met, by kind; narrow trenches apart.
experiment::Table courses_table(const std::vector<CourseRow>& rows);
/// One row for every piece that the robot met.
experiment::Table course_rows(const std::vector<CourseRow>& rows);

/// True if a robot fell in this course, drove over a piece above its limit, or refused one that is
/// far enough below it and no narrow trench.
bool is_fault(const CourseRow& row);

}  // namespace server::soak
