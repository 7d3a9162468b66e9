// server/experiment/sweep/parameter_design.hpp: the settings of the swept parameters: a grid, a
// list, or seeded draws.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "algo/parameters.hpp"
#include "server/run/json_reader.hpp"

namespace server::sweep {

constexpr std::size_t kMostAxes = 16;        // swept parameters
constexpr std::size_t kMostValues = 10'000;  // of one parameter
constexpr std::size_t kMostDraws = 100'000;  // settings of a list or of draws

/// One setting: value by parameter key, in order of the key. Empty: nothing is swept.
using Point = std::map<std::string, double>;

enum class DesignKind : std::uint8_t { None, Grid, List, Random, LatinHypercube };

struct Design {
  struct Axis {
    const algo::ParameterInfo* parameter = nullptr;
    std::vector<double> values{};  // of a grid; of draws the least and the largest value
  };

  DesignKind kind = DesignKind::None;
  std::vector<Axis> axes{};   // of a grid and of draws
  std::vector<Point> list{};  // of a list
  std::size_t draws = 0;
  std::uint64_t seed = 1;

  /// The number of settings, 1 if nothing is swept. May be too large to make them.
  double size() const;
  /// All settings, in order; a grid's last parameter changes fastest. The same design gives the
  /// same settings on every machine. Draws are uniform, and whole numbers where the parameter takes
  /// only those. A Latin hypercube cuts each range into as many equal parts as there are settings
  /// and draws once in each. Source: McKay, Beckman and Conover 1979.
  std::vector<Point> points() const;
};

/// Reads the field "sweep" of `in`. Throws DocumentError.
Design design_from_json(const JsonReader& in);

/// `{"k_r": 0.3}` with names and values checked one by one. Throws DocumentError about the field.
Point point_from_json(const JsonReader& in);

}  // namespace server::sweep
