// server/serve/net/visitor.cpp: the words of roles, and the cleaning of names.
#include "server/serve/net/visitor.hpp"

#include <array>
#include <cstddef>

#include <fmt/format.h>

#include "server/serve/net/http.hpp"

namespace server::net {
namespace {

constexpr std::size_t kLongest = 32;  // characters of a name

/// The bytes of the character that begins with `first`, in valid UTF-8.
std::size_t bytes_of(char first) {
  const auto c = static_cast<unsigned char>(first);
  return c < 0x80 ? 1 : c < 0xE0 ? 2 : c < 0xF0 ? 3 : 4;
}

std::uint32_t code_point(std::string_view character) {
  std::uint32_t out = static_cast<unsigned char>(character[0]);
  if (character.size() > 1) out &= 0xFFu >> (character.size() + 1);
  for (const char c : character.substr(1)) out = out << 6 | (static_cast<unsigned char>(c) & 0x3Fu);
  return out;
}

/// Control characters, and those that hide or turn round the text beside them.
bool unfit(std::uint32_t c) {
  return c < 0x20 || (c >= 0x7F && c < 0xA0) || c == 0xAD || c == 0x61C || c == 0xFEFF ||
         (c >= 0x200B && c <= 0x200F) || (c >= 0x2028 && c <= 0x202E) ||
         (c >= 0x2060 && c <= 0x206F) || c >= 0xE0000;
}

}  // namespace

std::string_view name(Role role) {
  static constexpr std::array<std::string_view, 4> kNames{"nobody", "viewer", "operator", "admin"};
  return kNames[static_cast<std::size_t>(role)];
}

std::string role_refusal(Role has, Role needed) {
  const std::string_view article = needed == Role::Viewer ? "a" : "an";
  return fmt::format("This needs the role {}; yours is {}. Sign in with {} {}'s token.",
                     name(needed),
                     name(has),
                     article,
                     name(needed));
}

std::string clean_name(std::string_view text) {
  std::string out;
  if (!valid_utf8(text)) return out;
  std::size_t characters = 0;
  while (!text.empty() && characters < kLongest) {
    const std::string_view character = text.substr(0, bytes_of(text.front()));
    text.remove_prefix(character.size());
    const std::uint32_t c = code_point(character);
    if (unfit(c) || (out.empty() && c == ' ')) continue;
    out += character;
    ++characters;
  }
  while (!out.empty() && out.back() == ' ') out.pop_back();
  return out;
}

}  // namespace server::net
