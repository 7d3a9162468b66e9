// tests/web/image/image.mjs: the main job against a server that is running already, at TAUTLINE_URL.
import { test } from "node:test";
import { main_job } from "../main_job.mjs";
import { launch, open } from "../page.mjs";

test("the main job in the page of the image", { timeout: 240_000 }, async () => {
  const base = process.env.TAUTLINE_URL;
  const browser = await launch();
  try {
    const p = await open(browser, base, {});
    await main_job(p, base, "bullet");
    await p.close();
  } finally {
    await browser.close();
  }
});
