// server/run/pgm_picture.cpp: words, and then as many values as the header says.
#include "server/run/pgm_picture.hpp"

#include <algorithm>
#include <charconv>
#include <stdexcept>

#include <fmt/format.h>

namespace server {
namespace {

constexpr unsigned kMostGrey = 65535;

class PgmReader {
 public:
  PgmReader(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  GreyPicture read() {
    const std::string_view kind = word();
    if (kind != "P2" && kind != "P5") {
      fail("is no PGM picture: it begins with neither P2 nor P5.");
    }
    GreyPicture out;
    out.width = whole("width", kMostPixels);
    out.height = whole("height", kMostPixels);
    out.most = static_cast<unsigned>(whole("greatest value", kMostGrey));
    if (out.width == 0 || out.height == 0 || out.most == 0) {
      fail("has a width, a height or a greatest value of 0.");
    }
    if (out.width > kMostPixels / out.height) fail("has more than 64 million pixels.");
    const std::size_t pixels = out.width * out.height;
    const std::size_t least = kind == "P2" || out.most > 255 ? 2 * pixels : pixels;
    if (bytes_.size() - at_ < least) fail("ends too early.");
    if (kind == "P5") skip_separator(least);
    out.grey.resize(pixels);
    if (kind == "P2") {
      for (auto& grey : out.grey) grey = static_cast<std::uint16_t>(whole("value", out.most));
      if (!word().empty()) fail("holds more values than width times height.");
    } else {
      read_bytes(out);
    }
    return out;
  }

 private:
  [[noreturn]] void fail(const std::string& why) const {
    throw std::runtime_error(name_ + " " + why);
  }
  unsigned byte(std::size_t k) const { return static_cast<unsigned char>(bytes_[k]); }

  /// One white space lies before the `wanted` bytes, or CR LF if the bytes fit only so. White space
  /// may follow them.
  void skip_separator(std::size_t wanted) {
    const std::size_t left = bytes_.size() - at_;
    if (left <= wanted) fail("ends too early.");
    std::size_t separator = 1;
    if (left == wanted + 2 && bytes_.substr(at_).starts_with("\r\n")) separator = 2;
    const std::string_view rest = bytes_.substr(at_ + separator + wanted);
    if (rest.find_first_not_of(" \t\r\n") != std::string_view::npos) {
      fail(fmt::format("holds {} bytes more than its width and height say.", rest.size()));
    }
    at_ += separator;
  }

  void read_bytes(GreyPicture& out) {
    const bool wide = out.most > 255;
    for (auto& grey : out.grey) {
      unsigned value = byte(at_++);
      if (wide) value = 256 * value + byte(at_++);
      grey = static_cast<std::uint16_t>(std::min(value, out.most));
    }
  }

  /// The next word; a '#' begins a comment to the end of the line.
  std::string_view word() {
    while (at_ < bytes_.size() && (byte(at_) <= ' ' || byte(at_) == '#')) {
      if (byte(at_) == '#') at_ = std::min(bytes_.find('\n', at_), bytes_.size());
      if (at_ < bytes_.size()) ++at_;
    }
    const std::size_t begin = at_;
    while (at_ < bytes_.size() && byte(at_) > ' ') ++at_;
    return bytes_.substr(begin, at_ - begin);
  }
  std::size_t whole(const char* what, std::size_t most) {
    const std::string_view text = word();
    if (text.empty()) fail("ends too early.");
    std::size_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || value > most) {
      fail(fmt::format(
          "has \"{}\" as {}, not a whole number up to {}.", text.substr(0, 20), what, most));
    }
    return value;
  }

  std::string_view bytes_;
  const std::string& name_;
  std::size_t at_ = 0;
};

}  // namespace

GreyPicture read_pgm(std::string_view bytes, const std::string& name) {
  return PgmReader(bytes, name).read();
}

}  // namespace server
