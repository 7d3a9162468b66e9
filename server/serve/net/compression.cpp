// server/serve/net/compression.cpp: gzip, RFC 1952, around Beast's raw deflate.
#include "server/serve/net/compression.hpp"

#include <cstdint>
#include <memory>
#include <utility>

#include <boost/beast/zlib/deflate_stream.hpp>
#include <boost/crc.hpp>

namespace server::net {
namespace {

constexpr std::size_t kLeast = 1024;
constexpr std::size_t kMost = 64 << 10;

void append_u32(std::string& out, std::uint32_t value) {
  for (int shift = 0; shift < 32; shift += 8) out.push_back(static_cast<char>(value >> shift));
}

}  // namespace

bool accepts_coding(const Request& request, std::string_view coding) {
  for (const std::string_view element : request.elements("Accept-Encoding")) {
    const std::size_t end = element.find_first_of("; ");
    if (!equal_no_case(element.substr(0, end), coding)) continue;
    const std::size_t weight = element.find("q=");
    return weight == std::string_view::npos ||
           element.substr(weight + 2).find_first_of("123456789") != std::string_view::npos;
  }
  return false;
}

std::string gzip(std::string_view text) {
  namespace zlib = boost::beast::zlib;
  std::string out("\x1f\x8b\x08\0\0\0\0\0\0\xff", 10);  // deflate, no name, time and system
  const std::size_t head = out.size();
  zlib::deflate_stream deflate;
  out.resize(head + deflate.upper_bound(text.size()) + 16);
  zlib::z_params z{};
  z.next_in = text.data();
  z.avail_in = text.size();
  z.next_out = out.data() + head;
  z.avail_out = out.size() - head;
  boost::system::error_code ended;
  deflate.write(z, zlib::Flush::finish, ended);
  out.resize(head + z.total_out);
  boost::crc_32_type crc;
  crc.process_bytes(text.data(), text.size());
  append_u32(out, crc.checksum());
  append_u32(out, static_cast<std::uint32_t>(text.size()));
  return out;
}

void compress_json(const Request& request, Response& response) {
  if (!response.body || response.body->size() < kLeast || response.body->size() > kMost) return;
  if (response.content_type != "application/json") return;
  response.headers.push_back({"Vary", "Accept-Encoding"});
  if (!accepts_coding(request, "gzip")) return;
  response.headers.push_back({"Content-Encoding", "gzip"});
  response.body = std::make_shared<const std::string>(gzip(*response.body));
}

}  // namespace server::net
