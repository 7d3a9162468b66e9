// tests/bench/bench.cpp: timing by Google Benchmark, and a little statistics.
#include "tests/bench/bench.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <map>

#include "tests/bench/report.hpp"
#include <benchmark/benchmark.h>
#include <fmt/core.h>

namespace bench {
namespace {

constexpr int kRepetitions = 5;
constexpr double kMinTime = 0.2;  // [s] of CPU time a repetition

/// Collects the CPU time of every repetition by name.
class Collector final : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context& /*context*/) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      if (run.run_type != Run::RT_Iteration) continue;
      seconds[run.run_name.function_name].push_back(run.cpu_accumulated_time /
                                                    static_cast<double>(run.iterations));
    }
  }
  std::map<std::string, std::vector<double>> seconds{};
};

std::string full_name(const std::string& title, const Subject& subject) {
  return fmt::format("{} {}", title, subject.name);
}

double clock_seconds(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

/// An instruction counter finds the code to count by this name.
extern "C" [[gnu::noinline]] void bench_counted(const std::function<void()>& call, int calls) {
  for (int i = 0; i < calls; ++i) call();
}

void require(bool holds, const std::string& sentence) {
  if (!holds) throw Disagreement(sentence);
}

void Pass::count_calls(const std::string& title, const std::vector<Subject>& subjects) const {
  constexpr int kWarm = 8;  // so that buffers have grown
  for (const Subject& subject : subjects) {
    for (int i = 0; i < kWarm; ++i) subject.call();
    bench_counted(subject.call, calls_);
    fmt::print("counted {}\t{}\n", full_name(title, subject), calls_);
  }
}

std::vector<Timing> Pass::time(const std::string& title,
                               const std::vector<Subject>& subjects) const {
  if (calls_ > 0) {
    count_calls(title, subjects);
    return std::vector<Timing>(subjects.size(), {.seconds = 1, .spread = 0});
  }
  for (const Subject& subject : subjects) {
    auto* const made = benchmark::RegisterBenchmark(
        full_name(title, subject).c_str(), [call = &subject.call](benchmark::State& state) {
          for (auto _ : state) (*call)();
        });
    made->Repetitions(quick_ ? 1 : kRepetitions)->MinTime(quick_ ? 1e-4 : kMinTime);
  }
  Collector collector;
  benchmark::RunSpecifiedBenchmarks(&collector);
  benchmark::ClearRegisteredBenchmarks();
  std::vector<Timing> timings;
  for (const Subject& subject : subjects) {
    const std::vector<double>& seconds = collector.seconds.at(full_name(title, subject));
    timings.push_back({median(seconds), spread(seconds)});
  }
  return timings;
}

void Pass::add(Figure figure) {
  if (!quick_) fmt::print(stderr, "  {}\n", line(figure));
  figures_.push_back(std::move(figure));
}

void Pass::add_ratio(Figure figure, const Timing& ours, const Timing& reference) {
  figure.value = reference.seconds / ours.seconds;
  figure.unit = std::string("x");
  figure.noise = ours.spread + reference.spread;
  const std::string times =
      fmt::format("{} against {}", duration(ours.seconds), duration(reference.seconds));
  figure.note = figure.note.empty() ? times : fmt::format("{}; {}", times, figure.note);
  add(std::move(figure));
}

void Pass::add_detail(const std::string& row,
                      const std::string& name,
                      double value,
                      const std::string& unit,
                      const std::string& note) {
  add({.row = row,
       .name = name,
       .value = value,
       .unit = unit,
       .better = Better::Lower,
       .note = note});
}

double quantile(std::vector<double>& values, double q) {
  if (values.empty()) return kNone;
  const auto last = static_cast<double>(values.size() - 1);
  const auto at = static_cast<std::ptrdiff_t>(std::ceil(q * last));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

double median(std::vector<double> values) {
  return quantile(values, 0.5);
}

double spread(std::vector<double> values) {
  const double low = quantile(values, 0.25);
  return (quantile(values, 0.75) - low) / quantile(values, 0.5);
}

double thread_cpu() {
  return clock_seconds(CLOCK_THREAD_CPUTIME_ID);
}
double process_cpu() {
  return clock_seconds(CLOCK_PROCESS_CPUTIME_ID);
}
double wall() {
  return clock_seconds(CLOCK_MONOTONIC);
}

}  // namespace bench
