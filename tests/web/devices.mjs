// tests/web/devices.mjs: an emulated scanner and base for the browser tests.
import { spawn } from "node:child_process";
import { existsSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { binary, until } from "./program.mjs";

/**
 * The devices on pseudo-terminals in `folder`, in the world `scenario`, and the robot's file beside them; with `named`
 * the file says that they are emulated. `record`: a file for the true poses. `speed` [m/s] of the robot at most.
 */
export async function devices(folder, { named = false, scenario = "demo", record = "", speed = 0.1 } = {}) {
  const emulator = spawn(binary,
    ["emulate", "robot", "--scenario", scenario, "--links", folder, ...(record ? ["--record", record] : [])],
    { stdio: ["pipe", "ignore", "inherit"] });
  const there = () => existsSync(join(folder, "scanner")) && existsSync(join(folder, "base"));
  await until("the emulated devices", 20, async () => there(), (yes) => yes);
  const file = join(folder, "robot.toml");
  writeFileSync(file, `name = "emulated"
emulated = ${named}
period = 0.026
[hull]
radius = 0.35
[limits]
speed = ${speed}
[[laser]]
name = "front laser"
port = "${folder}/scanner"
rate = 500000
[base]
type = "roboteq"
port = "${folder}/base"
track = 0.5
watchdog = 0.5
wheel_radius = 0.1
gear = 20
encoder_lines = 500
full_speed_rpm = 1000
`);
  return { file, tell: (line) => emulator.stdin.write(`${line}\n`), end: () => emulator.kill() };
}

/**
 * Arms the robot by the page `p` as a person does: where a moment refused, such as a late scan, they press again.
 * `session` asks the server.
 */
export async function arm(p, session) {
  const press = async () => {
    const at_rest = (await p.get("arm").getAttribute("aria-pressed")) === "false";
    if (at_rest) await p.get("arm").click();
    await p.page.waitForTimeout(1000);
    return session();
  };
  await until("armed", 20, press, (s) => s.hardware.armed);
}
