// drivers/emulators/card_memory.cpp: maps the registers and interprets them.
#include "drivers/emulators/card_memory.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <new>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

namespace drivers::emulators {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, const std::string& what) {
  throw std::runtime_error(path.string() + " " + what + ": " +
                           std::system_category().message(errno) + ".");
}

/// A lock of the maker, as long as it lives. Of another kind than flock(), by which a driver keeps
/// other drivers out.
constexpr struct flock kWholeFile {
  .l_type = F_WRLCK, .l_whence = SEEK_SET, .l_start = 0, .l_len = 0, .l_pid = 0
};

/// True if the emulator that made the file runs.
bool has_maker(const fs::path& path) {
  const int file = ::open(path.c_str(), O_RDWR | O_CLOEXEC);
  struct flock found = kWholeFile;
  const bool taken =
      file >= 0 && ::fcntl(file, F_OFD_GETLK, &found) == 0 && found.l_type != F_UNLCK;
  if (file >= 0) ::close(file);
  return taken;
}

/// The inode of `path`; 0 without a file.
std::uint64_t inode_of(const fs::path& path) {
  struct stat status {};
  return ::stat(path.c_str(), &status) == 0 ? status.st_ino : 0;
}

}  // namespace

double CardMemory::volts(std::size_t output) const {
  constexpr double kMost = 10;  // [V]
  const double share = static_cast<double>(samples[output].load()) / kFullSample;
  return ranges[output].load() == kSymmetric ? kMost * (2 * share - 1) : kMost * share;
}

std::uint32_t CardMemory::count(std::size_t counter, double now) const {
  const double since = std::clamp(now - turned_at, 0.0, kLongestStep);
  const auto whole =
      static_cast<std::int64_t>(std::floor(turned[counter] + rates[counter] * since));
  return static_cast<std::uint32_t>(whole) & kFullCount;
}

void CardMemory::set_line(std::uint32_t line, bool high, double now) {
  const std::uint32_t bit = 1U << line;
  const std::uint32_t before = high ? levels.fetch_or(bit) : levels.fetch_and(~bit);
  if (line != kRelayLine || ((before & bit) != 0) == high) return;
  relay_changed_at = now;
  ++relay_changes;
}

void CardMemory::reset() {
  for (auto& sample : samples) sample = kZeroSample;
  for (auto& range : ranges) range = kSymmetric;
  directions = levels = relay_changes = 0;
}

CardFile::CardFile(fs::path path, const CardChannels& channels)
    : path_(std::move(path)), made_(true) {
  if (fs::exists(path_)) {
    const CardFile former(path_);  // throws for a file that is no card, which must not be replaced
    if (has_maker(path_)) {
      throw std::runtime_error(path_.string() +
                               " is the card of another emulator that runs: end it first, or "
                               "choose another place.");
    }
    former.memory().gone = 1;  // left over by an emulator that was killed
  }
  // Made under another name first, so that a program that opens the card finds it complete.
  const fs::path making = path_.string() + ".new";
  const int file = ::open(making.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  if (file < 0 || ::ftruncate(file, sizeof(CardMemory)) != 0) fail(path_, "cannot be made");
  map(file);
  kept_ = file;
  struct flock whole = kWholeFile;
  ::fcntl(kept_, F_OFD_SETLK, &whole);
  memory_ = ::new (memory_) CardMemory;
  memory_->channels = channels;
  if (::rename(making.c_str(), path_.c_str()) != 0) fail(path_, "cannot be made");
  inode_ = inode_of(path_);
}

CardFile::CardFile(fs::path path) : path_(std::move(path)) {
  const int file = ::open(path_.c_str(), O_RDWR | O_CLOEXEC);
  struct stat status {};
  if (file < 0 || ::fstat(file, &status) != 0) fail(path_, "cannot be opened");
  if (static_cast<std::size_t>(status.st_size) != sizeof(CardMemory)) {
    ::close(file);
    throw std::runtime_error(path_.string() + " is no emulated card.");
  }
  map(file);
  ::close(file);
  if (memory_->magic != CardMemory::kMagic) {
    ::munmap(memory_, sizeof(CardMemory));
    throw std::runtime_error(path_.string() + " is no emulated card.");
  }
}

void CardFile::map(int descriptor) {
  void* const at =
      ::mmap(nullptr, sizeof(CardMemory), PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
  if (at == MAP_FAILED) fail(path_, "cannot be mapped");
  memory_ = static_cast<CardMemory*>(at);
}

CardFile::~CardFile() {
  if (made_) {
    memory_->gone = 1;
    std::error_code ignored;
    if (inode_of(path_) == inode_) fs::remove(path_, ignored);  // not another program's file
  }
  ::munmap(memory_, sizeof(CardMemory));
  if (kept_ >= 0) ::close(kept_);
}

}  // namespace drivers::emulators
