// tests/bench/rows.hpp: all rows, one function per family.
#pragma once

#include "tests/bench/bench.hpp"

namespace bench {

void scans(Pass& pass);      // P1 P1r P2 P3 P4 P5
void ticks(Pass& pass);      // P6 P7 P11
void fleets(Pass& pass);     // P10
void control(Pass& pass);    // P13
void filters(Pass& pass);    // P12
void frames(Pass& pass);     // P18
void storage(Pass& pass);    // P19 P20 P21
void headless(Pass& pass);   // P9
void streaming(Pass& pass);  // P14 P16 P17
void timers(Pass& pass);     // P22
void external(Pass& pass);   // P23
void arms(Pass& pass);       // P24 P26
void terrain(Pass& pass);    // P25

}  // namespace bench
