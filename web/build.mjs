// web/build.mjs: builds the page into dist/; --wire-only stops after the wire code, --tests runs
// the unit tests of ../tests/web.
import { execFileSync, spawnSync } from "node:child_process";
import { cpSync, mkdirSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { basename, dirname, extname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { brotliCompressSync, constants } from "node:zlib";
import zopfli from "@gfx/zopfli";
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

/** The page reads frames and scans and writes none: it leaves out the code that builds them, and the readers of a message
 * that is any other table. */
const readers_only = {
  name: "readers-only",
  setup: (build) => build.onLoad({ filter: /src\/wire\/tautline\/wire\/.*\.ts$/ }, ({ path }) => ({
    contents: readFileSync(path, "utf8").replace(/^static (?:start|add|create|end|finish|getSizePrefixedRoot|getRootAs(?!Frame|LaserScan))\w+\([^]*?^}\n/gm, ""),
    loader: "ts",
  })),
};

/** `import css from "x.css?text"`: the style sheet as a string. */
const sheets_as_text = {
  name: "sheets-as-text",
  setup: (build) => {
    build.onResolve({ filter: /\.css\?text$/ }, ({ path, resolveDir }) => ({ path: join(resolveDir, path.replace(/\?text$/, "")), namespace: "sheet" }));
    build.onLoad({ filter: /./, namespace: "sheet" }, async ({ path }) => ({
      contents: (await esbuild.transform(readFileSync(path, "utf8"), { loader: "css", minify: true })).code, loader: "text",
    }));
  },
};

async function build_page() {
  const dist = join(root, "dist");
  rmSync(dist, { recursive: true, force: true });
  const { metafile } = await esbuild.build({
    ...shared,
    entryPoints: { app: "src/main.tsx" },
    outdir: dist,
    splitting: true, // three.js comes in its own file, when 3D is first asked for
    entryNames: "[name]-[hash]", // the server lets browsers keep a name with a hash for ever
    chunkNames: "part-[hash]",
    minify: true,
    plugins: [readers_only, sheets_as_text],
    metafile: true,
    legalComments: "linked",
    define: { "process.env.NODE_ENV": '"production"' },
  });
  cpSync(join(root, "static"), dist, { recursive: true });
  name_parts(join(dist, "index.html"), metafile.outputs);
  for (const name of readdirSync(dist)) await compress(join(dist, name));
}

/** Gives index.html the names of this build: of its script, its style, and the parts that the script begins with. */
function name_parts(index, outputs) {
  const [entry, { cssBundle, imports }] = Object.entries(outputs)
    .find(([, output]) => output.entryPoint?.endsWith("main.tsx"));
  const early = imports.filter((part) => part.kind === "import-statement").map((part) =>
    `<link rel="modulepreload" href="/${basename(part.path)}">\n`);
  const html = readFileSync(index, "utf8")
    .replace("/app.css", `/${basename(cssBundle)}`)
    .replace(/<script [^>]*app\.js/, (script) =>
      early.join("") + script.replace("/app.js", `/${basename(entry)}`));
  writeFileSync(index, html);
}

/** Writes NAME.gz and NAME.br beside a text. Browsers take brotli over HTTPS only. */
async function compress(file) {
  if (![".html", ".js", ".css", ".svg"].includes(extname(file))) return;
  const text = readFileSync(file);
  writeFileSync(`${file}.gz`, await zopfli.gzipAsync(text, { numiterations: 5 })); // 4 % smaller than zlib makes them
  writeFileSync(`${file}.br`, brotliCompressSync(text, {
    params: { [constants.BROTLI_PARAM_SIZE_HINT]: text.length },
  }));
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
  const result = spawnSync(process.execPath, ["--enable-source-maps", "--test", "--test-reporter=spec",
    ...built.map((name) => join(out, name))], { stdio: "inherit" });
  process.exitCode = result.status ?? 1;
}

generate_wire();
if (option === "--tests") await run_tests();
else if (option !== "--wire-only") await build_page();
