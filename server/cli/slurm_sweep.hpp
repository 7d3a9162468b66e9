// server/cli/slurm_sweep.hpp: `tautline sweep --slurm`: submits an experiment, or what is missing
// of it, and merges it in the end.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "server/experiment/sweep/sweep_plan.hpp"

namespace server {

struct SlurmSweep {
  std::filesystem::path folder{};          // of the results, seen by every node
  std::optional<std::size_t> tasks{};      // nothing: as before, or 16
  std::vector<std::string> options{};      // of sbatch
  std::vector<std::string> controllers{};  // options of `tautline sweep`
  std::chrono::milliseconds pause{2000};   // before the second try of a command; then doubled
};

/// If all runs are in the folder, merges them, writes the report and returns the status of
/// write_and_print(). Else submits the tasks that miss runs and are not in the queue, and returns
/// kIncomplete. Throws std::runtime_error with a sentence, also if Slurm refuses four times.
int sweep_on_slurm(const sweep::Plan& plan, const SlurmSweep& request);

}  // namespace server
