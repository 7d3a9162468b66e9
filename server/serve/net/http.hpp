// server/serve/net/http.hpp: requests and responses as plain values; REST handlers know no socket.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "server/serve/net/visitor.hpp"

namespace server::net {

/// Bytes shared by all their recipients; never changed once built.
using Payload = std::shared_ptr<const std::string>;

struct Header {
  std::string name{};
  std::string value{};
};

/// One HTTP request, complete with its body. Valid until the handler returns; copy anything to
/// keep.
struct Request {
  std::string method{};                         // upper case, as sent
  std::string target{};                         // as sent, undecoded
  std::string path{};                           // percent-decoded once, without the query
  std::map<std::string, std::string> query{};   // decoded; the last value of a repeated name
  std::map<std::string, std::string> params{};  // matches of the router: "{id}" of the pattern
  std::vector<Header> headers{};                // in order of arrival
  std::string body{};
  std::string peer{};     // address of the client, even behind a trusted proxy
  bool loopback = false;  // the client is on this machine
  bool https = false;     // a trusted proxy encrypts for it
  Role role = Role::Nobody;
  std::string person{};  // the name that the person gave, cleaned; may be empty

  /// Value of the first header of that name (case does not matter); empty if there is none.
  std::string_view header(std::string_view name) const;
  /// Number of headers of that name.
  std::size_t count(std::string_view name) const;
  /// The elements of a comma list that may be split over several headers of that name, in order.
  std::vector<std::string_view> elements(std::string_view name) const;
  /// Value of the cookie `name`; empty if there is none.
  std::string_view cookie(std::string_view name) const;
  Visitor visitor() const { return {role, peer, person}; }
};

/// A body made while it is sent, so that its memory is one slice per client, however long the body
/// or slow the client. Io thread only.
class BodyStream {
 public:
  /// The next bytes; empty after the last ones; nothing if the rest cannot be made. The connection
  /// then breaks off, so that the client does not take a part for the whole.
  using Slice = std::optional<std::string>;

  virtual ~BodyStream() = default;
  /// Calls `give` once, now or later. Called for the next slice when the last one has been written.
  virtual void next(std::function<void(Slice)> give) = 0;
};

struct Response {
  int status = 200;
  std::string content_type{};
  std::vector<Header> headers{};
  Payload body{};
  std::shared_ptr<BodyStream> stream{};  // instead of `body`
};

/// Thrown by handlers: becomes a problem response with that status and what() as its detail.
class HttpError : public std::runtime_error {
 public:
  HttpError(int status, const std::string& detail) : std::runtime_error(detail), status_(status) {}
  int status() const { return status_; }

 private:
  int status_;
};

/// The standard phrase of a status, "Not Found"; "Unknown" for a code not in use here.
std::string_view reason_phrase(int status);

Response json_response(int status, std::string text);
Response text_response(int status, std::string content_type, std::string text);
/// RFC 9457: application/problem+json with type, title, status and detail.
Response problem(int status, std::string_view title, std::string_view detail);
/// A problem titled with the status' own phrase.
Response problem(int status, std::string_view detail);

/// Splits an origin-form target into path and query and percent-decodes both once.
/// @return the fault in words; nothing if the target is valid
std::optional<std::string> parse_target(std::string_view target, Request& request);

/// Decodes %XX once. @return nothing on a broken escape or an encoded NUL
std::optional<std::string> percent_decode(std::string_view text, bool plus_is_space);

bool equal_no_case(std::string_view a, std::string_view b);
/// True when `text` is well-formed UTF-8 (no overlong forms, no surrogates).
bool valid_utf8(std::string_view text);

/// How the client finds the end of a body.
enum class Framing : std::uint8_t { Length, Chunked, Close };

/// Status line and header block, ending in the empty line. Line breaks in a value become spaces, so
/// that no value can add a header.
std::string response_head(const Response& response,
                          std::size_t body_size,
                          bool keep_alive,
                          Framing framing = Framing::Length);

/// The refusal of a badly framed request body; nothing if the framing is valid. Two readers of the
/// same bytes, such as a proxy and this server, must agree on where the next request begins.
std::optional<Response> framing_problem(const Request& request, bool http_1_0);

/// Answers one request, at once or later. Io thread only. The first call sends, later ones do
/// nothing; a client that has gone is no error. If the last copy is destroyed unused, the client
/// gets 500.
class Responder {
 public:
  explicit Responder(std::function<void(Response)> send)
      : state_(std::make_shared<State>(std::move(send))) {}
  void operator()(Response response) const { state_->answer(std::move(response)); }

 private:
  class State {
   public:
    explicit State(std::function<void(Response)> send) : send_(std::move(send)) {}
    ~State();
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    void answer(Response response);

   private:
    std::function<void(Response)> send_;
  };
  std::shared_ptr<State> state_;
};

}  // namespace server::net
