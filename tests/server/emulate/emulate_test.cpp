// tests/server/emulate/emulate_test.cpp: emulated devices on their pseudo-terminals, in a simulated
// world.
#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <sstream>
#include <string>
#include <thread>

#include "tests/folders.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "drivers/comedi_card.hpp"
#include "drivers/lms200_protocol.hpp"
#include "drivers/lms200_scan.hpp"
#include "drivers/psd_device.hpp"
#include "drivers/roboteq_protocol.hpp"
#include "drivers/serial_port.hpp"
#include "server/emulate/emulation.hpp"

namespace server::emulate {
namespace {

namespace fs = std::filesystem;
namespace lms200 = drivers::lms200;
using drivers::SerialPort;
using std::chrono::milliseconds;
using ::testing::HasSubstr;

constexpr int kPatience = 30000;  // [ms] timeout

class EmulationTest : public ::testing::Test {
 protected:
  EmulationTest() {
    static int count = 0;
    folder_ = fs::temp_directory_path() /
              ("tautline_emulate_" + std::to_string(::getpid()) + "_" + std::to_string(count++));
    fs::create_directories(folder_);
    options_.scenario.obstacles = {
        algo::Obstacle{.id = 1, .pose_W = {2, 0.5, 0}, .shape = algo::Cylinder{.radius = 0.3}}};
    options_.record = folder_ / "record";
  }
  ~EmulationTest() override { fs::remove_all(folder_); }

  void add_scanner() { options_.scanner_links = {folder_ / "scanner"}; }
  void add_base(BaseKind kind) {
    options_.base = kind;
    options_.base_link = folder_ / "base";
  }
  std::vector<std::string> recorded(const std::string& kind) const {
    std::vector<std::string> found;
    std::ifstream file(options_.record);
    for (std::string line; std::getline(file, line);) {
      if (line.starts_with(kind + " ")) found.push_back(line);
    }
    return found;
  }

  fs::path folder_{};
  EmulationOptions options_{};
};

/// A minimal host of a scanner, without the driver.
class ScannerHost {
 public:
  ScannerHost(const fs::path& link, unsigned baud) : port_(link.string(), baud) {}

  /// Calls `on_telegram` for each telegram until it returns true or kPatience is over.
  template <class OnTelegram>
  bool listen(OnTelegram&& on_telegram, int patience_ms = kPatience) {
    bool done = false;
    const auto end = std::chrono::steady_clock::now() + milliseconds(patience_ms);
    while (!done && std::chrono::steady_clock::now() < end) {
      std::array<std::uint8_t, 4096> bytes{};
      const std::size_t size = port_.read(bytes, milliseconds(20));
      reader_.feed(
          drivers::ByteView(bytes).first(size),
          [&](drivers::ByteView frame) { done = done || on_telegram(lms200::telegram_of(frame)); },
          [](std::uint8_t) {});
    }
    return done;
  }
  bool ask(const lms200::Command& command, lms200::Answer answer, int patience_ms = kPatience) {
    port_.write(command.view(), milliseconds(kPatience));
    return listen(
        [&](const lms200::Telegram& t) { return t.code() == static_cast<std::uint8_t>(answer); },
        patience_ms);
  }
  SerialPort& port() { return port_; }

