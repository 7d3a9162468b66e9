// algo/full_strip/plan_world.hpp: what a plan rests on: the map of the scans, what is remembered
// beyond it, and a known map.
#pragma once

#include <optional>

#include "algo/drawn_space.hpp"
#include "algo/full_strip/building_memory.hpp"
#include "algo/full_strip/local_map.hpp"

namespace algo {

/// The places to plan over.
struct PlanWorld {
  const LocalMap& map;
  const BuildingMemory& memory;
  /// A known map; null: none. It counts where the robot has not looked.
  const DrawnSpace* drawn = nullptr;

  /// [m] The clearance that the known map shows of a cell; nothing if it shows none.
  std::optional<double> drawn_room(BuildingMemory::Cell c) const {
    if (drawn == nullptr) return std::nullopt;
    const std::uint8_t cm = drawn->clearance(c.column, c.row);
    if (cm == DrawnSpace::kUnknown) return std::nullopt;
    return cm * 0.01 + kDrawnDoubt;
  }
  static constexpr double kDrawnDoubt = 0.06;  // [m] by which a drawn clearance may be too low
};

}  // namespace algo
