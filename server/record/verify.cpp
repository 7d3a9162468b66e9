// server/record/verify.cpp: replay of the record.
#include "server/record/verify.hpp"

#include <memory>
#include <span>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "algo/pipeline/pipeline.hpp"
#include "server/record/frame_codec.hpp"
#include "server/record/run_json.hpp"
#include "server/run/drawn_map.hpp"
#include "server/run/json_limits.hpp"
#include "server/run/obstacle_json.hpp"
#include "server/run/run_spec.hpp"

namespace server {
namespace {

struct Decided {
  algo::Command command{};
  algo::Hold hold{};
  algo::Mission mission{};
  bool operator==(const Decided&) const = default;
};

Decided decided(const algo::Telemetry& t) {
  return {t.command, t.hold, t.mission};
}

/// Gives the answers of a controller outside the program again, as decode_frame() left them.
class RecordedController final : public algo::Controller {
 public:
  void reset(const algo::Pose2& /*start_W*/) override {}
  void update(const algo::ControlInput& in,
              const algo::Parameters& /*parameters*/,
              algo::ControlOutput& out) override {
    if (!out.answered) {
      throw std::runtime_error(
          fmt::format("The record has no answer of the controller at {:.3f} s.", in.stamp));
    }
  }
  void explain(const algo::Telemetry& /*t*/, algo::Explanation& words) const override {
    words = {};
  }
};

algo::ControllerCatalogue recorded(const std::string& controller) {
  return algo::ControllerCatalogue({{.name = controller, .outside = true, .make = [] {
                                       return std::make_unique<RecordedController>();
                                     }}});
}

/// The pieces that a robot with an arm knew from the start.
std::vector<algo::Obstacle> declared_in(const nlohmann::json& document) {
  std::vector<algo::Obstacle> pieces;
  for (const nlohmann::json& piece : document.at("scenario").at("obstacles")) {
    pieces.push_back(obstacle_from_json(piece, "obstacles"));
  }
  return pieces;
}

algo::Pipeline pipeline_of(const db::RunRow& row) {
  const nlohmann::json document = parse_json(row.what.document, kOwnDocument);
  const algo::RobotSpec spec = robot_spec_from_json(document.at("robot"));
  algo::PipelineConfig config;
  config.controller = row.what.controller;
  config.filter = stored_filter(row);
  config.parameters = stored_parameters(row);
  if (spec.arm) config.declared = declared_in(document);
  if (document.contains("map")) {
    config.run.map =
        std::make_shared<const algo::DrawnSpace>(drawn_space_from_json(document["map"]));
  }
  if (document.contains("answers")) {
    return {config, spec, recorded(config.controller)};
  }
  return {config, spec};
}

/// Feeds the frames of one run, in order, to a pipeline of its own.
class Comparison {
 public:
  explicit Comparison(const db::RunRow& row) : row_(row), pipeline_(pipeline_of(row)) {}

  /// Reads up to `limit` ticks from `from` on. Returns the tick to continue with, or nothing.
  std::optional<std::uint64_t> read(db::RunReader& reader, std::uint64_t from, std::size_t limit) {
    return reader.frames(
        row_.id, from, limit, [&](std::uint64_t, std::span<const std::byte> frame) {
          decode_frame(frame, t_);
          compare();
        });
  }
  const Verification& result() const { return result_; }

 private:
  void compare() {
    ++result_.ticks;
    if (result_.difference || result_.incomplete) return;
    // The pipeline's state after a missing tick cannot be recovered.
    if (t_.tick != result_.compared) {
      result_.incomplete = why_missing(result_.compared, t_.tick - 1);
      return;
    }
    if (t_.tick == 0) pipeline_.reset(t_.observation.odometry.pose);
    const Decided stored = decided(t_);
    pipeline_.tick(t_);
    ++result_.compared;
    if (decided(t_) == stored) return;
    result_.difference = fmt::format(
        "Tick {}: stored v {:.17g} omega {:.17g}, now v {:.17g} omega {:.17g}.{}",
        t_.tick,
        stored.command.base.v,
        stored.command.base.omega,
        t_.command.base.v,
        t_.command.base.omega,
        stored.command.joint_rates == t_.command.joint_rates ? ""
                                                             : " The rates of the joints differ.");
  }

  std::string why_missing(std::uint64_t first, std::uint64_t last) const {
    std::string why;
    for (const db::Gap& gap : row_.gaps) {
      if (gap.first_tick <= last && gap.last_tick >= first) why = gap.sentence;
    }
    return fmt::format(
        "Ticks {} to {} are missing from the record{} What follows them cannot be "
        "compared.",
        first,
        last,
        why.empty() ? "." : ": " + why);
  }

  const db::RunRow& row_;
  algo::Pipeline pipeline_;
  algo::Telemetry t_{};
  Verification result_{};
};

}  // namespace

std::optional<std::string> incompleteness(db::RunReader& reader,
                                          const db::RunRow& row,
                                          std::uint64_t ticks) {
  const auto now = reader.get(row.id);
  if (!now) return fmt::format("Run {} was deleted while it was read.", row.id);
  if (row.status == db::RunStatus::Recording || row.status == db::RunStatus::Queued) {
    return fmt::format("Run {} is still {}.", row.id, db::to_string(row.status));
  }
  if (row.status == db::RunStatus::Interrupted) return row.reason;
  if (row.status == db::RunStatus::Cancelled) return fmt::format("Run {} was cancelled.", row.id);
  if (row.status == db::RunStatus::Failed) {
    return fmt::format("Run {} failed: {}", row.id, row.reason);
  }
  for (const db::Gap& gap : now->gaps) {
    if (gap.cause == db::GapCause::Pause) continue;
    return fmt::format(
        "Ticks {} to {} are not in the record: {}", gap.first_tick, gap.last_tick, gap.sentence);
  }
  if (row.lost_ticks > 0) return fmt::format("{} ticks of the run were lost.", row.lost_ticks);
  if (ticks != row.ticks) {
    return fmt::format("Only {} of the run's {} ticks could be read.", ticks, row.ticks);
  }
  return std::nullopt;
}

Verification verify_run(db::RunReader& reader, db::RunId run) {
  const auto row = reader.get(run);
  if (!row) throw std::runtime_error(fmt::format("There is no run {}.", run));
  Comparison comparison(*row);
  std::optional<std::uint64_t> from = 0;
  while (from && !comparison.result().difference) from = comparison.read(reader, *from, 1024);
  Verification result = comparison.result();
  if (!result.difference && !result.incomplete) {
    result.incomplete = incompleteness(reader, *row, result.ticks);
  }
  return result;
}

}  // namespace server
