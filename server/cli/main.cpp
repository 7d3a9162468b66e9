// server/cli/main.cpp: the program with all its commands.
#include "server/cli/program.hpp"

int main(int argc, char** argv) {
  using namespace server;
  std::vector<AddCommand> commands = serving_commands();
  commands.insert(commands.end(),
                  {add_reproduce_command,
                   add_barn_command,
                   add_buildings_command,
                   add_climbs_command,
                   add_soak_command,
                   add_compare_command,
                   add_crowd_command,
                   add_locate_command,
                   add_map_command,
                   add_merge_command,
                   add_report_command,
                   add_sweep_command,
                   add_tune_command,
                   add_worlds_command,
                   add_emulate_command});
  return run_program(
      argc, argv, commands, "Each command has its own --help. First time: tautline serve");
}
