// server/cli/main_serve.cpp: the program without the studies and the emulators, which take a third
// of the time to compile.
#include "server/cli/program.hpp"

int main(int argc, char** argv) {
  return server::run_program(argc,
                             argv,
                             server::serving_commands(),
                             "This program serves. `./dev tautline` builds the one with reproduce, "
                             "compare, barn, soak, map "
                             "and emulate too.");
}
