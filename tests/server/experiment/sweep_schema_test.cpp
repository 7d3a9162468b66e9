// tests/server/experiment/sweep_schema_test.cpp: the published JSON Schema of an experiment accepts
// and refuses what the reader does.
#include <algorithm>
#include <regex>
#include <stdexcept>
#include <string>

#include "tests/folders.hpp"
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "server/experiment/sweep/sweep_document.hpp"
#include "server/run/text_file.hpp"

namespace server::sweep {
namespace {

using nlohmann::json;

bool has_type(const json& value, const std::string& type) {
  if (type == "object") return value.is_object();
  if (type == "array") return value.is_array();
  if (type == "string") return value.is_string();
  if (type == "number") return value.is_number();
  if (type == "boolean") return value.is_boolean();
  if (type == "integer") return value.is_number_integer();
  throw std::invalid_argument("the schema has the type " + type);
}

bool accepts(const json& schema, const json& value);

bool accepts_members(const json& schema, const json& value) {
  for (const json& key : schema.value("required", json::array())) {
    if (!value.contains(key.get<std::string>())) return false;
  }
  const json properties = schema.value("properties", json::object());
  const json others = schema.value("additionalProperties", json(true));
  for (const auto& [key, member] : value.items()) {
    const auto known = properties.find(key);
    const json& rule = known != properties.end() ? *known : others;
    if (rule.is_boolean() ? !rule.get<bool>() : !accepts(rule, member)) return false;
  }
  return true;
}

/// True if `count` lies within the two bounds, where the schema has them.
bool within(const json& schema, const char* least, const char* most, double count) {
  return (!schema.contains(least) || count >= schema[least].get<double>()) &&
         (!schema.contains(most) || count <= schema[most].get<double>());
}

/// The keywords that docs/experiments/schema.json uses, by JSON Schema 2020-12.
bool accepts(const json& schema, const json& value) {
  if (schema.contains("type") && !has_type(value, schema["type"].get<std::string>())) return false;
  if (schema.contains("enum") && std::ranges::count(schema["enum"], value) == 0) return false;
  const auto fits = [&](const json& each) { return accepts(each, value); };
  if (schema.contains("anyOf") && std::ranges::none_of(schema["anyOf"], fits)) return false;
  if (schema.contains("not") && fits(schema["not"])) return false;
  const auto size = static_cast<double>(value.size());
  if (value.is_object()) {
    return within(schema, "minProperties", "maxProperties", size) && accepts_members(schema, value);
  }
  if (value.is_array()) {
    const json items = schema.value("items", json::object());
    return within(schema, "minItems", "maxItems", size) &&
           std::ranges::all_of(value, [&](const json& each) { return accepts(items, each); });
  }
  if (value.is_string()) {
    const auto text = value.get<std::string>();
    return within(schema, "minLength", "maxLength", static_cast<double>(text.size())) &&
           (!schema.contains("pattern") ||
            std::regex_search(text, std::regex(schema["pattern"].get<std::string>())));
  }
  if (!value.is_number()) return true;
  const auto number = value.get<double>();
  return within(schema, "minimum", "maximum", number) &&
         (!schema.contains("exclusiveMinimum") ||
          number > schema["exclusiveMinimum"].get<double>());
}

json file(const char* name) {
  return json::parse(read_text(tests::folder() / "../docs/experiments" / name));
}

bool reader_accepts(const json& document) {
  try {
    document_from_json(document, ScenarioLibrary("", ""));
    return true;
  } catch (const DocumentError&) {
    return false;
  }
}

/// The least document, with `patch` in place of its fields; null removes a field.
json patched(const char* patch) {
  json document = json::parse(
      R"({"name": "small", "scenarios": ["case1"], "controllers": ["modified", "vff"]})");
  document.merge_patch(json::parse(patch));
  return document;
}

constexpr const char* kGood[] = {
    R"({})",
    R"({"scenarios": ["case1", {"random_layouts": {"count": 2, "seed": 7, "obstacles": 4}}]})",
    R"({"scenarios": [{"name": "mine", "goal": {"x": 1, "y": 0}}]})",
    R"({"controllers": [{"name": "vff", "label": "mine", "parameters": {"v_max": 0.2}}, "strip"]})",
    R"({"scenarios": ["case1", {"random_layouts": {"count": 2, "density": 0.2, "gap": 0.8}}],
        "controllers": ["modified", {"name": "vff", "repeats": 3, "scenarios": ["case1"]}]})",
    R"({"sweep": {"grid": {"k_r": [0.4, 0.6], "v_max": [0.1]}}})",
    R"({"sweep": {"list": [{"k_r": 0.4}, {"k_r": 0.6}]}})",
    R"({"sweep": {"random": {"count": 3, "seed": 2, "parameters": {"k_r": [0.3, 0.9]}}}})",
    R"({"sweep": {"latin_hypercube": {"count": 3, "parameters": {"v_max": [0.1, 0.3]}}}})",
    R"({"repeats": 10000, "seed": 0, "physics": "bullet", "filter": "lulu", "time_limit": 0.1})",
    R"({"noise": {"laser": 0.01, "odometry_scale": 0.02, "odometry_noise": 0, "odometry_slip": 0.1,
                  "yaw_slip": 0}})",
    R"({"limits": {"max_v": 0.2, "max_omega": 1, "max_acceleration": 1, "ramps": true,
                   "max_angular_acceleration": 2, "delay_ticks": 2}, "time_factor": 0.5})",
    R"({"scenarios": [{"random_layouts": {"count": 1, "robot": "jackal"}}]})",
    R"({"comparisons": {"baseline": "vff", "others": ["modified"]}})",
};

