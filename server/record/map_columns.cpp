// server/record/map_columns.cpp: the table of the map's columns.
#include "server/record/map_columns.hpp"

#include <array>

#include "server/record/csv_cells.hpp"

namespace server {
namespace {

using algo::MapPose;
using algo::Pose2;
using algo::Telemetry;

void put_fix(std::string& out, const Telemetry& t) {
  if (t.observation.map_pose) put_text(out, algo::name(t.observation.map_pose->fix));
}
template <std::uint32_t MapPose::*Count>
void put_number_of(std::string& out, const Telemetry& t) {
  if (t.observation.map_pose) out += std::to_string((*t.observation.map_pose).*Count);
}
/// Without a place there is none.
template <double MapPose::*Value>
void put_place(std::string& out, const Telemetry& t) {
  const auto& at = t.observation.map_pose;
  if (at && at->places > 0) put_number(out, (*at).*Value);
}
template <double Pose2::*Part>
void put_wheels(std::string& out, const Telemetry& t) {
  if (t.observation.map_pose) put_number(out, t.observation.map_pose->wheels.*Part);
}

constexpr auto kMapColumns = std::to_array<FrameColumn>({
    {"map.fix", "", put_fix},
    {"map.places", "", put_number_of<&MapPose::places>},
    {"map.epoch", "", put_number_of<&MapPose::epoch>},
    {"map.xx", "m2", put_place<&MapPose::xx>},
    {"map.xy", "m2", put_place<&MapPose::xy>},
    {"map.yy", "m2", put_place<&MapPose::yy>},
    {"map.turn", "rad2", put_place<&MapPose::turn>},
    {"map.fit", "", put_place<&MapPose::fit>},
    {"wheels.x", "m", put_wheels<&Pose2::x>},
    {"wheels.y", "m", put_wheels<&Pose2::y>},
    {"wheels.heading", "rad", put_wheels<&Pose2::heading>},
});

}  // namespace

std::span<const FrameColumn> map_columns() {
  return kMapColumns;
}

}  // namespace server
