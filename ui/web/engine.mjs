// A worker that computes, one request after the other. One that takes too long, or fails, is ended
// and begun anew.

const PATIENCE = 300; // that a run goes on for where a newer one is waiting [ms]

// startWorker() returns a worker; a request may take `limit` seconds.
export function createEngine(startWorker, limit) {
  let worker = null;
  let current = null;
  let waiting = [];
  let number = 0;

  function settle(act) {
    const done = current;
    clearTimeout(done.timer);
    current = null;
    act(done);
    next();
  }

  function endWorker() {
    worker?.terminate();
    worker = null;
  }

  function take({ data }) {
    if (current === null || data.number !== current.request.number) {
      return;
    }
    if (data.part !== undefined) {
      current.progress?.(data.part);
    } else if (data.failure !== undefined) {
      endWorker();
      settle((done) => done.reject(new Error(data.failure)));
    } else {
      settle((done) => done.resolve(data.answer));
    }
  }

  function next() {
    if (current !== null || waiting.length === 0) {
      return;
    }
    if (worker === null) {
      worker = startWorker();
      worker.onmessage = take;
      worker.onerror = (event) => {
        endWorker();
        const why = event.message || "the worker cannot be started";
        if (current !== null) {
          settle((done) => done.reject(new Error(why)));
        }
      };
    }
    current = waiting.shift();
    current.since = performance.now();
    current.timer = setTimeout(() => {
      endWorker();
      settle((done) =>
        done.reject(new Error(`The computation was ended after ${limit} s; ask for less of it.`)),
      );
    }, 1e3 * limit);
    worker.postMessage(current.request);
  }

  // Asks for something; a `newest` request takes the place of those of its kind and path that wait,
  // which come to null, and of one that has been under way for long.
  function ask(request, { newest = false, progress } = {}) {
    return new Promise((resolve, reject) => {
      if (newest) {
        dropOlder(request);
      }
      number += 1;
      waiting.push({ request: { ...request, number }, resolve, reject, progress, newest });
      next();
    });
  }

  function dropOlder({ kind, path }) {
    const isOlder = ({ newest, request }) =>
      newest && request.kind === kind && request.path === path;
    waiting.filter(isOlder).forEach((entry) => entry.resolve(null));
    waiting = waiting.filter((entry) => !isOlder(entry));
    const slow = current;
    if (slow !== null && isOlder(slow)) {
      const rest = Math.max(0, PATIENCE - (performance.now() - slow.since));
      setTimeout(() => {
        if (current === slow) {
          endWorker();
          settle((done) => done.resolve(null));
        }
      }, rest);
    }
  }

  return { ask };
}
