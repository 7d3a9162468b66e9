// server/serve/net/compression.hpp: what a client takes compressed, and the compression of answers
// made here. The page's files are compressed by its build.
#pragma once

#include <string>
#include <string_view>

#include "server/serve/net/http.hpp"

namespace server::net {

/// Whether Accept-Encoding lists `coding`, such as "gzip", with a weight other than zero.
bool accepts_coding(const Request& request, std::string_view coding);

std::string gzip(std::string_view text);

/// Compresses the body of a JSON answer, if the client takes gzip and it is worth it: below 1 kB it
/// saves no packet, above 64 kB it would keep the io thread, which carries Stop, for milliseconds.
void compress_json(const Request& request, Response& response);

}  // namespace server::net
