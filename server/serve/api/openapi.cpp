// server/serve/api/openapi.cpp: what every operation may answer is written once and told of each.
#include "server/serve/api/openapi.hpp"

#include <nlohmann/json.hpp>

namespace server {
namespace {

using nlohmann::ordered_json;

void add_responses(ordered_json& operation, const ordered_json& statuses) {
  // Its own list of securities, empty: open to all.
  const bool open = operation.contains("security") && operation["security"].empty();
  ordered_json& responses = operation["responses"];
  for (const std::string status : statuses) {
    if ((status == "401" && open) || responses.contains(status)) continue;
    responses[status] = {{"$ref", "#/components/responses/" + status}};
  }
}

std::string whole_document() {
  ordered_json document = ordered_json::parse(embedded_openapi());
  const ordered_json any = document.at("x-any-operation");
  const ordered_json change = document.at("x-any-change");
  document.erase("x-any-operation");
  document.erase("x-any-change");
  for (auto& [path, methods] : document.at("paths").items()) {
    for (auto& [method, operation] : methods.items()) {
      add_responses(operation, any);
      if (method != "get") add_responses(operation, change);
    }
  }
  return document.dump();
}

}  // namespace

const std::string& openapi_document() {
  static const std::string document = whole_document();
  return document;
}

}  // namespace server
