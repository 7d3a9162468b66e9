// server/run/library_files.hpp: names, files and errors that all libraries of named documents
// share.
#pragma once

#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace server {

/// The document does not exist, may not be changed, or cannot be read or kept. what() is a
/// sentence.
class LibraryError : public std::runtime_error {
 public:
  enum class Kind { NotFound, Builtin, BadName, Unreadable, NoRoom };
  LibraryError(Kind kind, const std::string& sentence)
      : std::runtime_error(sentence), kind_(kind) {}
  Kind kind() const { return kind_; }

 private:
  Kind kind_;
};

/// Whether `name` may name a document: [a-z0-9_-], 1 to 64 characters.
bool valid_name(std::string_view name);

/// True if `text` names a file: such a file exists, or it looks like a path.
bool names_file(const std::string& text);

/// @param shown  the file's name in messages, without its folder: visitors need not know that
/// Throws LibraryError.
std::string read_file(const std::filesystem::path& path, const std::string& shown);

/// Visits files of `folder` whose stem is a valid name, sorted; none if the folder does not exist.
void for_each_file(const std::filesystem::path& folder,
                   const char* extension,
                   const std::function<void(const std::filesystem::path&)>& visit);

}  // namespace server