constexpr const char* kBad[] = {
    R"({"name": null})",
    R"({"name": "My Study"})",
    R"({"colour": "red"})",
    R"({"scenarios": []})",
    R"({"scenarios": "case1"})",
    R"({"scenarios": [7]})",
    R"({"scenarios": [{"name": "mine"}]})",
    R"({"scenarios": [{"random_layouts": {}}]})",
    R"({"scenarios": [{"random_layouts": {"count": 0}}]})",
    R"({"scenarios": [{"random_layouts": {"count": 2, "obstacles": 13}}]})",
    R"({"scenarios": [{"random_layouts": {"count": 2, "obstacles": 3, "density": 0.1}}]})",
    R"({"controllers": [{"name": "vff", "repeats": 0}]})",
    R"({"controllers": [{"name": "vff", "scenarios": []}]})",
    R"({"scenarios": [{"random_layouts": {"count": 2, "k_r": -1}}]})",
    R"({"scenarios": [{"random_layouts": {"count": 2, "crowd": 1}}]})",
    R"({"controllers": []})",
    R"({"controllers": [{"label": "x"}]})",
    R"({"controllers": [{"name": "vff", "label": "a|b"}]})",
    R"({"controllers": [{"name": "vff", "label": ""}]})",
    R"({"controllers": [{"name": "vff", "gain": 1}]})",
    R"({"controllers": [{"name": "vff", "parameters": {"k_r": "big"}}]})",
    R"({"sweep": {}})",
    R"({"sweep": {"zigzag": {}}})",
    R"({"sweep": {"grid": {"k_r": [0.4]}, "list": [{"k_r": 0.4}]}})",
    R"({"sweep": {"grid": {}}})",
    R"({"sweep": {"grid": {"k_r": []}}})",
    R"({"sweep": {"list": []}})",
    R"({"sweep": {"random": {"parameters": {"k_r": [0.3, 0.9]}}}})",
    R"({"sweep": {"random": {"count": 0, "parameters": {"k_r": [0.3, 0.9]}}}})",
    R"({"sweep": {"latin_hypercube": {"count": 2, "parameters": {"k_r": [0.3]}}}})",
    R"({"repeats": 0})",
    R"({"repeats": 10001})",
    R"({"repeats": 2.5})",
    R"({"seed": -1})",
    R"({"seed": 1000000000001})",
    R"({"physics": "newton"})",
    R"({"filter": "sieve"})",
    R"({"time_limit": 0})",
    R"({"time_factor": 0})",
    R"({"noise": {"laser": 2}})",
    R"({"noise": {"sonar": 0.1}})",
    R"({"limits": {"max_v": 0}})",
    R"({"limits": {"delay_ticks": 1.5}})",
    R"({"scenarios": [{"random_layouts": {"count": 1, "robot": ""}}]})",
    R"({"scenarios": [{"barn": {}}]})",
    R"({"scenarios": [{"barn": {"worlds": "a.json", "count": 0}}]})",
    R"({"comparisons": {}})",
    R"({"comparisons": {"baseline": "vff", "others": []}})",
    R"({"comparisons": {"baseline": "vff", "test": "t"}})",
};

TEST(SweepSchema, AcceptsTheExamplesAsTheReaderDoes) {
  for (const char* const name : {"canonical.json", "thesis.json"}) {
    EXPECT_TRUE(accepts(file("schema.json"), file(name))) << name;
    EXPECT_TRUE(reader_accepts(file(name))) << name;
  }
}

TEST(SweepSchema, AcceptsWhatTheReaderAccepts) {
  const json schema = file("schema.json");
  for (const char* const patch : kGood) {
    EXPECT_TRUE(reader_accepts(patched(patch))) << patch;
    EXPECT_TRUE(accepts(schema, patched(patch))) << patch;
  }
}

TEST(SweepSchema, RefusesWhatTheReaderRefuses) {
  const json schema = file("schema.json");
  for (const char* const patch : kBad) {
    EXPECT_FALSE(reader_accepts(patched(patch))) << patch;
    EXPECT_FALSE(accepts(schema, patched(patch))) << patch;
  }
}

}  // namespace
}  // namespace server::sweep