 private:
  SerialPort port_;
  lms200::TelegramReader reader_{};
};

TEST_F(EmulationTest, AScannerAtAnotherRateIsUnreadable) {
  add_scanner();
  Emulation emulation(options_);
  emulation.start();
  ScannerHost host(options_.scanner_links[0], 38400);
  EXPECT_FALSE(host.ask(lms200::type_command(), lms200::Answer::Type, 300));
  host.port().set_baud(9600);
  EXPECT_TRUE(host.ask(lms200::type_command(), lms200::Answer::Type));
}

/// Waits until `done`; false if it is not within kPatience.
template <class Done>
bool comes(Done&& done) {
  const auto end = std::chrono::steady_clock::now() + milliseconds(kPatience);
  while (!done()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(milliseconds(10));
  }
  return true;
}

TEST_F(EmulationTest, FloorSensorsSeeAFlatFloorAndTheirFaultsAreSaid) {
  options_.psd_link = folder_ / "psd";
  Emulation emulation(options_);
  emulation.start();
  drivers::psd::PsdDevice device(options_.psd_link.string(), {});
  algo::FloorRanges ranges;
  ASSERT_TRUE(comes([&] { return device.readings() > 30 && device.take(ranges); }));
  EXPECT_NEAR(ranges.far_left, 0.28, 0.03);
  EXPECT_NEAR(ranges.near_right, 0.20, 0.03);
  EXPECT_TRUE(device.report().well) << device.report().sentence;
  EXPECT_THAT(emulation.truth(), HasSubstr(R"("psd":{"listened_to":true)"));

  const auto says = [&](const std::string& words) {
    return comes([&] { return device.report().sentence.find(words) != std::string::npos; });
  };
  emulation.command("stick 3");
  EXPECT_TRUE(says("The near left sensor is stuck"));
  emulation.command("stick 5");
  EXPECT_TRUE(says("its converter stands still"));
  emulation.command("stick 0");
  EXPECT_TRUE(says("Well."));
  emulation.command("jump 3");
  EXPECT_TRUE(says("Its clock jumped by 3.0 s"));
  EXPECT_TRUE(says("Well."));
  emulation.command("psd damage 1");
  EXPECT_TRUE(says("of its lines are damaged"));
  emulation.command("psd damage 0");
  EXPECT_TRUE(says("Well."));
  emulation.command("psd silence 1.5");
  EXPECT_TRUE(says("It has been silent for"));
  emulation.command("psd unplug 1");
  EXPECT_TRUE(says("has gone"));
  EXPECT_TRUE(says("Well."));
  EXPECT_THROW(emulation.command("psd stop on"), std::invalid_argument);
  EXPECT_THROW(emulation.command("base stick 1"), std::invalid_argument);
}

TEST_F(EmulationTest, ScansArriveAsTheyWereRecorded) {
  add_scanner();
  options_.scanner.variant = {180, 50};
  std::vector<std::vector<std::uint16_t>> got;
  {
    Emulation emulation(options_);
    emulation.start();
    ScannerHost host(options_.scanner_links[0], 9600);
    ASSERT_TRUE(host.ask(lms200::rate_command(lms200::Rate::Baud500000), lms200::Answer::Mode));
    std::this_thread::sleep_for(milliseconds(50));
    host.port().set_baud(500000);
    ASSERT_TRUE(host.ask(lms200::mode_command(lms200::Mode::Continuous), lms200::Answer::Mode));
    const lms200::ScanDecoder decoder({180, 50}, {});
    EXPECT_TRUE(host.listen([&](const lms200::Telegram& telegram) {
      const auto values = lms200::measured_values(telegram);
      algo::LaserScan scan;
      if (values && decoder.decode(*values, scan)) {
        got.emplace_back(scan.size());
        algo::pack_beams(scan, got.back());
      }
      return got.size() == 20;
    }));
  }
  std::vector<std::vector<std::uint16_t>> sent;
  for (const std::string& line : recorded("scan")) {
    std::istringstream words(line);
    std::string word;
    for (int i = 0; i < 6; ++i) words >> word;
    sent.emplace_back();
    for (std::uint16_t beam = 0; words >> beam;) sent.back().push_back(beam);
  }
  // Each scan that arrived was sent, in the same order.
  auto at = sent.begin();
  for (const auto& scan : got) {
    at = std::find(at, sent.end(), scan);
    ASSERT_NE(at, sent.end());
    ++at;
  }
}

TEST_F(EmulationTest, TheBaseTurnsTheWheelsOfTheWorld) {
  add_base(BaseKind::Roboteq);
  Emulation emulation(options_);
  emulation.start();
  SerialPort port(options_.base_link.string(), 115200);
  drivers::roboteq::LineReader reader;
  int counts = 0;
  const auto end = std::chrono::steady_clock::now() + milliseconds(kPatience);
  while (counts < 2000 && std::chrono::steady_clock::now() < end) {
    const std::string text = "!G 1 30_!G 2 30_?C 1\r";
    port.write({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()},
               milliseconds(kPatience));
    std::this_thread::sleep_for(milliseconds(20));
    std::array<std::uint8_t, 4096> bytes{};
    const std::size_t size = port.read(bytes, milliseconds(20));
    reader.feed(drivers::ByteView(bytes).first(size), [&](std::string_view line) {
      const auto reply = drivers::roboteq::parse_reply(line);
      if (reply.name == "C") counts = reply.values[0];
    });
  }
  EXPECT_GE(counts, 2000);
  const auto truth = nlohmann::json::parse(emulation.truth());
  EXPECT_GT(truth["pose"][0].get<double>(), 0.02);  // 2000 counts of 40000 a turn are 31 mm
  EXPECT_GT(truth["base"]["commands"].get<int>(), 0);
}

/// A card wired as the emulated one is.
std::unique_ptr<drivers::AnalogCard> open_card(const fs::path& path) {
  drivers::ComediSetup setup;
  setup.library = tests::emulated_comedi().string();
  setup.relay_closed_line = 1;
  setup.stop_line = 2;
  return drivers::open_comedi_card(path.string(), setup);
}

TEST_F(EmulationTest, VoltagesTurnTheWheelsWhileTheRelayIsClosed) {
  add_base(BaseKind::Analog);
  Emulation emulation(options_);
  emulation.start();
  const auto card = open_card(options_.base_link);
  const auto drive = [&](bool relay_is_held, const std::function<bool()>& until) {
    bool high = false;
    const auto end = std::chrono::steady_clock::now() + milliseconds(kPatience);
    while (!until() && std::chrono::steady_clock::now() < end) {
      card->write({1, 1});
      if (relay_is_held) card->set_relay_line(high = !high);
      std::this_thread::sleep_for(milliseconds(10));
    }
    return until();
  };
  const auto rolled = [&] { return card->read().counts[0]; };
  ASSERT_TRUE(drive(true, [&] { return rolled() > 100 && rolled() < 1U << 31; }));
  ASSERT_TRUE(drive(true, [&] { return card->read().relay_closed == true; }));
  // Voltages without ticks, as after the death of the host program.
  ASSERT_TRUE(drive(false, [&] { return card->read().relay_closed == false; }));
  ASSERT_TRUE(drive(true, [&] { return card->read().relay_closed == true; }));
  emulation.command("stop on");
  ASSERT_TRUE(drive(true, [&] { return card->read().stop_button; }));
  EXPECT_EQ(card->read().relay_closed, false);
  const auto truth = nlohmann::json::parse(emulation.truth());
  EXPECT_GT(truth["pose"][0].get<double>(), 0.01);
  EXPECT_GT(truth["base"]["commands"].get<int>(), 0);
}

TEST_F(EmulationTest, ACardIsUnpluggedAndReturns) {
  add_base(BaseKind::Analog);
  Emulation emulation(options_);
  emulation.start();
  const auto card = open_card(options_.base_link);
  emulation.command("unplug 0.2");
  EXPECT_THROW(card->read(), drivers::CardError);
  const auto end = std::chrono::steady_clock::now() + milliseconds(kPatience);
  while (!fs::exists(options_.base_link) && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(milliseconds(10));
  }
  EXPECT_EQ(open_card(options_.base_link)->read().stop_button, false);
  EXPECT_THROW(emulation.command("drop 0.1"), std::invalid_argument);
}

TEST_F(EmulationTest, UnpluggedPortsDisappearAndReturn) {
  add_scanner();
  Emulation emulation(options_);
  emulation.start();
  EXPECT_TRUE(fs::is_symlink(options_.scanner_links[0]));
  emulation.command("unplug 0.2");
  EXPECT_FALSE(fs::is_symlink(options_.scanner_links[0]));
  const auto end = std::chrono::steady_clock::now() + milliseconds(kPatience);
  while (!fs::is_symlink(options_.scanner_links[0]) && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(milliseconds(10));
  }
  ScannerHost host(options_.scanner_links[0], 9600);
  EXPECT_TRUE(host.ask(lms200::type_command(), lms200::Answer::Type));
}

TEST_F(EmulationTest, LinksAreRemovedAtTheEndAndNeverReplaceAFile) {
  add_scanner();
  {
    const Emulation emulation(options_);
    EXPECT_TRUE(fs::is_symlink(options_.scanner_links[0]));
  }
  EXPECT_FALSE(fs::exists(fs::symlink_status(options_.scanner_links[0])));
  std::ofstream(options_.scanner_links[0]) << "mine";
  EXPECT_THROW(Emulation{options_}, std::runtime_error);
  EXPECT_TRUE(fs::is_regular_file(options_.scanner_links[0]));
}

TEST_F(EmulationTest, ASecondEmulatorLeavesTheFirstItsLinks) {
  add_scanner();
  add_base(BaseKind::Roboteq);
  const Emulation first(options_);
  const fs::path scanner = fs::read_symlink(options_.scanner_links[0]);
  const fs::path base = fs::read_symlink(options_.base_link);
  try {
    const Emulation second(options_);
    ADD_FAILURE() << "two emulators have one link";
  } catch (const std::runtime_error& e) {
    EXPECT_THAT(e.what(), testing::HasSubstr(options_.scanner_links[0].string() + " leads to"));
    EXPECT_THAT(e.what(), testing::HasSubstr("another program has"));
  }
  EXPECT_EQ(fs::read_symlink(options_.scanner_links[0]), scanner);
  EXPECT_EQ(fs::read_symlink(options_.base_link), base);
}

TEST_F(EmulationTest, ASecondEmulatorLeavesTheFirstItsCard) {
  add_base(BaseKind::Analog);
  const Emulation first(options_);
  const auto card = open_card(options_.base_link);
  EXPECT_THROW(Emulation{options_}, std::runtime_error);
  EXPECT_NO_THROW(card->read());
  EXPECT_TRUE(fs::exists(options_.base_link));
}

TEST_F(EmulationTest, ADeadLinkIsReplacedAndAForeignOneIsKept) {
  add_scanner();
  const fs::path& link = options_.scanner_links[0];
  fs::create_symlink("/dev/pts/999999", link);  // left over by a killed emulator
  { const Emulation emulation(options_); }
  EXPECT_FALSE(fs::is_symlink(link));
  fs::create_symlink("/nowhere/at-all", link);
  EXPECT_THROW(Emulation{options_}, std::runtime_error);
  EXPECT_EQ(fs::read_symlink(link), "/nowhere/at-all");
}

TEST_F(EmulationTest, InvalidCommandsAreRefusedWithASentence) {
  add_scanner();
  add_base(BaseKind::P2os);
  Emulation emulation(options_);
  const auto said = [&](const char* line) -> std::string {
    try {
      emulation.command(line);
    } catch (const std::invalid_argument& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_THAT(said("explode"), HasSubstr("no command 'explode'"));
  EXPECT_THAT(said("silence"), HasSubstr("of which device"));
  EXPECT_THAT(said("scanner silence long"), HasSubstr("SECONDS"));
  EXPECT_THAT(said("base dazzle on"), HasSubstr("does not apply to this base"));
  EXPECT_THAT(said("scanner2 silence 1"), HasSubstr("no device"));
  EXPECT_EQ(said("stop on"), "");
  EXPECT_EQ(said("dazzle on"), "");
  EXPECT_EQ(said("scanner damage 0.01"), "");
  EXPECT_EQ(said("# a remark"), "");
}

TEST(TruthRecord, AFullDiskIsSaidOnce) {
  testing::internal::CaptureStderr();
  TruthRecord record("/dev/full");
  record.event(1, "silence 2");
  record.event(2, "silence 2");
  EXPECT_EQ(testing::internal::GetCapturedStderr(),
            "tautline: The record is incomplete: is the disk full?\n");
}

}  // namespace
}  // namespace server::emulate
