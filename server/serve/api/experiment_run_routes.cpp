// server/serve/api/experiment_run_routes.cpp: the runs of an experiment: listed, drawn, and made
// again.
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include <fmt/format.h>

#include "server/experiment/judge.hpp"
#include "server/experiment/sweep/sweep_figures.hpp"
#include "server/run/json_reader.hpp"
#include "server/run/pose_json.hpp"
#include "server/serve/api/api.hpp"
#include "server/serve/api/reply.hpp"

namespace server {
namespace {

using nlohmann::json;

/// Which runs a page lists, and in which order.
struct RunQuery {
  std::string arm{}, scenario{}, outcome{}, sort{};
  bool descending = false;
};

json figures_json(const experiment::Row& row) {
  json figures = json::object();
  for (const auto& [column, value] : row.figures) {
    figures[std::string(column)] = std::isfinite(value) ? json(value) : json(nullptr);
  }
  return figures;
}

json run_json(const sweep::Plan& plan, std::size_t i, const experiment::Row& row) {
  const sweep::RunPlace at = plan.place(i);
  return {{"run", i},
          {"scenario", plan.document().scenarios[at.scenario].name},
          {"controller", plan.arms()[at.arm].label},
          {"seed", plan.seed(i)},
          {"outcome", algo::name(row.outcome)},
          {"reason", row.reason},
          {"figures", figures_json(row)},
          {"command", plan.command(i)}};
}

RunQuery query_of(const net::Request& request) {
  const auto text = [&](const char* key) {
    const auto it = request.query.find(key);
    return it == request.query.end() ? std::string() : it->second;
  };
  RunQuery query{text("controller"), text("scenario"), text("outcome"), text("sort")};
  if (query.sort.starts_with('-')) {
    query.descending = true;
    query.sort.erase(0, 1);
  }
  if (!query.sort.empty() && experiment::find_column(query.sort) == nullptr) {
    throw DocumentError("?sort", fmt::format("no figure is called '{}'", query.sort));
  }
  return query;
}

/// The numbers of the finished runs that `query` asks for, in its order. Runs without the figure
/// come last.
std::vector<std::size_t> found(const sweep::Plan& plan,
                               const sweep::Rows& rows,
                               const RunQuery& query) {
  std::vector<std::size_t> list;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!rows.has(i)) continue;
    const sweep::RunPlace at = plan.place(i);
    const auto other = [](const std::string& wanted, std::string_view is) {
      return !wanted.empty() && wanted != is;
    };
    if (other(query.arm, plan.arms()[at.arm].label)) continue;
    if (other(query.scenario, plan.document().scenarios[at.scenario].name)) continue;
    if (other(query.outcome, algo::name(rows.outcome(i)))) continue;
    list.push_back(i);
  }
  if (query.sort.empty()) return list;
  std::vector<double> keys(rows.size());
  for (const std::size_t i : list) {
    const double value = rows.figure(i, query.sort);
    const double worst = std::numeric_limits<double>::infinity();
    keys[i] = !std::isfinite(value) ? worst : query.descending ? -value : value;
  }
  std::ranges::stable_sort(list, {}, [&](std::size_t i) { return keys[i]; });
  return list;
}

net::Response list_experiment_runs(ApiContext& context, const net::Request& request, Worker&) {
  const std::shared_ptr<Experiment> experiment = experiment_of(context, request);
  const RunQuery query = query_of(request);
  const std::size_t begin = number_of(request, "from", 0);
  const std::size_t limit = limit_of(request, 100, 1000);
  json body;
  experiment->look([&](const sweep::Plan& plan, const sweep::Rows& rows) {
    const std::vector<std::size_t> list = found(plan, rows, query);
    const std::size_t from = std::min(list.size(), begin);
    const std::size_t end = std::min(list.size(), from + limit);
    json items = json::array();
    for (std::size_t k = from; k < end; ++k) {
      items.push_back(run_json(plan, list[k], rows.row(list[k])));
    }
    body = {{"items", std::move(items)},
            {"found", list.size()},
            {"next", end < list.size() ? json(end) : json(nullptr)}};
  });
  context.experiments.looked_at(experiment);
  return json_response(200, body);
}

