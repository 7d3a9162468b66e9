// server/serve/api/reply.cpp: reads and writes JSON.
#include "server/serve/api/reply.hpp"

#include <new>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "db/sqlite.hpp"
#include "server/run/json_limits.hpp"
#include "server/run/json_reader.hpp"
#include "server/run/paths.hpp"
#include "server/run/scenario_library.hpp"

namespace server {
namespace {

net::Response problem_of_library(const LibraryError& e) {
  switch (e.kind()) {
    case LibraryError::Kind::NotFound:
      return net::problem(404, "Not found", e.what());
    case LibraryError::Kind::Builtin:
      return net::problem(409, "Built in", e.what());
    case LibraryError::Kind::BadName:
      return net::problem(422, "Bad name", e.what());
    case LibraryError::Kind::NoRoom:
      return net::problem(503, e.what());
    case LibraryError::Kind::Unreadable:
      break;
  }
  return net::problem(422, "Scenario not usable", e.what());
}

}  // namespace

net::Response json_response(int status, const nlohmann::json& body) {
  return net::json_response(status, dump_json(body));
}

net::Response problem_of_current_exception() {
  try {
    throw;
  } catch (const JsonError& e) {
    return net::problem(400, "Not JSON", e.what());
  } catch (const DocumentError& e) {
    return net::problem(422, "Document not usable", e.what());
  } catch (const LibraryError& e) {
    return problem_of_library(e);
  } catch (const db::StoreError& e) {
    return net::problem(503, "The record is not available", without_folders(e.what()));
  } catch (const std::bad_alloc&) {
    return net::problem(
        503, "Out of memory", "The server has not enough memory for this. Ask for less.");
  } catch (const net::HttpError& e) {
    return net::problem(e.status(), e.what());
  } catch (const std::invalid_argument& e) {  // an invalid world
    return net::problem(422, "Scenario not usable", without_folders(e.what()));
  } catch (const std::exception& e) {
    return net::problem(500, "Internal error", without_folders(e.what()));
  }
}

net::Response problem_of(const std::exception_ptr& failure) {
  try {
    std::rethrow_exception(failure);
  } catch (...) {
    return problem_of_current_exception();
  }
}

void require(const net::Request& request, net::Role needed) {
  if (request.role < needed) throw net::HttpError(403, net::role_refusal(request.role, needed));
}

nlohmann::json body_json(const net::Request& request) {
  if (request.body.empty()) throw JsonError("the body is empty: send a JSON object");
  return parse_json(request.body);
}

net::Handler guarded(std::function<void(const net::Request&, const net::Responder&)> handler) {
  return
      [handler = std::move(handler)](const net::Request& request, const net::Responder& respond) {
        try {
          handler(request, respond);
        } catch (...) {
          respond(problem_of_current_exception());
        }
      };
}

std::optional<std::uint64_t> whole_number(const std::string& text, std::size_t digits) {
  const bool good = !text.empty() && text.size() <= digits &&
                    text.find_first_not_of("0123456789") == std::string::npos;
  if (!good) return std::nullopt;
  return std::stoull(text);
}

std::uint64_t number_of(const net::Request& request,
                        const std::string& key,
                        std::uint64_t fallback) {
  const auto it = request.query.find(key);
  if (it == request.query.end()) return fallback;
  const auto number = whole_number(it->second);
  if (!number) {
    throw DocumentError("?" + key, fmt::format("'{}' is not a whole number", it->second));
  }
  return *number;
}

std::size_t limit_of(const net::Request& request, std::size_t fallback, std::size_t max) {
  const std::uint64_t limit = number_of(request, "limit", fallback);
  if (limit < 1 || limit > max) {
    throw DocumentError("?limit", fmt::format("is {}, must lie in 1 to {}", limit, max));
  }
  return limit;
}

}  // namespace server
