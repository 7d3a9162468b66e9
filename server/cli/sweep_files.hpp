// server/cli/sweep_files.hpp: what `sweep` and `report` share: a checked plan, and the files.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include <nlohmann/json.hpp>

#include "server/experiment/sweep/run_log.hpp"
#include "server/experiment/sweep/sweep_plan.hpp"

namespace server {

/// The plan of a document that came from `file`, with the user's scenarios and robots.
/// `controllers`: as in RunSpec. Throws std::runtime_error naming the file and the field.
sweep::Plan plan_from(const nlohmann::json& document,
                      const std::string& file,
                      std::shared_ptr<const algo::ControllerCatalogue> controllers);

/// The plan of an experiment that `tautline sweep` left in `folder`, with the scenarios and robots
/// as they were then. Throws std::runtime_error naming the file.
sweep::Plan plan_in(const std::filesystem::path& folder,
                    std::shared_ptr<const algo::ControllerCatalogue> controllers);

/// Writes the report to `folder` and prints the rates. Returns the exit status: 0, 1 if a run
/// failed, 4 if only runs are missing.
int write_and_print(const sweep::Plan& plan, const sweep::Rows& rows, const std::string& folder);

}  // namespace server
