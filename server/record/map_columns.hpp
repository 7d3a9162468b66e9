// server/record/map_columns.hpp: the pose on a known map as columns of the CSV, which only the runs
// of a robot with a map have.
#pragma once

#include <span>

#include "server/record/frame_columns.hpp"

namespace server {

std::span<const FrameColumn> map_columns();

}  // namespace server
