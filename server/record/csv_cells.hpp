// server/record/csv_cells.hpp: values as cells of a CSV: numbers in their shortest exact form,
// texts quoted where necessary.
#pragma once

#include <string>
#include <string_view>

namespace server {

/// NaN leaves an empty cell.
void put_number(std::string& out, double value);
/// A number that the frame holds as a float.
void put_float(std::string& out, double value);
/// In quotes if it holds a comma, a quote or a line end. A line end becomes a blank: each tick has
/// one line.
void put_text(std::string& out, std::string_view text);

}  // namespace server
