// tests/drivers/comedi_card_test.cpp: the COMEDI driver on an emulated card, loaded like libcomedi.
#include "drivers/comedi_card.hpp"

#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <string>

#include "tests/folders.hpp"
#include "tests/temporary_folder.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/emulators/card_memory.hpp"

namespace drivers {
namespace {

using emulators::CardChannels;
using emulators::CardFile;
using emulators::CardMemory;
using ::testing::HasSubstr;

ComediSetup card_setup() {
  ComediSetup out;
  out.library = tests::emulated_comedi().string();
  out.relay_closed_line = 1;
  out.stop_line = 2;
  out.fault_line = 3;
  out.bumper_lines = {4, 5};
  out.rear_bumper_lines = {6};
  return out;
}

struct Slot {
  explicit Slot(const CardChannels& channels = {}) : file(path(), channels) {}
  std::filesystem::path path() const { return folder.path() / "card"; }
  std::unique_ptr<AnalogCard> open(const ComediSetup& with = card_setup()) const {
    return open_comedi_card(path().string(), with);
  }
  /// The error sentence for `setup`.
  std::string refusal(const ComediSetup& with = card_setup()) const {
    try {
      open(with);
    } catch (const CardError& error) {
      return error.what();
    }
    return "";
  }
  CardMemory& memory() const { return file.memory(); }

