// drivers/comedi_card.cpp: finds the channels that a robot is wired to, and uses them.
#include "drivers/comedi_card.hpp"

#include <algorithm>
#include <cerrno>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include "drivers/comedi_library.hpp"

namespace drivers {
namespace {

/// A channel of the card.
struct Channel {
  unsigned subdevice = 0;
  unsigned channel = 0;
};

std::string plural(int count, const std::string& noun) {
  return (count == 0 ? "no" : std::to_string(count)) + " " + noun + (count == 1 ? "" : "s");
}

/// The kinds of subdevices that matter here.
struct Kind {
  int type = 0;
  const char* noun = nullptr;
};
constexpr std::array<Kind, 6> kKinds{{{COMEDI_SUBD_AI, "analog input"},
                                      {COMEDI_SUBD_AO, "analog output"},
                                      {COMEDI_SUBD_DI, "digital input"},
                                      {COMEDI_SUBD_DO, "digital output"},
                                      {COMEDI_SUBD_DIO, "digital line"},
                                      {COMEDI_SUBD_COUNTER, "counter"}}};

/// Keeps out other programs that lock the card too, before they touch a voltage or a line. COMEDI
/// itself lets any number of programs open a card.
class CardLock {
 public:
  /// Throws CardError if another program has the card. Says nothing about a port that cannot be
  /// opened: the library has the reason.
  explicit CardLock(const std::string& port)
      : fd_(::open(port.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)) {
    if (fd_ < 0 || ::flock(fd_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
    ::close(fd_);
    throw CardError("The analog card at " + port + " is in use by another program.");
  }
  ~CardLock() {
    if (fd_ >= 0) ::close(fd_);
  }
  CardLock(const CardLock&) = delete;
  CardLock& operator=(const CardLock&) = delete;

 private:
  int fd_ = -1;
};

class ComediCard final : public AnalogCard {
 public:
  ComediCard(std::string port, const ComediSetup& setup)
      : port_(std::move(port)), setup_(setup), library_(load_comedi(setup.library)), lock_(port_) {
    device_ = std::unique_ptr<comedi_t, decltype(library_.close)>(library_.open(port_.c_str()),
                                                                  library_.close);
    if (!device_) {
      throw CardError("The analog card at " + port_ + " cannot be opened: " + reason() + ".");
    }
    find_outputs();
    write({0, 0});
    find_counters();
    find_lines();
    set_relay_line(false);
    set_enabled(false);
  }

  void write(const Volts& volts) override {
    for (std::size_t side = 0; side < volts.size(); ++side) {
      const Output& out = outputs_[side];
      const double wanted = setup_.reversed_outputs[side] ? -volts[side] : volts[side];
      const lsampl_t sample = library_.from_phys(wanted, out.range, out.maxdata);
      const int written = library_.write(
          device_.get(), out.at.subdevice, out.at.channel, out.range_index, AREF_GROUND, sample);
      if (written != 1) fail("does not accept a voltage");
    }
  }

  CardInputs read() override {
    CardInputs out;
    for (std::size_t side = 0; side < counters_.size(); ++side) {
      out.counts[side] = count(counters_[side], setup_.reversed_counters[side]);
    }
    if (setup_.relay_closed_line) out.relay_closed = high(*setup_.relay_closed_line);
    out.stop_button = setup_.stop_line && !high(*setup_.stop_line);
    out.fault = setup_.fault_line && !high(*setup_.fault_line);
    const auto hit = [this](unsigned line) { return high(line); };
    out.bumper_front = std::ranges::any_of(setup_.bumper_lines, hit);
    out.bumper_rear = std::ranges::any_of(setup_.rear_bumper_lines, hit);
    return out;
  }

  void set_relay_line(bool high) override { set_line(setup_.relay_line, high); }
  void set_enabled(bool enabled) override {
    if (setup_.enable_line) set_line(*setup_.enable_line, enabled);
  }

  std::vector<std::pair<std::string, std::string>> facts() const override {
    const auto pair = [](const Channel& left, const Channel& right) {
      return fmt::format(
          "{}:{} and {}:{}", left.subdevice, left.channel, right.subdevice, right.channel);
    };
    const Output& out = outputs_[0];
    return {{"kind", "analog"},
            {"board", library_.board_name(device_.get())},
            {"driver", library_.driver_name(device_.get())},
            {"outputs",
             pair(out.at, outputs_[1].at) +
                 fmt::format(", {:g} to {:g} V in steps of {:.2g} V",
                             out.range->min,
                             out.range->max,
                             (out.range->max - out.range->min) / out.maxdata)},
            {"counters",
             pair(counters_[0].at, counters_[1].at) +
                 fmt::format(", modulo {:.0f}", static_cast<double>(counters_[0].maxdata) + 1)},
            {"relay", fmt::format("{}:{}", lines_, setup_.relay_line)},
            {"subdevices", subdevices()}};
  }

 private:
  struct Output {
    Channel at{};
    unsigned range_index = 0;
    comedi_range* range = nullptr;  // the library's
    lsampl_t maxdata = 0;
  };
  struct Counter {
    Channel at{};
    lsampl_t maxdata = 0;
    lsampl_t newest = 0;
    std::uint32_t total = 0;  // modulo 2^32
  };

  std::string reason() const { return library_.error_text(library_.error()); }
  [[noreturn]] void fail(const std::string& what) const {
    throw CardError("The analog card at " + port_ + " " + what + ": " + reason() + ".");
  }
  [[noreturn]] void refuse(const std::string& what) const {
    throw CardError("The analog card at " + port_ + " (" + library_.board_name(device_.get()) +
                    ") " + what + ". It has: " + subdevices() + ".");
  }
  /// The card's subdevices as text, for the people who wire it.
  std::string subdevices() const {
    std::string out;
    const int count = library_.subdevices(device_.get());
    for (int i = 0; i < count; ++i) {
      const auto subdevice = static_cast<unsigned>(i);
      const int type = library_.type(device_.get(), subdevice);
      const auto* const kind = std::ranges::find(kKinds, type, &Kind::type);
      if (kind == kKinds.end()) continue;
      out += (out.empty() ? "" : "; ") + std::to_string(i) + ": " +
             plural(library_.channels(device_.get(), subdevice), kind->noun);
    }
    return out.empty() ? "nothing" : out;
  }

  /// The subdevices whose type is one of `types`.
  std::vector<unsigned> subdevices_of(std::initializer_list<int> types) const {
    std::vector<unsigned> out;
    const int count = library_.subdevices(device_.get());
    for (int i = 0; i < count; ++i) {
      const auto subdevice = static_cast<unsigned>(i);
      const int type = library_.type(device_.get(), subdevice);
      if (std::ranges::find(types, type) != types.end()) out.push_back(subdevice);
    }
    return out;
  }
  /// `asked`, or the first subdevice of `types`. `noun` names its channels.
  unsigned subdevice(const std::optional<unsigned>& asked,
                     std::initializer_list<int> types,
                     const std::string& noun) const {
    const std::vector<unsigned> found = subdevices_of(types);
    if (found.empty()) refuse("has no " + noun);
    if (!asked) return found.front();
    if (std::ranges::find(found, *asked) == found.end()) {
      refuse(fmt::format("has no {} on subdevice {}", noun, *asked));
    }
    return *asked;
  }
  /// Refuses a channel that the subdevice does not have.
  void check(const Channel& at, const std::string& key, const std::string& noun) const {
    const int count = std::max(0, library_.channels(device_.get(), at.subdevice));
    if (at.channel >= static_cast<unsigned>(count)) {
      refuse("has " + plural(count, noun) + fmt::format(" on subdevice {}, and ", at.subdevice) +
             key + fmt::format(" asks for number {}", at.channel));
    }
  }

  void find_outputs() {
    const unsigned sub = subdevice(setup_.output_subdevice, {COMEDI_SUBD_AO}, "analog output");
    for (std::size_t side = 0; side < outputs_.size(); ++side) {
      Output& out = outputs_[side];
      out.at = {sub, setup_.outputs[side]};
      check(out.at, "outputs", "analog output");
      out.maxdata = library_.maxdata(device_.get(), sub, out.at.channel);
      choose_range(out);
    }
  }
  /// The narrowest output range that includes +-max_volts.
  void choose_range(Output& out) const {
    const int count = library_.ranges(device_.get(), out.at.subdevice, out.at.channel);
    std::string known;
    for (int i = 0; i < count; ++i) {
      const auto index = static_cast<unsigned>(i);
      comedi_range* const range =
          library_.range(device_.get(), out.at.subdevice, out.at.channel, index);
      if (range == nullptr || range->unit != UNIT_volt) continue;
      known += fmt::format("{}{:g} to {:g} V", known.empty() ? "" : ", ", range->min, range->max);
      if (range->min > -setup_.max_volts || range->max < setup_.max_volts) continue;
      if (out.range != nullptr && range->max - range->min >= out.range->max - out.range->min) {
        continue;
      }
      out.range = range;
      out.range_index = index;
    }
    if (out.range == nullptr || out.maxdata == 0) {
      refuse(fmt::format("gives no -{:g} to {:g} V, which max_volts asks for, but ",
                         setup_.max_volts,
                         setup_.max_volts) +
             (known.empty() ? "no volts at all" : known));
    }
  }

  /// Cards have one counter per subdevice, or all counters on one.
  void find_counters() {
    const std::vector<unsigned> found = subdevices_of({COMEDI_SUBD_COUNTER});
    if (found.empty()) refuse("has no counters; the encoders need two");
    const std::vector<unsigned>& subs =
        setup_.counter_subdevices.empty() ? found : setup_.counter_subdevices;
    const bool apart = subs.size() > 1;
    const std::array<unsigned, 2> channels =
        setup_.counters.value_or(apart ? std::array{0U, 0U} : std::array{0U, 1U});
    for (std::size_t side = 0; side < counters_.size(); ++side) {
      Counter& counter = counters_[side];
      counter.at = {subdevice(subs[apart ? side : 0], {COMEDI_SUBD_COUNTER}, "counters"),
                    channels[side]};
      check(counter.at, "counters", "counter");
      counter.maxdata = library_.maxdata(device_.get(), counter.at.subdevice, counter.at.channel);
      if (counter.maxdata == 0) refuse("does not report the size of its counters");
      if (setup_.counter_mode) begin_counting(counter.at);
    }
    const Channel& left = counters_[0].at;
    const Channel& right = counters_[1].at;
    if (left.subdevice == right.subdevice && left.channel == right.channel) {
      refuse("cannot count both wheels with one counter");
    }
    for (Counter& counter : counters_) counter.newest = raw_count(counter);
  }
  void begin_counting(const Channel& at) {
    if (library_.reset(device_.get(), at.subdevice) < 0 ||
        library_.set_counter_mode(device_.get(), at.subdevice, at.channel, *setup_.counter_mode) <
            0 ||
        library_.arm(device_.get(), at.subdevice, NI_GPCT_ARM_IMMEDIATE) < 0) {
      fail(fmt::format("does not accept counter_mode {}", *setup_.counter_mode));
    }
  }
  lsampl_t raw_count(const Counter& counter) const {
    lsampl_t value = 0;
    if (library_.read(device_.get(), counter.at.subdevice, counter.at.channel, 0, 0, &value) != 1) {
      fail("does not read its counters");
    }
    return value;
  }
  /// Adds up the shorter of both differences modulo the counter's size.
  std::uint32_t count(Counter& counter, bool reversed) const {
    const lsampl_t value = raw_count(counter);
    const std::int64_t size = static_cast<std::int64_t>(counter.maxdata) + 1;
    std::int64_t moved = static_cast<std::int64_t>(value) - counter.newest;
    if (moved > size / 2) moved -= size;
    if (moved < -size / 2) moved += size;
    counter.newest = value;
    counter.total += static_cast<std::uint32_t>(reversed ? -moved : moved);
    return counter.total;
  }

  void find_lines() {
    lines_ = subdevice(
        setup_.line_subdevice, {COMEDI_SUBD_DIO, COMEDI_SUBD_DO}, "digital lines that can be set");
    configure({lines_, setup_.relay_line}, "relay_line", COMEDI_OUTPUT);
    if (setup_.enable_line) configure({lines_, *setup_.enable_line}, "enable_line", COMEDI_OUTPUT);
    inputs_ = lines_;
    const auto input = [this](const std::optional<unsigned>& line, const char* key) {
      if (!line) return;
      if (setup_.input_subdevice || is(lines_, COMEDI_SUBD_DO)) {
        inputs_ = subdevice(
            setup_.input_subdevice, {COMEDI_SUBD_DIO, COMEDI_SUBD_DI}, "digital lines to read");
      }
      configure({inputs_, *line}, key, COMEDI_INPUT);
    };
    input(setup_.relay_closed_line, "relay_closed_line");
    input(setup_.stop_line, "stop_line");
    input(setup_.fault_line, "fault_line");
    for (const unsigned line : setup_.bumper_lines) input(line, "bumper_lines");
    for (const unsigned line : setup_.rear_bumper_lines) input(line, "rear_bumper_lines");
  }
  bool is(unsigned subdevice, int type) const {
    return library_.type(device_.get(), subdevice) == type;
  }
  void configure(const Channel& line, const char* key, unsigned direction) const {
    check(line, key, "digital line");
    if (!is(line.subdevice, COMEDI_SUBD_DIO)) return;  // its lines have one direction
    if (library_.configure_line(device_.get(), line.subdevice, line.channel, direction) < 0) {
      refuse(fmt::format("cannot use digital line {} as an {}, which {} asks for",
                         line.channel,
                         direction == COMEDI_OUTPUT ? "output" : "input",
                         key));
    }
  }
  void set_line(unsigned line, bool high) const {
    if (library_.write_line(device_.get(), lines_, line, high ? 1 : 0) != 1) {
      fail("does not set its lines");
    }
  }
  bool high(unsigned line) const {
    unsigned level = 0;
    if (library_.read_line(device_.get(), inputs_, line, &level) != 1)
      fail("does not read its lines");
    return level != 0;
  }

  std::string port_;
  ComediSetup setup_;
  ComediLibrary library_;
  CardLock lock_;  // released after the card is closed
  std::unique_ptr<comedi_t, decltype(ComediLibrary::close)> device_{nullptr, nullptr};
  std::array<Output, 2> outputs_{};
  std::array<Counter, 2> counters_{};
  unsigned lines_ = 0;   // the subdevice of the relay's line
  unsigned inputs_ = 0;  // the subdevice of the lines that are read
};

}  // namespace

std::unique_ptr<AnalogCard> open_comedi_card(const std::string& port, const ComediSetup& setup) {
  return std::make_unique<ComediCard>(port, setup);
}

}  // namespace drivers
