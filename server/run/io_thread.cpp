// server/run/io_thread.cpp: one mark for each thread.
#include "server/run/io_thread.hpp"

#include <stdexcept>
#include <string>

namespace server::net {
namespace {
thread_local bool marked = false;
}

IoThreadMark::IoThreadMark() {
  marked = true;
}
IoThreadMark::~IoThreadMark() {
  marked = false;
}

void not_on_io_thread(const char* work) {
  if (marked) throw std::logic_error(std::string(work) + " was asked of the io thread");
}

}  // namespace server::net
