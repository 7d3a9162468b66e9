// server/lab/mapping/locate_document.cpp: what the study of known maps found, as text, JSON and
// pictures.
#include <algorithm>

#include <fmt/format.h>

#include "server/experiment/path_picture.hpp"
#include "server/experiment/table.hpp"
#include "server/lab/mapping/locate_study.hpp"
#include "server/lab/reproduce/marked.hpp"
#include "server/run/text_file.hpp"

namespace server::mapping {
namespace {

constexpr reproduce::Marks kLocateMarks{"<!-- locate study: made by the program, not by hand -->\n",
                                        "<!-- end of the locate study -->"};
constexpr double kGoalRing = 0.3;  // [m]

const char* word(DrivesBy by) {
  switch (by) {
    case DrivesBy::Wheels:
      return "wheels alone";
    case DrivesBy::Map:
      return "map, start known";
    case DrivesBy::MapLost:
      break;
  }
  return "map, start unknown";
}

/// Of one drawing and DrivesBy.
struct Sum {
  std::size_t runs = 0, reached = 0, collided = 0, found = 0;
  double goal_off = 0, worst_off = 0, false_time = 0, located = 0, within_3 = 0;
  double way = 0;              // [m] of the passengers who were located, at most
  double passenger_false = 0;  // [s]

