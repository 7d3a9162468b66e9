// server/lab/soak/course_study.cpp: courses from seeds, and their pieces by kind.
#include "server/lab/soak/course_study.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "algo/units.hpp"

namespace server::soak {
namespace {

using algo::GroundClass;

bool is_slope(GroundClass kind) {
  return kind == GroundClass::SlopeUp || kind == GroundClass::SlopeDown;
}

using PieceChoice = std::function<bool(const CoursePiece&)>;

void add_pieces(experiment::Table& table,
                const std::string& title,
                const std::vector<CourseRow>& rows,
                const PieceChoice& chosen) {
  std::array<int, 3> passed{};
  std::array<int, 3> stopped{};
  for (const CourseRow& row : rows) {
    for (const MetPiece& met : row.end.met) {
      if (!chosen(met.piece)) continue;
      ++(met.passed ? passed : stopped).at(static_cast<std::size_t>(met.fit));
    }
  }
  std::vector<std::string>& line = table.rows.emplace_back();
  line.push_back(title);
  for (std::size_t fit = 0; fit < passed.size(); ++fit) {
    line.push_back(fmt::format("{}", passed.at(fit)));
    line.push_back(fmt::format("{}", stopped.at(fit)));
  }
}

}  // namespace

std::vector<CourseRow> run_courses(const CourseOptions& options) {
  const algo::ClimbLimits limits = masuda_limits();
  std::vector<CourseRow> rows(options.pool.shard.share(options.worlds));
  experiment::for_each(
      options.worlds, options.pool, [&](std::size_t i, const std::stop_token& /*stop*/) {
        CourseRow& row = rows[i / options.pool.shard.count];
        row.seed = options.first_seed + i;
        row.end = drive_course(random_course(row.seed, limits), limits, row.seed, options.seconds);
      });
  return rows;
}

experiment::Table courses_table(const std::vector<CourseRow>& rows) {
  experiment::Table table{.header = {"",
                                     "below the limit: passed",
                                     "refused",
                                     "within the margin: passed",
                                     "refused",
                                     "above the limit: passed",
                                     "refused"}};
  constexpr std::array<std::pair<GroundClass, const char*>, 5> kKinds{
      {{GroundClass::StepUp, "steps up"},
       {GroundClass::StepDown, "steps down"},
       {GroundClass::SlopeUp, "slopes up"},
       {GroundClass::SlopeDown, "slopes down"},
       {GroundClass::Trench, "trenches"}}};
  for (const auto& [kind, title] : kKinds) {
    add_pieces(table, title, rows, [kind = kind](const CoursePiece& piece) {
      return piece.kind == kind && !is_narrow(piece);
    });
  }
  add_pieces(table, "all", rows, [](const CoursePiece& piece) { return !is_narrow(piece); });
  add_pieces(table, "trenches under 2 cm", rows, is_narrow);
  return table;
}

experiment::Table course_rows(const std::vector<CourseRow>& rows) {
  experiment::Table table{
      .header = {"course", "piece", "fit", "size_m_or_deg", "passed", "arrived", "fell", "words"}};
  constexpr std::array<const char*, 3> kFits{"below", "within", "above"};
  for (const CourseRow& row : rows) {
    for (const MetPiece& met : row.end.met) {
      const double unit = is_slope(met.piece.kind) ? algo::units::kRadiansPerDegree : 1;
      table.rows.push_back({fmt::format("{}", row.seed),
                            std::string(name(met.piece.kind)),
                            kFits.at(static_cast<std::size_t>(met.fit)),
                            fmt::format("{:.4f}", met.piece.size / unit),
                            met.passed ? "1" : "0",
                            row.end.arrived ? "1" : "0",
                            row.end.fell ? "1" : "0",
                            met.passed ? "" : row.end.words});
    }
  }
  return table;
}

bool is_fault(const CourseRow& row) {
  return row.end.fell || std::ranges::any_of(row.end.met, [](const MetPiece& met) {
           const bool climbed = met.passed && met.fit == PieceFit::Above;
           const bool refused = !met.passed && met.fit == PieceFit::Below;
           return climbed || (refused && !is_narrow(met.piece));
         });
}

}  // namespace server::soak
