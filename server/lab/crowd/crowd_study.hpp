// server/lab/crowd/crowd_study.hpp: crossings among recorded people at 100 moments, and the same
// by a robot that stands still near people.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "server/experiment/pool.hpp"
#include "server/lab/crowd/crossing.hpp"

namespace server::crowd {

/// The figures of all crossings of one driver.
struct CrowdFigures {
  int crossings = 0;
  int crossed = 0;
  int contacts_moving = 0;
  int contacts_at_rest = 0;
  double intrusion = 0;   // [s] of all crossings together
  double personal = 0;    // [s] of all crossings together
  double free_time = 0;   // [s] mean of the same ways without people
  double time_ratio = 0;  // of those crossed, against the same ways without people; NaN: none
};

struct CrowdStudy {
  std::string name{};
  std::size_t people = 0;
  double seconds = 0;  // of the recording
  std::vector<Way> ways{};
  std::vector<Crossing> driven{};    // one a way
  std::vector<Crossing> standing{};  // one a way
  CrowdFigures figures{};
  CrowdFigures standing_figures{};
};

/// `robot` as for cross().
CrowdStudy study_crowd(const Recording& recording,
                       const RunSpec& robot,
                       const experiment::PoolOptions& pool);

nlohmann::json to_json(const CrowdStudy& study);
/// For people.
std::string to_text(const CrowdStudy& study);
/// A line `crossing,t,x,y,heading` for each tick of the driven crossings: time [s] and pose [m,
/// rad] of the recording.
void write_tracks(const CrowdStudy& study, double period, const std::filesystem::path& file);

}  // namespace server::crowd
