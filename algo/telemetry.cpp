// algo/telemetry.cpp: names of the states, as REST and CSV spell them.
#include "algo/telemetry.hpp"

namespace algo {

std::string_view name(Hold hold) {
  switch (hold) {
    case Hold::None:
      return "none";
    case Hold::Stopped:
      return "stopped";
    case Hold::Bumper:
      return "bumper";
    case Hold::StaleScan:
      return "stale_scan";
    case Hold::NotFinite:
      return "not_finite";
    case Hold::LinkLost:
      return "link_lost";
  }
  return "none";
}

std::string_view name(Mission mission) {
  switch (mission) {
    case Mission::Idle:
      return "idle";
    case Mission::Driving:
      return "driving";
    case Mission::Arrived:
      return "arrived";
    case Mission::Stuck:
      return "stuck";
    case Mission::Held:
      return "held";
  }
  return "idle";
}

std::string_view name(BehaviourId behaviour) {
  switch (behaviour) {
    case BehaviourId::Rest:
      return "rest";
    case BehaviourId::Avoid:
      return "avoid";
    case BehaviourId::Manual:
      return "manual";
  }
  return "rest";
}

}  // namespace algo
