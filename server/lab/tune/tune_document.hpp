// server/lab/tune/tune_document.hpp: a search for parameters as a JSON document
// (docs/experiments.md): objective, training and test scenarios, limits, budget.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "server/experiment/sweep/sweep_document.hpp"
#include "server/experiment/sweep/sweep_plan.hpp"

namespace server::tune {

/// Something of a run to be made large or small.
struct Goal {
  std::string metric{};  // an outcome, whose rate counts, or a figure of the judges
  bool is_rate = false;
  bool maximize = false;
};

struct Document {
  /// One goal; or a rate and then a figure, which decides only between equal rates.
  std::vector<Goal> goals{};
  std::vector<sweep::Design::Axis> axes{};  // parameters with their least and largest value
  std::size_t settings = 0;                 // that the budget allows to try
  sweep::Document training{};               // one controller; the point is chosen by the search
  nlohmann::json test{};                    // document of a sweep, without the tuned controller
  nlohmann::json source{};

  /// The sweep that compares the tuned controller with the untuned on the test scenarios.
  nlohmann::json test_of(const sweep::Point& tuned) const;
};

/// Reads the document. Throws DocumentError naming the field, also if a scenario is both in
/// training and in test, or if the budget is too small for the number of parameters.
Document document_from_json(
    const nlohmann::json& source,
    const ScenarioLibrary& library,
    const std::shared_ptr<const algo::ControllerCatalogue>& controllers = {});

}  // namespace server::tune
