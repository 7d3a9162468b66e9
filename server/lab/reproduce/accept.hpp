// server/lab/reproduce/accept.hpp: what the file asks for, held against the rows.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "server/experiment/figures.hpp"
#include "server/lab/reproduce/paper_file.hpp"

namespace server::reproduce {

/// One limit and whether it held.
struct Check {
  std::string layout{};
  std::string subject{};  // "modified", "modified < original", "modified, noise-free"
  std::string asked{};    // "path_mm at most 7651"
  std::string figure{};   // "6955.2"
  bool held = false;
};

/// Every `accept` and `accept_compare` over `paper`, every `accept_noise_free` over `noise_free`.
/// A row that is not there fails its checks.
std::vector<Check> evaluate(const PaperFile& file,
                            std::span<const Row> paper,
                            std::span<const Row> noise_free);

bool all_held(std::span<const Check> checks);

}  // namespace server::reproduce
