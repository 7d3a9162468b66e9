// server/experiment/judges/metrics.cpp: the figures of every run (algo/metrics.hpp).
#include "algo/metrics.hpp"

#include "server/experiment/judge.hpp"

namespace server::experiment::judges {
namespace {

constexpr Column kMetricColumns[] = {{"time_s", Aggregate::Mean, 1},
                                     {"path_m", Aggregate::Mean, 2},
                                     {"min_clearance_m", Aggregate::Least, 3},
                                     {"safety_infringed_s", Aggregate::Largest, 1},
                                     {"safety_depth_m", Aggregate::Largest, 3},
                                     {"turning_rad", Aggregate::Mean, 2},
                                     {"via_points", Aggregate::Mean, 1}};

class Metrics final : public Judge {
 public:
  explicit Metrics(const JudgedRun& run) : parameters_(run.spec.parameters) {
    recorder_.reset(run.robot);
  }

  void see(const algo::Telemetry& t) override { recorder_.add(t, parameters_); }

  void write(std::span<double> row) const override {
    const algo::Metrics& m = recorder_.metrics();
    row[0] = m.time;
    row[1] = m.path_length;
    row[2] = m.min_clearance;
    row[3] = m.infringed_time;
    row[4] = m.intrusion;
    row[5] = m.turning;
    row[6] = m.via_points;
  }

 private:
  algo::Parameters parameters_;  // constant during a trial
  algo::MetricsRecorder recorder_{};
};

}  // namespace

JudgeInfo metrics() {
  return {.help = "Time, path, clearance, safety circle, turning, via points",
          .columns = kMetricColumns,
          .make = make_judge<Metrics>};
}

}  // namespace server::experiment::judges
