// tests/folders.cpp: the only file that gets the paths from CMake.
#include "tests/folders.hpp"

namespace tests {

std::filesystem::path folder() {
  return TAUTLINE_TESTS;
}

std::filesystem::path shared_data() {
  return TAUTLINE_SHARED_DATA;
}

std::filesystem::path emulated_comedi() {
  return TAUTLINE_EMULATED_COMEDI;
}

}  // namespace tests
