// server/cli/slurm_sweep.cpp: asks the queue, then the folder, and acts on the difference.
#include "server/cli/slurm_sweep.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <set>
#include <stdexcept>
#include <thread>

#include <fmt/format.h>
#include <stdlib.h>    // NOLINT(modernize-deprecated-headers): mkdtemp
#include <sys/wait.h>  // WEXITSTATUS

#include "server/cli/cli.hpp"
#include "server/cli/sweep_files.hpp"
#include "server/experiment/sweep/merge.hpp"
#include "server/experiment/sweep/slurm_script.hpp"
#include "server/experiment/sweep/sweep_run.hpp"
#include "server/run/text_file.hpp"

namespace server {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using Tasks = std::set<std::size_t>;

constexpr int kTries = 4;
constexpr std::size_t kTasks = 16;

/// A folder on this machine's disk, for logs that must not be on a network.
class Scratch {
 public:
  Scratch() {
    std::string name = (fs::temp_directory_path() / "tautline_XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) {
      throw std::runtime_error(name + ": no folder can be made there; set TMPDIR to another place");
    }
    path_ = name;
  }
  ~Scratch() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_{};
};

struct Answer {
  int status = 0;
  std::string text{};  // of standard output, and of standard error if the command failed
};

Answer answer_of(const std::string& command, const fs::path& errors) {
  std::FILE* const pipe = ::popen((command + " 2>" + sweep::quoted(errors.string())).c_str(), "r");
  if (pipe == nullptr) throw std::runtime_error("no process can be started for: " + command);
  Answer answer;
  std::array<char, 4096> part{};
  while (const std::size_t n = std::fread(part.data(), 1, part.size(), pipe)) {
    answer.text.append(part.data(), n);
  }
  const int ended = ::pclose(pipe);
  answer.status = WIFEXITED(ended) ? WEXITSTATUS(ended) : 1;
  if (answer.status != 0) answer.text += read_text(errors);
  while (answer.text.ends_with('\n')) answer.text.pop_back();
  return answer;
}

/// The output of a command of Slurm. A busy or restarting controller gets some tries.
std::string ask(const std::string& name, const std::string& arguments, const SlurmSweep& request) {
  const Scratch scratch;
  Answer answer;
  std::chrono::milliseconds pause = request.pause;
  for (int i = 0; i < kTries; ++i, pause *= 2) {
    if (i > 0) std::this_thread::sleep_for(pause);
    answer = answer_of(fmt::format("{} {}", name, arguments), scratch.path() / "errors");
    if (answer.status == 0) return answer.text;
    constexpr int kNotFound = 127;  // of a shell
    if (answer.status == kNotFound) {
      throw std::runtime_error(name + " is not installed here; --slurm needs Slurm's commands");
    }
  }
  throw std::runtime_error(
      fmt::format("{} failed {} times and said in the end: {}", name, kTries, answer.text));
}

Tasks queued(const std::string& name, const SlurmSweep& request) {
  return sweep::tasks_in_queue(
      ask("squeue", "--noheader --array --me --format=%K --name=" + sweep::quoted(name), request));
}

/// Takes the folder for this experiment, or checks that it is its. Returns the number of tasks.
std::size_t claim(const sweep::Plan& plan, const SlurmSweep& request) {
  const fs::path file = request.folder / "slurm.json";
  const json identity = sweep::identity_of(plan.document());
  if (!fs::exists(file)) {
    if (fs::exists(request.folder / "runs.jsonl")) {
      throw std::runtime_error(request.folder.string() +
                               ": holds an experiment that ran without Slurm. Choose another "
                               "folder with --out.");
    }
    const std::size_t tasks = std::min(request.tasks.value_or(kTasks), plan.size());
    make_folder(request.folder / "logs");
    make_folder(request.folder / "shards");
    write_text(request.folder / "document.json", plan.document().source.dump(1) + "\n");
    replace_text(file, json{{"tasks", tasks}, {"identity", identity}}.dump(1) + "\n");
    return tasks;
  }
  const json known = json::parse(read_text(file), nullptr, false);
  if (!known.is_object() || !known.contains("identity") || !known["tasks"].is_number_unsigned()) {
    throw std::runtime_error(file.string() + ": is damaged; choose another folder with --out");
  }
  if (known["identity"] != identity) {
    throw std::runtime_error(
        fmt::format("{}: is of another experiment: {}. Choose another folder "
                    "with --out.",
                    file.string(),
                    sweep::difference(known["identity"], identity)));
  }
  const auto tasks = known["tasks"].get<std::size_t>();
  if (request.tasks && std::min(*request.tasks, plan.size()) != tasks) {
    throw std::runtime_error(
        fmt::format("{}: was begun with --tasks {}, and cannot go on with another number",
                    file.string(),
                    tasks));
  }
  return tasks;
}

fs::path shard_folder(const SlurmSweep& request, std::size_t task) {
  return request.folder / "shards" / std::to_string(task);
}

/// The tasks whose shard in the folder misses a run. A failed run is there.
Tasks unfinished(const sweep::Plan& plan, const SlurmSweep& request, std::size_t tasks) {
  const Scratch scratch;
  Tasks missing;
  for (std::size_t task = 0; task < tasks; ++task) {
    const fs::path folder = shard_folder(request, task);
    if (!fs::exists(folder / "runs.jsonl")) {
      missing.insert(task);
      continue;
    }
    const sweep::Rows rows = rows_in(plan, folder, scratch.path());
    for (std::size_t i = task; i < rows.size(); i += tasks) {
      if (!rows.has(i)) missing.insert(task);
    }
  }
  return missing;
}

void copy_whole(const fs::path& from, const fs::path& to) {
  replace_text(to, read_text(from));
}

int merge(const sweep::Plan& plan, const SlurmSweep& request, std::size_t tasks) {
  const Scratch scratch;
  std::vector<fs::path> shards;
  for (std::size_t task = 0; task < tasks; ++task) shards.push_back(shard_folder(request, task));
  const sweep::Merged merged = merge_shards(plan, scratch.path(), shards);
  write_scenarios(plan.document(), request.folder);
  for (const char* const file : {"runs.jsonl", "machines.json"}) {
    copy_whole(scratch.path() / file, request.folder / file);
  }
  for (const std::string& warning : merged.warnings) fmt::print(stderr, "tautline: {}\n", warning);
  return write_and_print(plan, merged.rows, request.folder.string());
}

/// Submits one array. Returns Slurm's number of it.
std::string submit(const sweep::Plan& plan,
                   const SlurmSweep& request,
                   std::size_t tasks,
                   const Tasks& chosen) {
  const sweep::SlurmArray array{.program = fs::read_symlink("/proc/self/exe"),
                                .folder = request.folder,
                                .tasks = tasks,
                                .options = request.options,
                                .controllers = request.controllers};
  const fs::path script = request.folder / "job.sh";
  replace_text(script, script_of(array, plan.document().name));
  return ask(
      "sbatch",
      fmt::format(
          "--parsable --array={} {}", sweep::array_text(chosen), sweep::quoted(script.string())),
      request);
}

}  // namespace

int sweep_on_slurm(const sweep::Plan& plan, const SlurmSweep& given) {
  SlurmSweep request = given;
  request.folder = fs::absolute(request.folder).lexically_normal();
  const std::string name = sweep::job_name(plan.document().name, request.folder);
  // The queue first: a task that ends meanwhile is then seen as running, and not submitted again.
  const Tasks waiting = queued(name, request);
  const std::size_t tasks = claim(plan, request);
  Tasks missing = unfinished(plan, request, tasks);
  if (missing.empty()) return merge(plan, request, tasks);
  const std::size_t all = missing.size();
  for (const std::size_t task : waiting) missing.erase(task);
  fmt::print(
      "{} of {} tasks have ended, {} are in the queue\n", tasks - all, tasks, all - missing.size());
  if (!missing.empty()) {
    const std::string job = submit(plan, request, tasks, missing);
    fmt::print("submitted {} tasks as job {} ({})\n", missing.size(), job, name);
  }
  fmt::print("The same command again tells how far they are, and writes the report in the end.\n");
  return kIncomplete;
}

}  // namespace server
