// tests/web/slow_link.mjs: a TCP proxy on this machine that delays every byte, keeps their order, and may be cut.
import { connect, createServer } from "node:net";

/** Between a client and `port`. `delay` [ms] each way, `jitter` [ms] more at random. */
export async function slow_link(port, { delay = 0, jitter = 0 } = {}) {
  const link = { delay, jitter, held: null, sockets: new Set() };
  const pipe = (from, to) => {
    let last = Promise.resolve(); // none overtakes the one before
    const pass = (act) => {
      const due = performance.now() + link.delay + Math.random() * link.jitter;
      last = last.then(async () => {
        const rest = due - performance.now();
        if (rest > 0) await new Promise((resolve) => setTimeout(resolve, rest));
        await link.held?.promise;
        act();
      });
    };
    from.on("data", (bytes) => pass(() => !to.destroyed && to.write(bytes)));
    from.on("end", () => pass(() => to.end()));
    from.on("error", () => to.destroy());
    from.on("close", () => link.sockets.delete(from));
    link.sockets.add(from);
  };
  const server = createServer((near) => {
    const far = connect(port, "127.0.0.1");
    near.setNoDelay(true);
    far.setNoDelay(true);
    pipe(near, far);
    pipe(far, near);
  });
  await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
  return {
    base: `http://127.0.0.1:${server.address().port}`,
    /** [ms] there and back, from now on. */
    set_round_trip: (ms, more = 0) => Object.assign(link, { delay: ms / 2, jitter: more / 2 }),
    /** Nothing passes until the returned function is called; nothing is lost, as in an outage of a radio. */
    hold: () => {
      let go;
      link.held = { promise: new Promise((resolve) => (go = resolve)) };
      return () => {
        link.held = null;
        go();
      };
    },
    /** Breaks all connections. */
    cut: () => link.sockets.forEach((socket) => socket.destroy()),
    close: () => {
      link.sockets.forEach((socket) => socket.destroy());
      return new Promise((resolve) => server.close(resolve));
    },
  };
}
