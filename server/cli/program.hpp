// server/cli/program.hpp: the program around its commands.
#pragma once

#include <string>
#include <vector>

#include "server/cli/cli.hpp"

namespace server {

using AddCommand = void (*)(CLI::App& app, int& status);

/// Those that every build has: serving, single runs, stored runs, devices.
std::vector<AddCommand> serving_commands();

/// Runs the command that the arguments name and returns the program's exit status. `footer` ends
/// the help.
int run_program(int argc,
                char** argv,
                const std::vector<AddCommand>& commands,
                const std::string& footer);

}  // namespace server
