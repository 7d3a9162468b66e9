// server/cli/main.cpp: the program with all its commands.
#include "server/cli/program.hpp"

int main(int argc, char** argv) {
  using namespace server;
  return run_program(argc,
                     argv,
                     {add_serve_command,
                      add_run_command,
                      add_replay_command,
                      add_export_command,
                      add_verify_command,
                      add_health_command,
                      add_reproduce_command,
                      add_barn_command,
                      add_soak_command,
                      add_emulate_command,
                      add_compare_command,
                      add_doctor_command,
                      add_lms200_command,
                      add_map_command},
                     "Each command has its own --help. First time: tautline serve");
}
