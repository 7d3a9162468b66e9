// server/experiment/sweep/origin.cpp: reads, checks and writes machines.json.
#include "server/experiment/sweep/origin.hpp"

#include <algorithm>
#include <set>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "server/run/text_file.hpp"

namespace server::sweep {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* kFile = "machines.json";

std::string shard_text(const experiment::Shard& shard) {
  return fmt::format("{}/{}", shard.index, shard.count);
}

/// "'a' and 'b'"; empty if there is but one.
std::string different(const std::vector<Machine>& machines, std::string Machine::*part) {
  std::set<std::string> names;
  for (const Machine& machine : machines) names.insert("'" + machine.*part + "'");
  return names.size() < 2 ? std::string() : fmt::format("{}", fmt::join(names, " and "));
}

}  // namespace

std::optional<Origin> read_origin(const fs::path& folder) {
  const fs::path file = folder / kFile;
  if (!fs::exists(file)) return std::nullopt;
  try {
    const json text = json::parse(read_text(file));
    Origin origin;
    if (text.contains("shard")) {
      origin.shard = experiment::shard_from_text(text["shard"].get<std::string>());
    }
    for (const json& machine : text.at("machines")) {
      origin.machines.push_back({machine.at("processor").get<std::string>(),
                                 machine.at("mathematics").get<std::string>()});
    }
    return origin;
  } catch (const std::exception&) {
    throw std::runtime_error(file.string() + ": is damaged; remove it if you trust the runs");
  }
}

void write_origin(const Origin& origin, const fs::path& folder) {
  json text = {{"machines", json::array()}};
  if (origin.shard) text["shard"] = shard_text(*origin.shard);
  for (const Machine& machine : origin.machines) {
    text["machines"].push_back(
        {{"processor", machine.processor}, {"mathematics", machine.mathematics}});
  }
  replace_text(folder / kFile, text.dump(1) + "\n");
}

void add_machines(Origin& origin, const std::vector<Machine>& other) {
  std::set<Machine> all(origin.machines.begin(), origin.machines.end());
  all.insert(other.begin(), other.end());
  origin.machines.assign(all.begin(), all.end());
}

void claim_for_shard(const fs::path& folder, const experiment::Shard& shard) {
  std::optional<Origin> origin = read_origin(folder);
  if (!origin) {
    if (fs::exists(folder / "runs.jsonl")) {
      throw std::runtime_error(folder.string() +
                               ": holds a whole experiment and not a shard. Choose another folder "
                               "with --out.");
    }
    origin = Origin{.shard = shard};
  }
  const std::string theirs = origin->shard ? "shard " + shard_text(*origin->shard) : "the whole";
  if (!origin->shard || shard_text(*origin->shard) != shard_text(shard)) {
    throw std::runtime_error(fmt::format(
        "{}: holds {} of an experiment and not shard {}. Choose another folder with --out.",
        folder.string(),
        theirs,
        shard_text(shard)));
  }
  make_folder(folder);
  add_machines(*origin, {this_machine()});
  write_origin(*origin, folder);
}

void check_is_whole(const fs::path& folder) {
  const std::optional<Origin> origin = read_origin(folder);
  if (!origin || !origin->shard) return;
  throw std::runtime_error(
      fmt::format("{}: holds shard {} of an experiment. Give --shard {}, or choose another folder.",
                  folder.string(),
                  shard_text(*origin->shard),
                  shard_text(*origin->shard)));
}

std::string mixed_machines_text(const Origin& origin) {
  std::string text;
  const auto tell = [&](const std::string& what, const std::string& names) {
    if (!names.empty()) text += fmt::format("The runs come from different {}: {}. ", what, names);
  };
  tell("processors", different(origin.machines, &Machine::processor));
  tell("mathematical libraries", different(origin.machines, &Machine::mathematics));
  if (!text.empty())
    text += "A run made again elsewhere may differ in its last digits, and then in its end.";
  return text;
}

}  // namespace server::sweep
