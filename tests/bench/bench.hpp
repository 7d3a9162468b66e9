// tests/bench/bench.hpp: tools of a benchmark row: pairs timed together, checks, and figures.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace bench {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

enum class Better { Higher, Lower };

/// One line of the table. A line without bars is a detail: it explains a neighbour.
struct Figure {
  std::string row{};   // "P1"
  std::string name{};  // "scan/20"
  double value = kNone;
  std::string unit{};  // "x" for a ratio
  Better better = Better::Higher;
  double floor = kNone;
  double stretch = kNone;
  double noise = 0;  // spread of the repetitions as a share of the value
  std::string note{};
};

/// The timed code does not give the result of its reference; what() is a sentence.
class Disagreement : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};
void require(bool holds, const std::string& sentence);

/// CPU time of one call: median of the repetitions.
struct Timing {
  double seconds = 0;
  double spread = 0;  // middle half of the repetitions over their median
};
struct Subject {
  std::string name{};
  std::function<void()> call{};  // one unit of work; goes on to its next input by itself
};

/// One pass over the rows. A row checks that ours and its reference agree, then times both, then
/// adds figures. A quick pass makes the same checks on fewer inputs; its figures are meaningless.
class Pass {
 public:
  explicit Pass(bool quick) : quick_(quick) {}
  /// A quick pass that makes `calls` calls of each subject in counted() and prints the subjects,
  /// for a program that counts instructions there (tests/dev/bench_instructions.py).
  static Pass counting(int calls) {
    Pass pass(true);
    pass.calls_ = calls;
    return pass;
  }

  bool quick() const { return quick_; }
  /// `full`, or the smaller number in a quick pass.
  template <typename Count>
  Count count(Count full, Count few) const {
    return quick_ ? few : full;
  }
  /// Times all subjects in one interleaved run of Google Benchmark, so that the machine's noise
  /// affects them alike.
  std::vector<Timing> time(const std::string& title, const std::vector<Subject>& subjects) const;
  /// Adds a figure and prints it.
  void add(Figure figure);
  /// Adds `reference` / `ours`.
  void add_ratio(Figure figure, const Timing& ours, const Timing& reference);
  /// A line without bars.
  void add_detail(const std::string& row,
                  const std::string& name,
                  double value,
                  const std::string& unit,
                  const std::string& note = "");

  const std::vector<Figure>& figures() const { return figures_; }

 private:
  void count_calls(const std::string& title, const std::vector<Subject>& subjects) const;

  bool quick_ = false;
  int calls_ = 0;  // to count; 0: time instead
  std::vector<Figure> figures_{};
};

/// Median of at least one value, and the middle half's width over it.
double median(std::vector<double> values);
double spread(std::vector<double> values);
/// The quantile `q`.
double quantile(std::vector<double>& values, double q);

/// "9.1 us".
std::string duration(double seconds);

/// [s] CPU time so far of the calling thread, and of the whole program.
double thread_cpu();
double process_cpu();
/// [s] on the steady clock.
double wall();

}  // namespace bench
