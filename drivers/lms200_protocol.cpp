// drivers/lms200_protocol.cpp: requests to an LMS2xx, and its answers without measured values.
#include "drivers/lms200_protocol.hpp"

namespace drivers::lms200 {
namespace {

enum class Request : std::uint8_t {
  Mode = 0x20,
  Status = 0x31,
  Type = 0x3A,
  Variant = 0x3B,
  ReadConfiguration = 0x74,
  WriteConfiguration = 0x77,
};

constexpr std::size_t kPasswordBytes = 8;

/// The payload of a frame.
using Payload = FixedBytes<Configuration::kBytes + 1>;

Command framed(const Payload& payload, std::uint8_t address) {
  Command command;
  append_frame(command, address, payload.view());
  return command;
}

Command plain(Request code, std::uint8_t address) {
  Payload payload;
  payload.push_back(static_cast<std::uint8_t>(code));
  return framed(payload, address);
}

Payload begun(Request code, std::uint8_t parameter) {
  Payload payload;
  payload.push_back(static_cast<std::uint8_t>(code));
  payload.push_back(parameter);
  return payload;
}

Payload begun(Mode mode) {
  return begun(Request::Mode, static_cast<std::uint8_t>(mode));
}

bool is(const Telegram& telegram, Answer answer) {
  return telegram.code() == static_cast<std::uint8_t>(answer) && telegram.payload.size() >= 2;
}

const char* severity_text(std::uint8_t severity) {
  constexpr std::array<const char*, 5> kWords{"nothing", "info", "warning", "error", "fatal error"};
  return severity < kWords.size() ? kWords[severity] : "unknown severity";
}

}  // namespace

bool exists(const Variant& variant) {
  const unsigned step = variant.step_centidegrees;
  if (variant.angle_degrees == 100) return step == 100 || step == 50 || step == 25;
  return variant.angle_degrees == 180 && (step == 100 || step == 50);
}

unsigned baud_of(Rate rate) {
  switch (rate) {
    case Rate::Baud38400:
      return 38400;
    case Rate::Baud19200:
      return 19200;
    case Rate::Baud500000:
      return 500000;
    default:
      return 9600;
  }
}

Command status_command(std::uint8_t address) {
  return plain(Request::Status, address);
}
Command type_command(std::uint8_t address) {
  return plain(Request::Type, address);
}
Command read_configuration_command(std::uint8_t address) {
  return plain(Request::ReadConfiguration, address);
}

Command rate_command(Rate rate, std::uint8_t address) {
  return framed(begun(Request::Mode, static_cast<std::uint8_t>(rate)), address);
}
Command mode_command(Mode mode, std::uint8_t address) {
  return framed(begun(mode), address);
}

Command installation_command(std::string_view password, std::uint8_t address) {
  if (password.size() != kPasswordBytes) return {};
  Payload payload = begun(Mode::Installation);
  payload.append(password);
  return framed(payload, address);
}

Command variant_command(const Variant& variant, std::uint8_t address) {
  if (!exists(variant)) return {};
  Payload payload;
  payload.push_back(static_cast<std::uint8_t>(Request::Variant));
  payload.append_word(variant.angle_degrees);
  payload.append_word(variant.step_centidegrees);
  return framed(payload, address);
}

Command write_configuration_command(const Configuration& configuration, std::uint8_t address) {
  Payload payload;
  payload.push_back(static_cast<std::uint8_t>(Request::WriteConfiguration));
  payload.append(configuration.block());
  return framed(payload, address);
}

std::string health_text(Health health) {
  std::string text;
  const auto add = [&text](const std::string& sentence) {
    text += (text.empty() ? "" : " ") + sentence;
  };
  if (health.level() > 4) {
    add("The scanner reports a state unknown to its manual.");
  } else if (health.level() > 0) {
    const auto severity = static_cast<std::uint8_t>(health.level());
    add("The scanner reports: " + std::string(severity_text(severity)) + ".");
  }
  if (health.implausible()) add("Its values are implausible.");
  if (health.polluted()) add("Its window is dirty: clean it.");
  return text;
}

std::string refusal_text(const Telegram& telegram) {
  if (is(telegram, Answer::Refused)) return "The scanner refuses this in its present mode.";
  if (!is(telegram, Answer::Mode)) return "";
  if (telegram.data().size() != 1)
    return "The scanner's answer about its mode is too long or short.";
  switch (telegram.data()[0]) {
    case 0:
      return "";
    case 1:
      return "The scanner refuses the mode: the password is wrong (`password` in the robot's file, "
             "--password on the command line).";
    case 2:
      return "The scanner refuses the mode: it has a fault.";
    default:
      return "The scanner refuses the mode for a reason unknown to its manual.";
  }
}

std::optional<std::string_view> type_text(const Telegram& telegram) {
  if (!is(telegram, Answer::Type) && !is(telegram, Answer::PowerOn)) return std::nullopt;
  return text_of(telegram.data());
}

std::optional<VariantAnswer> variant_answer(const Telegram& telegram) {
  if (!is(telegram, Answer::Variant) || telegram.data().size() != 5) return std::nullopt;
  const ByteView data = telegram.data();
  return VariantAnswer{
      .done = data[0] == 1,
      .now = {.angle_degrees = word_at(data, 1), .step_centidegrees = word_at(data, 3)}};
}

std::optional<ConfigurationAnswer> configuration_answer(const Telegram& telegram) {
  constexpr std::size_t kShortest = 7;  // up to the unit, which a driver needs
  const bool written = is(telegram, Answer::ConfigurationWritten);
  if (!written && !is(telegram, Answer::Configuration)) return std::nullopt;
  const ByteView data = telegram.data();
  const std::size_t before = written ? 1 : 0;
  if (data.size() < before + kShortest || data.size() > before + Configuration::kBytes) {
    return std::nullopt;
  }
  return ConfigurationAnswer{.done = !written || data[0] == 1,
                             .now = Configuration(data.subspan(before))};
}

std::optional<DeviceStatus> device_status(const Telegram& telegram) {
  constexpr std::size_t kLength = 0x9A;
  if (!is(telegram, Answer::Status) || telegram.payload.size() != kLength) return std::nullopt;
  const ByteView p = telegram.payload;  // the manual counts bytes from the code, byte 0
  return DeviceStatus{.software = text_of(p.subspan(1, 7)),
                      .faulty = p[9] != 0,
                      .measuring_mode = p[102],
                      .variant = {word_at(p, 107), word_at(p, 109)},
                      .in_millimetres = p[122] == 1};
}

}  // namespace drivers::lms200
