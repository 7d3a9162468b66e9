// docs/examples/go_to_goal.cpp: turns to the goal and drives there, as a shared object:
//   g++ -O2 -shared -fPIC -I server/external docs/examples/go_to_goal.cpp -o go_to_goal.so
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tautline_controller.h"

namespace {

struct GoToGoal {
  tautline_run run{};
  float line[4] = {};  // from the robot to its goal
  tautline_layer layer{};
};

}  // namespace

uint32_t tautline_controller_version(void) {
  return TAUTLINE_CONTROLLER_VERSION;
}

void* tautline_controller_make(void) {
  return new GoToGoal;
}

void tautline_controller_reset(void* self, const tautline_run* run) {
  static_cast<GoToGoal*>(self)->run = *run;
}

int tautline_controller_update(void* self,
                               const tautline_observation* seen,
                               tautline_command* command) {
  if (!seen->has_goal) return 0;
  auto& own = *static_cast<GoToGoal*>(self);
  const double dx = seen->goal.x - seen->pose.x;
  const double dy = seen->goal.y - seen->pose.y;
  const double error =
      std::remainder(std::atan2(dy, dx) - seen->pose.heading, 2 * std::numbers::pi);
  double ahead = seen->range_max;  // [m] the nearest return of all beams
  for (uint32_t i = 0; i < seen->beams; ++i) ahead = std::min(ahead, seen->ranges[i]);
  const double slow = std::clamp(ahead - 0.5, 0.2, 1.0);
  command->twist = {0.3 * std::max(0.0, std::cos(error)) * slow, std::clamp(2 * error, -1.0, 1.0)};
  command->what = "Driving straight to the goal";
  command->why = "This example looks at nothing else.";
  own.line[0] = static_cast<float>(seen->pose.x);
  own.line[1] = static_cast<float>(seen->pose.y);
  own.line[2] = static_cast<float>(seen->goal.x);
  own.line[3] = static_cast<float>(seen->goal.y);
  own.layer = {"mine.line", 1, 0, 0, 0, own.line, 4};
  command->layers = &own.layer;
  command->layer_count = 1;
  return 0;
}

void tautline_controller_free(void* self) {
  delete static_cast<GoToGoal*>(self);
}
