// server/lab/mapping/relations.hpp: surveyed steps between poses of a log, and a path's error
// against them.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include "algo/types.hpp"

namespace server::mapping {

/// The true step between the poses of two scans, as somebody surveyed it.
struct Relation {
  std::size_t from = 0, to = 0;  // scans of the log
  algo::Pose2 step{};
};

/// Reads lines "t1 t2 dx dy dz roll pitch yaw": the pose at stamp t2 seen from that at t1 [m, rad].
/// `stamps` are those of the log's scans. Empty lines and those after '#' are skipped. Throws
/// std::runtime_error with a sentence if a line is no relation, or names a time without a scan.
std::vector<Relation> read_relations(const std::filesystem::path& file,
                                     std::span<const double> stamps);

/// What is left between the steps of a path and the surveyed ones, over all relations (Kuemmerle,
/// Steder, Dornhege, Ruhnke, Grisetti, Stachniss, Kleiner 2009).
struct RelationError {
  std::size_t count = 0;
  double translation_mean = 0, translation_sd = 0;  // [m]
  double rotation_mean = 0, rotation_sd = 0;        // [rad]
};

RelationError relation_error(std::span<const Relation> relations,
                             std::span<const algo::Pose2> path_W);

}  // namespace server::mapping
