// algo/pipeline/parameter_table.hpp: all parameters there are: the union of the lists of the
// controllers, the filter, the behaviours and the gate.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "algo/parameters.hpp"

namespace algo {

/// Each once, in the order in which people are shown them.
ParameterList parameter_table();

/// Those that are read whichever controller drives: filter, behaviours, gate.
ParameterList common_parameters();

/// By its name or its alias; null when there is none.
const ParameterInfo* find_parameter(std::string_view name);

/// Why `value` cannot be given to `parameter` while the others are as in `now`, as a sentence;
/// nothing when it can. Refuses what is out of limits or not finite, and a strip that would be
/// pushed into an obstacle.
std::optional<std::string> refusal(const Parameters& now,
                                   const ParameterInfo& parameter,
                                   double value);

/// The same for a whole set, such as a scenario's.
std::optional<std::string> refusal(const Parameters& all);

}  // namespace algo
