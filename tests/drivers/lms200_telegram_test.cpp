// tests/drivers/lms200_telegram_test.cpp: frames of the LMS2xx, whole, cut and damaged.
#include "drivers/lms200_telegram.hpp"

#include <algorithm>

#include "tests/drivers/lms200_telegrams.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace drivers::lms200 {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

Bytes ack() {
  return {kAck};
}
Bytes mode_done() {
  return hex("02 80 03 00 A0 00 10 16 0A");
}
Bytes joined(const std::vector<Bytes>& parts) {
  Bytes all;
  for (const Bytes& part : parts) append(all, part);
  return all;
}

TEST(Lms200Telegram, CrcMatchesTheManual) {
  EXPECT_EQ(crc(hex("02 00 01 00 31")), 0x1215);
  EXPECT_EQ(crc({}), 0);
}

TEST(Lms200Telegram, WholeScansHaveThePrintedCheckValue) {
  const Bytes half = scan_361();
  EXPECT_EQ(half.size(), 732U);
  EXPECT_EQ(Bytes(half.begin(), half.begin() + 11), hex("02 80 D6 02 B0 69 41 E8 03 E9 03"));
  EXPECT_EQ(Bytes(half.end() - 5, half.end()), hex("50 05 10 86 0C"));
  const Bytes whole = scan_181();
  EXPECT_EQ(whole.size(), 372U);
  EXPECT_EQ(Bytes(whole.end() - 3, whole.end()), hex("10 95 9D"));
}

TEST(Lms200Telegram, ReadsAcknowledgementsOnlyOutsideOfFrames) {
  Kept kept;
  kept.feed(joined({ack(), mode_done(), {kNak}, scan_361()}));  // its values hold 06 and 15
  EXPECT_THAT(kept.frames, ElementsAre(mode_done(), scan_361()));
  EXPECT_EQ(kept.strays, (Bytes{kAck, kNak}));
  EXPECT_EQ(kept.reader.counters(), (LineCounters{.frames = 2, .skipped_bytes = 2}));
  EXPECT_EQ(kept.reader.pending(), 0U);
}

TEST(Lms200Telegram, AcceptsAnswersFromAnyAddressAndNoRequests) {
  Kept device;
  device.feed(hex("02 81 03 00 A0 00 10 36 1A 02 00 01 00 31 15 12"));
  ASSERT_THAT(device.frames, SizeIs(1));
  EXPECT_EQ(telegram_of(device.frames[0]).address, 0x81);
  Kept host(Sender::Host);
  host.feed(hex("02 81 03 00 A0 00 10 36 1A 02 00 01 00 31 15 12"));
  EXPECT_THAT(host.frames, ElementsAre(hex("02 00 01 00 31 15 12")));
}

TEST(Lms200Telegram, RefusesImpossibleLengths) {
  for (const char* start : {"02 80 01 00 B0", "02 80 00 00 B0", "02 80 01 04 B0", "02 80 FF FF"}) {
    Kept kept;
    kept.feed(joined({hex(start), mode_done()}));
    EXPECT_THAT(kept.frames, ElementsAre(mode_done())) << start;
  }
}

TEST(Lms200Telegram, PiecesOfAnySizeGiveTheSameTelegrams) {
  const Bytes stream = joined({ack(), mode_done(), scan_181(), scan_361(), mode_done()});
  for (std::size_t piece = 1; piece < 800; ++piece) {
    Kept kept;
    kept.feed(stream, piece);
    EXPECT_THAT(kept.frames, ElementsAre(mode_done(), scan_181(), scan_361(), mode_done()));
  }
}

// A request interrupts a scan: its rest never comes; an answer and whole scans follow.
TEST(Lms200Telegram, ScanCutAtAnyByteLosesOnlyThatScan) {
  const Bytes scan = scan_361();
  for (std::size_t cut = 1; cut < scan.size(); ++cut) {
    const Bytes begun(scan.begin(), scan.begin() + static_cast<std::ptrdiff_t>(cut));
    Kept kept;
    kept.feed(joined({scan_181(), begun, ack(), mode_done(), scan_181(), scan_361(), scan_181()}));
    kept.expire();
    EXPECT_THAT(kept.frames,
                ElementsAre(scan_181(), mode_done(), scan_181(), scan_361(), scan_181()))
        << cut;
  }
}

TEST(Lms200Telegram, StreamEnteredAtAnyByteLosesOnlyTheFirstScan) {
  const Bytes stream = joined({scan_361(), scan_181(), scan_361()});
  for (std::size_t from = 1; from < scan_361().size(); ++from) {
    Kept kept;
    kept.feed(ByteView(stream).subspan(from), 64);
    kept.expire();
    EXPECT_THAT(kept.frames, ElementsAre(scan_181(), scan_361())) << from;
  }
}

TEST(Lms200Telegram, OneLostOrChangedByteLosesOneScan) {
  const Bytes stream = joined({scan_181(), scan_361(), mode_done(), scan_181()});
  const std::size_t begin = scan_181().size();
  for (std::size_t at = begin; at < begin + scan_361().size(); ++at) {
    const auto damaged_at = static_cast<std::ptrdiff_t>(at);
    Bytes lost = stream;
    lost.erase(lost.begin() + damaged_at);
    Bytes changed = stream;
    changed[at] ^= 0x82U;  // a start mark out of a zero, and no start mark out of one
    for (const Bytes& damaged : {lost, changed}) {
      Kept kept;
      kept.feed(damaged);
      kept.expire();
      EXPECT_THAT(kept.frames, ElementsAre(scan_181(), mode_done(), scan_181())) << at;
    }
  }
}

TEST(Lms200Telegram, WaitsForTheRestOfAFrameUntilTheTimeout) {
  const Bytes scan = scan_181();
  Kept kept;
  kept.feed(ByteView(scan).first(100));
  EXPECT_EQ(kept.reader.pending(), 100U);
  kept.feed(ByteView(scan).subspan(100));
  EXPECT_THAT(kept.frames, ElementsAre(scan));
  kept.feed(ByteView(scan).first(100));
  kept.expire();
  EXPECT_EQ(kept.reader.pending(), 0U);
  EXPECT_EQ(kept.reader.counters().given_up, 1U);
  EXPECT_THAT(kept.strays, IsEmpty());  // debris is no acknowledgement
}

TEST(Lms200Telegram, TransferTakesTenBitsAByte) {
  EXPECT_DOUBLE_EQ(transfer_time(732, 38400), 0.190625);
}

}  // namespace
}  // namespace drivers::lms200
