// server/serve/api/openapi.cpp: adds the answers common to all operations to each one, and the
// operations common to all sessions.
#include "server/serve/api/openapi.hpp"

#include <algorithm>
#include <cctype>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

namespace server {
namespace {

using nlohmann::ordered_json;

void add_responses(ordered_json& operation, const ordered_json& statuses) {
  // An empty list of securities of its own: open to all.
  const bool open = operation.contains("security") && operation["security"].empty();
  ordered_json& responses = operation["responses"];
  for (const std::string status : statuses) {
    if ((status == "401" && open) || responses.contains(status)) continue;
    responses[status] = {{"$ref", "#/components/responses/" + status}};
  }
}

/// Repeats the operations of `main` for a session by its id.
void add_sessions(ordered_json& paths) {
  const std::string of_main = "/api/v1/session";
  std::vector<std::pair<std::string, ordered_json>> copies;
  for (const auto& [path, methods] : paths.items()) {
    if (path == of_main || path.starts_with(of_main + "/")) {
      copies.emplace_back("/api/v1/sessions/{session}" + path.substr(of_main.size()), methods);
    }
  }
  for (auto& [path, methods] : copies) {
    for (auto& [method, operation] : methods.items()) {
      operation["operationId"] = operation["operationId"].get<std::string>() + "ById";
      ordered_json& of_session = paths[path][method];
      of_session = std::move(operation);
    }
    for (auto& [method, operation] : paths[path].items()) {
      ordered_json parameters = ordered_json::array();
      parameters.push_back({{"$ref", "#/components/parameters/session"}});
      for (const ordered_json& own : operation.value("parameters", ordered_json::array())) {
        parameters.push_back(own);
      }
      operation["parameters"] = std::move(parameters);
      operation["responses"]["404"] = {{"$ref", "#/components/responses/404"}};
    }
  }
}

std::string whole_document() {
  ordered_json document = ordered_json::parse(embedded_openapi());
  const ordered_json any = document.at("x-any-operation");
  const ordered_json change = document.at("x-any-change");
  document.erase("x-any-operation");
  document.erase("x-any-change");
  add_sessions(document.at("paths"));
  for (auto& [path, methods] : document.at("paths").items()) {
    for (auto& [method, operation] : methods.items()) {
      add_responses(operation, any);
      if (method != "get") add_responses(operation, change);
    }
  }
  return document.dump();
}

}  // namespace

void take_described_queries(net::Router& router) {
  const ordered_json document = ordered_json::parse(openapi_document());
  for (const auto& [path, methods] : document.at("paths").items()) {
    for (const auto& [method, operation] : methods.items()) {
      std::vector<std::string> names;
      for (const ordered_json& parameter : operation.value("parameters", ordered_json::array())) {
        if (parameter.value("in", "") == "query") names.push_back(parameter.at("name"));
      }
      std::string upper = method;
      std::ranges::transform(upper, upper.begin(), [](unsigned char c) { return std::toupper(c); });
      router.take_queries(upper, path, std::move(names));
    }
  }
}

const std::string& openapi_document() {
  static const std::string document = whole_document();
  return document;
}

}  // namespace server
