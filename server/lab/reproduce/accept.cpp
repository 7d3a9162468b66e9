// server/lab/reproduce/accept.cpp: one Check for every field of accept and accept_compare.
#include "server/lab/reproduce/accept.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace server::reproduce {
namespace {

std::string number(double value) {
  return fmt::format("{:.6g}", value);
}

class Judge {
 public:
  explicit Judge(std::vector<Check>& checks) : checks_(checks) {}

  void judge(const Layout& layout,
             const Acceptance& accept,
             std::span<const Row> rows,
             const char* suffix) {
    Check check{.layout = layout.name, .subject = accept.reading + suffix};
    const Row* row = find_row(rows, layout.name, accept.reading);
    if (row == nullptr) return add(check, "a run", "none", false);
    if (accept.outcome) {
      add(check,
          fmt::format("all {}", algo::name(*accept.outcome)),
          outcomes_text(*row),
          common_outcome(*row) == accept.outcome);
    }
    if (accept.collisions) {
      const std::size_t collided = count(*row, algo::Outcome::Collided);
      add(check,
          fmt::format("collisions {}", *accept.collisions),
          fmt::format("{}", collided),
          collided == *accept.collisions);
    }
    for (const Limit& limit : accept.limits) {
      const double value = figure_against(*row, *find_metric(limit.metric), limit.at_least);
      add(check,
          fmt::format(
              "{} at {} {}", limit.metric, limit.at_least ? "least" : "most", number(limit.value)),
          number(value),
          limit.at_least ? value >= limit.value : value <= limit.value);
    }
  }

  void compare(const Layout& layout, const Comparison& comparison, std::span<const Row> rows) {
    Check check{.layout = layout.name,
                .subject = fmt::format("{} < {}", comparison.lower, comparison.higher)};
    const Row* lower = find_row(rows, layout.name, comparison.lower);
    const Row* higher = find_row(rows, layout.name, comparison.higher);
    if (lower == nullptr || higher == nullptr) return add(check, "two runs", "none", false);
    const MetricInfo& metric = *find_metric(comparison.metric);
    const double a = figure(*lower, metric);
    const double b = figure(*higher, metric);
    add(check, comparison.metric, fmt::format("{} < {}", number(a), number(b)), a < b);
  }

 private:
  void add(Check check, std::string asked, std::string figure, bool held) {
    check.asked = std::move(asked);
    check.figure = std::move(figure);
    check.held = held;
    checks_.push_back(std::move(check));
  }

  std::vector<Check>& checks_;
};

}  // namespace

std::vector<Check> evaluate(const PaperFile& file,
                            std::span<const Row> paper,
                            std::span<const Row> noise_free) {
  std::vector<Check> checks;
  Judge judge(checks);
  for (const Layout& layout : file.layouts) {
    for (const Acceptance& accept : layout.accept) judge.judge(layout, accept, paper, "");
    for (const Comparison& each : layout.accept_compare) judge.compare(layout, each, paper);
    for (const Acceptance& accept : layout.accept_noise_free) {
      judge.judge(layout, accept, noise_free, ", noise-free");
    }
  }
  return checks;
}

bool all_held(std::span<const Check> checks) {
  return std::ranges::all_of(checks, &Check::held);
}

}  // namespace server::reproduce
