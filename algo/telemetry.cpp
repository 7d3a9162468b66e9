// algo/telemetry.cpp: names of the states, as REST and CSV spell them.
#include "algo/telemetry.hpp"

namespace algo {

std::string_view name(const Hold& hold) {
  return hold ? hold.name.view() : "none";
}

std::string_view name(Halt halt) {
  switch (halt) {
    case Halt::None:
      return "none";
    case Halt::Disarmed:
      return "disarmed";
    case Halt::BaseLost:
      return "base_lost";
    case Halt::ScannerLost:
      return "scanner_lost";
    case Halt::BadLine:
      return "bad_line";
    case Halt::ScannerFault:
      return "scanner_fault";
    case Halt::StopButton:
      return "stop_button";
    case Halt::BaseFault:
      return "base_fault";
    case Halt::OverCurrent:
      return "over_current";
    case Halt::BatteryLow:
      return "battery_low";
    case Halt::MotorsOff:
      return "motors_off";
    case Halt::LateTick:
      return "late_tick";
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

std::optional<double> ControlOutput::measure(std::string_view name) const {
  for (const Measure& each : measures) {
    if (each.name == name) return each.value;
  }
  return std::nullopt;
}

void ControlOutput::clear() {
  twist = {};
  pass_W.reset();
  waits = false;
  state = 0;
  measures.clear();
  layers.clear();
}

}  // namespace algo
