// server/run/io_thread.hpp: the thread that carries Stop, and what must not run on it.
#pragma once

namespace server::net {

/// Marks the calling thread as the io thread for the life of this object.
class IoThreadMark {
 public:
  IoThreadMark();
  ~IoThreadMark();
  IoThreadMark(const IoThreadMark&) = delete;
  IoThreadMark& operator=(const IoThreadMark&) = delete;
};

/// Stands at the beginning of all work that reads a whole run, waits for a disk or another thread,
/// or builds a world. Throws std::logic_error on the io thread.
void not_on_io_thread(const char* work);

}  // namespace server::net
