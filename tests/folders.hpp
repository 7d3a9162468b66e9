// tests/folders.hpp: the folders of test data. In a small library, since a path on every command
// line would keep ccache from sharing objects between two clones.
#pragma once

#include <filesystem>

namespace tests {

/// tests/ of the clone that was built.
std::filesystem::path folder();

/// The large recordings beside the repository: laser/, barn/, people/. May be missing.
std::filesystem::path shared_data();

/// The emulated libcomedi of this build.
std::filesystem::path emulated_comedi();

}  // namespace tests
