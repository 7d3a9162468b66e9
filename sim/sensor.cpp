// sim/sensor.cpp: checks configurations against the table of sensors.
#include "sim/sensor.hpp"

#include <algorithm>
#include <cmath>

#include "algo/name.hpp"

namespace sim {
namespace {

const SensorKind* find_kind(std::string_view name) {
  const auto table = sensor_table();
  const auto found = std::ranges::find(table, name, &SensorKind::name);
  return found == table.end() ? nullptr : &*found;
}

std::string known_kinds() {
  std::string known;
  for (const SensorKind& kind : sensor_table()) {
    known += (known.empty() ? "" : ", ") + std::string(kind.name);
  }
  return known;
}

/// Without trailing zeros.
std::string text_of(double value) {
  std::string text = std::to_string(value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.ends_with('.')) text.pop_back();
  return text;
}

std::optional<std::string> defect(const SettingInfo& info, const std::vector<double>& values) {
  const std::string name(info.name);
  if (values.empty()) return name + " must not be empty";
  if (values.size() > info.most) {
    return name + (info.most == 1 ? " must be a number"
                                  : " must have " + std::to_string(info.most) + " numbers at most");
  }
  for (const double value : values) {
    if (value >= info.min && value <= info.max) continue;  // false for NaN
    return name + " must be " + text_of(info.min) + " to " + text_of(info.max);
  }
  return std::nullopt;
}

bool plain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '.' || c == '_';
}

}  // namespace

const std::vector<double>* SensorConfig::find(std::string_view name) const {
  const auto found = std::ranges::find(settings, name, &Setting::name);
  return found == settings.end() ? nullptr : &found->values;
}

double SensorConfig::number(std::string_view name, double fallback) const {
  const std::vector<double>* const values = find(name);
  return values == nullptr ? fallback : values->front();
}

std::optional<std::string> defect(const SensorConfig& config) {
  const SensorKind* const kind = find_kind(config.sensor);
  if (kind == nullptr) {
    return "sensor '" + config.sensor + "' is unknown; known are " + known_kinds();
  }
  const bool named = !config.channel.empty() && config.channel.size() <= algo::Name::kLongest &&
                     std::ranges::all_of(config.channel, plain);
  if (!named) return "channel must be 1 to 31 of a-z, 0-9, '.' and '_'";
  for (const Setting& setting : config.settings) {
    const auto info = std::ranges::find(kind->settings, setting.name, &SettingInfo::name);
    if (info == kind->settings.end()) return "there is no setting '" + setting.name + "'";
    if (auto complaint = defect(*info, setting.values)) return complaint;
  }
  for (const SettingInfo& info : kind->settings) {
    if (info.required && config.find(info.name) == nullptr) {
      return std::string(info.name) + " is missing: " + std::string(info.help);
    }
  }
  return kind->defect ? kind->defect(config) : std::nullopt;
}

std::unique_ptr<ChannelSensor> make_sensor(const SensorConfig& config, std::uint64_t seed) {
  return find_kind(config.sensor)->make(config, seed);
}

algo::ChannelInfo channel_of(const SensorConfig& config) {
  const SensorKind* const kind = find_kind(config.sensor);
  return {.name = config.channel,
          .kind = std::string(kind->kind),
          .unit = config.unit.empty() ? std::string(kind->unit) : config.unit,
          .values = kind->values};
}

bool Every::due(double stamp) {
  constexpr double kSlack = 1e-9;  // [s] rounding of sums of periods
  if (stamp + kSlack < next_) return false;
  if (period_ > 0) next_ = (std::floor((stamp + kSlack) / period_) + 1) * period_;
  return true;
}

}  // namespace sim
