// server/record/encoded_frame.cpp: the first reader encodes.
#include "server/record/encoded_frame.hpp"

#include <stdexcept>

namespace server {

void EncodedFrame::encode_once() const {
  int expected = None;
  if (encoding_.compare_exchange_strong(expected, Running, std::memory_order_acquire)) {
    bytes_ = encoder_.encode(telemetry);
    encoding_.store(Done, std::memory_order_release);
    encoding_.notify_all();
    return;
  }
  while (encoding_.load(std::memory_order_acquire) != Done) encoding_.wait(Running);
}

std::span<const std::byte> EncodedFrame::bytes() const {
  encode_once();
  return bytes_;
}

std::span<const db::Window> EncodedFrame::windows() const {
  encode_once();
  return encoder_.windows();
}

EncodedFrame& encoded(Frame& frame) {
  auto* const found = dynamic_cast<EncodedFrame*>(&frame);
  if (found == nullptr)
    throw std::logic_error("The frames of this run are not made to be encoded.");
  return *found;
}

}  // namespace server
