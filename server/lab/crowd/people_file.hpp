// server/lab/crowd/people_file.hpp: people who were recorded on a square or in a street.
#pragma once

#include <filesystem>
#include <istream>
#include <optional>
#include <string>
#include <vector>

#include "algo/obstacle_path.hpp"
#include "algo/types.hpp"

namespace server::crowd {

inline constexpr double kPersonRadius = 0.25;  // [m]
inline constexpr double kPersonHeight = 1.7;   // [m]
inline constexpr double kFrameTime = 0.04;     // [s] between two frames of a recording

/// One person, there from the first key to the last, on straight lines in between.
struct Walker {
  std::string id{};
  std::vector<algo::ObstaclePath::Key> keys{};  // times [s] and places [m] of the recording

  double from() const { return keys.front().time; }
  double until() const { return keys.back().time; }
  bool there(double time) const { return from() <= time && time <= until(); }
  /// `time` lies between from() and until().
  algo::Vec2 at(double time) const;
};

/// All people of a recording, and the rectangle of all their places.
struct Recording {
  std::string name{};
  std::vector<Walker> walkers{};  // by their first appearance
  double from = 0;                // [s]
  double until = 0;               // [s]
  algo::Vec2 low{0, 0};           // [m]
  algo::Vec2 high{0, 0};          // [m]
};

/// The frame at `time` [s], with as many digits as a file has.
std::string frame_at(double time);

/// Reads lines `frame id x y`, with x and y in metres; `name` stands in the errors. Throws
/// std::runtime_error with a sentence that names the line.
Recording read_people(std::istream& lines, const std::string& name);
/// Throws std::runtime_error with a sentence if the file cannot be read.
Recording read_people(const std::filesystem::path& file);

}  // namespace server::crowd
