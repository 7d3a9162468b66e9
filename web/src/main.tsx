// web/src/main.tsx: puts the page together and starts the link.
import "uplot/dist/uPlot.min.css";
import "./style/tokens.css";
import "./style/layout.css";
import "./style/controls.css";
import "./style/scene.css";
import "./style/layers.css";
import "./style/runs.css";
import "./style/hardware.css";
import "./style/narrow.css";
import { JSX, render } from "preact";
import { App, AppContext, use_app, use_ui } from "./app";
import { use_listener, use_store } from "./state/store";
import { Drive } from "./views/drive";
import { SessionGone } from "./views/gone";
import { stop_key, typing } from "./views/keys";
import { HardwareBar } from "./views/hardware";
import { Login } from "./views/login";
import { Rail } from "./views/rail";
import { Runs } from "./views/runs";
import { Shortcuts } from "./views/shortcuts";
import { System } from "./views/system";
import { StopAlarm } from "./views/stop";
import { Spoken, Toasts } from "./views/toasts";
import { TopBar } from "./views/topbar";

function Shell(): JSX.Element {
  const app = use_app();
  const { view, shortcuts, locked } = use_ui("view", "shortcuts", "locked");
  const hardware = use_store(app.ui, (u) => u.session?.source === "hardware");
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
      <HardwareBar />
      {view === "drive" && <Drive />}
      {view === "runs" && <Runs />}
      {view === "system" && <System />}
      <SessionGone />
      <StopAlarm />
      <Toasts />
      <Spoken />
      {shortcuts && <Shortcuts />}
      {locked && <Login />}
    </div>
  );
}

const app = new App();
app.start();
render(<AppContext.Provider value={app}><Shell /></AppContext.Provider>,
  document.getElementById("app")!);
