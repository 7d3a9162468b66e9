// tests/bench/report.hpp: figures as a table, as a result file, and against an older result file.
#pragma once

#include <string>
#include <vector>

#include "tests/bench/bench.hpp"

namespace bench {

/// Ratios within this share of 1, or within both files' own spread, count as the same.
constexpr double kNoiseBand = 0.10;

enum class Verdict { Stretch, Floor, Below, None };
Verdict verdict(const Figure& figure);
std::string to_string(Verdict verdict);

/// A figure on one line of a terminal.
std::string line(const Figure& figure);

void print_table(const std::vector<Figure>& figures);

/// Writes figures, failures and the machine as JSON. Throws std::runtime_error.
void write_results(const std::string& path,
                   const std::vector<Figure>& figures,
                   const std::vector<std::string>& failures);

/// Prints every figure of two result files as a ratio; above 1 is better. @return how many are
/// worse. Throws std::runtime_error with a sentence for an unreadable file.
std::size_t compare(const std::string& old_path, const std::string& new_path);

}  // namespace bench
