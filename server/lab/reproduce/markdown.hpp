// server/lab/reproduce/markdown.hpp: docs/reproduction.md as separate sections.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "server/lab/reproduce/report.hpp"
#include "server/lab/reproduce/sweeps.hpp"

namespace server::reproduce {

/// A heading and its text. A further study adds its own section to the list.
struct Section {
  std::string title{};
  std::string body{};  // Markdown, ends with a line feed
};

/// The sections: conditions, claims, both tables, limits, differences. Pictures are linked as
/// `pictures`/NAME.svg.
std::vector<Section> study_sections(const StudyFile& file,
                                    const Study& study,
                                    const std::string& pictures);
Section sweeps_section(std::span<const Sweep> sweeps, std::size_t seeds);

/// The whole document.
std::string to_markdown(std::span<const Section> sections);

/// Writes the document to `path` and the pictures beside it in pictures/reproduction/. Throws
/// std::runtime_error with the path that cannot be written.
void write_reproduction(const std::string& path,
                        const StudyFile& file,
                        const Study& study,
                        std::span<const Section> sections);

/// The pictures' folder of write_reproduction(), relative to the document's folder.
constexpr const char* kPictures = "pictures/reproduction";

}  // namespace server::reproduce
