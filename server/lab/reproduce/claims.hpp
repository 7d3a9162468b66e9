// server/lab/reproduce/claims.hpp: tests the sources' claims about their cases against the rows.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "server/experiment/series.hpp"

namespace server::reproduce {

using experiment::Series;

enum class Verdict : std::uint8_t {
  Reproduced,         // by a reading of Eq. 13-14 as printed
  OnlyWithExtension,  // by our continuous law or our side choice only
  NotReproduced,
};
std::string_view name(Verdict verdict);

struct Claim {
  std::string scenario{};
  std::string text{};
  Verdict verdict = Verdict::NotReproduced;
  std::vector<std::string> held_by{};  // readings of the modified strip
};

/// The claims of Nong 2008 about the scenarios in `rows`. A claim about the modified strip is
/// tested with each reading of it.
std::vector<Claim> judge_claims(std::span<const Series> rows);

}  // namespace server::reproduce
