// db/file_lock.cpp: flock on the database file, and a list of the files this process holds.
#include "db/file_lock.hpp"

#include <algorithm>
#include <cerrno>
#include <mutex>
#include <vector>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "db/network_disk.hpp"
#include "db/sqlite.hpp"

namespace db {

namespace {

std::mutex g_mutex;
std::vector<FileIdentity> g_held;  // guarded by g_mutex

bool held_here(const std::optional<FileIdentity>& file) {
  return file && std::find(g_held.begin(), g_held.end(), *file) != g_held.end();
}

[[noreturn]] void refuse(const std::string& path) {
  throw DatabaseError("The run store " + path +
                          " is being written by another server; stop it or choose another file.",
                      Trouble::Refused);
}

}  // namespace

std::optional<FileIdentity> identity_of(const std::string& path) {
  struct stat found {};
  if (::stat(path.c_str(), &found) != 0) return std::nullopt;
  return FileIdentity{found.st_dev, found.st_ino};
}

FileLock::FileLock(const std::string& path) {
  if (const auto refusal = refusal_on_network(path))
    throw DatabaseError(*refusal, Trouble::Refused);
  const std::lock_guard lock(g_mutex);
  if (held_here(identity_of(path))) refuse(path);
  descriptor_ = ::open(path.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0644);
  if (descriptor_ < 0) {
    const bool full = errno == ENOSPC || errno == EDQUOT;
    throw DatabaseError(full ? "The disk is full: the run store " + path + " could not be made."
                             : "Cannot open the run store " + path +
                                   ": its folder is missing or may not be written.",
                        full ? Trouble::Full : Trouble::Refused);
  }
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
    const bool held = errno == EWOULDBLOCK;
    ::close(descriptor_);
    if (held) refuse(path);
    throw DatabaseError("The run store " + path + " cannot be locked.", Trouble::Refused);
  }
  struct stat opened {};
  ::fstat(descriptor_, &opened);
  identity_ = {opened.st_dev, opened.st_ino};
  g_held.push_back(identity_);
}

FileLock::~FileLock() {
  const std::lock_guard lock(g_mutex);
  std::erase(g_held, identity_);
  ::close(descriptor_);
}

}  // namespace db
