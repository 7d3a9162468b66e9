// server/cli/program.hpp: the program around its commands.
#pragma once

#include <initializer_list>
#include <string>

#include "server/cli/cli.hpp"

namespace server {

using AddCommand = void (*)(CLI::App& app, int& status);

/// Runs the command that the arguments name and returns the program's exit status. `footer` ends
/// the help.
int run_program(int argc,
                char** argv,
                std::initializer_list<AddCommand> commands,
                const std::string& footer);

}  // namespace server
