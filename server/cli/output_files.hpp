// server/cli/output_files.hpp: checks of the files that a command will write, before its work.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace server {

/// A check for an output path, which refuses at once, and not after minutes of work, a folder and a
/// file that cannot be written. It leaves no file behind and changes none.
std::string refuse_unwritable(const std::string& path);

/// The same for a file whose missing folders its command makes.
std::string refuse_unwritable_document(const std::string& path);

/// A file of a command, with the words for it in messages, such as its option. An empty path: not
/// given.
struct NamedFile {
  std::string name{};
  std::filesystem::path path{};
};

/// Throws std::runtime_error if an output would overwrite an input or another output.
void refuse_shared_files(const std::vector<NamedFile>& inputs,
                         const std::vector<NamedFile>& outputs);

}  // namespace server
