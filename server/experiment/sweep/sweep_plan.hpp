// server/experiment/sweep/sweep_plan.hpp: the runs of an experiment, one after the other.
#pragma once

#include <cstddef>
#include <stop_token>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "server/experiment/sweep/sweep_document.hpp"
#include "server/experiment/trial.hpp"

namespace server::sweep {

/// A controller at one swept setting.
struct Arm {
  std::string label{};         // "modified, k_r=0.2"
  std::size_t controller = 0;  // in Document::controllers
  std::size_t point = 0;       // in Document::points
  Point parameters{};          // of both
};

/// Run `i` is a scenario, an arm and a seed; seeds change fastest, then arms. An arm has no runs in
/// a scenario that its controller does not drive.
struct RunPlace {
  std::size_t scenario = 0;
  std::size_t arm = 0;
  std::size_t repeat = 0;
};

constexpr std::size_t kMostPathPictures = 24;  // one a scenario

class Plan {
 public:
  explicit Plan(Document document);

  const Document& document() const { return document_; }
  const std::vector<Arm>& arms() const { return arms_; }
  std::size_t size() const { return first_.back(); }
  /// The runs of an arm in a scenario, 0 if it does not drive there.
  std::size_t repeats(std::size_t scenario, std::size_t arm) const;
  bool drives_all(std::size_t arm) const;  // the scenarios

  RunPlace place(std::size_t i) const;
  std::size_t number(const RunPlace& place) const;
  std::uint64_t seed(std::size_t i) const { return document_.seed + place(i).repeat; }
  /// Judged by judges(). Throws DocumentError if the parts do not go together.
  experiment::Trial trial(std::size_t i) const;
  /// True of the first seed of the first arms in the first scenarios: their paths are drawn.
  bool keeps_track(const RunPlace& place) const;
  /// [s] of the run clock, of a scenario with an arm.
  double time_limit(std::size_t scenario, std::size_t arm) const;
  /// The command that repeats the run alone, from the folder of the results.
  std::string command(std::size_t i) const;

  /// Makes the spec of every scenario with every arm, and every world. Throws DocumentError naming
  /// the scenario and the arm that do not go together, and the reason. `stop` leaves
  /// the rest unchecked.
  void check(const std::stop_token& stop = {}) const;

 private:
  RunSpec spec(std::size_t scenario, std::size_t arm, std::uint64_t seed) const;

  Document document_{};
  std::vector<Arm> arms_{};
  std::vector<std::size_t> first_{};  // run of each scenario and arm; then the number of all runs
};

/// The judges of every study, and that of the motion.
const std::vector<experiment::JudgeChoice>& judges();

/// Everything that the results depend on: program version, document, a hash of each scenario, and
/// the figures of a run.
nlohmann::json identity_of(const Document& document);
/// Of a JSON document: 16 hexadecimal digits.
std::string hash_of(const nlohmann::json& document);

/// The file of a scenario inside the folder of the results: "scenarios/case1.json".
std::string scenario_file(const sim::Scenario& scenario);

}  // namespace server::sweep
