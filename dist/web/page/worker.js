// A worker: the program with its window, or one of its threads.

import init, { Program, answer, putFile, runTasks } from "./rilievo.js";

/** A copy that can be sent: the program's memory is shared, and goes on changing. */
const copy = (bytes) => new Uint8Array(bytes);

function send(message, bytes) {
  const copied = bytes && copy(bytes);
  self.postMessage(copied ? { ...message, bytes: copied } : message, copied ? [copied.buffer] : []);
}

let id = 0;

/** What the program calls; `src/io/platform/web/host.rs` and `src/web/page.rs` declare it. */
self.host = {
  startThread: () => send({ kind: "thread" }),
  store: (path, from, bytes) => send({ kind: "store", path, from }, bytes),
  rename: (from, to) => send({ kind: "rename", from, to }),
  remove: (path) => send({ kind: "remove", path }),
  handOut: (path, bytes) => send({ kind: "handOut", path }, bytes),
  ask: (number, question, details, bytes) => send({ kind: "ask", number, question, details }, bytes),
  locale: () => navigator.language ?? "",
  pageId: () => id,
  setCursor: (name) => send({ kind: "cursor", name }),
  setTitle: (title) => send({ kind: "title", title }),
  openAddress: (address) => send({ kind: "address", address }),
  editText: (x, y, width, height) => send({ kind: "editText", x, y, width, height }),
  endText: () => send({ kind: "endText" }),
};

let program;
let isShown = false;

function paint(now) {
  const isPainted = program.tryFrame(now);
  if (isPainted && !isShown) {
    isShown = true;
    send({ kind: "painted" });
  }
  requestAnimationFrame(paint);
}

const doing = {
  async start({ module, canvas, threads, isMac, files, open, sample, ...rest }) {
    id = rest.id;
    const exports = await init({ module_or_path: module });
    send({ kind: "memory", memory: exports.memory });
    files.forEach(([path, bytes]) => putFile(path, bytes));
    try {
      program = new Program(canvas, threads, isMac, open, sample);
    } catch (error) {
      return send({ kind: "failed", sentence: String(error) });
    }
    waiting.splice(0).forEach(take);
    requestAnimationFrame(paint);
  },
  async thread({ module, memory, ...rest }) {
    id = rest.id;
    await init({ module_or_path: module, memory });
    runTasks();
  },
  answer: ({ number, text, bytes }) => answer(number, text, bytes),
  drop({ files, names, x, y }) {
    files.forEach(([path, bytes]) => putFile(path, bytes));
    program.drop(names, x, y);
  },
};

/** What came before the program could take it. */
const waiting = [];

function take(data) {
  if (doing[data.kind]) {
    return doing[data.kind](data);
  }
  program[data.kind](...data.args);
}

self.onmessage = ({ data }) => {
  const isEarly = !program && data.kind !== "start" && data.kind !== "thread";
  return isEarly ? waiting.push(data) : take(data);
};