// ---- the paths ---------------------------------------------------------------------------------

json points_json(std::span<const algo::Vec2> points_W) {
  json points = json::array();
  for (const algo::Vec2& p_W : points_W) points.push_back({p_W.x(), p_W.y()});
  return points;
}

/// {"x", "y", "radius"} of a cylinder, or {"corners"}, at the start of the run; with "ground" for a
/// ramp or trench, which is no obstacle.
json outlines_json(const sim::Scenario& scenario) {
  json outlines = json::array();
  for (const algo::Obstacle& each : scenario.obstacles) {
    if (each.path && !each.path->is_there(0)) continue;
    const auto* const cylinder = std::get_if<algo::Cylinder>(&each.shape);
    if (cylinder == nullptr) {
      outlines.push_back({{"corners", points_json(outline_W(each))}});
      if (algo::is_ground(each)) outlines.back()["ground"] = true;
    } else {
      outlines.push_back(
          {{"x", each.pose_W.x}, {"y", each.pose_W.y}, {"radius", cylinder->radius}});
    }
  }
  return outlines;
}

json paths_json(const sweep::Plan& plan, const sweep::Rows& rows, std::size_t scenario) {
  json paths = json::array();
  for (const std::size_t run : sweep::runs_with_path(plan, rows, scenario)) {
    paths.push_back({{"run", run},
                     {"controller", plan.arms()[plan.place(run).arm].label},
                     {"outcome", algo::name(rows.outcome(run))},
                     {"points", points_json(rows.track_W(run))}});
  }
  return paths;
}

/// The world of a scenario, without one of the first, and the paths through it.
net::Response get_paths(ApiContext& context, const net::Request& request, Worker&) {
  const std::shared_ptr<Experiment> experiment = experiment_of(context, request);
  const auto wanted = request.query.find("scenario");
  json body;
  experiment->look([&](const sweep::Plan& plan, const sweep::Rows& rows) {
    const std::vector<sim::Scenario>& all = plan.document().scenarios;
    const auto found = wanted == request.query.end()
                           ? all.begin()
                           : std::ranges::find(all, wanted->second, &sim::Scenario::name);
    if (found == all.end()) throw DocumentError("?scenario", "the experiment has no such scenario");
    const auto number = static_cast<std::size_t>(found - all.begin());
    const algo::Vec2 end_W = *found->end_W();  // the document has checked it
    body = {{"scenario", found->name},
            {"obstacles", outlines_json(*found)},
            {"start", to_json(found->start)},
            {"radius", found->robot.radius},
            {"goal", {{"x", end_W.x()}, {"y", end_W.y()}}},
            {"paths", paths_json(plan, rows, number)}};
  });
  context.experiments.looked_at(experiment);
  return json_response(200, body);
}

/// Makes the run once more, with its record.
void record_run(ApiContext& context,
                const net::Request& request,
                Worker&,
                const net::Responder& respond) {
  const std::shared_ptr<Experiment> experiment = experiment_of(context, request);
  const std::shared_ptr<const sweep::Plan> plan = experiment->plan();
  const auto run = whole_number(request.params.at("run"));
  if (!run || *run >= plan->size()) {
    throw net::HttpError(404,
                         fmt::format("The experiment has the runs 0 to {}.", plan->size() - 1));
  }
  queue_runs(context, {.spec = plan->trial(*run).spec}, respond);
}

}  // namespace

std::shared_ptr<Experiment> experiment_of(ApiContext& context, const net::Request& request) {
  return context.experiments.find(request.params.at("id"));
}

void add_experiment_run_routes(Routes& routes) {
  routes.make("GET", "/experiments/{id}/runs", list_experiment_runs);
  routes.make("GET", "/experiments/{id}/paths", get_paths);
  routes.work("POST", "/experiments/{id}/runs/{run}/record", record_run);
}

}  // namespace server
