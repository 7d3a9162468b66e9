// server/experiment/sweep/machine.cpp: reads the processor's name and probes the library.
#include "server/experiment/sweep/machine.hpp"

#include <fstream>
#include <iterator>

#include <fmt/format.h>
#include <gnu/libc-version.h>

#include "server/experiment/arithmetic.hpp"

namespace server::sweep {

std::string processor_in(const std::string& cpuinfo) {
  const std::size_t line = cpuinfo.find("model name");
  const std::size_t colon = cpuinfo.find(": ", line == std::string::npos ? cpuinfo.size() : line);
  if (colon == std::string::npos) return "unknown";
  return cpuinfo.substr(colon + 2, cpuinfo.find('\n', colon) - colon - 2);
}

Machine this_machine() {
  std::ifstream in("/proc/cpuinfo");
  const std::string cpuinfo{std::istreambuf_iterator<char>(in), {}};
  return {processor_in(cpuinfo),
          fmt::format("glibc {}, values {}", gnu_get_libc_version(), experiment::arithmetic())};
}

}  // namespace server::sweep