  tests::TemporaryFolder folder{};
  CardFile file;
};

/// A second program must neither stop the first one's motors nor drive them.
TEST(ComediCard, ASecondProgramIsKeptOutAndChangesNothing) {
  const Slot slot;
  {
    const auto card = slot.open();
    card->write({2, -3});
    card->set_relay_line(true);
    const std::uint32_t left = slot.memory().samples[0];
    const std::uint32_t right = slot.memory().samples[1];
    const std::uint32_t levels = slot.memory().levels;
    EXPECT_EQ(slot.refusal(),
              "The analog card at " + slot.path().string() + " is in use by another program.");
    EXPECT_EQ(slot.memory().samples[0], left);
    EXPECT_EQ(slot.memory().samples[1], right);
    EXPECT_EQ(slot.memory().levels, levels);
    EXPECT_EQ(slot.memory().opened, 1U);
    EXPECT_NO_THROW(card->write({0, 0}));
  }
  EXPECT_EQ(slot.refusal(), "");
}

TEST(ComediCard, OpensWithZeroVoltsAndTheRelayOpen) {
  const Slot slot;
  slot.memory().samples[0] = 60000;  // an earlier program died
  const auto card = slot.open();
  EXPECT_NEAR(slot.memory().volts(0), 0, 1e-3);
  EXPECT_NEAR(slot.memory().volts(1), 0, 1e-3);
  EXPECT_EQ(slot.memory().relay_changes, 0U);
}

TEST(ComediCard, WritesVoltsOfBothSigns) {
  const Slot slot;
  ComediSetup with = card_setup();
  with.reversed_outputs = {false, true};
  const auto card = slot.open(with);
  card->write({2.5, 2.5});
  EXPECT_NEAR(slot.memory().volts(0), 2.5, 1e-3);
  EXPECT_NEAR(slot.memory().volts(1), -2.5, 1e-3);
  card->write({-10, 10});
  EXPECT_NEAR(slot.memory().volts(0), -10, 1e-3);
}

TEST(ComediCard, CountsContinueOverTheCounterWrap) {
  const Slot slot;
  slot.memory().turned[0] = 0xFF'FFFE;
  ComediSetup with = card_setup();
  with.reversed_counters = {false, true};
  const auto card = slot.open(with);
  slot.memory().turned[0] = 0x100'0003;
  slot.memory().turned[1] = -5;
  const CardInputs inputs = card->read();
  EXPECT_EQ(inputs.counts[0], 5U);
  EXPECT_EQ(inputs.counts[1], 5U);
}

TEST(ComediCard, ReadsItsLines) {
  const Slot slot;
  const auto card = slot.open();
  slot.memory().inputs = 0b0000'1110;
  CardInputs inputs = card->read();
  EXPECT_EQ(inputs.relay_closed, true);
  EXPECT_FALSE(inputs.stop_button || inputs.fault || inputs.bumper_front || inputs.bumper_rear);
  slot.memory().inputs = 0b0110'0000;
  inputs = card->read();
  EXPECT_EQ(inputs.relay_closed, false);
  EXPECT_TRUE(inputs.stop_button && inputs.fault && inputs.bumper_front && inputs.bumper_rear);
}

TEST(ComediCard, TogglingHoldsTheRelayClosed) {
  const Slot slot;
  const auto card = slot.open();
  for (int i = 0; i < 5; ++i) card->set_relay_line(i % 2 == 0);
  EXPECT_EQ(slot.memory().relay_changes, 5U);
}

TEST(ComediCard, TheEnableInputIsLowAtFirst) {
  const Slot slot;
  ComediSetup with = card_setup();
  with.bumper_lines = {4};
  with.enable_line = 5;
  slot.memory().set_line(5, true, 0);
  const auto card = slot.open(with);
  EXPECT_EQ(slot.memory().levels & 0b10'0000U, 0U);
  card->set_enabled(true);
  EXPECT_NE(slot.memory().levels & 0b10'0000U, 0U);
}

TEST(ComediCard, ReportsItsChannels) {
  const Slot slot;
  std::string text;
  for (const auto& [name, value] : slot.open()->facts()) text += name + " " + value + "\n";
  EXPECT_THAT(text, HasSubstr("-10 to 10 V"));
  EXPECT_THAT(text, HasSubstr("modulo 16777216"));
  EXPECT_THAT(text, HasSubstr("0: 2 analog outputs; 1: 2 counters; 2: 8 digital lines"));
}

TEST(ComediCard, ALostCardIsReported) {
  const Slot slot;
  auto card = slot.open();
  slot.memory().gone = 1;
  EXPECT_THROW(card->read(), CardError);
  EXPECT_THROW(card->write({0, 0}), CardError);
  EXPECT_THROW(card->set_relay_line(true), CardError);
  card.reset();  // until then it is in use
  EXPECT_THAT(slot.refusal(), HasSubstr("cannot be opened: No such device"));
}

TEST(ComediCard, AMissingCardOrLibraryIsReported) {
  const Slot slot;
  const auto refused = [&](const std::function<void(ComediSetup&)>& change) {
    ComediSetup with = card_setup();
    change(with);
    return slot.refusal(with);
  };
  EXPECT_THAT(refused([](ComediSetup& s) { s.library = "libnothing.so.7"; }),
              HasSubstr("cannot be loaded"));
  EXPECT_THAT(refused([](ComediSetup& s) { s.library = "libc.so.6"; }), HasSubstr("no libcomedi"));
  EXPECT_THAT(
      refused([](ComediSetup& s) { s.max_volts = 12; }),
      HasSubstr("gives no -12 to 12 V, which max_volts asks for, but 0 to 10 V, -10 to 10 V"));
  EXPECT_THAT(refused([](ComediSetup& s) {
                s.outputs = {0, 2};
              }),
              HasSubstr("has 2 analog outputs on subdevice 0, and outputs asks for number 2"));
  EXPECT_THAT(refused([](ComediSetup& s) { s.output_subdevice = 1; }),
              HasSubstr("has no analog output on subdevice 1"));
  EXPECT_THAT(refused([](ComediSetup& s) {
                s.counters = {1, 1};
              }),
              HasSubstr("count both wheels with one counter"));
  EXPECT_THAT(refused([](ComediSetup& s) { s.counter_subdevices = {2}; }),
              HasSubstr("has no counters on subdevice 2"));
  EXPECT_THAT(refused([](ComediSetup& s) { s.relay_line = 8; }),
              HasSubstr("has 8 digital lines on subdevice 2, and relay_line asks for number 8"));
  EXPECT_THAT(refused([](ComediSetup& s) { s.bumper_lines = {40}; }),
              HasSubstr("bumper_lines asks for number 40"));
}

TEST(ComediCard, ACardWithoutTheChannelsIsRefused) {
  EXPECT_THAT(Slot({.outputs = 1}).refusal(), HasSubstr("has 1 analog output on subdevice 0"));
  EXPECT_THAT(Slot({.outputs = 0}).refusal(), HasSubstr("has no analog output"));
  EXPECT_THAT(Slot({.counters = 1}).refusal(), HasSubstr("has 1 counter on subdevice 1"));
  EXPECT_THAT(Slot({.counters = 0}).refusal(), HasSubstr("has no counters"));
  EXPECT_THAT(Slot({.lines = 0}).refusal(), HasSubstr("has no digital lines"));
}

TEST(ComediCard, AnEndingEmulatorKeepsTheNextOnesCardFile) {
  const tests::TemporaryFolder folder;
  const auto path = folder.path() / "card";
  auto first = std::make_unique<CardFile>(path, CardChannels{});
  EXPECT_THROW(CardFile(path, CardChannels{}), std::runtime_error);  // it is in use
  std::filesystem::remove(path);
  auto second = std::make_unique<CardFile>(path, CardChannels{});
  first.reset();
  EXPECT_EQ(open_comedi_card(path.string(), card_setup())->read().stop_button, true);
  second.reset();
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(ComediCard, AnotherFileIsNotReplacedByACard) {
  const tests::TemporaryFolder folder;
  const auto path = folder.path() / "letter";
  std::ofstream(path) << "Dear Sir";
  EXPECT_THROW(CardFile(path, CardChannels{}), std::runtime_error);
  EXPECT_TRUE(std::filesystem::exists(path));
}

}  // namespace
}  // namespace drivers
