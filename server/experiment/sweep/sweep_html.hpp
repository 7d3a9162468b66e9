// server/experiment/sweep/sweep_html.hpp: the report as one HTML file.
#pragma once

#include <span>
#include <string>

#include "server/experiment/sweep/sweep_figures.hpp"
#include "server/experiment/sweep/sweep_results.hpp"

namespace server::sweep {

constexpr std::size_t kMostListed = 1000;  // runs in the table of runs; of more it has no table

/// A whole page: tables, pictures and method, with its style, its drawings and the script that
/// sorts the table of runs in it. It loads nothing. Light or dark as the browser prefers.
std::string to_html(const Plan& plan,
                    const Rows& rows,
                    const Results& results,
                    std::span<const Picture> pictures);

}  // namespace server::sweep
