// server/serve/api/reply.hpp: reads and writes JSON; every failure becomes a problem document.
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

/// The problem document for the exception being handled: 400 for a body that is not JSON, 422 for
/// an invalid document, 404 or 409 for scenarios, 503 for the database.
net::Response problem_of_current_exception();

net::Response problem_of(const std::exception_ptr& failure);

/// Throws the 403 that names the role, if the request's is lower than `needed`.
void require(const net::Request& request, net::Role needed);

/// The body as JSON; an empty body gives an empty object. Throws on malformed JSON.
nlohmann::json body_json(const net::Request& request);

/// Wraps `handler`, which answers through the responder now or later. Turns its exceptions into
/// problem documents.
net::Handler guarded(std::function<void(const net::Request&, const net::Responder&)> handler);

/// The whole number in `text`, of at most `digits` digits; nothing for any other text.
std::optional<std::uint64_t> whole_number(const std::string& text, std::size_t digits = 18);
/// `?limit=` within 1 to `max`; throws DocumentError.
std::size_t limit_of(const net::Request& request, std::size_t fallback, std::size_t max);
/// A whole number from the query, or `fallback`. Throws DocumentError.
std::uint64_t number_of(const net::Request& request,
                        const std::string& key,
                        std::uint64_t fallback);

}  // namespace server
