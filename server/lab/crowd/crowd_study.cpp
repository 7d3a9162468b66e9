// server/lab/crowd/crowd_study.cpp: the crossings on all cores, and their figures.
#include "server/lab/crowd/crowd_study.hpp"

#include <limits>

#include <fmt/format.h>

#include "server/experiment/table.hpp"
#include "server/run/text_file.hpp"

namespace server::crowd {
namespace {

constexpr std::size_t kWays = 4;

CrowdFigures figures_of(const std::vector<Crossing>& crossings,
                        const std::vector<double>& free_times) {
  CrowdFigures sum{.crossings = static_cast<int>(crossings.size())};
  double time = 0;
  double free_time = 0;
  for (std::size_t k = 0; k < crossings.size(); ++k) {
    const Crossing& crossing = crossings[k];
    sum.contacts_moving += crossing.moving_contact ? 1 : 0;
    sum.contacts_at_rest += crossing.contacts_at_rest;
    sum.intrusion += crossing.intrusion;
    sum.personal += crossing.personal;
    sum.free_time += free_times[k % kWays] / static_cast<double>(crossings.size());
    if (!crossing.crossed) continue;
    ++sum.crossed;
    time += crossing.time;
    free_time += free_times[k % kWays];
  }
  sum.time_ratio = sum.crossed > 0 ? time / free_time : std::numeric_limits<double>::quiet_NaN();
  return sum;
}

nlohmann::json to_json(const CrowdFigures& figures) {
  return {{"crossings", figures.crossings},
          {"crossed", figures.crossed},
          {"contacts_moving", figures.contacts_moving},
          {"contacts_at_rest", figures.contacts_at_rest},
          {"intrusion_s", figures.intrusion},
          {"personal_s", figures.personal},
          {"free_time_s", figures.free_time},
          {"time_ratio", figures.time_ratio}};  // null where nobody has crossed
}

}  // namespace

CrowdStudy study_crowd(const Recording& recording,
                       const RunSpec& robot,
                       const experiment::PoolOptions& pool) {
  CrowdStudy study{.name = recording.name,
                   .people = recording.walkers.size(),
                   .seconds = recording.until - recording.from};
  for (std::size_t k = 0; k < kCrossings; ++k) study.ways.push_back(way_of(recording, k));
  study.driven.resize(kCrossings);
  study.standing.resize(kCrossings);
  std::vector<double> free_times(kWays);
  experiment::for_each(
      2 * kCrossings + kWays, pool, [&](std::size_t i, const std::stop_token& /*stop*/) {
        const Way& way = study.ways[i % kCrossings];
        if (i < kCrossings) {
          study.driven[i] = cross(recording, way, robot, Driver::Controller);
        } else if (i < 2 * kCrossings) {
          study.standing[i - kCrossings] = cross(recording, way, robot, Driver::Standing);
        } else {
          free_times[i % kWays] = cross(recording, way, robot, Driver::Alone).time;
        }
      });
  study.figures = figures_of(study.driven, free_times);
  study.standing_figures = figures_of(study.standing, free_times);
  return study;
}

nlohmann::json to_json(const CrowdStudy& study) {
  nlohmann::json out = to_json(study.figures);
  out["file"] = study.name;
  out["people"] = study.people;
  out["recorded_s"] = study.seconds;
  out["standing"] = to_json(study.standing_figures);
  return out;
}

std::string to_text(const CrowdStudy& study) {
  experiment::Table table{.header = {"robot",
                                     "crossed",
                                     "contacts moving",
                                     "at rest",
                                     "under 0.45 m [s]",
                                     "under 1.2 m [s]",
                                     "time over free"}};
  const auto add = [&](const char* name, const CrowdFigures& f) {
    table.rows.push_back({name,
                          fmt::format("{} of {}", f.crossed, f.crossings),
                          fmt::format("{}", f.contacts_moving),
                          fmt::format("{}", f.contacts_at_rest),
                          fmt::format("{:.1f}", f.intrusion),
                          fmt::format("{:.1f}", f.personal),
                          fmt::format("{:.2f}", f.time_ratio)});
  };
  add("driven", study.figures);
  add("stands still near people", study.standing_figures);
  return fmt::format("{}: {} people in {:.0f} s; alone, a way takes {:.1f} s in the mean\n{}",
                     study.name,
                     study.people,
                     study.seconds,
                     study.figures.free_time,
                     experiment::to_text(table));
}

void write_tracks(const CrowdStudy& study, double period, const std::filesystem::path& file) {
  std::string lines = "crossing,t,x,y,heading\n";
  for (std::size_t k = 0; k < study.driven.size(); ++k) {
    const auto& track_W = study.driven[k].track_W;
    for (std::size_t tick = 0; tick < track_W.size(); ++tick) {
      const algo::Pose2& pose_W = track_W[tick];
      lines += fmt::format("{},{:.3f},{:.6f},{:.6f},{:.6f}\n",
                           k,
                           study.ways[k].begin + period * static_cast<double>(tick),
                           pose_W.x,
                           pose_W.y,
                           pose_W.heading);
    }
  }
  write_text(file, lines);
}

}  // namespace server::crowd
