// server/cli/program.hpp: the main program of the commands.
#pragma once

#include <string>
#include <vector>

#include "server/cli/cli.hpp"

namespace server {

using AddCommand = void (*)(Command app, int& status);

/// Adds the commands of every build: serving, single runs, stored runs, devices.
std::vector<AddCommand> serving_commands();

/// Runs the command that the arguments name and returns the exit status of the program. `footer` is
/// the last part of the help.
int run_program(int argc,
                char** argv,
                const std::vector<AddCommand>& commands,
                const std::string& footer);

}  // namespace server
