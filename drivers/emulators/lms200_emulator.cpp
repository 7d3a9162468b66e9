// drivers/emulators/lms200_emulator.cpp: how an LMS200 answers telegrams.
#include "drivers/emulators/lms200_emulator.hpp"

#include <algorithm>
#include <utility>

#include "drivers/emulators/lms200_words.hpp"

namespace drivers::lms200 {
namespace {

constexpr double kLongestGap = 0.006;        // [s] between two bytes of a request
constexpr std::size_t kLongestRequest = 96;  // LENGTH; the second part of a configuration has 85
constexpr std::uint8_t kAccepted = 1;
constexpr std::uint8_t kRejected = 0;

/// Request codes of the manual.
enum class Request : std::uint8_t {
  Reset = 0x10,
  Mode = 0x20,
  Values = 0x30,
  Status = 0x31,
  Errors = 0x32,
  Mean = 0x36,
  Range = 0x37,
  Type = 0x3A,
  Variant = 0x3B,
  MeanRange = 0x3F,
  StartUp = 0x66,
  ReadConfiguration = 0x74,
  WriteConfiguration = 0x77,
  ReadSecond = 0x7B,
  WriteSecond = 0x7C,
};
constexpr std::uint8_t kTestPassword = 0x30;  // as a mode
constexpr std::uint8_t kAnswerBit = 0x80;

// Results of a mode request.
constexpr std::uint8_t kDone = 0;
constexpr std::uint8_t kWrongPassword = 1;
constexpr std::uint8_t kFault = 2;

constexpr std::size_t kAvailability = 4;  // in the configuration
constexpr std::size_t kMeasuringMode = 5;
constexpr std::size_t kUnit = 6;

std::uint8_t code_of(Answer answer) {
  return static_cast<std::uint8_t>(answer);
}

Configuration factory_configuration() {
  std::array<std::uint8_t, Configuration::kBytes> block{};
  block[2] = 0x46;  // stop threshold [mV]
  block[kUnit] = 1;
  block[9] = 2;   // multiple evaluation
  block[10] = 2;  // restart mode
  block[32] = 2;  // evaluations when dazzled
  return Configuration(block);
}

/// The rate word of the status.
std::uint16_t rate_word(unsigned baud) {
  switch (baud) {
    case 500000:
      return 0x8001;
    case 38400:
      return 0x8019;
    case 19200:
      return 0x8033;
    default:
      return 0x8067;
  }
}

std::optional<unsigned> rate_of_mode(std::uint8_t mode) {
  switch (mode) {
    case 0x40:
      return 38400;
    case 0x41:
      return 19200;
    case 0x42:
      return 9600;
    case 0x48:
      return 500000;
    default:
      return std::nullopt;
  }
}

}  // namespace

Emulator::Emulator(const EmulatorOptions& options)
    : Device(options.start_rate, options.seed),
      options_(options),
      boot_end_(-emulators::kNever),
      variant_(options.variant),
      configuration_(factory_configuration()),
      stored_rate_(options.start_rate),
      start_up_(options.start_up),
      refusals_(options.refusals) {
  note_sweep();
}

// ---- the line ----------------------------------------------------------------------------------

void Emulator::on_byte(std::uint8_t byte, double at) {
  if (!started(at) || at < deaf_until_) return;
  if (request_.size() == 0 && byte != kStart) return;
  request_.push_back(byte);
  const ByteView so_far = request_.view();
  if (so_far.size() < 4) return;
  const std::size_t length = word_at(so_far, 2);
  if (so_far[1] >= kAnswerAddress || length == 0 || length > kLongestRequest) {
    request_.clear();
    return;
  }
  if (so_far.size() < length + kFrameBytes) return;
  const FixedBytes<128> frame = request_;
  request_.clear();
  take(frame.view(), at);
}

void Emulator::on_quiet(double silence) {
  if (silence > kLongestGap) request_.clear();
}

void Emulator::work(double now) {
  if (!begun_) {
    begun_ = true;
    if (!options_.powered) restart(now, options_.boot_time);
  }
  if (!greeted_ && now >= boot_end_) {
    greeted_ = true;
    std::vector<std::uint8_t> text(options_.type.begin(), options_.type.end());
    go_deaf(say(code_of(Answer::PowerOn), text, boot_end_).end);
  }
  while (!jobs_.empty() && jobs_.front().due <= now) {
    const Job job = std::move(jobs_.front());
    jobs_.erase(jobs_.begin());
    job.run(job.due);
  }
  if (leaving_ && leaving_->end <= now) {
    close_scan(mute_at(now) ? SentScan::Fate::Muted : leaving_->fate);
  }
}

double Emulator::next_duty() const {
  double next = emulators::kNever;
  if (!jobs_.empty()) next = jobs_.front().due;
  if (!greeted_) next = std::min(next, boot_end_);
  return next;
}

void Emulator::later(double due, std::function<void(double)> run) {
  jobs_.push_back({.due = due, .run = std::move(run)});
}

void Emulator::take(ByteView frame, double at) {
  const bool mine = frame[1] == kEverybody || frame[1] == options_.address;
  if (!mine) return;
  // A request aborts any transmission.
  if (line().cut(at) && leaving_) close_scan(SentScan::Fate::Cut);
  once_ = {};
  const ByteView checked = frame.first(frame.size() - 2);
  const bool sound = crc(checked) == word_at(frame, checked.size());
  const double answered = at + options_.times.acknowledge;
  if (!sound || refusals_ > 0) {
    if (sound) --refusals_;
    ++bad_telegrams_;
    line().say(std::array{kNak}, answered);
    return;
  }
  if (!jobs_.empty()) return;  // busy with the previous request: no answer
  line().say(std::array{kAck}, answered);
  carry_out(frame.subspan(4, frame.size() - kFrameBytes), answered);
}

void Emulator::carry_out(ByteView payload, double at) {
  const ByteView data = payload.subspan(1);
  const double soon = options_.times.answer;
  const auto bare = [&](std::uint8_t code, const std::vector<std::uint8_t>& content) {
    if (data.empty()) {
      answer(code, content, soon, at);
    } else {
      refuse(at);
    }
  };
  switch (static_cast<Request>(payload[0])) {
    case Request::Reset:
      bare(code_of(Answer::ResetConfirmed), {});
      later(at + soon, [this](double due) {
        later(std::max(due, line().free_at()),
              [this](double then) { restart(then, options_.boot_time); });
      });
      return;
    case Request::Mode:
      change_mode(data, at);
      return;
    case Request::Values:
    case Request::Mean:
    case Request::Range:
    case Request::MeanRange:
      take_values(payload, at);
      return;
    case Request::Status:
      bare(code_of(Answer::Status), status());
      return;
    case Request::Errors:
      bare(code_of(Answer::Errors), errors());
      return;
    case Request::Type:
      bare(code_of(Answer::Type), {options_.type.begin(), options_.type.end()});
      return;
    case Request::Variant:
      change_variant(data, at);
      return;
    case Request::StartUp:
      change_start_up(data, at);
      return;
    case Request::ReadConfiguration: {
      const ByteView block = configuration_.block();
      bare(code_of(Answer::Configuration), {block.begin(), block.end()});
      return;
    }
    case Request::WriteConfiguration:
      write_configuration(data, at);
      return;
    case Request::ReadSecond:
      bare(code_of(Answer::SecondConfiguration), {second_.begin(), second_.end()});
      return;
    case Request::WriteSecond:
      write_second(data, at);
      return;
    default:
      refuse(at);
  }
}

void Emulator::answer(std::uint8_t code,
                      const std::vector<std::uint8_t>& data,
                      double delay,
                      double at) {
  later(at + delay, [this, code, data](double due) { say(code, data, due); });
}

void Emulator::refuse(double at) {
  answer(code_of(Answer::Refused), {}, options_.times.answer, at);
}

emulators::Sending Emulator::say(std::uint8_t code, ByteView data, double at) {
  FixedBytes<kLongestLength + kFrameBytes> payload;
  payload.push_back(code);
  payload.append(data);
  payload.push_back(health_);
  FixedBytes<kLongestLength + kFrameBytes> frame;
  append_frame(frame, static_cast<std::uint8_t>(kAnswerAddress + options_.address), payload.view());
  return line().say(frame.view(), at);
}

// ---- modes and settings ------------------------------------------------------------------------

void Emulator::enter(Mode mode, const Taking& stream) {
  mode_ = mode;
  stream_ = stream;
  summed_ = 0;
  note_sweep();
}

void Emulator::change_mode(ByteView data, double at) {
  if (data.empty()) return refuse(at);
  const ByteView parameters = data.subspan(1);
  const auto done = [&](std::uint8_t result) {
    later(at + options_.times.mode, [this, result](double due) {
      go_deaf(say(code_of(Answer::Mode), std::array{result}, due).end);
    });
  };
  const auto enter_then = [&](Mode mode, const Taking& stream) {
    done(kDone);
    later(at + options_.times.mode, [this, mode, stream](double) { enter(mode, stream); });
  };

  if (const auto baud = rate_of_mode(data[0])) {
    if (!parameters.empty()) return refuse(at);
    if (*baud == 500000 && !options_.rs422) return done(kFault);
    done(kDone);
    // The answer still comes at the old rate.
    later(at + options_.times.mode, [this, rate = *baud](double due) {
      later(std::max(due, line().free_at()), [this, rate](double) { line().set_baud(rate); });
    });
    return;
  }
  const auto means_at = [&](std::size_t i) -> unsigned { return parameters[i]; };
  const auto range_at = [&](std::size_t i) {
    return ValueRange{word_at(parameters, i), word_at(parameters, i + 2)};
  };
  const auto fits = [&](const Taking& taking) {
    return taking.means >= 1 && taking.means <= 250 && (!taking.range || range_fits(*taking.range));
  };
  const auto stream = [&](const Taking& taking) {
    if (!fits(taking)) return refuse(at);
    enter_then(static_cast<Mode>(data[0]), taking);
  };
  switch (data[0]) {
    case 0x00:
    case kTestPassword:
      if (text_of(parameters) != options_.password) return done(kWrongPassword);
      if (data[0] == kTestPassword) return done(kDone);
      return enter_then(Mode::Installation, {});
    case 0x10:
      return parameters.empty() ? enter_then(Mode::Diagnosis, {}) : refuse(at);
    case 0x24:
      return parameters.empty() ? stream({.code = code_of(Answer::Values)}) : refuse(at);
    case 0x25:
      return parameters.empty() ? enter_then(Mode::OnRequest, {}) : refuse(at);
    case 0x26:
      if (parameters.size() != 1 || means_at(0) < 2) return refuse(at);
      return stream({.code = code_of(Answer::Means), .means = means_at(0)});
    case 0x27:
      if (parameters.size() != 4) return refuse(at);
      return stream({.code = code_of(Answer::RangeValues), .range = range_at(0)});
    case 0x28:
      if (parameters.size() != 5 || means_at(0) < 2) return refuse(at);
      return stream(
          {.code = code_of(Answer::MeanRange), .means = means_at(0), .range = range_at(1)});
    case 0x2A:
      return parameters.empty() ? stream({.code = code_of(Answer::Values), .parts = true})
                                : refuse(at);
    default:
      return refuse(at);  // minima, fields, reflectivity: not emulated
  }
}

void Emulator::take_values(ByteView payload, double at) {
  constexpr std::uint8_t kAll = 1;
  if (mode_ == Mode::Installation || mode_ == Mode::Diagnosis) return refuse(at);
  const ByteView data = payload.subspan(1);
  Taking once{.code = static_cast<std::uint8_t>(payload[0] + kAnswerBit)};
  std::size_t expected = 1;
  switch (static_cast<Request>(payload[0])) {
    case Request::Values:
      if (data.size() == 1 && data[0] != kAll) return refuse(at);  // "every second": not emulated
      break;
    case Request::Mean:
      if (data.size() == 1) once.means = data[0];
      break;
    case Request::Range:
      expected = 4;
      if (data.size() == expected) once.range = ValueRange{word_at(data, 0), word_at(data, 2)};
      break;
    default:
      expected = 5;
      if (data.size() == expected) {
        once.means = data[0];
        once.range = ValueRange{word_at(data, 1), word_at(data, 3)};
      }
  }
  const auto request = static_cast<Request>(payload[0]);
  const bool averages = request == Request::Mean || request == Request::MeanRange;
  const bool means_fit = !averages || (once.means >= 2 && once.means <= 250);
  if (data.size() != expected || !means_fit || (once.range && !range_fits(*once.range))) {
    return refuse(at);
  }
  later(at + options_.times.answer, [this, once](double) {
    once_ = once;
    summed_ = 0;
  });
}

bool Emulator::range_fits(const ValueRange& range) const {
  return range.first >= 1 && range.first <= range.last && range.last <= variant_.beams();
}

void Emulator::change_variant(ByteView data, double at) {
  if (data.size() != 4) return refuse(at);
  const Variant wanted{.angle_degrees = word_at(data, 0), .step_centidegrees = word_at(data, 2)};
  const bool done = exists(wanted);
  later(at + options_.times.variant, [this, wanted, done](double due) {
    if (done) {
      variant_ = wanted;
      // A new variant ends a running stream.
      enter(mode_ == Mode::Installation ? mode_ : Mode::OnRequest, {});
    }
    FixedBytes<5> content;
    content.push_back(done ? kAccepted : kRejected);
    content.append_word(variant_.angle_degrees);
    content.append_word(variant_.step_centidegrees);
    say(code_of(Answer::Variant), content.view(), due);
  });
}

void Emulator::change_start_up(ByteView data, double at) {
  const bool done = data.size() == 1 && data[0] <= 2;
  if (done) {
    start_up_ = static_cast<StartUpRate>(data[0]);
    if (start_up_ == StartUpRate::Baud9600) stored_rate_ = 9600;
    if (start_up_ == StartUpRate::KeepPresent) stored_rate_ = baud();
    ++memory_writes_;
  }
  answer(code_of(Answer::StartUpRate),
         {done ? kAccepted : kRejected, static_cast<std::uint8_t>(start_up_)},
         options_.times.answer,
         at);
}

void Emulator::write_configuration(ByteView data, double at) {
  constexpr std::size_t kShortest = 7;
  if (mode_ != Mode::Installation) return refuse(at);
  std::array<std::uint8_t, Configuration::kBytes> block{};
  std::ranges::copy(configuration_.block(), block.begin());
  bool done = data.size() >= kShortest && data.size() <= block.size();
  if (done) {
    std::ranges::copy(data, block.begin());
    constexpr std::uint8_t kEnergy = 0x3F;
    const std::uint8_t mode = block[kMeasuringMode];
    done = block[kUnit] <= 1 && block[kAvailability] <= 7 && (layout_of(mode) || mode == kEnergy);
  }
  later(at + options_.times.write_configuration, [this, block, done](double due) {
    if (done) {
      configuration_ = Configuration(block);
      ++memory_writes_;
    }
    std::vector<std::uint8_t> content{done ? kAccepted : kRejected};
    const ByteView now = configuration_.block();
    content.insert(content.end(), now.begin(), now.end());
    say(code_of(Answer::ConfigurationWritten), content, due);
  });
}

void Emulator::write_second(ByteView data, double at) {
  if (mode_ != Mode::Installation) return refuse(at);
  const bool done = data.size() == second_.size();
  if (done) {
    std::ranges::copy(data, second_.begin());
    ++memory_writes_;
  }
  std::vector<std::uint8_t> content{done ? kAccepted : kRejected};
  content.insert(content.end(), second_.begin(), second_.end());
  answer(
      code_of(Answer::SecondConfigurationWritten), content, options_.times.write_configuration, at);
}

std::vector<std::uint8_t> Emulator::status() const {
  constexpr std::size_t kBytes = 152;
  constexpr std::size_t kMotor = 148;  // [us] for 1/90 of a turn, nominal
  std::vector<std::uint8_t> data(kBytes);
  // The manual counts bytes from the code of the answer, byte 0.
  const auto put = [&data](std::size_t at, std::size_t value) {
    data[at - 1] = static_cast<std::uint8_t>(value & 0xFFU);
  };
  const auto put_word = [&put](std::size_t at, std::size_t value) {
    put(at, value);
    put(at + 1, value >> 8U);
  };
  const auto put_text = [&put](std::size_t at, std::string_view text) {
    for (std::size_t i = 0; i < text.size(); ++i) put(at + i, static_cast<std::uint8_t>(text[i]));
  };
  const ByteView block = configuration_.block();
  const std::size_t version = options_.type.rfind(';') + 1;
  put_text(1, std::string_view(options_.type).substr(version, 7));
  put(8, static_cast<std::size_t>(mode_));
  put(9, (health_ & 7U) >= 3 ? 1 : 0);
  constexpr std::size_t kClean = 100;  // a pollution word of a clean window
  for (std::size_t i = 0; i < 8; ++i) put_word(19 + 2 * i, kClean);
  put_word(67, kMotor);
  put(102, block[kMeasuringMode]);
  put_word(107, variant_.angle_degrees);
  put_word(109, variant_.step_centidegrees);
  put(111, block[10]);
  put_word(112, block[11]);
  put_word(116, rate_word(baud()));
  put(118, block[9]);
  put(119, static_cast<std::size_t>(start_up_));
  put(120, options_.address);
  put(122, block[kUnit]);
  put(123, 1);
  put_text(124, "X01.27 ");
  return data;
}

std::vector<std::uint8_t> Emulator::errors() const {
  constexpr std::uint8_t kWarning = 2;
  constexpr std::uint8_t kGone = 0x80;
  constexpr std::uint8_t kDazzledNumber = 5;
  if (!was_dazzled_) return {};
  return {static_cast<std::uint8_t>(dazzled_ ? kWarning : kWarning | kGone), kDazzledNumber};
}

void Emulator::restart(double now, double boot_time) {
  if (line().cut(now) && leaving_) close_scan(SentScan::Fate::Cut);
  jobs_.clear();
  request_.clear();
  once_ = {};
  line().set_baud(stored_rate_);
  variant_ = options_.variant;
  enter(Mode::OnRequest, {});
  boot_end_ = now + boot_time;
  greeted_ = false;
}

}  // namespace drivers::lms200
