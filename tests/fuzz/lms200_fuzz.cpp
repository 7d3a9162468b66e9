// tests/fuzz/lms200_fuzz.cpp: any bytes are telegrams or skipped, with the same result for any
// pieces; decoding never turns a code into a distance.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "drivers/lms200_scan.hpp"

namespace {

using namespace drivers;
using namespace drivers::lms200;

void check_scan(const algo::LaserScan& scan) {
  for (std::size_t i = 0; i < scan.size(); ++i) {
    if (scan.status[i] == algo::Beam::Ok && scan.ranges[i] >= scan.range_max) std::abort();
  }
}

void decode(const Telegram& telegram) {
  refusal_text(telegram);
  type_text(telegram);
  variant_answer(telegram);
  configuration_answer(telegram);
  device_status(telegram);
  health_text(Health(telegram.status()));

  const auto values = measured_values(telegram);
  if (!values) return;
  for (const Variant variant : {Variant{180, 100}, Variant{180, 50}, Variant{100, 25}}) {
    algo::LaserScan scan;
    if (ScanDecoder(variant, WordFormat{}).decode(*values, scan)) check_scan(scan);
    PartialScans parts(variant, WordFormat{});
    if (parts.add(*values, scan)) check_scan(scan);
  }
}

std::uint64_t read(ByteView bytes, std::size_t piece) {
  TelegramReader reader;
  const auto on_frame = [](ByteView frame) { decode(telegram_of(frame)); };
  const auto on_stray = [](std::uint8_t) {};
  for (ByteView rest = bytes; !rest.empty();) {
    const std::size_t size = std::min(piece, rest.size());
    reader.feed(rest.first(size), on_frame, on_stray);
    rest = rest.subspan(size);
  }
  reader.expire(on_frame, on_stray);
  if (reader.pending() != 0) std::abort();
  return reader.counters().frames;
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const ByteView bytes(data, size);
  if (read(bytes, size + 1) != read(bytes, 7)) std::abort();
  return 0;
}
