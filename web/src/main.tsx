// web/src/main.tsx: puts the page together and starts the link.
import "./style/tokens.css";
import "./style/layout.css";
import "./style/controls.css";
import "./style/scene.css";
import "./style/names.css";
import "./style/stop.css";
import "./style/timeline.css";
import "./style/people.css";
import "./style/narrow.css";
import "./style/short.css";
import { JSX, render } from "preact";
import { useState } from "preact/hooks";
import { App, AppContext, use_app, use_ui } from "./app";
import { use_listener, use_store } from "./state/store";
import { lazy } from "./ui/lazy";
import { Drive } from "./views/drive";
import { Nowhere, SessionGone } from "./views/gone";
import { stop_key, typing } from "./views/keys";
import { Tips } from "./ui/tip";
import { Rail } from "./views/rail";
import { StopAlarm } from "./views/stop";
import { Spoken, Toasts } from "./views/toasts";
import { TopBar } from "./views/topbar";

// What Drive can do without at first.
const Teleop = lazy(async () => (await import("./teleop/teleop")).Teleop);
const Runs = lazy(async () => (await import("./views/runs")).Runs);
const Experiments = lazy(async () => (await import("./experiments/experiments")).Experiments);
const System = lazy(async () => (await import("./views/system")).System);

const HardwareBar = lazy(async () => (await import("./views/hardware")).HardwareBar);
const Login = lazy(async () => (await import("./views/login")).Login);
const Dropped = lazy(async () => (await import("./views/world")).Dropped); // a part that there is anyway
const Shortcuts = lazy(async () => (await import("./views/shortcuts")).Shortcuts);

function Shell(): JSX.Element {
  const app = use_app();
  const { view, shortcuts, locked } = use_ui("view", "shortcuts", "locked");
  const hardware = use_store(app.ui, (u) => u.session?.source === "hardware");
  const [dragged, set_dragged] = useState(false);
  const hold = (e: DragEvent) => { // a browser left to itself opens a dropped file in place of the page
    if (!e.dataTransfer?.types.includes("Files")) return;
    e.preventDefault();
    set_dragged(true);
  };
  use_listener("dragover", hold);
  use_listener("drop", hold);
  use_listener("keydown", (e) => stop_key(app, e), true);
  use_listener("keyup", (e) => stop_key(app, e), true);
  use_listener("keydown", (e) => {
    if (e.key !== "?" || typing(e.target)) return;
    e.preventDefault();
    app.ui.set({ shortcuts: !shortcuts });
  });
  return (
    <div class={`shell view-${view} ${hardware ? "real" : ""}`}>
      <TopBar />
      <Rail />
      {hardware && <HardwareBar />}
      {view === "drive" && <Drive />}
      {view === "teleop" && <Teleop />}
      {view === "runs" && <Runs />}
      {view === "experiments" && <Experiments />}
      {view === "system" && <System />}
      {view === "nowhere" && <Nowhere />}
      <SessionGone />
      <StopAlarm />
      <Toasts />
      <Spoken />
      <Tips />
      {dragged && <Dropped />}
      {shortcuts && <Shortcuts />}
      {locked && <Login />}
    </div>
  );
}

const app = new App();
app.start();
render(<AppContext.Provider value={app}><Shell /></AppContext.Provider>,
  document.getElementById("app")!);
