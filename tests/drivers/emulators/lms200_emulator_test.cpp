// tests/drivers/emulators/lms200_emulator_test.cpp: the emulated LMS200 against the telegrams that
// the manual prints, and those it forbids.
#include "drivers/emulators/lms200_emulator.hpp"

#include "tests/drivers/emulators/talk.hpp"
#include "tests/drivers/hex.hpp"
#include "tests/drivers/lms200_telegrams.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/lms200_scan.hpp"

namespace drivers::lms200 {
namespace {

using emulators::Host;
using ::testing::ElementsAre;

const std::string kAcked = "06 ";
const char* const kModeDone = "02 80 03 00 A0 00 10 16 0A";
const char* const kRefused = "02 80 02 00 92 10 7F 33";
const char* const kInstallation = "02 00 0A 00 20 00 53 49 43 4B 5F 4C 4D 53 BE C5";
const char* const kStream = "02 00 02 00 20 24 34 08";
const char* const kOnRequest = "02 00 02 00 20 25 35 08";
const char* const kStatusRequest = "02 00 01 00 31 15 12";

EmulatorOptions still(Variant variant = {180, 50}) {
  EmulatorOptions options;
  options.variant = variant;
  return options;
}

/// A scan of `variant`, beam i at 1 + i / 1000 m.
algo::LaserScan ramp(const Variant& variant) {
  algo::LaserScan scan;
  ScanDecoder(variant, {}).prepare(true, 0, variant.beams(), scan);
  for (std::size_t i = 0; i < scan.size(); ++i) {
    scan.set_ok(i, 1.0 + static_cast<double>(i) / 1000);
  }
  return scan;
}

/// Whole telegrams among `bytes`; bytes outside are dropped.
std::vector<Bytes> telegrams(const Bytes& bytes) {
  std::vector<Bytes> found;
  TelegramReader reader;
  reader.feed(
      bytes, [&](ByteView frame) { found.push_back(bytes_of(frame)); }, [](std::uint8_t) {});
  return found;
}

struct Row {
  const char* request;
  std::string answer;
};

TEST(Lms200Emulator, AnswersMatchTheManual) {
  const std::vector<Row> rows{
      {"02 00 01 00 3A 1E 12",
       "02 80 17 00 BA 4C 4D 53 32 30 30 3B 33 30 31 30 36 33 3B 56 30 32 2E 31 30 20 10 22 61"},
      {"02 00 01 00 32 16 12", "02 80 02 00 B2 10 3F 13"},
      {kOnRequest, kModeDone},
      {kStream, kModeDone},
      {"02 00 05 00 3B B4 00 32 00 3B 1F", "02 80 07 00 BB 01 B4 00 32 00 10 03 9D"},
      {kInstallation, kModeDone},
      {"02 00 0A 00 20 30 53 49 43 4B 5F 4C 4D 53 EE F5", kModeDone},
      {"02 00 02 00 30 01 31 18", kRefused},  // installation mode still
      {"02 00 23 00 77 00 00 70 00 00 00 01 00 00 02 02 21x00 02 00 11 88",
       "02 80 25 00 F7 01 00 00 70 00 00 00 01 00 00 02 02 21x00 02 00 10 C5 7A"},
  };
  EmulatorOptions options;
  options.type = "LMS200;301063;V02.10 ";
  Emulator device(options);
  Host host(device);
  for (const Row& row : rows) {
    EXPECT_EQ(host.ask(hex(row.request)), hex(kAcked + row.answer)) << row.request;
  }
  EXPECT_EQ(device.memory_writes(), 1U);
}

TEST(Lms200Emulator, ResetsAndSendsItsGreeting) {
  Emulator device;
  Host host(device);
  Bytes expected = hex("06 02 80 02 00 91 10 79 30");
  append(expected,
         hex("02 80 17 00 90 4C 4D 53 32 30 30 3B 33 30 31 30 36 33 3B 56 30 32 2E 33 30 20 10 "
             "73 56"));
  EXPECT_EQ(host.ask(hex("02 00 01 00 10 34 12"), 3.0), expected);
}

TEST(Lms200Emulator, IgnoresRequestsUntilItHasStarted) {
  EmulatorOptions options;
  options.powered = false;
  options.boot_time = 9;
  Emulator device(options);
  Host host(device);
  EXPECT_EQ(host.ask(hex(kStatusRequest), 8.9), Bytes{});
  const Bytes greeting = host.listen(0.3);
  ASSERT_EQ(telegrams(greeting).size(), 1U);
  EXPECT_EQ(greeting[4], 0x90);
  EXPECT_EQ(host.ask(hex(kStatusRequest))[0], kAck);
}

TEST(Lms200Emulator, AnswersFromItsAddressAndOnlyToIt) {
  EmulatorOptions options = still();
  options.address = 1;
  Emulator device(options);
  Host host(device);
  EXPECT_EQ(host.ask(hex("02 01 02 00 20 24 24 00")), hex("06 02 81 03 00 A0 00 10 36 1A"));
  EXPECT_EQ(host.ask(hex(kOnRequest)), hex("06 02 81 03 00 A0 00 10 36 1A"));
  FixedBytes<32> other;
  append_frame(other, 2, hex("31"));
  EXPECT_EQ(host.ask(other.view()), Bytes{});
}

TEST(Lms200Emulator, WrongPasswordChangesNothing) {
  Emulator device;
  Host host(device);
  const Command wrong = installation_command("SICK_XXX");
  EXPECT_EQ(host.ask(wrong.view()), hex("06 02 80 03 00 A0 01 10 14 0B"));
  EXPECT_EQ(device.mode(), Mode::OnRequest);
}

TEST(Lms200Emulator, NaksDamagedTelegramsAndDropsSlowOnes) {
  Emulator device;
  Host host(device);
  EXPECT_EQ(host.ask(hex("02 00 01 00 31 15 13")), hex("15"));
  EXPECT_EQ(device.bad_telegrams(), 1U);
  host.tell(hex("02 00 01 00"));
  host.listen(0.012);  // four bytes at 9600 take 4.2 ms, the gap is longer than 6
  EXPECT_EQ(host.ask(hex("31 15 12")), Bytes{});
  EXPECT_EQ(host.ask(hex(kStatusRequest))[0], kAck);
  device.refuse_next(1);
  EXPECT_EQ(host.ask(hex(kStatusRequest)), hex("15"));
}

TEST(Lms200Emulator, ChangesItsRateAfterTheAnswer) {
  Emulator device;
  Host host(device);
  host.tell(hex("02 00 02 00 20 48 58 08"));
  const Bytes answer = host.listen(0.065);
  EXPECT_EQ(device.baud(), 9600U);
  Bytes rest = answer;
  append(rest, host.listen(0.1));
  EXPECT_EQ(rest, hex(kAcked + kModeDone));
  EXPECT_EQ(device.baud(), 500000U);
  device.restart(host.now(), 0.5);
  EXPECT_EQ(device.baud(), 9600U);  // it was not stored
}

TEST(Lms200Emulator, KeepsAStoredRate) {
  Emulator device;
  Host host(device);
  host.ask(hex("02 00 02 00 20 40 50 08"));
  ASSERT_EQ(device.baud(), 38400U);
  EXPECT_EQ(telegrams(host.ask(hex("02 00 02 00 66 01 9D 4E"))).size(), 1U);
  device.restart(host.now(), 0.5);
  EXPECT_EQ(device.baud(), 38400U);
}

TEST(Lms200Emulator, NoHalfMegabaudOnRs232) {
  EmulatorOptions options;
  options.rs422 = false;
  Emulator device(options);
  Host host(device);
  const Bytes answer = host.ask(hex("02 00 02 00 20 48 58 08"));
  ASSERT_EQ(answer.size(), 10U);
  EXPECT_EQ(answer[6], 2);  // a fault
  EXPECT_EQ(device.baud(), 9600U);
}

TEST(Lms200Emulator, WritesItsConfigurationOnlyInInstallationMode) {
  Emulator device;
  Host host(device);
  const std::string write = "02 00 23 00 77 00 00 46 00 02 06 01 00 00 02 02 21x00 02 00 8D A6";
  EXPECT_EQ(host.ask(hex(write)), hex(kAcked + kRefused));
  EXPECT_EQ(device.memory_writes(), 0U);
  host.ask(hex(kInstallation));
  const std::vector<Bytes> written = telegrams(host.ask(hex(write)));
  ASSERT_EQ(written.size(), 1U);
  EXPECT_EQ(written[0][5], 1);
  EXPECT_TRUE(device.configuration().sends_indices());
  EXPECT_EQ(device.configuration().measuring_mode(), 6);
  // An impossible variant is refused, and the answer has the present one.
  Configuration odd = device.configuration();
  odd.set_measuring_mode(0x77);
  const std::vector<Bytes> refused = telegrams(host.ask(write_configuration_command(odd).view()));
  ASSERT_EQ(refused.size(), 1U);
  EXPECT_EQ(refused[0][5], 0);
  EXPECT_EQ(device.memory_writes(), 1U);
}

TEST(Lms200Emulator, RefusesVariantsThatDoNotExist) {
  Emulator device;
  Host host(device);
  FixedBytes<32> frame;
  append_frame(frame, 0, hex("3B B4 00 19 00"));  // 180 degrees, 0.25
  const std::vector<Bytes> got = telegrams(host.ask(frame.view()));
  ASSERT_EQ(got.size(), 1U);
  const auto answer = variant_answer(telegram_of(got[0]));
  ASSERT_TRUE(answer);
  EXPECT_FALSE(answer->done);
  EXPECT_EQ(answer->now, (Variant{180, 100}));
}

TEST(Lms200Emulator, ReportsItsStatus) {
  EmulatorOptions options = still({100, 25});
  options.address = 3;
  Emulator device(options);
  Host host(device);
  const std::vector<Bytes> got = telegrams(host.ask(hex(kStatusRequest)));
  ASSERT_EQ(got.size(), 1U);
  const auto status = device_status(telegram_of(got[0]));
  ASSERT_TRUE(status);
  EXPECT_EQ(status->software, "V02.30 ");
  EXPECT_EQ(status->variant, options.variant);
  const ByteView payload = telegram_of(got[0]).payload;
  EXPECT_EQ(word_at(payload, 116), 0x8067);  // 9600 bit/s
  EXPECT_EQ(payload[120], 3);                // its address
  EXPECT_EQ(word_at(payload, 67), 148);      // [us] of its motor
  EXPECT_TRUE(status->in_millimetres);
}

TEST(Lms200Emulator, SendsTheScanOfTheManualOnRequest) {
  Emulator device(still());
  Host host(device);
  host.tell(hex("02 00 02 00 30 01 31 18"));
  EXPECT_EQ(host.listen(0.1), hex("06"));
  device.offer(ramp({180, 50}), host.now());
  const Bytes scan = host.listen(1.0);
  ASSERT_EQ(scan.size(), 732U);
  EXPECT_EQ(Bytes(scan.begin(), scan.begin() + 11), hex("02 80 D6 02 B0 69 41 E8 03 E9 03"));
  EXPECT_EQ(Bytes(scan.end() - 5, scan.end()), hex("50 05 10 86 0C"));
  device.offer(ramp({180, 50}), host.now());
  EXPECT_EQ(host.listen(1.0), Bytes{});  // one was asked for
}

/// Streams for `seconds` at `baud`, one scan every `turns` of the mirror.
std::vector<SentScan> streamed(unsigned baud, Variant variant, double seconds) {
  EmulatorOptions options = still(variant);
  options.start_rate = baud;
  Emulator device(options);
  std::vector<SentScan> sent;
  device.on_scan = [&](const SentScan& scan) { sent.push_back(scan); };
  Host host(device);
  host.ask(hex(kStream), 0.2);
  const double period = kTurnPeriod * variant.turns();
  const int scans = static_cast<int>(seconds / period);
  for (int i = 0; i < scans; ++i) {
    host.listen(period);
    device.offer(ramp(variant), host.now());
  }
  host.listen(2.0);
  return sent;
}

std::size_t count(const std::vector<SentScan>& scans, SentScan::Fate fate) {
  return static_cast<std::size_t>(
      std::ranges::count_if(scans, [&](const SentScan& s) { return s.fate == fate; }));
}

TEST(Lms200Emulator, ALineCarriesNoMoreThanItsRate) {
  // 361 values: 732 bytes, 14.6 ms at 500000, 190.6 ms at 38400, 0.76 s at 9600.
  const std::vector<SentScan> fast = streamed(500000, {180, 50}, 4);
  EXPECT_EQ(count(fast, SentScan::Fate::Lost), 0U);
  EXPECT_NEAR(static_cast<double>(count(fast, SentScan::Fate::Sent)), 4 / 0.02664, 1.5);
  const std::vector<SentScan> slow = streamed(38400, {180, 50}, 4);
  EXPECT_NEAR(static_cast<double>(count(slow, SentScan::Fate::Sent)), 4 * 4.69, 1.5);
  EXPECT_NEAR(static_cast<double>(count(streamed(9600, {180, 50}, 4), SentScan::Fate::Sent)),
              4 * 1.25,
              1.5);
  // 181 values at 75 Hz pass at 500000.
  EXPECT_EQ(count(streamed(500000, {180, 100}, 2), SentScan::Fate::Lost), 0U);
}

TEST(Lms200Emulator, ARequestCutsTheScanInTheMiddle) {
  EmulatorOptions options = still();
  options.start_rate = 38400;
  Emulator device(options);
  std::vector<SentScan> sent;
  device.on_scan = [&](const SentScan& scan) { sent.push_back(scan); };
  Host host(device);
  host.ask(hex(kStream), 0.2);
  device.offer(ramp({180, 50}), host.now());
  const Bytes begun = host.listen(0.05);
  EXPECT_NEAR(static_cast<double>(begun.size()), 0.05 * 3840, 3);
  host.tell(hex(kOnRequest));
  const Bytes rest = host.listen(1.0);
  EXPECT_LT(begun.size() + rest.size(), 300U);
  EXPECT_EQ(Bytes(rest.end() - 10, rest.end()), hex(kAcked + kModeDone));
  ASSERT_EQ(sent.size(), 1U);
  EXPECT_EQ(sent[0].fate, SentScan::Fate::Cut);
}

TEST(Lms200Emulator, CodesAndFlagsMatchTheManual) {
  EmulatorOptions options = still({100, 100});
  options.field_a = 1.5;
  Emulator device(options);
  Host host(device);
  host.tell(hex("02 00 02 00 30 01 31 18"));
  host.listen(0.1);
  algo::LaserScan scan = ramp({100, 100});
  scan.set_ok(0, 2.0);
  scan.set_free(1);
  scan.set_invalid(2, algo::BeamCode::NoEcho);
  scan.set_invalid(3, algo::BeamCode::WeakSignal);
  scan.set_ok(4, 8.183);
  scan.set_ok(5, 1.0);
  device.offer(scan, host.now());
  const std::vector<Bytes> got = telegrams(host.listen(1.0));
  ASSERT_EQ(got.size(), 1U);
  const auto values = measured_values(telegram_of(got[0]));
  ASSERT_TRUE(values);
  EXPECT_EQ(values->word(0), 2000);
  EXPECT_EQ(values->word(1), 0x1FF7);
  EXPECT_EQ(values->word(2), 0x1FFF);
  EXPECT_EQ(values->word(3), 0x1FFB);
  EXPECT_EQ(values->word(4), 0x1FF7);  // where codes begin there are no distances
  EXPECT_EQ(values->word(5), 1000 | 0x2000);
  device.dazzle(true);
  host.tell(hex("02 00 02 00 30 01 31 18"));
  host.listen(0.1);
  device.offer(scan, host.now());
  const std::vector<Bytes> blind = telegrams(host.listen(1.0));
  ASSERT_EQ(blind.size(), 1U);
  EXPECT_EQ(measured_values(telegram_of(blind[0]))->word(0), 0x9FFE);
}

TEST(Lms200Emulator, RecordsTheBeamsThatAReceiverMustKeep) {
  for (const bool millimetres : {true, false}) {
    for (const std::uint8_t mode : std::array<std::uint8_t, 3>{0, 3, 6}) {
      EmulatorOptions options = still({100, 50});
      options.field_a = 1.1;
      Emulator device(options);
      std::vector<SentScan> sent;
      device.on_scan = [&](const SentScan& scan) { sent.push_back(scan); };
      Host host(device);
      Configuration wanted = device.configuration();
      wanted.set_measuring_mode(mode);
      wanted.set_millimetres(millimetres);
      host.ask(hex(kInstallation));
      host.ask(write_configuration_command(wanted).view());
      host.ask(hex(kStream));
      algo::LaserScan scan = ramp({100, 50});
      scan.set_free(7);
      scan.set_invalid(8, algo::BeamCode::NoEcho);
      scan.set_ok(9, 20.5);
      device.offer(scan, host.now());
      const std::vector<Bytes> got = telegrams(host.listen(2.0));
      ASSERT_EQ(got.size(), 1U);
      ASSERT_EQ(sent.size(), 1U);
      algo::LaserScan decoded;
      const ScanDecoder decoder({100, 50}, *word_format(mode));
      ASSERT_TRUE(decoder.decode(*measured_values(telegram_of(got[0])), decoded));
      ASSERT_EQ(decoded.size(), sent[0].beams.size());
      for (std::size_t i = 0; i < decoded.size(); ++i) {
        EXPECT_EQ(algo::pack_beam(decoded, i), sent[0].beams[i]) << "beam " << i;
      }
    }
  }
}

TEST(Lms200Emulator, MeanValuesAreAveragesOfScans) {
  Emulator device(still({100, 100}));
  Host host(device);
  host.tell(hex("02 00 02 00 36 02 3E 1E"));
  host.listen(0.1);
  algo::LaserScan scan = ramp({100, 100});
  scan.set_ok(0, 1.0);
  device.offer(scan, host.now());
  EXPECT_EQ(host.listen(0.1), Bytes{});
  scan.set_ok(0, 2.0);
  scan.set_free(1);
  device.offer(scan, host.now());
  const std::vector<Bytes> got = telegrams(host.listen(1.0));
  ASSERT_EQ(got.size(), 1U);
  const auto values = measured_values(telegram_of(got[0]));
  ASSERT_TRUE(values);
  EXPECT_EQ(values->averaged, 2);
  EXPECT_EQ(values->word(0), 1500);
  EXPECT_EQ(values->word(1), 1001);  // one of two had an echo
}

TEST(Lms200Emulator, RangesCarryTheNumberOfTheirFirstValue) {
  Emulator device(still());
  Host host(device);
  EXPECT_EQ(telegrams(host.ask(hex("02 00 05 00 37 01 00 69 01 EB 75"))).size(), 0U);
  device.offer(ramp({180, 50}), host.now());
  const std::vector<Bytes> whole = telegrams(host.listen(1.0));
  ASSERT_EQ(whole.size(), 1U);
  EXPECT_EQ(measured_values(telegram_of(whole[0]))->size(), 361U);

  host.ask(hex("02 00 06 00 20 27 1B 00 2B 01 FF FE"));  // 27 to 299, continuously
  device.offer(ramp({180, 50}), host.now());
  const std::vector<Bytes> part = telegrams(host.listen(1.0));
  ASSERT_EQ(part.size(), 1U);
  const auto values = measured_values(telegram_of(part[0]));
  ASSERT_TRUE(values);
  EXPECT_EQ(values->first, 27);
  EXPECT_EQ(values->size(), 273U);
  EXPECT_EQ(values->word(0), 1026);
  EXPECT_EQ(host.ask(framed(0, hex("37 01 00 6A 01"))), hex(kAcked + kRefused));
}

TEST(Lms200Emulator, PartialScansComeInOrder) {
  EmulatorOptions options = still();
  options.interlaced = true;
  options.start_rate = 500000;
  Emulator device(options);
  Host host(device);
  host.ask(hex("02 00 02 00 20 2A 3A 08"));
  EXPECT_THAT(device.sweep().parts, ElementsAre(0, 1, 2, 3));
  const algo::LaserScan turn = ramp({180, 100});
  PartialScans parts({180, 25}, {});
  algo::LaserScan whole;
  int complete = 0;
  for (int i = 0; i < 8; ++i) {
    device.offer(turn, host.now(), static_cast<std::uint8_t>(i % 4));
    const std::vector<Bytes> got = telegrams(host.listen(0.02));
    ASSERT_EQ(got.size(), 1U);
    if (parts.add(*measured_values(telegram_of(got[0])), whole)) ++complete;
  }
  EXPECT_EQ(complete, 2);
  EXPECT_EQ(parts.dropped_sweeps(), 0U);
}

TEST(Lms200Emulator, ANewVariantEndsAStream) {
  Emulator device(still());
  Host host(device);
  host.ask(hex(kStream));
  EXPECT_EQ(device.mode(), Mode::Continuous);
  host.ask(hex("02 00 05 00 3B B4 00 64 00 97 49"));
  EXPECT_EQ(device.mode(), Mode::OnRequest);
  EXPECT_EQ(device.sweep().variant, (Variant{180, 100}));
}

TEST(Lms200Emulator, SendsNothingWhileMuteOrBusy) {
  Emulator device;
  Host host(device);
  device.mute(host.now() + 1);
  EXPECT_EQ(host.ask(hex(kStatusRequest), 0.9), Bytes{});
  host.listen(0.2);
  host.ask(hex(kInstallation));
  host.tell(write_configuration_command(device.configuration()).view());
  const Bytes acknowledged = host.listen(0.1);
  EXPECT_EQ(acknowledged, hex("06"));
  EXPECT_EQ(host.ask(hex(kStatusRequest), 0.2), Bytes{});  // it is writing
  EXPECT_EQ(telegrams(host.listen(1.0)).size(), 1U);
}

}  // namespace
}  // namespace drivers::lms200
