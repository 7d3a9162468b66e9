// algo/telemetry.cpp: names and texts of the states.
#include "algo/telemetry.hpp"

#include <array>

namespace algo {
namespace {

// In the order of their enumerators.
constexpr std::array<HaltInfo, 14> kHalts{
    {{"none", "Holding still", "The robot holds its wheels still."},
     {"disarmed",
      "The motors are off",
      "Nobody has armed this robot. It moves only once somebody does."},
     {"base_lost",
      "Waiting for the base",
      "The motor controller is silent. The wheels are held still."},
     {"scanner_lost", "Waiting for the laser", "The scanner is silent. The wheels are held still."},
     {"bad_line",
      "Holding still",
      "More of what the scanner sends comes damaged than whole: look at its cable."},
     {"scanner_fault", "Holding still", "The scanner reports a fault of its own, or is blinded."},
     {"stop_button",
      "Stop button pressed",
      "The stop button on the robot is pressed. Release it, then arm again."},
     {"base_fault", "Holding still", "The motor controller reports a fault."},
     {"over_current",
      "Holding still",
      "A motor took more current than it may: is a wheel blocked?"},
     {"battery_low", "Battery low", "The battery is below its limit. Charge it."},
     {"motors_off", "Waiting for the motors", "The robot is armed, but its motors are not on yet."},
     {"late_tick", "Holding still", "The control loop came too late; the wheels were stopped."},
     {"floor_lost",
      "Waiting for the floor sensors",
      "The sensors that look at the floor are silent. The wheels are held still."},
     {"floor_fault",
      "Holding still",
      "The readings of the sensors that look at the floor are not to be trusted."}}};
static_assert(kHalts.size() == static_cast<std::size_t>(Halt::FloorFault) + 1);
constexpr std::array<std::string_view, 5> kMissions{"idle", "driving", "arrived", "stuck", "held"};
static_assert(kMissions.size() == static_cast<std::size_t>(Mission::Held) + 1);

constexpr std::array<std::string_view, 7> kArmStates{
    "rest", "turns", "plans", "goes", "waits", "arrived", "given_up"};
static_assert(kArmStates.size() == static_cast<std::size_t>(ArmState::GivenUp) + 1);

}  // namespace

std::string_view name(ArmState state) {
  const auto k = static_cast<std::size_t>(state);
  return kArmStates[k < kArmStates.size() ? k : 0];
}

std::string_view name(const Hold& hold) {
  return hold ? hold.name.view() : "none";
}

const HaltInfo& info(Halt halt) {
  const auto k = static_cast<std::size_t>(halt);
  return kHalts[k < kHalts.size() ? k : 0];  // a record may hold any value
}

std::string_view name(Mission mission) {
  const auto k = static_cast<std::size_t>(mission);
  return kMissions[k < kMissions.size() ? k : 0];
}

std::optional<double> ControlOutput::measure(std::string_view name) const {
  for (const Measure& each : measures) {
    if (each.name == name) return each.value;
  }
  return std::nullopt;
}

void ControlOutput::clear() {
  twist = {};
  joint_rates.reset();
  pass_W.reset();
  waits = false;
  state = 0;
  answered = false;
  measures.clear();
  layers.clear();
}

}  // namespace algo
