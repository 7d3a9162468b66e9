// server/run/library_files.hpp: what libraries of named documents share: names, files, complaints.
#pragma once

#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace server {

/// A document that is not there, may not be changed, or does not read. what() is a sentence.
class LibraryError : public std::runtime_error {
 public:
  enum class Kind { NotFound, Builtin, BadName, Unreadable };
  LibraryError(Kind kind, const std::string& sentence)
      : std::runtime_error(sentence), kind_(kind) {}
  Kind kind() const { return kind_; }

 private:
  Kind kind_;
};

/// Whether `name` may name a document: [a-z0-9_-], 1 to 64 characters.
bool valid_name(std::string_view name);

/// Whether a person who typed `text` means a file: there is one, or it looks like a path.
bool names_file(const std::string& text);

/// @param shown  the file as it is named to people: visitors need not know where it lies
/// Throws LibraryError.
std::string read_file(const std::filesystem::path& path, const std::string& shown);

/// Files of `folder` whose stem is a valid name, in order; none where there is no folder.
void for_each_file(const std::filesystem::path& folder,
                   const char* extension,
                   const std::function<void(const std::filesystem::path&)>& visit);

}  // namespace server
