// server/record/arm_columns.hpp: the values of an arm as columns of the CSV, which only the runs of
// a robot with an arm have.
#pragma once

#include <span>

#include "server/record/frame_columns.hpp"

namespace server {

std::span<const FrameColumn> arm_columns();

}  // namespace server
