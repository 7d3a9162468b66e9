// tests/fuzz/replay_main.cpp: runs a fuzz target over its seeds and over seeded mutations of them,
// for compilers without libFuzzer and for the quick pass of every test run.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr int kMutations = 3000;

std::vector<Bytes> read_seeds(int count, char** folders) {
  std::vector<std::filesystem::path> files;
  for (int i = 0; i < count; ++i) {
    for (const auto& entry : std::filesystem::directory_iterator(folders[i])) {
      if (entry.is_regular_file()) files.push_back(entry.path());
    }
  }
  std::ranges::sort(files);  // the same mutations on every machine
  std::vector<Bytes> seeds;
  seeds.reserve(files.size());
  for (const auto& file : files) {
    std::ifstream in(file, std::ios::binary);
    seeds.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  }
  return seeds;
}

/// Cuts, repeats, joins and overwrites inputs, like a damaged file or a faulty client.
Bytes mutate(const std::vector<Bytes>& seeds, std::mt19937_64& random) {
  Bytes bytes = seeds[random() % seeds.size()];
  const auto somewhere = [&] { return static_cast<std::ptrdiff_t>(random() % (bytes.size() + 1)); };
  switch (random() % 5) {
    case 0:
      bytes.resize(static_cast<std::size_t>(somewhere()));
      break;
    case 1: {
      const Bytes& other = seeds[random() % seeds.size()];
      bytes.resize(static_cast<std::size_t>(somewhere()));
      bytes.insert(bytes.end(), other.begin(), other.end());
      break;
    }
    case 2: {
      const Bytes copy(bytes.begin() + somewhere(), bytes.end());
      bytes.insert(bytes.begin() + somewhere(), copy.begin(), copy.end());
      break;
    }
    default:
      break;
  }
  for (std::uint64_t hits = random() % 8; hits > 0 && !bytes.empty(); --hits) {
    constexpr std::uint8_t kTelling[] = {0x00, 0x01, 0x7F, 0x80, 0xFF, '0', '-', '"'};
    const bool telling = random() % 2 == 0;
    bytes[random() % bytes.size()] =
        telling ? kTelling[random() % std::size(kTelling)] : static_cast<std::uint8_t>(random());
  }
  return bytes;
}

int replay(int count, char** folders) {
  const std::vector<Bytes> seeds = read_seeds(count, folders);
  if (seeds.empty()) {
    std::fputs("no seeds in the folders given\n", stderr);
    return 1;
  }
  for (const Bytes& seed : seeds) LLVMFuzzerTestOneInput(seed.data(), seed.size());
  std::mt19937_64 random(1);
  for (int i = 0; i < kMutations; ++i) {
    const Bytes bytes = mutate(seeds, random);
    LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
  }
  std::printf("%zu seeds and %d mutations\n", seeds.size(), kMutations);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return replay(argc - 1, argv + 1);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
