// server/experiment/sweep/parameter_design.cpp: reads a design and makes its settings.
#include "server/experiment/sweep/parameter_design.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "algo/pipeline/parameter_table.hpp"
#include "sim/random.hpp"

namespace server::sweep {
namespace {

using nlohmann::json;

constexpr std::uint64_t kPurpose = 0x7377656570000000;  // "sweep": the generator's purpose
constexpr std::uint64_t kMaxDesignSeed = (std::uint64_t{1} << 53) - 1;  // exact in a JSON number

const algo::ParameterInfo& parameter_named(const JsonReader& in, const std::string& name) {
  const algo::ParameterInfo* const found = algo::find_parameter(name);
  if (found == nullptr) in.fail(name, "there is no such parameter");
  return *found;
}

double value_of(const algo::ParameterInfo& parameter, const json& value, const std::string& path) {
  const double number = finite_number(value, path);
  if (const auto complaint = algo::limit_refusal(parameter, number)) {
    throw DocumentError(path, *complaint);
  }
  return number;
}

/// The lists of values of the object `key` of `parent`, one for each parameter.
std::vector<Design::Axis> axes_from_json(const JsonReader& parent,
                                         std::string_view key,
                                         std::size_t most_values) {
  const JsonReader in = parent.object(key);
  std::vector<Design::Axis> axes;
  if (in.raw().empty()) parent.fail(key, "names no parameter");
  if (in.raw().size() > kMostAxes) {
    parent.fail(key, fmt::format("has more than {} parameters", kMostAxes));
  }
  for (const auto& [name, unused] : in.raw().items()) {
    Design::Axis axis{.parameter = &parameter_named(in, name)};
    if (std::ranges::count(axes, axis.parameter, &Design::Axis::parameter) > 0) {
      in.fail(name, fmt::format("is {} by another name", axis.parameter->key()));
    }
    in.each(name, most_values, [&](const json& value, const std::string& path) {
      axis.values.push_back(value_of(*axis.parameter, value, path));
    });
    if (axis.values.empty()) in.fail(name, "has no value");
    axes.push_back(std::move(axis));
  }
  return axes;
}

void read_grid(const JsonReader& in, Design& design) {
  design.axes = axes_from_json(in, "grid", kMostValues);
  for (const Design::Axis& axis : design.axes) {
    std::vector<double> values = axis.values;
    std::ranges::sort(values);
    if (std::ranges::adjacent_find(values) == values.end()) continue;
    in.object("grid").fail(axis.parameter->key(), "has a value twice");
  }
}

void read_list(const JsonReader& in, Design& design) {
  in.each("list", kMostDraws, [&](const json& value, const std::string& path) {
    Point point = point_from_json(JsonReader(value, path));
    if (point.empty()) throw DocumentError(path, "names no parameter");
    const bool alike =
        design.list.empty() ||
        std::ranges::equal(
            point, design.list.front(), {}, &Point::value_type::first, &Point::value_type::first);
    if (!alike) throw DocumentError(path, "must name the same parameters as the first entry");
    design.list.push_back(std::move(point));
  });
  if (design.list.empty()) in.fail("list", "is empty");
}

void read_draws(const JsonReader& in, Design& design) {
  in.only({"count", "seed", "parameters"});
  design.draws = in.whole("count", kMostDraws);
  if (design.draws == 0) in.fail("count", "must be at least 1");
  design.seed = in.whole_or("seed", design.seed, kMaxDesignSeed);
  design.axes = axes_from_json(in, "parameters", 2);
  const JsonReader ranges = in.object("parameters");
  for (const auto& [name, value] : ranges.raw().items()) {
    if (value.size() == 2 && value[0].get<double>() < value[1].get<double>()) continue;
    ranges.fail(name, "must be [least, largest], the first below the second");
  }
}

/// The value at `share`, in [0, 1), of the axis' range.
double between(const Design::Axis& axis, double share) {
  const double low = axis.values[0];
  const double high = axis.values[1];
  if (axis.parameter->step == 1) return low + std::floor(share * (high - low + 1));
  return low + share * (high - low);
}

std::vector<Point> grid(const Design& design) {
  std::vector<Point> points{{}};
  for (const Design::Axis& axis : design.axes) {
    std::vector<Point> next;
    next.reserve(points.size() * axis.values.size());
    for (const Point& point : points) {
      for (const double value : axis.values) {
        next.push_back(point);
        next.back()[std::string(axis.parameter->key())] = value;
      }
    }
    points = std::move(next);
  }
  return points;
}

std::vector<Point> random(const Design& design) {
  sim::Random numbers(design.seed, kPurpose);
  std::vector<Point> points(design.draws);
  for (Point& point : points) {
    for (const Design::Axis& axis : design.axes) {
      point[std::string(axis.parameter->key())] = between(axis, numbers.uniform());
    }
  }
  return points;
}

std::vector<Point> latin_hypercube(const Design& design) {
  sim::Random numbers(design.seed, kPurpose + 1);
  std::vector<Point> points(design.draws);
  std::vector<std::size_t> parts(design.draws);
  const auto count = static_cast<double>(design.draws);
  for (const Design::Axis& axis : design.axes) {
    std::iota(parts.begin(), parts.end(), std::size_t{0});
    for (std::size_t left = parts.size(); left > 1; --left) {
      const double pick = numbers.uniform() * static_cast<double>(left);
      std::swap(parts[left - 1], parts[static_cast<std::size_t>(pick)]);
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double share = (static_cast<double>(parts[i]) + numbers.uniform()) / count;
      points[i][std::string(axis.parameter->key())] = between(axis, share);
    }
  }
  return points;
}

}  // namespace

double Design::size() const {
  switch (kind) {
    case DesignKind::None:
      return 1;
    case DesignKind::Grid:
      return std::transform_reduce(
          axes.begin(), axes.end(), 1.0, std::multiplies{}, [](const Axis& axis) {
            return static_cast<double>(axis.values.size());
          });
    case DesignKind::List:
      return static_cast<double>(list.size());
    default:
      return static_cast<double>(draws);
  }
}

std::vector<Point> Design::points() const {
  switch (kind) {
    case DesignKind::None:
      return {{}};
    case DesignKind::Grid:
      return grid(*this);
    case DesignKind::List:
      return list;
    case DesignKind::Random:
      return random(*this);
    default:
      return latin_hypercube(*this);
  }
}

Design design_from_json(const JsonReader& in) {
  Design design;
  if (!in.has("sweep")) return design;
  const JsonReader sweep = in.object("sweep");
  sweep.only({"grid", "list", "random", "latin_hypercube"});
  if (sweep.raw().size() != 1) {
    in.fail("sweep", "must have exactly one of grid, list, random, latin_hypercube");
  }
  const std::string kind = sweep.raw().items().begin().key();
  if (kind == "grid") {
    design.kind = DesignKind::Grid;
    read_grid(sweep, design);
  } else if (kind == "list") {
    design.kind = DesignKind::List;
    read_list(sweep, design);
  } else {
    design.kind = kind == "random" ? DesignKind::Random : DesignKind::LatinHypercube;
    read_draws(sweep.object(kind), design);
  }
  return design;
}

Point point_from_json(const JsonReader& in) {
  Point point;
  for (const auto& [name, value] : in.raw().items()) {
    const algo::ParameterInfo& parameter = parameter_named(in, name);
    const double number = value_of(parameter, value, in.at(name));
    if (!point.emplace(parameter.key(), number).second) {
      in.fail(name, fmt::format("is {} by another name", parameter.key()));
    }
  }
  return point;
}

}  // namespace server::sweep
