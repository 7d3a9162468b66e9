// tests/fuzz/carmen_line_fuzz.cpp: any line is a scan, an odometry, something else or an error;
// never more readings than it has words, and every reading has a wire value.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "sim/carmen_log.hpp"

namespace {

void check_scan(const sim::CarmenScan& scan, std::size_t line_size) {
  if (scan.readings.size() > line_size / 2) std::abort();
  sim::CarmenUnitGuess guess;
  for (const double reading : scan.readings) {
    if (!std::isfinite(reading) || reading < 0) std::abort();
    guess.see(static_cast<std::uint32_t>(std::lround(std::min(reading, 1e6) * 1000)));
  }
  for (const double reading : scan.readings) {
    sim::pack_carmen(static_cast<std::uint32_t>(std::lround(std::min(reading, 1e6) * 1000)),
                     guess.unit());
  }
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view line(reinterpret_cast<const char*>(data), size);
  const sim::CarmenLine parsed = sim::parse_carmen_line(line);
  if (const auto* scan = std::get_if<sim::CarmenScan>(&parsed)) check_scan(*scan, size);
  if (const auto* error = std::get_if<sim::CarmenError>(&parsed)) {
    if (error->reason.empty()) std::abort();
  }
  return 0;
}
