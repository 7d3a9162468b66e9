// web/build.mjs: builds the page into dist/; --wire-only stops after the wire code, --tests runs
// the unit tests of ../tests/web.
import { execFileSync, spawnSync } from "node:child_process";
import { cpSync, mkdirSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import * as esbuild from "esbuild";

const root = dirname(fileURLToPath(import.meta.url));
const option = process.argv[2] ?? "";

/** The TypeScript side of the wire contract, from the same schema as the C++ side. */
function generate_wire() {
  const out = join(root, "src/wire");
  rmSync(out, { recursive: true, force: true });
  mkdirSync(out, { recursive: true });
  try {
    execFileSync("flatc", ["--ts", "-o", out, join(root, "telemetry.fbs")], { stdio: "inherit" });
  } catch (error) {
    throw new Error(`flatc is needed (Debian package flatbuffers-compiler): ${error.message}`);
  }
  // Generated code has imports it does not use; our own code is held to more.
  for (const name of readdirSync(join(out, "tautline/wire"))) {
    const path = join(out, "tautline/wire", name);
    writeFileSync(path, `// @ts-nocheck\n${readFileSync(path, "utf8")}`);
  }
}

const shared = {
  absWorkingDir: root,
  bundle: true,
  format: "esm",
  target: "es2022",
  jsx: "automatic",
  jsxImportSource: "preact",
  logLevel: "warning",
};

async function build_page() {
  const dist = join(root, "dist");
  rmSync(dist, { recursive: true, force: true });
  await esbuild.build({
    ...shared,
    entryPoints: { app: "src/main.tsx" },
    outdir: dist,
    splitting: true, // three.js comes in its own file, when 3D is first asked for
    chunkNames: "part-[hash]",
    minify: true,
    legalComments: "linked",
    define: { "process.env.NODE_ENV": '"production"' },
  });
  cpSync(join(root, "static"), dist, { recursive: true });
}

async function run_tests() {
  const tests = join(root, "../tests/web");
  const out = join(root, ".test");
  rmSync(out, { recursive: true, force: true });
  const files = readdirSync(tests).filter((name) => /\.test\.tsx?$/.test(name));
  await esbuild.build({
    ...shared,
    entryPoints: files.map((name) => join(tests, name)),
    outdir: out,
    outExtension: { ".js": ".mjs" },
    platform: "node",
    target: "node18",
    nodePaths: [join(root, "node_modules")],
    sourcemap: "inline",
    define: { "process.env.TAUTLINE_TESTS": JSON.stringify(join(root, "../tests")) },
  });
  writeFileSync(join(out, "package.json"), '{"type":"module"}\n');
  const built = readdirSync(out).filter((name) => name.endsWith(".mjs"));
  const result = spawnSync(process.execPath, ["--enable-source-maps", "--test",
    ...built.map((name) => join(out, name))], { stdio: "inherit" });
  process.exitCode = result.status ?? 1;
}

generate_wire();
if (option === "--tests") await run_tests();
else if (option !== "--wire-only") await build_page();
