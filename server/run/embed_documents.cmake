# Writes OUTPUT: the documents in sim/worlds and sim/robots as string literals, the demo first (cmake -P).
function(entries_of result folder)
  file(GLOB paths ${SIM}/${folder}/*.json)
  list(SORT paths)
  if(EXISTS ${SIM}/${folder}/demo.json)
    list(FILTER paths EXCLUDE REGEX "/demo\\.json$")
    list(PREPEND paths ${SIM}/${folder}/demo.json)
  endif()
  set(entries "")
  foreach(path ${paths})
    get_filename_component(name ${path} NAME_WE)
    file(READ ${path} json)
    string(APPEND entries "    {\"${name}\", R\"document(${json})document\"},\n")
  endforeach()
  set(${result} "${entries}" PARENT_SCOPE)
endfunction()
entries_of(worlds worlds)
entries_of(robots robots)
file(WRITE ${OUTPUT}
"// Made by server/run/embed_documents.cmake.
#include \"server/run/embedded_documents.hpp\"

#include <array>

namespace server {

std::span<const EmbeddedDocument> embedded_worlds() {
  static constexpr auto kWorlds = std::to_array<EmbeddedDocument>({
${worlds}  });
  return kWorlds;
}

std::span<const EmbeddedDocument> embedded_robots() {
  static constexpr auto kRobots = std::to_array<EmbeddedDocument>({
${robots}  });
  return kRobots;
}

}  // namespace server
")
