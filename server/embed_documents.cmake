# Writes OUTPUT: the scenarios in WORLDS, the OPENAPI document and the PAPER's scenarios as string
# literals (cmake -P).
file(GLOB paths ${WORLDS}/*.json)
list(SORT paths)
list(FILTER paths EXCLUDE REGEX "/demo\\.json$")
list(PREPEND paths ${WORLDS}/demo.json)
set(entries "")
foreach(path ${paths})
  get_filename_component(name ${path} NAME_WE)
  file(READ ${path} json)
  string(APPEND entries "    {\"${name}\", R\"world(${json})world\"},\n")
endforeach()
file(READ ${OPENAPI} openapi)
file(READ ${PAPER} paper)
file(WRITE ${OUTPUT}
"// Made by server/embed_documents.cmake.
#include \"server/embedded_documents.hpp\"

#include <array>

namespace server {

std::span<const EmbeddedWorld> embedded_worlds() {
  static constexpr auto kWorlds = std::to_array<EmbeddedWorld>({
${entries}  });
  return kWorlds;
}

std::string_view embedded_openapi() { return R\"api(${openapi})api\"; }

std::string_view embedded_paper() { return R\"paper(${paper})paper\"; }

}  // namespace server
")
