// server/cli/carmen_line.hpp: a scan as a line of a CARMEN log, the format sim/carmen_log.hpp
// reads.
#pragma once

#include <string>
#include <string_view>

#include "algo/laser_scan.hpp"

namespace server {

/// FLASER, which says nothing of angles, for half a turn; ROBOTLASER1 for other fields of view.
/// Poses are zero: there is no robot. What is no distance is written as the scanner's range.
/// `wall` [s] is the time of day, `since` [s] that since the log began.
std::string carmen_line(const algo::LaserScan& scan,
                        std::string_view host,
                        double wall,
                        double since);

}  // namespace server
