// server/verify.cpp: replay of the record.
#include "server/verify.hpp"

#include <span>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "algo/pipeline.hpp"
#include "server/json_limits.hpp"
#include "server/run_spec.hpp"
#include "server/scenario_json.hpp"
#include "server/wire/frame_codec.hpp"

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

algo::Pipeline pipeline_of(const db::RunRow& row) {
  const nlohmann::json document = parse_json(row.what.document);
  const algo::RobotSpec spec = robot_spec_from_json(document.at("robot"));
  const auto filter = algo::find_filter(row.what.filter);
  if (!filter) throw std::runtime_error(fmt::format("Run {} used an unknown filter.", row.id));
  algo::PipelineConfig config;
  config.controller = row.what.controller;
  config.filter = *filter;
  config.parameters = parameters_from_json(parse_json(row.what.parameters), "parameters", {});
  return {config, spec};
}

}  // namespace

Verification verify_run(db::RunReader& reader, db::RunId run) {
  const auto row = reader.get(run);
  if (!row) throw std::runtime_error(fmt::format("There is no run {}.", run));
  algo::Pipeline pipeline = pipeline_of(*row);
  Verification result;
  algo::Telemetry t;
  const auto check = [&](std::uint64_t /*tick*/, std::span<const std::byte> frame) {
    if (result.difference) return;
    decode_frame(frame, t);
    if (result.ticks == 0) pipeline.reset(t.observation.odometry.pose);
    if (t.tick != result.ticks) {
      result.difference = fmt::format("Tick {} is missing from the record.", result.ticks);
      return;
    }
    const Decided stored = decided(t);
    pipeline.tick(t);
    ++result.ticks;
    if (decided(t) == stored) return;
    result.difference =
        fmt::format("Tick {}: stored v {:.17g} omega {:.17g}, now v {:.17g} omega {:.17g}.",
                    t.tick,
                    stored.command.base.v,
                    stored.command.base.omega,
                    t.command.base.v,
                    t.command.base.omega);
  };
  std::optional<std::uint64_t> from = 0;
  while (from && !result.difference) from = reader.frames(run, *from, 1024, check);
  return result;
}

}  // namespace server
