// server/lab/mapping/relations.cpp: reads surveyed relations, and judges a path by them.
#include "server/lab/mapping/relations.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <sstream>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include "server/run/text_file.hpp"

namespace server::mapping {
namespace {

constexpr double kSameStamp = 0.05;  // [s] between a relation and its scan

/// Finds scans by their stamps.
class ScanTimes {
 public:
  explicit ScanTimes(std::span<const double> stamps) : stamps_(stamps), order_(stamps.size()) {
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::ranges::stable_sort(order_, {}, [&](std::size_t i) { return stamps_[i]; });
    if (stamps.empty() || stamps_[order_.front()] == stamps_[order_.back()]) {
      throw std::runtime_error(
          "The log's scans have no stamps that differ, so relations cannot name them.");
    }
  }

  /// The scan nearest to `stamp`.
  std::size_t at(double stamp) const {
    const auto after =
        std::ranges::lower_bound(order_, stamp, {}, [&](std::size_t i) { return stamps_[i]; });
    if (after == order_.begin()) return *after;
    if (after == order_.end()) return order_.back();
    const std::size_t before = *std::prev(after);
    return stamp - stamps_[before] <= stamps_[*after] - stamp ? before : *after;
  }
  double off(double stamp) const { return std::abs(stamps_[at(stamp)] - stamp); }

 private:
  std::span<const double> stamps_;
  std::vector<std::size_t> order_;
};

std::array<double, 8> numbers_of(const std::string& line, const std::string& where) {
  std::istringstream words(line);
  std::array<double, 8> numbers{};
  std::string rest;
  for (double& number : numbers) {
    if (!(words >> number) || !std::isfinite(number)) {
      throw std::runtime_error(where + " is no relation: t1 t2 dx dy dz roll pitch yaw.");
    }
  }
  if (words >> rest) {
    throw std::runtime_error(where + " has more than the eight numbers of a relation.");
  }
  return numbers;
}

struct MeanAndSpread {
  double mean = 0, spread = 0;
};

MeanAndSpread over(const std::vector<double>& values) {
  if (values.empty()) return {};
  const auto count = static_cast<double>(values.size());
  MeanAndSpread out;
  for (const double value : values) out.mean += value / count;
  for (const double value : values) out.spread += (value - out.mean) * (value - out.mean) / count;
  out.spread = std::sqrt(out.spread);
  return out;
}

}  // namespace

std::vector<Relation> read_relations(const std::filesystem::path& file,
                                     std::span<const double> stamps) {
  std::istringstream text(read_text(file));
  const ScanTimes times(stamps);
  std::vector<Relation> relations;
  std::string line;
  for (int number = 1; std::getline(text, line); ++number) {
    line.erase(std::ranges::find(line, '#'), line.end());
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    const std::string where = fmt::format("Line {} of {}", number, file.filename().string());
    const auto [t1, t2, dx, dy, dz, roll, pitch, yaw] = numbers_of(line, where);
    for (const double t : {t1, t2}) {
      if (times.off(t) <= kSameStamp) continue;
      throw std::runtime_error(
          fmt::format("{} names the time {:.6f}, but the log's nearest scan is {:.3g} s away.",
                      where,
                      t,
                      times.off(t)));
    }
    relations.push_back({times.at(t1), times.at(t2), {dx, dy, algo::wrap_angle(yaw)}});
  }
  if (relations.empty()) {
    throw std::runtime_error("The file " + file.filename().string() + " holds no relation.");
  }
  return relations;
}

RelationError relation_error(std::span<const Relation> relations,
                             std::span<const algo::Pose2> path_W) {
  std::vector<double> translations;
  std::vector<double> rotations;
  for (const Relation& relation : relations) {
    const algo::Pose2 step = algo::pose_step(path_W[relation.from], path_W[relation.to]);
    const algo::Pose2 left = algo::pose_step(relation.step, step);
    translations.push_back(left.position().norm());
    rotations.push_back(std::abs(left.heading));
  }
  const MeanAndSpread translation = over(translations);
  const MeanAndSpread rotation = over(rotations);
  return {relations.size(), translation.mean, translation.spread, rotation.mean, rotation.spread};
}

}  // namespace server::mapping
