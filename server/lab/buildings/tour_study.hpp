// server/lab/buildings/tour_study.hpp: `tautline buildings --tour`: tours in many buildings, and
// their figures.
#pragma once

#include <vector>

#include <nlohmann/json.hpp>

#include "server/experiment/table.hpp"
#include "server/lab/buildings/tour_drive.hpp"

namespace server::buildings {

struct TourStudyOptions {
  Options buildings{};  // seeds, kinds, controller, pool
  std::size_t goals = 200;
  std::vector<Odometry> odometries{kOdometries.begin(), kOdometries.end()};
};

/// The tours of the shard by seed, then by odometry, with any number of threads. The memory is that
/// of the process: with more than one thread, that of several tours.
std::vector<Tour> run_tours(const TourStudyOptions& options);

/// One row per tour, and the sum for each odometry.
experiment::Table tours_table(const std::vector<Tour>& tours);
/// The legs that are faults.
experiment::Table tour_faults_table(const std::vector<Tour>& tours);
/// One row per leg.
experiment::Table legs_table(const std::vector<Tour>& tours);
nlohmann::json tours_json(const std::vector<Tour>& tours);

}  // namespace server::buildings
