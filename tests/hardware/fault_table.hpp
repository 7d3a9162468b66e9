// tests/hardware/fault_table.hpp: every fault that is injected into emulated devices while the
// robot drives. docs/hardware.md has a row for each on either base, which a test looks after.
#pragma once

#include <array>

namespace server::hardware {

/// What the wheels have to do.
enum class Expected : unsigned char {
  GoOn,           // nothing happens to them
  AfterScans,     // zero within three scan periods
  AfterBase,      // zero once the base's state is too old
  AfterReport,    // zero in the tick after the base's report
  AfterBattery,   // zero when the voltage has been low for long
  AfterStorm,     // zero when it is clear that most telegrams are damaged
  AfterBlind,     // zero when the last scan that showed anything is too old
  AfterWatchdog,  // nobody can tell the base: it stops itself
};

struct Fault {
  const char* name;
  const char* command;   // that brings it
  const char* recovery;  // that takes it away; empty: it passes by itself
  Expected expected;
};

constexpr std::array<Fault, 17> kFaults{{
    {"scanner silent for 2 s", "scanner silence 2", "", Expected::AfterScans},
    {"scanner restarts, 3 s", "scanner restart 3", "", Expected::AfterScans},
    {"scanner unplugged for 2 s", "scanner unplug 2", "", Expected::AfterScans},
    {"scanner dazzled", "dazzle on", "dazzle off", Expected::AfterBlind},
    {"scanner reports an error", "health 3", "health 0", Expected::AfterScans},
    {"7 of 10 scans damaged", "scanner damage 0.7", "scanner damage 0", Expected::AfterStorm},
    {"1 % of the scanner's bytes lost",
     "scanner drop 0.01",
     "scanner drop 0",
     Expected::AfterStorm},
    {"1 % of the scanner's bytes flipped",
     "scanner flip 0.01",
     "scanner flip 0",
     Expected::AfterStorm},
    {"1 % of the scans damaged", "scanner damage 0.01", "scanner damage 0", Expected::GoOn},
    {"scanner takes 3 telegrams for damaged", "nak 3", "", Expected::GoOn},
    {"base silent for 2 s", "base silence 2", "", Expected::AfterBase},
    {"base restarts, 2 s", "base restart 2", "", Expected::AfterBase},
    {"base unplugged for 4 s", "base unplug 4", "", Expected::AfterWatchdog},
    {"stop button", "stop on", "stop off", Expected::AfterReport},
    {"bumper", "bumper on", "bumper off", Expected::AfterReport},
    {"battery low", "battery 10", "battery 25", Expected::AfterBattery},
    {"controller reports a fault", "faults 8", "faults 0", Expected::AfterReport},
}};

}  // namespace server::hardware
