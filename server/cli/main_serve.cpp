// server/cli/main_serve.cpp: the program for who wants to see the page soon: without the studies
// and the emulators, which take a third of the time to compile.
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
                      add_doctor_command,
                      add_lms200_command},
                     "This program serves. `./dev tautline` builds the one with reproduce, "
                     "compare, barn, soak, map "
                     "and emulate too.");
}
