// server/cli/carmen_line.hpp: a scan as a line of a CARMEN log, the format sim/carmen_log.hpp
// reads.
#pragma once

#include <string>
#include <string_view>

#include "algo/laser_scan.hpp"

namespace server {

/// FLASER, which has no angles, for 180 degrees; ROBOTLASER1 for other fields of view. Poses are
/// zero: there is no robot. A beam without a distance is written as the scanner's range. `wall` [s]
/// is the time of day, `since` [s] the time since the start of the log.
std::string carmen_line(const algo::LaserScan& scan,
                        std::string_view host,
                        double wall,
                        double since);

}  // namespace server
