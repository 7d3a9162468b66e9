// algo/pipeline/parameter_table.hpp: all parameters: the union of the lists of the controllers, the
// filter, the behaviours and the gate.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "algo/parameters.hpp"

namespace algo {

/// Each parameter once, in display order.
ParameterList parameter_table();

/// The parameters that matter for every controller: filter, behaviours, gate.
ParameterList common_parameters();

/// Finds a parameter by its name or its alias; null if there is none.
const ParameterInfo* find_parameter(std::string_view name);

/// Why `parameter` cannot take `value` while the others are as in `now`, as a sentence; nothing if
/// it can. Refuses values out of limits or not finite, and values with which the strip could be
/// pushed into an obstacle.
std::optional<std::string> refusal(const Parameters& now,
                                   const ParameterInfo& parameter,
                                   double value);

/// The same for a whole set of parameters, such as a scenario's.
std::optional<std::string> refusal(const Parameters& all);

}  // namespace algo
