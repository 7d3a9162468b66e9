// server/run/json_fields.hpp: one table of fields reads and writes both a struct and its document.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <variant>
#include <vector>

#include "server/run/json_reader.hpp"

namespace server {

/// One field of T. A field without a member is an allowed key that other code reads and writes.
template <typename T>
struct Field {
  using Member = std::variant<std::monostate,
                              double T::*,
                              std::optional<double> T::*,
                              bool T::*,
                              std::uint32_t T::*>;
  const char* key = "";
  Member member{};
  NumberRange range{};
  double unit = 1;  // the document's unit in the member's unit: pi / 180 for degrees
  bool required = false;
};

/// A field that the document must have.
template <typename T>
constexpr Field<T> required(const char* key, double T::*member, NumberRange range = {}) {
  return {key, member, range, 1, true};
}

/// Reads the fields that the document has; the others keep their values. Throws DocumentError.
template <typename T, std::size_t N>
void read_fields(const JsonReader& in, const Field<T> (&table)[N], std::type_identity_t<T>& out) {
  for (const Field<T>& field : table) {
    const auto read = [&](auto member) {
      using M = decltype(member);
      if constexpr (std::is_same_v<M, double T::*>) {
        const double now = out.*member / field.unit;
        out.*member = field.unit * (field.required ? in.number(field.key, field.range)
                                                   : in.number_or(field.key, now, field.range));
      } else if constexpr (std::is_same_v<M, std::optional<double> T::*>) {
        if (in.has(field.key)) out.*member = in.number(field.key, field.range);
      } else if constexpr (std::is_same_v<M, bool T::*>) {
        out.*member = in.flag_or(field.key, out.*member);
      } else if constexpr (std::is_same_v<M, std::uint32_t T::*>) {
        const auto most = static_cast<std::uint64_t>(field.range.max);
        out.*member = static_cast<std::uint32_t>(in.whole_or(field.key, out.*member, most));
      }
    };
    std::visit(read, field.member);
  }
}

/// As read_fields(), but the document may have no other fields.
template <typename T, std::size_t N>
void read_only_fields(const JsonReader& in,
                      const Field<T> (&table)[N],
                      std::type_identity_t<T>& out) {
  std::vector<std::string_view> known;
  for (const Field<T>& field : table) known.emplace_back(field.key);
  in.only(known);
  read_fields(in, table, out);
}

/// Writes every field that has a member and a value. Rounds a field in another unit to 1e-9 of it.
template <typename T, std::size_t N>
nlohmann::json written(const Field<T> (&table)[N], const std::type_identity_t<T>& value) {
  nlohmann::json out = nlohmann::json::object();
  for (const Field<T>& field : table) {
    const auto write = [&](auto member) {
      using M = decltype(member);
      if constexpr (std::is_same_v<M, double T::*>) {
        out[field.key] =
            field.unit == 1 ? value.*member : std::round(value.*member / field.unit * 1e9) / 1e9;
      } else if constexpr (std::is_same_v<M, std::optional<double> T::*>) {
        if (value.*member) out[field.key] = *(value.*member);
      } else if constexpr (!std::is_same_v<M, std::monostate>) {
        out[field.key] = value.*member;
      }
    };
    std::visit(write, field.member);
  }
  return out;
}

}  // namespace server
