// server/record/csv_cells.cpp: cells by std::to_chars.
#include "server/record/csv_cells.hpp"

#include <array>
#include <charconv>
#include <cmath>

namespace server {
namespace {

template <typename T>
void put(std::string& out, T value) {
  if (std::isnan(value)) return;
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  out.append(digits.data(), end);
}

}  // namespace

void put_number(std::string& out, double value) {
  put(out, value);
}

void put_float(std::string& out, double value) {
  put(out, static_cast<float>(value));
}

void put_text(std::string& out, std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) {
    out += text;
    return;
  }
  out += '"';
  for (const char c : text) out.append(c == '"' ? 2 : 1, c == '\n' || c == '\r' ? ' ' : c);
  out += '"';
}

}  // namespace server