  void add(const LocateRun& run) {
    ++runs;
    // By wheels alone a robot believes that it is there.
    if (run.outcome == algo::Outcome::Reached && run.goal_off <= 2 * kGoalRing) ++reached;
    if (run.outcome == algo::Outcome::Collided) ++collided;
    goal_off = std::max(goal_off, run.goal_off);
    worst_off = std::max(worst_off, run.worst_off);
    false_time += run.false_time;
    located += run.located;
    within_3 += run.within_3;
    passenger_false += run.passenger_false;
    if (run.passenger_found < 0) return;
    ++found;
    way = std::max(way, run.passenger_found);
  }
};

experiment::Table table_of(const std::vector<LocateRun>& runs) {
  experiment::Table table{.header = {"building",
                                     "by",
                                     "at the goal",
                                     "collisions",
                                     "goal off, worst m",
                                     "pose off, worst m",
                                     "located %",
                                     "sure and wrong s",
                                     "within 3 sd %",
                                     "passenger found",
                                     "sure and wrong s"}};
  for (const char* drawing : kDrawings) {
    for (const DrivesBy by : {DrivesBy::Wheels, DrivesBy::Map, DrivesBy::MapLost}) {
      Sum sum;
      for (const LocateRun& run : runs) {
        if (run.drawing == drawing && run.by == by) sum.add(run);
      }
      if (sum.runs == 0) continue;
      const bool wheels = by == DrivesBy::Wheels;
      const bool passenger = by == DrivesBy::Map;
      const auto part = [&](double value) {
        return wheels ? "" : fmt::format("{:.1f}", 100 * value / static_cast<double>(sum.runs));
      };
      table.rows.push_back(
          {drawing,
           word(by),
           fmt::format("{} of {}", sum.reached, sum.runs),
           fmt::format("{}", sum.collided),
           fmt::format("{:.2f}", sum.goal_off),
           wheels ? "" : fmt::format("{:.2f}", sum.worst_off),
           part(sum.located),
           wheels ? "" : fmt::format("{:.1f}", sum.false_time),
           part(sum.within_3),
           passenger ? fmt::format("{} of {}, after {:.0f} m at most", sum.found, sum.runs, sum.way)
                     : "",
           passenger ? fmt::format("{:.1f}", sum.passenger_false) : ""});
    }
  }
  return table;
}

experiment::Table table_of(const std::vector<DeadEndRun>& runs) {
  experiment::Table table{
      .header = {"building", "plans", "at the goal", "time s", "way m", "goal off, worst m"}};
  for (const char* drawing : kDrawings) {
    for (const bool planned : {false, true}) {
      double count = 0, reached = 0, time = 0, way = 0, goal_off = 0;
      for (const DeadEndRun& run : runs) {
        if (run.drawing != drawing || run.planned != planned) continue;
        ++count;
        time += run.time;
        way += run.way;
        goal_off = std::max(goal_off, run.goal_off);
        if (run.outcome == algo::Outcome::Reached && run.goal_off <= 2 * kGoalRing) ++reached;
      }
      if (count == 0) continue;
      table.rows.push_back({drawing,
                            planned ? "by sight and map" : "by sight",
                            fmt::format("{:.0f} of {:.0f}", reached, count),
                            fmt::format("{:.0f}", time / count),
                            fmt::format("{:.0f}", way / count),
                            fmt::format("{:.2f}", goal_off)});
    }
  }
  return table;
}

}  // namespace

std::string to_text(const LocateStudy& study) {
  return to_text(table_of(study.runs)) + '\n' + to_text(table_of(study.dead_ends));
}

nlohmann::json to_json(const LocateStudy& study) {
  nlohmann::json runs = nlohmann::json::array();
  for (const LocateRun& run : study.runs) {
    runs.push_back({{"building", run.drawing},
                    {"by", word(run.by)},
                    {"seed", run.seed},
                    {"outcome", algo::name(run.outcome)},
                    {"goal_off_m", run.goal_off},
                    {"worst_off_m", run.worst_off},
                    {"located", run.located},
                    {"false_s", run.false_time},
                    {"within_3_deviations", run.within_3},
                    {"passenger_found_m", run.passenger_found},
                    {"passenger_false_s", run.passenger_false}});
  }
  nlohmann::json dead_ends = nlohmann::json::array();
  for (const DeadEndRun& run : study.dead_ends) {
    dead_ends.push_back({{"building", run.drawing},
                         {"plans_by_map", run.planned},
                         {"seed", run.seed},
                         {"outcome", algo::name(run.outcome)},
                         {"time_s", run.time},
                         {"way_m", run.way},
                         {"goal_off_m", run.goal_off}});
  }
  return {{"runs", std::move(runs)}, {"dead_ends", std::move(dead_ends)}};
}

namespace {

/// The true paths of one building's first seed.
template <typename Run, typename Words>
std::vector<experiment::DrawnPath> paths_of(const std::vector<Run>& runs,
                                            const std::string& drawing,
                                            const Words& words) {
  std::vector<experiment::DrawnPath> paths;
  std::uint64_t seed = 0;
  for (const Run& run : runs) {
    if (run.drawing != drawing) continue;
    if (paths.empty()) seed = run.seed;
    const std::string told = words(run);
    if (run.seed == seed && !told.empty()) paths.push_back({told, run.track_W, paths.size()});
  }
  return paths;
}

}  // namespace

void write_markdown(const LocateStudy& study, const std::filesystem::path& file) {
  const std::filesystem::path pictures = reproduce::folder_beside(file, "pictures/maps");
  std::string section;
  const auto add_picture = [&](const std::string& name,
                               const std::string& title,
                               const Drawing& drawing,
                               const std::vector<experiment::DrawnPath>& paths) {
    write_text(pictures / (name + ".svg"),
               draw_paths(title, scenario_of(drawing), kGoalRing, paths));
    section += fmt::format("\n![{}](pictures/maps/{}.svg)\n", title, name);
  };
  const std::uint64_t seed = study.runs.empty() ? 1 : study.runs.front().seed;
  section += to_markdown(table_of(study.runs));
  for (const char* drawing : kDrawings) {
    add_picture(drawing,
                fmt::format("{}, seed {}: true paths", drawing, seed),
                drawing_of(drawing, seed),
                paths_of(study.runs, drawing, [](const LocateRun& run) -> std::string {
                  return run.by == DrivesBy::MapLost ? "" : word(run.by);
                }));
  }
  section += '\n' + to_markdown(table_of(study.dead_ends));
  for (const char* drawing : kDrawings) {
    add_picture(fmt::format("{}-dead-end", drawing),
                fmt::format("{} with a dead end, seed {}: true paths", drawing, seed),
                dead_end_of(drawing, seed),
                paths_of(study.dead_ends, drawing, [](const DeadEndRun& run) {
                  return std::string(run.planned ? "planned by sight and map" : "by sight");
                }));
  }
  reproduce::put_marked(file, kLocateMarks, section);
}

}  // namespace server::mapping
