// server/experiment/sweep/slurm_script.hpp: an experiment as one array of Slurm: the script, the
// list of tasks, and the answer of squeue.
#pragma once

#include <cstddef>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace server::sweep {

struct SlurmArray {
  std::filesystem::path program{};         // absolute, on every node
  std::filesystem::path folder{};          // absolute, seen by every node
  std::size_t tasks = 1;                   // of the whole experiment
  std::vector<std::string> options{};      // of sbatch, one a line
  std::vector<std::string> controllers{};  // options of `tautline sweep`
};

/// The name of the job: the same for the same folder, and another for another. `experiment` is the
/// document's name.
std::string job_name(const std::string& experiment, const std::filesystem::path& folder);

/// The batch script of every task.
std::string script_of(const SlurmArray& array, const std::string& experiment);

/// In quotes for a shell.
std::string quoted(const std::string& text);

/// "0-2,5": the numbers in order, each once, as sbatch --array takes them.
std::string array_text(const std::set<std::size_t>& tasks);

/// The tasks in the answer of squeue --array --format=%K. Throws std::runtime_error with the line
/// that is no number.
std::set<std::size_t> tasks_in_queue(const std::string& answer);

}  // namespace server::sweep
