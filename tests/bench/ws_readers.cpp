// tests/bench/ws_readers.cpp: subscribes many clients and reads them with epoll.
#include "tests/bench/ws_readers.hpp"

#include <array>
#include <cstring>

#include "tests/bench/bench.hpp"
#include <sys/epoll.h>

namespace bench {
namespace {

constexpr std::size_t kMessageHeader = 13;  // Foxglove: opcode 1, subscription u32, time u64

/// Size of the first WebSocket frame in `input` and where its payload begins; 0 when incomplete.
/// Frames of a server are not masked (RFC 6455, section 5).
std::size_t frame_size(std::string_view input, std::size_t& payload) {
  if (input.size() < 2) return 0;
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(input[i]); };
  std::size_t length = byte(1) & 0x7FU;
  const std::size_t extra = length == 126 ? 2 : length == 127 ? 8 : 0;
  if (input.size() < 2 + extra) return 0;
  if (extra > 0) length = 0;
  for (std::size_t i = 0; i < extra; ++i) length = length << 8U | byte(2 + i);
  payload = 2 + extra;
  return input.size() < payload + length ? 0 : payload + length;
}

}  // namespace

WsReaders::WsReaders(std::uint16_t port, std::size_t clients, std::size_t expected)
    : ages_(expected) {
  for (std::size_t i = 0; i < clients; ++i) {
    readers_.push_back(std::make_unique<Reader>(port));
    Reader& reader = *readers_.back();
    require(reader.client.handshake.status == 101, "A client was not let in.");
    reader.client.send_text(R"({"op":"subscribe","subscriptions":[{"id":7,"channelId":1}]})");
    reader.input = reader.client.socket.input();
    reader.input.reserve(std::size_t{1} << 17U);
  }
  thread_ = std::thread([this] { work(); });
}

void WsReaders::stop() {
  stopping_ = true;
  if (thread_.joinable()) thread_.join();
  ages_.resize(aged_);
}

void WsReaders::work() {
  const int poll = ::epoll_create1(0);
  for (const auto& reader : readers_) {
    epoll_event event{};
    event.events = EPOLLIN;
    event.data.ptr = reader.get();
    ::epoll_ctl(poll, EPOLL_CTL_ADD, reader->client.socket.fd(), &event);
    take_frames(*reader);  // frames that came with the handshake
  }
  std::array<epoll_event, 256> events{};
  while (!stopping_) {
    const int count = ::epoll_wait(poll, events.data(), static_cast<int>(events.size()), 20);
    for (int i = 0; i < count; ++i)
      read(*static_cast<Reader*>(events[static_cast<std::size_t>(i)].data.ptr));
    cpu_ = thread_cpu();
  }
  ::close(poll);
}

void WsReaders::read(Reader& reader) {
  std::array<char, 65536> buffer{};
  const ssize_t n = ::recv(reader.client.socket.fd(), buffer.data(), buffer.size(), MSG_DONTWAIT);
  if (n <= 0) return;
  reader.input.append(buffer.data(), static_cast<std::size_t>(n));
  take_frames(reader);
}

void WsReaders::take_frames(Reader& reader) {
  const double now = wall();
  std::size_t done = 0;
  std::size_t payload = 0;
  for (;;) {
    const std::string_view rest = std::string_view(reader.input).substr(done);
    const std::size_t size = frame_size(rest, payload);
    if (size == 0) break;
    done += size;
    if (rest[payload] != 1 || static_cast<unsigned char>(rest[0]) != 0x82 ||
        size < payload + kMessageHeader)
      continue;
    std::uint64_t stamp = 0;
    std::memcpy(&stamp, rest.data() + payload + 5, sizeof stamp);
    if (stamp <= reader.last) ++wrong_;
    reader.last = stamp;
    if (aged_ < ages_.size()) ages_[aged_++] = now - 1e-9 * static_cast<double>(stamp);
    ++received_;
  }
  reader.input.erase(0, done);
}

}  // namespace bench
