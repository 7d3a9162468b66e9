// server/serve/api/reply.hpp: JSON in, JSON out, and every failure as a problem document.
#pragma once

#include <exception>
#include <functional>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "server/serve/net/http.hpp"
#include "server/serve/net/router.hpp"

namespace server {

net::Response json_response(int status, const nlohmann::json& body);

/// The problem document for the exception now being handled: 400 for what is not JSON, 422 for a
/// document that does not say what it must, 404 or 409 for scenarios, 503 for the database.
net::Response problem_of_current_exception();

net::Response problem_of(const std::exception_ptr& failure);

/// The body as JSON; an empty one is an empty object. Throws on malformed JSON.
nlohmann::json body_json(const net::Request& request);

/// Runs `handler`, which answers through `respond` now or later, and turns what it throws into a
/// problem document.
net::Handler guarded(std::function<void(const net::Request&, const net::Responder&)> handler);

/// The number that `text` writes, of at most `digits`; nothing for any other text.
std::optional<std::uint64_t> whole_number(const std::string& text, std::size_t digits = 18);
/// `?limit=` within 1 to `max`; throws DocumentError.
std::size_t limit_of(const net::Request& request, std::size_t fallback, std::size_t max);
/// A whole number of the query, or `fallback`. Throws DocumentError.
std::uint64_t number_of(const net::Request& request,
                        const std::string& key,
                        std::uint64_t fallback);

}  // namespace server
