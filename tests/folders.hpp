// tests/folders.hpp: where tests find their data. Functions of one small library: a path on every
// command line would keep ccache from sharing objects between two clones.
#pragma once

#include <filesystem>

namespace tests {

/// This folder, of the clone that was built.
std::filesystem::path folder();

/// The large recordings beside the repository: laser/, barn/, people/. May be missing.
std::filesystem::path shared_data();

/// The emulated libcomedi of this build.
std::filesystem::path emulated_comedi();

}  // namespace tests
