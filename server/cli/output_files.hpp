// server/cli/output_files.hpp: checks of the files that a command will write, before its work.
#pragma once

#include <string>

namespace server {

/// A check for an output path, which refuses at once, and not after minutes of work, a folder and a
/// file that cannot be written. It leaves no file behind and changes none.
std::string refuse_unwritable(const std::string& path);

/// The same for a file whose missing folders its command makes.
std::string refuse_unwritable_document(const std::string& path);

}  // namespace server
