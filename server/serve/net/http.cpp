// server/serve/net/http.cpp: plain HTTP values: decodes targets, builds problems and heads.
#include "server/serve/net/http.hpp"

#include <algorithm>
#include <array>
#include <ctime>
#include <tuple>

#include <nlohmann/json.hpp>

namespace server::net {
namespace {

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  const char l = lower(c);
  return l >= 'a' && l <= 'f' ? l - 'a' + 10 : -1;
}

// The text before and after the first mark; without a mark, the whole text and an empty one.
std::pair<std::string_view, std::string_view> cut_at(std::string_view text, char mark) {
  const std::size_t end = std::min(text.find(mark), text.size());
  return {text.substr(0, end), text.substr(std::min(end + 1, text.size()))};
}

void append_header(std::string& head, std::string_view name, std::string_view value) {
  head.append(name).append(": ");
  for (const char c : value) head.push_back(c == '\r' || c == '\n' || c == '\0' ? ' ' : c);
  head.append("\r\n");
}

std::string http_date() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  std::array<char, 40> text{};
  const std::size_t size =
      std::strftime(text.data(), text.size(), "%a, %d %b %Y %H:%M:%S GMT", &utc);
  return {text.data(), size};
}

}  // namespace

bool equal_no_case(std::string_view a, std::string_view b) {
  return std::equal(
      a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) { return lower(x) == lower(y); });
}

bool valid_utf8(std::string_view text) {
  try {  // the JSON writer checks it
    static_cast<void>(nlohmann::json(text).dump());
    return true;
  } catch (const nlohmann::json::type_error&) {
    return false;
  }
}

std::string_view Request::header(std::string_view name) const {
  for (const Header& h : headers) {
    if (equal_no_case(h.name, name)) return h.value;
  }
  return {};
}

std::size_t Request::count(std::string_view name) const {
  return static_cast<std::size_t>(std::ranges::count_if(
      headers, [&](const Header& header) { return equal_no_case(header.name, name); }));
}

std::vector<std::string_view> Request::elements(std::string_view name) const {
  constexpr std::string_view kBlank = " \t";
  std::vector<std::string_view> out;
  for (const Header& header : headers) {
    if (!equal_no_case(header.name, name)) continue;
    std::string_view rest = header.value;
    for (bool more = true; more;) {
      const std::size_t comma = rest.find(',');
      std::string_view element = rest.substr(0, comma);
      element.remove_prefix(std::min(element.find_first_not_of(kBlank), element.size()));
      element = element.substr(0, element.find_last_not_of(kBlank) + 1);
      out.push_back(element);
      more = comma != std::string_view::npos;
      if (more) rest.remove_prefix(comma + 1);
    }
  }
  return out;
}

std::string_view Request::cookie(std::string_view name) const {
  std::string_view rest = header("Cookie");
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(';'), rest.size());
    std::string_view pair = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    while (!pair.empty() && pair.front() == ' ') pair.remove_prefix(1);
    const std::size_t equals = pair.find('=');
    if (equals != std::string_view::npos && pair.substr(0, equals) == name) {
      return pair.substr(equals + 1);
    }
  }
  return {};
}

std::string_view reason_phrase(int status) {
  static constexpr std::array<std::pair<int, std::string_view>, 22> kPhrases{
      {{200, "OK"},
       {201, "Created"},
       {202, "Accepted"},
       {204, "No Content"},
       {304, "Not Modified"},
       {400, "Bad Request"},
       {401, "Unauthorized"},
       {403, "Forbidden"},
       {404, "Not Found"},
       {405, "Method Not Allowed"},
       {408, "Request Timeout"},
       {409, "Conflict"},
       {413, "Content Too Large"},
       {415, "Unsupported Media Type"},
       {421, "Misdirected Request"},
       {422, "Unprocessable Content"},
       {426, "Upgrade Required"},
       {429, "Too Many Requests"},
       {431, "Request Header Fields Too Large"},
       {500, "Internal Server Error"},
       {501, "Not Implemented"},
       {503, "Service Unavailable"}}};
  const auto* const found = std::find_if(
      kPhrases.begin(), kPhrases.end(), [&](const auto& entry) { return entry.first == status; });
  return found == kPhrases.end() ? "Unknown" : found->second;
}

Response text_response(int status, std::string content_type, std::string text) {
  Response response;
  response.status = status;
  response.content_type = std::move(content_type);
  response.body = std::make_shared<const std::string>(std::move(text));
  return response;
}

Response json_response(int status, std::string text) {
  return text_response(status, "application/json", std::move(text));
}

