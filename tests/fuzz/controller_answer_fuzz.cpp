// tests/fuzz/controller_answer_fuzz.cpp: any bytes from a controller are an answer, or refused with
// a sentence.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

#include "server/external/messages.hpp"

namespace {

void check(const algo::ControlOutput& out) {
  if (!algo::finite(out.twist)) std::abort();
  for (const algo::Layer& layer : out.layers) {
    if (layer.name.empty() || layer.values.size() > server::external::kMostValues) std::abort();
  }
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace server::external;
  const auto given = std::as_bytes(std::span(data, size));
  const std::vector<std::byte> bytes(given.begin(), given.end());  // aligned, as a socket's buffer
  try {
    read_hello(bytes);
  } catch (const ControllerError&) {
  }
  Texts texts;
  algo::ControlOutput out;
  algo::Explanation words;
  try {
    read_answer(bytes, 0, texts, out, words);
  } catch (const ControllerError&) {
    return 0;
  }
  check(out);
  return 0;
}
