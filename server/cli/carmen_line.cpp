// server/cli/carmen_line.cpp: writes metres and poses separated by blanks.
#include "server/cli/carmen_line.hpp"

#include <cmath>
#include <iterator>
#include <numbers>

#include <fmt/format.h>

namespace server {

std::string carmen_line(const algo::LaserScan& scan,
                        std::string_view host,
                        double wall,
                        double since) {
  const double field = scan.angle_increment * static_cast<double>(scan.size() - 1);
  const bool half_turn = std::abs(field - std::numbers::pi) < 1e-6;
  std::string line;
  const auto out = std::back_inserter(line);
  if (half_turn) {
    fmt::format_to(out, "FLASER {}", scan.size());
  } else {
    fmt::format_to(out,
                   "ROBOTLASER1 0 {:.6f} {:.6f} {:.6f} {:.3f} 0.010 0 {}",
                   scan.angle_min,
                   field,
                   scan.angle_increment,
                   scan.range_max,
                   scan.size());
  }
  for (std::size_t i = 0; i < scan.size(); ++i) {
    fmt::format_to(
        out, " {:.3f}", scan.status[i] == algo::Beam::Ok ? scan.ranges[i] : scan.range_max);
  }
  fmt::format_to(out, "{}", half_turn ? " 0 0 0 0 0 0" : " 0 0 0 0 0 0 0 0 0 0 0 0");
  fmt::format_to(out, " {:.6f} {} {:.6f}", wall, host, since);
  return line;
}

}  // namespace server
