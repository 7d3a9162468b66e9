// web/src/ui/lazy.tsx: parts of the page that are fetched when they are first shown.
import { ComponentType, JSX, createElement } from "preact";
import { useEffect } from "preact/hooks";
import { use_redraw } from "../state/store";
import { use_problem } from "./controls";

/** A component whose code `load` fetches. */
export function lazy<P extends object>(load: () => Promise<ComponentType<P>>): ComponentType<P> {
  let ready: ComponentType<P> | null = null;
  return function Lazy(props: P): JSX.Element | null {
    const redraw = use_redraw();
    const [problem, attempt] = use_problem();
    useEffect(() => {
      if (!ready) void attempt(async () => {
        ready = await load();
        redraw();
      });
    }, []);
    if (ready) return createElement(ready, props);
    // A server that was updated has other parts than this page asks for.
    return problem === null ? null : (
      <p class="problem" role="alert">This part of the page could not be fetched.
        <button class="text" onClick={() => location.reload()}>Load the page again</button></p>
    );
  };
}
