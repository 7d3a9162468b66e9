// server/experiment/sweep/sweep_document.hpp: an experiment as a JSON document
// (docs/experiments.md): scenarios, controllers, swept parameters, repeats.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "algo/pipeline/controllers.hpp"
#include "server/experiment/sweep/parameter_design.hpp"
#include "server/run/scenario_library.hpp"
#include "sim/scenario.hpp"

namespace server::sweep {

constexpr std::size_t kMostRuns = 100'000;
constexpr std::size_t kMostScenarios = 1000;  // entries of the list
constexpr std::size_t kMostLayouts = 10'000;  // of one generator
constexpr std::size_t kMostControllers = 100;
constexpr std::size_t kMostRepeats = 10'000;

/// Whether a document may name files of this computer. A document that came over the network never
/// may.
enum class Files : bool { Refused, Allowed };

struct ControllerChoice {
  std::string name{};
  std::string label{};  // in the report; the name unless given
  Point parameters{};
  std::size_t repeats = 1;       // seeds in each of its scenarios and settings
  std::set<std::string> only{};  // the names of its scenarios; empty: all

  bool drives(const sim::Scenario& scenario) const {
    return only.empty() || only.contains(scenario.name);
  }
};

/// Every other controller against the baseline, on the same scenario, seed and swept setting.
struct Comparisons {
  std::string baseline{};             // label of a controller
  std::vector<std::string> others{};  // labels
};

struct Document {
  std::string name{};
  std::vector<sim::Scenario> scenarios{};  // with the document's physics, noise, limits
  std::vector<ControllerChoice> controllers{};
  std::vector<Point> points{};  // swept settings; a single empty one if nothing is swept
  std::uint64_t seed = 1;       // the first
  std::optional<Comparisons> comparisons{};
  nlohmann::json source{};                                       // the document as given
  std::shared_ptr<const algo::ControllerCatalogue> catalogue{};  // as in RunSpec

  std::size_t most_repeats() const;  // of any controller
  /// Counts them; see Plan::size().
  std::size_t runs() const;
};

/// Reads a whole document; `library` has the scenarios it may name, and `controllers` the
/// controllers (null: the built-in ones). Throws DocumentError saying which field is wrong and how,
/// also for a file where `files` are refused, and for more than kMostRuns runs, which are counted
/// before anything is made.
Document document_from_json(const nlohmann::json& source,
                            const ScenarioLibrary& library,
                            std::shared_ptr<const algo::ControllerCatalogue> controllers = {},
                            Files files = Files::Refused);

/// As document_from_json(), for scenarios that have been read before, and have what the document
/// sets in place of their own values.
Document document_with(const nlohmann::json& source,
                       std::vector<sim::Scenario> scenarios,
                       std::shared_ptr<const algo::ControllerCatalogue> controllers = {});

}  // namespace server::sweep
