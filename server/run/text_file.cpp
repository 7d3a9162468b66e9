// server/run/text_file.cpp: checks each stream for errors up to its end.
#include "server/run/text_file.hpp"

#include <cerrno>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <system_error>

namespace server {

namespace {

[[noreturn]] void refuse_to_write(const std::filesystem::path& file) {
  const std::string why = std::generic_category().message(errno);
  throw std::runtime_error(file.string() + ": cannot be written: " + why);
}

}  // namespace

std::string read_text(const std::filesystem::path& file) {
  std::error_code missing;
  if (std::filesystem::is_directory(file, missing)) {
    throw std::runtime_error(file.string() + ": is a folder, not a file");
  }
  std::ifstream in(file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  if (!in.is_open() || in.bad()) throw std::runtime_error(file.string() + ": cannot be read");
  return text;
}

void write_text(const std::filesystem::path& file, std::string_view text) {
  std::ofstream out(file, std::ios::binary);
  out << text;
  if (!out.flush()) refuse_to_write(file);
}

void replace_text(const std::filesystem::path& file, std::string_view text) {
  std::filesystem::path draft = file;
  draft += ".new";
  write_text(draft, text);
  if (std::rename(draft.c_str(), file.c_str()) != 0) refuse_to_write(file);
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw std::runtime_error(folder.string() + ": " + error.message());
}

}  // namespace server