Response problem(int status, std::string_view title, std::string_view detail) {
  const nlohmann::ordered_json body = {
      {"type", "about:blank"}, {"title", title}, {"status", status}, {"detail", detail}};
  // A sentence may quote the client's text, which may be broken UTF-8: replace, never throw.
  return text_response(status,
                       "application/problem+json",
                       body.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

Response problem(int status, std::string_view detail) {
  return problem(status, reason_phrase(status), detail);
}

std::optional<std::string> percent_decode(std::string_view text, bool plus_is_space) {
  std::string out;
  out.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    char c = text[i];
    if (c == '+' && plus_is_space) c = ' ';
    if (c == '%') {
      if (i + 2 >= text.size()) return std::nullopt;
      const int high = hex_digit(text[i + 1]);
      const int low = hex_digit(text[i + 2]);
      if (high < 0 || low < 0) return std::nullopt;
      c = static_cast<char>(high * 16 + low);
      i += 2;
    }
    if (c == '\0') return std::nullopt;
    out.push_back(c);
  }
  return out;
}

std::optional<std::string> parse_target(std::string_view target, Request& request) {
  request.target = target;
  if (target.empty() || target.front() != '/') {
    return "the request target must be a path that starts with '/'";
  }
  auto [encoded, rest] = cut_at(cut_at(target, '#').first, '?');
  const std::optional<std::string> path = percent_decode(encoded, false);
  if (!path) return "the path has a broken percent escape or an encoded NUL";
  if (!valid_utf8(*path)) return "the path is not valid UTF-8";
  request.path = *path;

  while (!rest.empty()) {
    std::string_view pair;
    std::tie(pair, rest) = cut_at(rest, '&');
    if (pair.empty()) continue;
    const auto [encoded_name, encoded_value] = cut_at(pair, '=');
    const auto name = percent_decode(encoded_name, true);
    const auto value = percent_decode(encoded_value, true);
    if (!name || !value || !valid_utf8(*name) || !valid_utf8(*value)) {
      return "the query has a broken percent escape, an encoded NUL or invalid UTF-8";
    }
    request.query[*name] = *value;
  }
  return std::nullopt;
}

std::string response_head(const Response& response,
                          std::size_t body_size,
                          bool keep_alive,
                          Framing framing) {
  std::string head = "HTTP/1.1 " + std::to_string(response.status) + ' ';
  head.append(reason_phrase(response.status)).append("\r\n");
  append_header(head, "Date", http_date());
  if (!response.content_type.empty()) append_header(head, "Content-Type", response.content_type);
  // 204 and 304 have no body and must not announce one.
  const bool has_body = response.status != 204 && response.status != 304;
  if (has_body && framing == Framing::Chunked) append_header(head, "Transfer-Encoding", "chunked");
  if (has_body && framing == Framing::Length) {
    append_header(head, "Content-Length", std::to_string(body_size));
  }
  if (std::ranges::none_of(response.headers, [](const Header& header) {
        return equal_no_case(header.name, "Cache-Control");
      })) {
    append_header(head, "Cache-Control", "no-store");
  }
  append_header(head, "X-Content-Type-Options", "nosniff");
  append_header(head, "Referrer-Policy", "no-referrer");
  // The policy binds documents. A script or a style has that of its page; data loads nothing.
  const std::string_view type = response.content_type;
  const bool page = type.starts_with("text/html");
  if (!type.starts_with("text/javascript") && !type.starts_with("text/css")) {
    append_header(head,
                  "Content-Security-Policy",
                  page ? "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' "
                         "data: blob:; font-src 'self'; connect-src 'self'; worker-src 'self'; "
                         "manifest-src 'self'; object-src 'none'; base-uri 'none'; form-action "
                         "'none'; frame-ancestors 'none'"
                       : "default-src 'none'; frame-ancestors 'none'");
  }
  for (const Header& h : response.headers) append_header(head, h.name, h.value);
  append_header(head, "Connection", keep_alive ? "keep-alive" : "close");
  head.append("\r\n");
  return head;
}

std::optional<Response> framing_problem(const Request& request, bool http_1_0) {
  for (const char* name :
       {"Host", "Origin", "Content-Length", "Transfer-Encoding", "Content-Type", "Authorization"}) {
    if (request.count(name) > 1) {
      return problem(400, "the request has more than one " + std::string(name) + " line");
    }
  }
  const std::string_view coding = request.header("Transfer-Encoding");
  const std::string_view length = request.header("Content-Length");
  if (std::any_of(length.begin(), length.end(), [](char c) { return c < '0' || c > '9'; })) {
    return problem(400, "the Content-Length is not a whole number");
  }
  if (request.count("Transfer-Encoding") == 0) return std::nullopt;
  if (!length.empty()) {
    return problem(400, "a request has either Content-Length or Transfer-Encoding, not both");
  }
  if (http_1_0) return problem(400, "HTTP/1.0 knows no Transfer-Encoding");
  if (!equal_no_case(coding, "chunked")) {
    return problem(501, "the only transfer coding understood here is chunked");
  }
  return std::nullopt;
}

Responder::State::~State() {
  if (!send_) return;
  try {
    answer(problem(500, "the request was accepted but nothing answered it"));
  } catch (...) {  // NOLINT(bugprone-empty-catch): a destructor cannot report it
    send_ = nullptr;
  }
}

void Responder::State::answer(Response response) {
  if (!send_) return;
  // Move it out first: sending may run a further request, which must find this one answered.
  const std::function<void(Response)> send = std::exchange(send_, nullptr);
  send(std::move(response));
}

}  // namespace server::net
