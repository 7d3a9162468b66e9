# Writes OUTPUT: the scenarios in WORLDS as string literals, the demo first (cmake -P).
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
file(WRITE ${OUTPUT}
"// Made by server/run/embed_worlds.cmake.
#include \"server/run/embedded_worlds.hpp\"

#include <array>

namespace server {

std::span<const EmbeddedWorld> embedded_worlds() {
  static constexpr auto kWorlds = std::to_array<EmbeddedWorld>({
${entries}  });
  return kWorlds;
}

}  // namespace server
")
