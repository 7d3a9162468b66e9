// server/lab/reproduce/pictures.hpp: a layout with the path of each reading.
#pragma once

#include <span>
#include <string>

#include "server/experiment/figures.hpp"
#include "server/lab/reproduce/paper_file.hpp"

namespace server::reproduce {

/// An SVG document: the obstacles, start and goal of `layout`, and of every row of it the path of
/// its first run.
std::string draw_paths(const PaperFile& file, const Layout& layout, std::span<const Row> rows);

}  // namespace server::reproduce
