// server/experiment/sweep/origin.hpp: machines.json, which says what part of an experiment a folder
// holds and on which machines it ran.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "server/experiment/pool.hpp"
#include "server/experiment/sweep/machine.hpp"

namespace server::sweep {

struct Origin {
  std::optional<experiment::Shard> shard{};  // nothing: the whole experiment
  std::vector<Machine> machines{};           // in order, each once
};

/// What `folder` says of itself; nothing if it says nothing. Throws std::runtime_error with a
/// sentence.
std::optional<Origin> read_origin(const std::filesystem::path& folder);
void write_origin(const Origin& origin, const std::filesystem::path& folder);

/// Adds the machines of `other`.
void add_machines(Origin& origin, const std::vector<Machine>& other);

/// Makes `folder` that of `shard`, or checks that it is, and notes this machine. Throws
/// std::runtime_error with a sentence if it is another shard's or the whole experiment's.
void claim_for_shard(const std::filesystem::path& folder, const experiment::Shard& shard);
/// Throws std::runtime_error with a sentence if `folder` is a shard's.
void check_is_whole(const std::filesystem::path& folder);

/// A sentence about runs from different processors or libraries; empty if all are alike.
std::string mixed_machines_text(const Origin& origin);

}  // namespace server::sweep
