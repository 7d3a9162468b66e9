// tests/fuzz/psd_fuzz.cpp: any bytes are lines or skipped; a line is written again as it was read,
// and the machine never gives a distance out of the sensors' range.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "drivers/psd_machine.hpp"

namespace {

bool possible(double metres) {
  return std::isnan(metres) || (metres >= algo::kPsdNearest && metres <= algo::kPsdFarthest);
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace drivers;
  const ByteView bytes(data, size);
  psd::Reader reader;
  reader.feed(
      bytes,
      [](ByteView line) {
        const auto reading = psd::parse(line);
        if (!reading || psd::line_of(*reading).text().substr(0, line.size()) != text_of(line)) {
          std::abort();
        }
      },
      [](std::uint8_t) {});
  psd::PsdMachine machine{psd::PsdSetup{}};
  double now = 100;
  machine.opened(now, 115'200);
  for (std::size_t at = 0; at < size; at += 16) {
    now += 0.01;
    machine.receive(now, bytes.subspan(at, std::min<std::size_t>(16, size - at)));
    machine.advance(now);
    algo::FloorRanges ranges;
    if (!machine.take(ranges)) continue;
    if (!possible(ranges.far_left) || !possible(ranges.far_right) || !possible(ranges.near_left) ||
        !possible(ranges.near_right)) {
      std::abort();
    }
  }
  if (machine.report(now).sentence.empty()) std::abort();
  return 0;
}
