// server/experiment/sweep/slurm_script.cpp: texts for Slurm and from it.
#include "server/experiment/sweep/slurm_script.hpp"

#include <charconv>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>

#include "server/experiment/sweep/sweep_plan.hpp"

namespace server::sweep {
namespace {

/// After the lines for sbatch and the variables out, tautline, tasks and controllers.
constexpr const char* kTask = R"(
task=$SLURM_ARRAY_TASK_ID
kept=$out/shards/$task
work=$(mktemp -d "${TMPDIR:-/tmp}/tautline_XXXXXX") || exit 1
trap 'rm -rf -- "$work"' EXIT

# Copies the finished runs to the shared folder. A reader finds the old file or the new one.
save() {
  local file
  mkdir -p -- "$kept" || return 1
  for file in machines.json runs.jsonl; do
    [[ -e $work/shard/$file ]] || continue
    cp -- "$work/shard/$file" "$kept/.$file.$SLURM_JOB_ID" || return 1
    mv -- "$kept/.$file.$SLURM_JOB_ID" "$kept/$file" || return 1
  done
}

# Go on from the runs of an earlier try.
mkdir -- "$work/shard" || exit 1
for file in machines.json runs.jsonl; do
  if [[ -e $kept/$file ]]; then cp -- "$kept/$file" "$work/shard/" || exit 1; fi
done

"$tautline" sweep "$out/document.json" --shard "$task/$tasks" --out "$work/shard" \
  --workers "${SLURM_CPUS_PER_TASK:-1}" "${controllers[@]}" &
runs=$!
# USR1 comes before the time limit, TERM from scancel: end after the runs under way.
trap 'kill -USR1 "$runs" 2>/dev/null' USR1 TERM
wait "$runs"
status=$?
while kill -0 "$runs" 2>/dev/null; do  # a signal had ended the wait
  wait "$runs"
  status=$?
done
save || { echo "The runs could not be copied to $kept."; exit 1; }
exit "$status"
)";

}  // namespace

std::string job_name(const std::string& experiment, const std::filesystem::path& folder) {
  return fmt::format("tautline_{}_{}", experiment, hash_of(folder.string()).substr(0, 8));
}

std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

std::string script_of(const SlurmArray& array, const std::string& experiment) {
  std::string text = fmt::format(
      "#!/bin/bash\n"
      "# Written by `tautline sweep --slurm`, again for each submission. Task I of {0} makes the\n"
      "# runs I, I + {0}, I + 2 x {0} ... on the node's own disk, and copies them to shards/I.\n"
      "#SBATCH --job-name={1}\n"
      "#SBATCH --output=\"{2}/logs/%a.txt\"\n"
      "#SBATCH --open-mode=append\n"
      "#SBATCH --requeue\n"
      "#SBATCH --signal=B:USR1@120\n",
      array.tasks,
      job_name(experiment, array.folder),
      array.folder.string());
  for (const std::string& option : array.options) text += "#SBATCH " + option + "\n";
  text += fmt::format("\nout={}\ntautline={}\ntasks={}\ncontrollers=(",
                      quoted(array.folder.string()),
                      quoted(array.program.string()),
                      array.tasks);
  const char* separator = "";
  for (const std::string& option : array.controllers) {
    text += separator + quoted(option);
    separator = " ";
  }
  return text + ")\n" + kTask;
}

std::string array_text(const std::set<std::size_t>& tasks) {
  std::string text;
  for (auto first = tasks.begin(); first != tasks.end();) {
    auto next = first;
    std::size_t last = *first;
    while (++next != tasks.end() && *next == last + 1) ++last;
    text += text.empty() ? "" : ",";
    text += last == *first ? fmt::format("{}", *first) : fmt::format("{}-{}", *first, last);
    first = next;
  }
  return text;
}

std::set<std::size_t> tasks_in_queue(const std::string& answer) {
  std::set<std::size_t> tasks;
  std::istringstream lines(answer);
  for (std::string line; std::getline(lines, line);) {
    std::size_t task = 0;
    const char* const end = line.data() + line.size();
    const auto read = std::from_chars(line.data(), end, task);
    if (read.ec != std::errc() || read.ptr != end) {
      throw std::runtime_error("squeue answered '" + line + "' where a task's number should be");
    }
    tasks.insert(task);
  }
  return tasks;
}

}  // namespace server::sweep
