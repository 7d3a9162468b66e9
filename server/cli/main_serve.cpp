// server/cli/main_serve.cpp: the program without studies and emulators, which take a third of the
// compile time.
#include "server/cli/program.hpp"

int main(int argc, char** argv) {
  return server::run_program(argc,
                             argv,
                             server::serving_commands(),
                             "This program serves. `./dev tautline` builds the one with reproduce, "
                             "compare, barn, soak, map "
                             "and emulate too.");
}
