// tests/web/wire.mjs: the page's own decoder of frames for tests that compare the page with the wire.
import { join } from "node:path";
import { repository, require } from "./program.mjs";

/** `decode_frames`, `decode_sweep` and `split_frames` of the page. */
export async function decoder() {
  const built = await require("esbuild").build({
    stdin: {
      contents: 'export { decode_frames, decode_sweep } from "./link/frame"; export { split_frames } from "./link/stored";',
      resolveDir: join(repository, "web/src"), loader: "ts",
    },
    bundle: true, format: "esm", platform: "node", write: false, nodePaths: [join(repository, "web/node_modules")],
  });
  return import(`data:text/javascript;base64,${Buffer.from(built.outputFiles[0].contents).toString("base64")}`);
}

/** The frame of `tick` of a run, and the newest filtered scan up to it. */
export async function frame_of(wire, base, run, tick) {
  const from = Math.max(0, tick - 90); // so far back that the legend of its layers is among them
  const frame = (await frames_of(wire, base, run, from, tick - from + 1)).find((f) => f.tick === tick);
  const filtered = (await messages(wire, base, run, "filtered", from, tick - from + 1)).map(wire.decode_sweep).filter((sweep) => sweep !== null).at(-1);
  return frame && { frame, filtered };
}

export async function frames_of(wire, base, run, from, count) {
  return wire.decode_frames(await messages(wire, base, run, "frames", from, count));
}

async function messages(wire, base, run, what, from, count) {
  const answer = await fetch(`${base}/api/v1/runs/${run}/${what}?from=${from}&limit=${count}`);
  return wire.split_frames(new Uint8Array(await answer.arrayBuffer()));
}
