// drivers/emulators/emulated_comedi.cpp: libcomedi for an emulated card: the functions that the
// driver calls, acting on a file of registers instead of a device.
//
// A separate library, so that the driver loads it just as it loads the real one.
#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <memory>
#include <stdexcept>

#include <comedilib.h>

#include "drivers/emulators/card_memory.hpp"

using drivers::emulators::CardFile;
using drivers::emulators::CardMemory;

// The C interface fixes the names. NOLINTBEGIN(readability-identifier-naming)

/// An opened card.
struct comedi_t_struct {
  explicit comedi_t_struct(const char* name) : file(name) {}
  CardFile file;
  CardMemory& memory() const { return file.memory(); }
};

namespace {

enum Subdevice : unsigned { Outputs, Counters, Lines, kSubdevices };

int g_error = 0;  // NOLINT: the error of the last call, for comedi_errno()

std::array<comedi_range, 2> g_ranges{{// NOLINT: handed out as pointers to non-const
                                      {.min = 0, .max = 10, .unit = UNIT_volt},
                                      {.min = -10, .max = 10, .unit = UNIT_volt}}};

int fail(int error) {
  g_error = error;
  return -1;
}

double now() {
  using Seconds = std::chrono::duration<double>;
  return Seconds(std::chrono::steady_clock::now().time_since_epoch()).count();
}

unsigned channels_of(const comedi_t* card, unsigned subdevice) {
  const auto& channels = card->memory().channels;
  const std::array<unsigned, kSubdevices> all{channels.outputs, channels.counters, channels.lines};
  return subdevice < kSubdevices ? all.at(subdevice) : 0;
}

/// 0, or -1 and an error number when a call for this channel must fail.
int check(const comedi_t* card, unsigned subdevice, unsigned wanted, unsigned channel) {
  if (card->memory().gone != 0) return fail(ENODEV);
  if (card->memory().busy != 0) return fail(ETIMEDOUT);
  if (subdevice != wanted || channel >= channels_of(card, subdevice)) return fail(EINVAL);
  return 0;
}

}  // namespace

extern "C" {

comedi_t* comedi_open(const char* name) {
  try {
    auto card = std::make_unique<comedi_t_struct>(name);
    if (card->memory().gone != 0 || card->memory().busy != 0) {
      fail(card->memory().gone != 0 ? ENODEV : EBUSY);
      return nullptr;
    }
    ++card->memory().opened;
    return card.release();
  } catch (const std::runtime_error&) {
    fail(errno != 0 ? errno : ENODEV);
    return nullptr;
  }
}

int comedi_close(comedi_t* card) {
  const std::unique_ptr<comedi_t_struct> closing(card);
  return 0;
}

int comedi_errno(void) {
  return g_error;
}

const char* comedi_strerror(int error) {
  return ::strerror(error);
}

const char* comedi_get_driver_name(comedi_t* /*card*/) {
  return "emulated";
}

const char* comedi_get_board_name(comedi_t* /*card*/) {
  return "emulated card";
}

int comedi_get_n_subdevices(comedi_t* /*card*/) {
  return kSubdevices;
}

int comedi_get_subdevice_type(comedi_t* card, unsigned subdevice) {
  constexpr std::array<int, kSubdevices> kTypes{
      COMEDI_SUBD_AO, COMEDI_SUBD_COUNTER, COMEDI_SUBD_DIO};
  if (subdevice >= kSubdevices) return fail(EINVAL);
  return channels_of(card, subdevice) > 0 ? kTypes.at(subdevice) : COMEDI_SUBD_UNUSED;
}

int comedi_get_n_channels(comedi_t* card, unsigned subdevice) {
  return static_cast<int>(channels_of(card, subdevice));
}

lsampl_t comedi_get_maxdata(comedi_t* /*card*/, unsigned subdevice, unsigned /*channel*/) {
  constexpr std::array<lsampl_t, kSubdevices> kMost{
      CardMemory::kFullSample, CardMemory::kFullCount, 1};
  return subdevice < kSubdevices ? kMost.at(subdevice) : 0;
}

int comedi_get_n_ranges(comedi_t* /*card*/, unsigned subdevice, unsigned /*channel*/) {
  return subdevice == Outputs ? static_cast<int>(g_ranges.size()) : 1;
}

comedi_range* comedi_get_range(comedi_t* /*card*/,
                               unsigned subdevice,
                               unsigned /*channel*/,
                               unsigned index) {
  return subdevice == Outputs && index < g_ranges.size() ? &g_ranges.at(index) : nullptr;
}

lsampl_t comedi_from_phys(double data, comedi_range* range, lsampl_t maxdata) {
  const double share = (data - range->min) / (range->max - range->min);
  return static_cast<lsampl_t>(std::lround(std::clamp(share, 0.0, 1.0) * maxdata));
}

int comedi_data_read(comedi_t* card,
                     unsigned subdevice,
                     unsigned channel,
                     unsigned /*range*/,
                     unsigned /*aref*/,
                     lsampl_t* data) {
  if (check(card, subdevice, Counters, channel) < 0) return -1;
  *data = card->memory().count(channel, now());
  return 1;
}

int comedi_data_write(comedi_t* card,
                      unsigned subdevice,
                      unsigned channel,
                      unsigned range,
                      unsigned /*aref*/,
                      lsampl_t data) {
  if (check(card, subdevice, Outputs, channel) < 0) return -1;
  if (range >= g_ranges.size() || data > CardMemory::kFullSample) return fail(EINVAL);
  card->memory().ranges.at(channel) = range;
  card->memory().samples.at(channel) = data;
  return 1;
}

int comedi_dio_config(comedi_t* card, unsigned subdevice, unsigned channel, unsigned direction) {
  if (check(card, subdevice, Lines, channel) < 0) return -1;
  const std::uint32_t bit = 1U << channel;
  if (direction == COMEDI_OUTPUT) {
    card->memory().directions |= bit;
  } else {
    card->memory().directions &= ~bit;
  }
  return 0;
}

int comedi_dio_read(comedi_t* card, unsigned subdevice, unsigned channel, unsigned* level) {
  if (check(card, subdevice, Lines, channel) < 0) return -1;
  const CardMemory& memory = card->memory();
  const std::uint32_t outputs = memory.directions;
  const std::uint32_t levels = (memory.levels & outputs) | (memory.inputs & ~outputs);
  *level = (levels >> channel) & 1U;
  return 1;
}

int comedi_dio_write(comedi_t* card, unsigned subdevice, unsigned channel, unsigned level) {
  if (check(card, subdevice, Lines, channel) < 0) return -1;
  CardMemory& memory = card->memory();
  if ((memory.directions & (1U << channel)) == 0) return fail(EPERM);
  memory.set_line(channel, level != 0, now());
  return 1;
}

/// The emulated counters count quadrature without configuration.
int comedi_reset(comedi_t* /*card*/, unsigned /*subdevice*/) {
  return 0;
}
int comedi_set_counter_mode(comedi_t* card,
                            unsigned subdevice,
                            unsigned channel,
                            unsigned /*mode*/) {
  return check(card, subdevice, Counters, channel);
}
int comedi_arm(comedi_t* /*card*/, unsigned /*subdevice*/, unsigned /*source*/) {
  return 0;
}

}  // extern "C"

// NOLINTEND(readability-identifier-naming)
