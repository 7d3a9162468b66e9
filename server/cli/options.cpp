// server/cli/options.cpp: passes everything on to CLI11.
#include "server/cli/options.hpp"

#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <system_error>
#include <type_traits>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace server {
namespace {

/// The type of one value of an option.
template <typename T>
struct Single {
  using Type = T;
};
template <typename T>
struct Single<std::optional<T>> {
  using Type = T;
};
template <typename T>
struct Single<std::vector<T>> {
  using Type = T;
};

/// CLI11 reads "-1" for an unsigned variable as 18446744073709551615.
std::string refuse_negative(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(" \t");
  const bool negative = begin != std::string::npos && text[begin] == '-';
  return negative ? text + " must not be negative" : "";
}

/// CLI11 reads a number beyond its type as the last one of the type.
template <typename Number>
std::string refuse_too_large(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(" \t+");
  const char* const end = text.data() + text.size();
  Number number{};
  if (begin == std::string::npos) return "";
  const auto read = std::from_chars(text.data() + begin, end, number);
  if (read.ec != std::errc::result_out_of_range) return "";
  return fmt::format("{} must be from {} to {}",
                     text,
                     std::numeric_limits<Number>::min(),
                     std::numeric_limits<Number>::max());
}

/// No comparison with the ends of a range refuses "nan".
std::string refuse_not_finite(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  const bool number = end != text.c_str() && *end == '\0';
  return number && !std::isfinite(value) ? text + " must be a finite number" : "";
}

}  // namespace

Option Option::required() const {
  option_->required();
  return *this;
}

Option Option::type_name(const std::string& word) const {
  option_->type_name(word);
  return *this;
}

Option Option::show_default() const {
  option_->capture_default_str();
  return *this;
}

Option Option::one_value() const {
  option_->allow_extra_args(false);
  return *this;
}

Option Option::excludes(Option other) const {
  option_->excludes(other.option_);
  return *this;
}

Option Option::needs(Option other) const {
  option_->needs(other.option_);
  return *this;
}

template <typename T>
Option Option::range(T low, T high) const {
  option_->check(CLI::Range(low, high));
  return *this;
}

template <typename T>
Option Option::one_of(std::initializer_list<T> values) const {
  option_->check(CLI::IsMember(values));
  return *this;
}

Option Option::existing_file() const {
  option_->check(CLI::ExistingFile);
  return *this;
}

Option Option::existing_folder() const {
  option_->check(CLI::ExistingDirectory);
  return *this;
}

Option Option::check(std::function<std::string(const std::string&)> complaint,
                     const std::string& words) const {
  option_->check(std::move(complaint), words);
  return *this;
}

template <typename T>
Option Command::add_option(const std::string& names, T& variable, const std::string& help) const {
  const Option option(*app_->add_option(names, variable, help));
  using Number = typename Single<T>::Type;
  if constexpr (std::is_integral_v<Number>) option.check(refuse_too_large<Number>);
  if constexpr (std::is_unsigned_v<Number>) return option.check(refuse_negative);
  if constexpr (std::is_floating_point_v<Number>) return option.check(refuse_not_finite);
  return option;
}

Option Command::add_option_function(const std::string& names,
                                    const std::function<void(const std::string&)>& take,
                                    const std::string& help) const {
  return Option(*app_->add_option_function<std::string>(names, take, help));
}

Option Command::add_flag(const std::string& names, bool& variable, const std::string& help) const {
  return Option(*app_->add_flag(names, variable, help));
}

Option Command::get_option(const std::string& name) const {
  return Option(*app_->get_option(name));
}

Command Command::add_subcommand(const std::string& name, const std::string& help) const {
  return Command(*app_->add_subcommand(name, help));
}

void Command::require_subcommand() const {
  app_->require_subcommand(1);
}

void Command::footer(const std::string& text) const {
  app_->footer(text);
}

void Command::callback(std::function<void()> run) const {
  app_->callback(std::move(run));
}

template Option Option::range(int, int) const;
template Option Option::range(double, double) const;
template Option Option::range(std::size_t, std::size_t) const;
template Option Option::one_of(std::initializer_list<const char*>) const;
template Option Option::one_of(std::initializer_list<int>) const;
template Option Option::one_of(std::initializer_list<unsigned>) const;
template Option Option::one_of(std::initializer_list<double>) const;

// The types of variables. Each costs half a second of compile time.
#define TAUTLINE_BINDS(...) \
  template Option Command::add_option(const std::string&, __VA_ARGS__&, const std::string&) const
TAUTLINE_BINDS(std::string);
TAUTLINE_BINDS(std::filesystem::path);
TAUTLINE_BINDS(double);
TAUTLINE_BINDS(int);
TAUTLINE_BINDS(unsigned);
TAUTLINE_BINDS(std::uint16_t);
TAUTLINE_BINDS(std::uint64_t);
TAUTLINE_BINDS(std::int64_t);
TAUTLINE_BINDS(std::optional<std::string>);
TAUTLINE_BINDS(std::optional<double>);
TAUTLINE_BINDS(std::optional<unsigned>);
TAUTLINE_BINDS(std::optional<std::uint64_t>);
TAUTLINE_BINDS(std::vector<std::string>);
TAUTLINE_BINDS(std::vector<std::uint64_t>);
#undef TAUTLINE_BINDS

}  // namespace server
