# Writes OUTPUT: FILE's text as the function server::NAME(), which HEADER declares (cmake -P).
file(READ ${FILE} text)
file(WRITE ${OUTPUT}
"// Made by server/embed_text.cmake.
#include \"${HEADER}\"

std::string_view server::${NAME}() { return R\"text(${text})text\"; }
")
