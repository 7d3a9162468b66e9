// server/lab/reproduce/study.hpp: all of `tautline reproduce` except its text: the runs and their
// results.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "server/lab/reproduce/accept.hpp"
#include "server/lab/reproduce/claims.hpp"
#include "server/lab/reproduce/differences.hpp"
#include "server/lab/reproduce/full_strip.hpp"

namespace server::reproduce {

struct StudyOptions {
  std::size_t seeds = 10;
  std::uint64_t first_seed = 1;
  bool full_simulator = true;
  unsigned threads = 0;  // 0: one per core
  experiment::NamedProgress progress{};
};

struct Study {
  std::size_t seeds = 0;
  std::uint64_t first_seed = 0;
  std::vector<Series> paper{};       // table A: every scenario with every reading
  std::vector<Series> noise_free{};  // one run each, where a limit of the file needs it
  std::vector<Series> full{};        // table B
  std::vector<Series> strip{};       // our full strip under the conditions of table A
  std::vector<Series> strip_full{};  // and of table B
  Depths least_depths{};
  std::vector<Check> checks{};
  std::vector<Claim> claims{};       // by table A
  std::vector<Claim> full_claims{};  // by table B
  std::vector<Difference> differences{};
};

/// The same file and seeds give the same study with any number of threads. Throws std::exception
/// with a sentence.
Study run_study(const StudyFile& file, const StudyOptions& options);

/// One series per scenario and controller, with `seeds` runs each from `first_seed` on.
std::vector<experiment::SeriesPlan> series_plans(
    const StudyFile& file,
    const Conditions& conditions,
    std::size_t seeds,
    std::uint64_t first_seed,
    std::span<const std::string_view> controllers = readings());

}  // namespace server::reproduce
