// server/run/io_thread.hpp: marks the thread that carries Stop, to keep slow work off it.
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

/// Call it at the start of any work that reads a whole run, waits for a disk or another thread, or
/// builds a world. Throws std::logic_error on the io thread.
void not_on_io_thread(const char* work);

}  // namespace server::net
