// server/foxglove/embed_schemas.mjs: writes a C++ file with the documents the server hands out: the
// published Foxglove schemas (from npm), the frame's binary schema, and the API's description.
//
// node embed_schemas.mjs WEB_FOLDER TELEMETRY_BFBS OPENAPI_JSON OUTPUT_CPP
import { readFileSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join, resolve } from "node:path";

const NAMES = ["LaserScan", "FrameTransforms", "Odometry", "SceneUpdate", "PoseInFrame", "PosesInFrame", "Log"];

const [webFolder, bfbsPath, openapiPath, outputPath] = process.argv.slice(2);
if (!outputPath) {
  console.error("usage: embed_schemas.mjs WEB_FOLDER TELEMETRY_BFBS OPENAPI_JSON OUTPUT_CPP");
  process.exit(1);
}
const require = createRequire(join(resolve(webFolder), "package.json"));
const schemas = require("@foxglove/schemas/jsonschema");

// A string literal may be 64 kB at most in strict C++: cut, and let the compiler join the pieces.
function literal(text) {
  const pieces = [];
  for (let i = 0; i < text.length; i += 8000) {
    pieces.push(JSON.stringify(text.slice(i, i + 8000)).replace(/\?\?/g, "?\\?"));
  }
  return pieces.join("\n     ");
}

const rows = NAMES.map((name) => {
  const schema = schemas[name];
  if (!schema) throw new Error(`@foxglove/schemas has no ${name}`);
  return `    {"foxglove.${name}",\n     ${literal(JSON.stringify(schema))}},`;
});
const bfbs = readFileSync(bfbsPath).toString("base64");
const openapi = JSON.stringify(JSON.parse(readFileSync(openapiPath, "utf8")));

writeFileSync(outputPath, `// Made by server/foxglove/embed_schemas.mjs.
#include "server/foxglove/embedded_schemas.hpp"

#include <array>

namespace server {

std::string_view foxglove_schema(std::string_view name) {
  struct Row {
    std::string_view name;
    std::string_view schema;
  };
  static constexpr auto kRows = std::to_array<Row>({
${rows.join("\n")}
  });
  for (const Row& row : kRows) {
    if (row.name == name) return row.schema;
  }
  return {};
}

std::string_view telemetry_bfbs_base64() {
  return
     ${literal(bfbs)};
}

std::string_view embedded_openapi() {
  return
     ${literal(openapi)};
}

}  // namespace server
`);
