// server/external/registration.cpp: parses registrations and makes catalogue entries of them.
#include "server/external/registration.hpp"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "algo/driving.hpp"
#include "server/external/external_controller.hpp"
#include "server/external/listening_source.hpp"
#include "server/external/process_source.hpp"
#include "server/external/shared_object.hpp"

namespace server::external {
namespace {

constexpr std::uint32_t kMostThinkTicks = 1000;
constexpr std::size_t kLongestName = 31;

bool valid_name(std::string_view name) {
  const auto fits = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  return !name.empty() && name.size() <= kLongestName && std::ranges::all_of(name, fits);
}

/// The texts of a catalogue entry, and where its controllers get their peers.
struct Entry {
  Registration registration{};
  std::string label{};
  std::string help{};
  std::shared_ptr<PeerSource> source{};
};

algo::ControllerInfo info_of(const std::shared_ptr<const Entry>& entry) {
  return {.name = entry->registration.name,
          .label = entry->label,
          .help = entry->help,
          .by_sonar = true,
          .outside = true,
          .parameters = algo::kDrivingParameters,
          .make = [entry]() -> std::unique_ptr<algo::Controller> {
            return std::make_unique<ExternalController>(
                entry->source, algo::kDrivingParameters, entry->registration.think);
          }};
}

std::shared_ptr<const Entry> entry_of(const Registration& registration) {
  auto entry = std::make_shared<Entry>();
  entry->registration = registration;
  entry->label = fmt::format("Your own: {}", registration.name);
  entry->help = "A controller outside the program, which answers each observation with a command.";
  if (registration.command.ends_with(".so")) {
    entry->source = std::make_shared<SharedObjectSource>(registration.name, registration.command);
  } else if (is_address(registration.command)) {
    const char* const token = std::getenv("TAUTLINE_CONTROLLER_TOKEN");
    entry->source = std::make_shared<ListeningSource>(registration, token == nullptr ? "" : token);
  } else {
    entry->source = std::make_shared<ProcessSource>(registration);
  }
  return entry;
}

}  // namespace

ThinkTime think_time_from_text(std::string_view text) {
  if (text == "pause") return {};
  if (text == "measured") return {.kind = ThinkTime::Kind::Measured};
  ThinkTime out{.kind = ThinkTime::Kind::Fixed};
  const char* const end = text.data() + text.size();
  const auto [last, error] = std::from_chars(text.data(), end, out.ticks);
  if (error != std::errc() || last != end || out.ticks > kMostThinkTicks) {
    throw std::invalid_argument(fmt::format(
        "'{}' must be pause, measured or a number of ticks from 0 to {}", text, kMostThinkTicks));
  }
  return out;
}

bool is_command(std::string_view text) {
  return text.find_first_of(" /=") != std::string_view::npos;
}

Registration registration_from_text(std::string_view text) {
  const std::size_t equals = text.find('=');
  const bool named = equals != std::string_view::npos && valid_name(text.substr(0, equals));
  Registration out;
  out.name = named ? text.substr(0, equals) : "external";
  out.command = named ? text.substr(equals + 1) : text;
  if (out.command.find_first_not_of(' ') == std::string::npos) {
    throw std::invalid_argument(fmt::format("'{}' has no command", text));
  }
  if (algo::builtin_controllers().find(out.name) != nullptr) {
    throw std::invalid_argument(
        fmt::format("'{}' is a built-in controller; give yours another name", out.name));
  }
  return out;
}

algo::ControllerCatalogue catalogue_with(const std::vector<Registration>& own) {
  std::vector<algo::ControllerInfo> entries = algo::builtin_controllers().entries();
  for (const Registration& each : own) {
    if (std::ranges::find(entries, each.name, &algo::ControllerInfo::name) != entries.end()) {
      throw std::invalid_argument(fmt::format("two controllers are called '{}'", each.name));
    }
    entries.push_back(info_of(entry_of(each)));
  }
  return algo::ControllerCatalogue(std::move(entries));
}

}  // namespace server::external
