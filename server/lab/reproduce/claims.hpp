// server/lab/reproduce/claims.hpp: what the sources say of their cases, held against the rows.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "server/experiment/figures.hpp"

namespace server::reproduce {

enum class Verdict : std::uint8_t {
  Reproduced,         // by a reading of Eq. 13-14 as printed
  OnlyWithExtension,  // by our continuous law or our side choice only
  NotReproduced,
};
std::string_view name(Verdict verdict);

struct Claim {
  std::string layout{};
  std::string text{};
  Verdict verdict = Verdict::NotReproduced;
  std::vector<std::string> held_by{};  // readings of the modified strip
};

/// The claims on those layouts of Nong 2008 that are among `rows`. A claim about the modified strip
/// is tried with each reading of it.
std::vector<Claim> judge_claims(std::span<const Row> rows);

}  // namespace server::reproduce
