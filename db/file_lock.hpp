// db/file_lock.hpp: one writer per file, by whatever name it is reached.
#pragma once

#include <optional>
#include <string>

#include <sys/stat.h>

namespace db {

/// Which file a path leads to.
struct FileIdentity {
  dev_t device = 0;
  ino_t inode = 0;
  bool operator==(const FileIdentity&) const = default;
};
/// Nothing when the path leads nowhere.
std::optional<FileIdentity> identity_of(const std::string& path);

/// Holds a file for as long as it lives, against other processes and within this one; the system
/// gives it back when the program dies. The lock is on the file itself, so that symbolic and hard
/// links lead to the same one.
///
/// SQLite's own locks are the process's and go when the process closes any descriptor of the file.
/// So a file this process holds is never opened a second time here, and the lock must outlive the
/// SQLite connections that write.
class FileLock {
 public:
  /// Makes the file when it is missing. Throws DatabaseError.
  explicit FileLock(const std::string& path);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

  /// False when the file was deleted, renamed or replaced since.
  bool still_at(const std::string& path) const { return identity_of(path) == identity_; }

 private:
  int descriptor_ = -1;
  FileIdentity identity_{};
};

}  // namespace db
