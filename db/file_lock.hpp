// db/file_lock.hpp: allows one writer per file, whatever path leads to it.
#pragma once

#include <optional>
#include <string>

#include <sys/stat.h>

namespace db {

/// Identifies the file that a path leads to.
struct FileIdentity {
  dev_t device = 0;
  ino_t inode = 0;
  bool operator==(const FileIdentity&) const = default;
};
/// Nothing if the path leads to no file.
std::optional<FileIdentity> identity_of(const std::string& path);

/// Locks a file during its lifetime, against other processes and within this one. The system
/// releases the lock when the program dies. The lock is on the file itself, so that symbolic and
/// hard links lead to the same lock.
///
/// SQLite's own locks belong to the process, and are lost when it closes any descriptor of the
/// file. So a process must never open a file that it holds a second time, and the lock must outlive
/// the SQLite connections that write.
class FileLock {
 public:
  /// Creates the file if it is missing. Throws DatabaseError, also on a network file system.
  explicit FileLock(const std::string& path);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

  /// False if the file has been deleted, renamed or replaced.
  bool still_at(const std::string& path) const { return identity_of(path) == identity_; }

 private:
  int descriptor_ = -1;
  FileIdentity identity_{};
};

}  // namespace db
