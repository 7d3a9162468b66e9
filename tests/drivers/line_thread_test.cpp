// tests/drivers/line_thread_test.cpp: a real thread and a pseudo-terminal between a machine and a
// device.
#include "drivers/line_thread.hpp"

#include <array>
#include <atomic>
#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <utility>

#include "tests/drivers/hex.hpp"
#include <gtest/gtest.h>
#include <pty.h>
#include <unistd.h>

namespace drivers {
namespace {

/// Echoes its input and sends a farewell when it leaves.
class EchoMachine final : public Machine {
 public:
  unsigned opening_baud() const override { return 38400; }
  void opened(double /*now*/, unsigned /*baud*/) override { ++openings; }
  void closed(double /*now*/, const std::string& why) override { reason = why; }
  void rate_set(double /*now*/, unsigned baud) override { rate = baud; }
  void receive(double /*now*/, ByteView bytes) override { orders.send(bytes); }
  void advance(double /*now*/) override {
    if (sleeps == 0) return;
    asleep = true;
    std::this_thread::sleep_for(std::chrono::duration<double>(std::exchange(sleeps, 0)));
  }
  void lost_bytes() override { ++lost; }
  double wake_time() const override { return 1e300; }
  std::optional<LineOrder> next_order() override { return orders.next(); }
  void leave(double /*now*/) override {
    orders.send(ByteView(goodbye));
    gone = true;
  }
  bool left() const override { return gone; }

  LineOrders orders{};
  Bytes goodbye = hex("FF");
  int openings = 0;
  unsigned rate = 0;
  std::string reason{};
  bool gone = false;
  double sleeps = 0;  // [s] the thread sleeps this long, once
  std::atomic<bool> asleep{false};
  int lost = 0;
};

class Terminal {
 public:
  Terminal() {
    std::array<char, 128> name{};
    EXPECT_EQ(::openpty(&fd_, &other_, name.data(), nullptr, nullptr), 0);
    path_ = name.data();
  }
  ~Terminal() {
    unplug();
    ::close(other_);
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  const std::string& path() const { return path_; }
  void unplug() {
    if (fd_ >= 0) ::close(fd_);
    fd_ = -1;
  }
  void send(const Bytes& bytes) const {
    EXPECT_EQ(::write(fd_, bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  }
  Bytes receive(std::size_t size) const {
    Bytes bytes(size);
    std::size_t got = 0;
    while (got < size) {
      const ssize_t more = ::read(fd_, bytes.data() + got, size - got);
      if (more <= 0) break;
      got += static_cast<std::size_t>(more);
    }
    bytes.resize(got);
    return bytes;
  }

 private:
  int fd_ = -1;
  int other_ = -1;
  std::string path_{};
};

/// Times out after much longer than a correct program needs.
template <class Done>
bool wait_for(Done&& done) {
  for (int i = 0; i < 3000; ++i) {
    if (done()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

/// Whether the line has opened its terminal, once.
bool opened(LineThread& line, const EchoMachine& machine) {
  return wait_for([&] {
    int openings = 0;
    line.look([&] { openings = machine.openings; });
    return openings == 1;
  });
}

TEST(LineThread, CarriesBytesBothWaysAndLetsTheMachineLeave) {
  const Terminal terminal;
  EchoMachine machine;
  {
    LineThread line(terminal.path(), machine);
    ASSERT_TRUE(opened(line, machine));
    terminal.send(hex("01 02 03"));
    EXPECT_EQ(terminal.receive(3), hex("01 02 03"));
    line.with([&] { machine.orders.send(ByteView(hex("0A 0B"))); });
    EXPECT_EQ(terminal.receive(2), hex("0A 0B"));
    line.with([&] { machine.orders.set_baud(500'000); });
    EXPECT_TRUE(wait_for([&] {
      unsigned rate = 0;
      line.look([&] { rate = machine.rate; });
      return rate == 500'000;
    }));
  }
  EXPECT_EQ(terminal.receive(1), hex("FF"));
}

TEST(LineThread, BytesFromASleepOfTheProgramAreDiscarded) {
  const Terminal terminal;
  EchoMachine machine;
  LineThread line(terminal.path(), machine);
  ASSERT_TRUE(opened(line, machine));
  terminal.send(hex("01"));
  EXPECT_EQ(terminal.receive(1), hex("01"));
  // GIVEN a thread that sleeps for half a second WHEN bytes arrive meanwhile THEN their age is
  // unknown.
  line.with([&] {
    machine.sleeps = 0.5;
    machine.orders.send_before(steady_now() + 0.1, ByteView(hex("EE")));
  });
  ASSERT_TRUE(wait_for([&] { return machine.asleep.load(); }));
  terminal.send(hex("02 03"));
  ASSERT_TRUE(wait_for([&] {
    int lost = 0;
    line.look([&] { lost = machine.lost; });
    return lost == 1;
  }));
  terminal.send(hex("04"));
  // A motion ordered before is not sent either.
  EXPECT_EQ(terminal.receive(1), hex("04"));
}

TEST(LineThread, MissingPortIsReportedAndRetried) {
  EchoMachine machine;
  LineThread line("/dev/no_such_port", machine);
  EXPECT_TRUE(wait_for([&] {
    std::string reason;
    line.look([&] { reason = machine.reason; });
    return reason.find("plugged in") != std::string::npos;
  }));
}

}  // namespace
}  // namespace drivers
