// tests/bench/report.cpp: verdicts, the table, the result file and the comparison.
#include "tests/bench/report.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <stdexcept>
#include <thread>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

namespace bench {
namespace {

using nlohmann::json;

std::string number(double value) {
  if (std::isnan(value)) return "";
  if (value == 0 || std::abs(value) >= 1000) return fmt::format("{:.0f}", value);
  return fmt::format("{:.3g}", value);
}

std::string bar(const Figure& figure, double value) {
  if (std::isnan(value)) return "";
  return (figure.better == Better::Higher ? ">= " : "<= ") + number(value);
}

json or_null(double value) {
  return std::isnan(value) ? json() : json(value);
}

/// First value of `key` in /proc/cpuinfo.
std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  std::string text;
  while (std::getline(file, text)) {
    if (text.starts_with("model name")) return text.substr(text.find(": ") + 2);
  }
  return "unknown";
}

json read(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error("Cannot read " + path + ".");
  json document = json::parse(file, nullptr, false);
  if (!document.is_object() || !document.contains("figures") ||
      !document.at("figures").is_array()) {
    throw std::runtime_error(path + " is not a result file of this program.");
  }
  return document;
}

const json* find(const json& figures, const json& like) {
  const auto found = std::find_if(figures.begin(), figures.end(), [&](const json& each) {
    return each.at("row") == like.at("row") && each.at("name") == like.at("name");
  });
  return found == figures.end() ? nullptr : &*found;
}

}  // namespace

Verdict verdict(const Figure& figure) {
  const auto meets = [&](double bar_value) {
    if (std::isnan(bar_value) || std::isnan(figure.value)) return false;
    return figure.better == Better::Higher ? figure.value >= bar_value : figure.value <= bar_value;
  };
  if (std::isnan(figure.floor) && std::isnan(figure.stretch)) return Verdict::None;
  if (meets(figure.stretch)) return Verdict::Stretch;
  return meets(figure.floor) ? Verdict::Floor : Verdict::Below;
}

std::string to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::Stretch:
      return "stretch met";
    case Verdict::Floor:
      return "floor met";
    case Verdict::Below:
      return "below floor";
    case Verdict::None:
      break;
  }
  return "";
}

std::string duration(double seconds) {
  if (seconds >= 1) return fmt::format("{:.3g} s", seconds);
  if (seconds >= 1e-3) return fmt::format("{:.3g} ms", seconds * 1e3);
  if (seconds >= 1e-6) return fmt::format("{:.3g} us", seconds * 1e6);
  return fmt::format("{:.3g} ns", seconds * 1e9);
}

std::string line(const Figure& figure) {
  return fmt::format("{:<4} {:<34} {:>9} {:<8} {:<11} {}",
                     figure.row,
                     figure.name,
                     number(figure.value),
                     figure.unit,
                     to_string(verdict(figure)),
                     figure.note);
}

void print_table(const std::vector<Figure>& figures) {
  fmt::print("| row | name | figure | floor | stretch | verdict | how |\n");
  fmt::print("| --- | --- | ---: | ---: | ---: | --- | --- |\n");
  for (const Figure& f : figures) {
    fmt::print("| {} | {} | {} {} | {} | {} | {} | {} |\n",
               f.row,
               f.name,
               number(f.value),
               f.unit,
               bar(f, f.floor),
               bar(f, f.stretch),
               to_string(verdict(f)),
               f.note);
  }
}

void write_results(const std::string& path,
                   const std::vector<Figure>& figures,
                   const std::vector<std::string>& failures) {
  json items = json::array();
  for (const Figure& f : figures) {
    items.push_back({{"row", f.row},
                     {"name", f.name},
                     {"value", or_null(f.value)},
                     {"unit", f.unit},
                     {"better", f.better == Better::Higher ? "higher" : "lower"},
                     {"floor", or_null(f.floor)},
                     {"stretch", or_null(f.stretch)},
                     {"noise", or_null(f.noise)},
                     {"verdict", to_string(verdict(f))},
                     {"note", f.note}});
  }
  const json document = {{"machine",
                          {{"processor", processor()},
                           {"threads", std::thread::hardware_concurrency()},
                           {"compiler", __VERSION__}}},
                         {"figures", std::move(items)},
                         {"failures", failures}};
  std::ofstream file(path);
  file << document.dump(2) << '\n';
  if (!file.flush()) throw std::runtime_error("Cannot write " + path + ".");
}

std::size_t compare(const std::string& old_path, const std::string& new_path) {
  const json before = read(old_path);
  const json after = read(new_path);
  std::size_t worse = 0;
  fmt::print(
      "Ratios above 1 are better. Within {:.0f} %, or within both files' own spread: same.\n",
      100 * kNoiseBand);
  for (const json& now : after.at("figures")) {
    const json* const then = find(before.at("figures"), now);
    const std::string name = fmt::format(
        "{:<4} {:<34}", now.at("row").get<std::string>(), now.at("name").get<std::string>());
    if (then == nullptr) {
      fmt::print("{} new\n", name);
      continue;
    }
    if (!then->at("value").is_number() || !now.at("value").is_number()) continue;
    const double a = then->at("value");
    const double b = now.at("value");
    const bool higher = now.at("better") == "higher";
    const double ratio = a == b ? 1.0 : higher ? b / a : a / b;
    const double band = std::max(kNoiseBand, then->value("noise", 0.0) + now.value("noise", 0.0));
    const bool is_worse = !(ratio >= 1 / (1 + band));
    if (is_worse) ++worse;
    fmt::print("{} {:>9} -> {:>9} {:<8} {:5.2f}  {}\n",
               name,
               number(a),
               number(b),
               now.at("unit").get<std::string>(),
               ratio,
               is_worse           ? "worse"
               : ratio > 1 + band ? "better"
                                  : "same");
  }
  for (const json& then : before.at("figures")) {
    if (find(after.at("figures"), then) == nullptr) {
      fmt::print("{:<4} {:<34} gone\n",
                 then.at("row").get<std::string>(),
                 then.at("name").get<std::string>());
    }
  }
  return worse;
}

}  // namespace bench
