// The page's own thread: it holds the canvas, hears the user, and starts the workers. The program runs in
// one of them (worker.js) and may wait there; nothing here ever does.

import { answerQuestion, handOut, notePaste } from "./files.js";
import { showFigure } from "./figure.js";
import { listen } from "./input.js";

const welcome = document.getElementById("welcome");
const progress = document.getElementById("progress");
const note = document.getElementById("note");

/** Shows a sentence instead of the program. */
function refuse(sentence) {
  welcome.hidden = false;
  progress.hidden = true;
  note.textContent = sentence;
}

/**
 * Threads share memory only in a page that is isolated from others. A server says so by two headers
 * (docs/INSTALL.md); where it does not, a service worker of the page adds them, and the page is loaded again.
 * Returns whether it goes on now.
 */
async function isIsolated() {
  if (crossOriginIsolated) {
    return true;
  }
  const tried = sessionStorage.getItem("isolated");
  if (!navigator.serviceWorker || tried) {
    refuse("This browser does not let the page use threads. A newer one does, over https.");
    return false;
  }
  sessionStorage.setItem("isolated", "tried");
  await navigator.serviceWorker.register("isolate.js");
  await navigator.serviceWorker.ready;
  location.reload();
  return false;
}

/** The workers that are started before the program asks for them, besides those that paint. */
const AHEAD = 3;

/** Workers that wait for what they are: starting one takes as long as a frame or more. */
class Workers {
  #idle = [];

  constructor(count) {
    this.#idle = Array.from({ length: count }, () => new Worker("worker.js", { type: "module" }));
  }

  take() {
    return this.#idle.shift() ?? new Worker("worker.js", { type: "module" });
  }
}

/** Shows how much of a response has come. */
async function showProgress(response) {
  const total = Number(response.headers.get("content-length"));
  const reader = response.body.getReader();
  let loaded = 0;
  for (let part = await reader.read(); !part.done; part = await reader.read()) {
    loaded += part.value.byteLength;
    if (total > 0 && loaded <= total) {
      progress.max = total;
      progress.value = loaded;
    }
  }
}

/**
 * Compiles the program while it is loaded. Of the response itself, not of a copy, the browser keeps what
 * it has compiled for the next visit.
 */
async function compiled() {
  const response = await fetch("rilievo_bg.wasm");
  if (!response.ok) {
    throw new Error(`rilievo_bg.wasm: ${response.status} ${response.statusText}`);
  }
  showProgress(response.clone()).catch(() => {});
  const type = "application/wasm";
  if (response.headers.get("content-type") === type) {
    return WebAssembly.compileStreaming(response);
  }
  return WebAssembly.compileStreaming(new Response(response.body, { headers: { "content-type": type } }));
}

/** A number for this page that no other open one has: it is held as a lock, so that others know it lives. */
function pageId() {
  const id = crypto.getRandomValues(new Uint32Array(1))[0] >>> 1;
  navigator.locks?.request(`rilievo-${id}`, () => new Promise(() => {}));
  return id;
}

async function livingPages() {
  const held = (await navigator.locks?.query())?.held ?? [];
  return held.map(({ name }) => /^rilievo-(\d+)$/.exec(name)?.[1]).filter(Boolean);
}

/** What the worker of stored files holds: a list of [path, bytes]. */
function storedFiles(storage, living) {
  return new Promise((resolve) => {
    storage.onmessage = ({ data }) => resolve(data);
    storage.postMessage({ kind: "load", living });
  });
}

async function fetched(address) {
  const response = await fetch(address);
  if (!response.ok) {
    throw new Error(`${address}: ${response.status} ${response.statusText}`);
  }
  return new Uint8Array(await response.arrayBuffer());
}

/** What a recipe or a script names that looks like a file. */
const FILE = /"([^"]+\.(?:png|jpe?g|webp|tiff?|exr|hdr|bmp|tga|svg|json|ora|psd|obj|ttf|otf|cube|gpl))"/gi;

/**
 * The files that a document names, from beside it or from beside the page, and those that recipes among
 * them name: a list of [path, bytes].
 */
async function filesNamedIn(address, bytes, path, known = new Set([path])) {
  const named = new TextDecoder().decode(bytes).matchAll(FILE);
  const files = [...named].map(async ([, name]) => {
    const own = new URL(name, `file://${path}`).pathname;
    if (known.has(own)) {
      return [];
    }
    known.add(own);
    for (const at of [address, location].map((base) => new URL(name, base))) {
      const found = await fetched(at.href).catch(() => null);
      if (found) {
        return [[own, found], ...(/\.json$/i.test(name) ? await filesNamedIn(at, found, own, known) : [])];
      }
    }
    return [];
  });
  return (await Promise.all(files)).flat();
}

/** The document that the address names, `?open=URL`, and after it the files that it names itself. */
async function namedFiles() {
  const named = new URLSearchParams(location.search).get("open");
  if (!named) {
    return [];
  }
  const address = new URL(named, location);
  const name = decodeURIComponent(address.pathname.split("/").pop()) || "document";
  const [path, bytes] = [`/documents/${name}`, await fetched(address)];
  const others = /\.jsonl?$/.test(name) ? await filesNamedIn(address, bytes, path) : [];
  return [[path, bytes], ...others];
}

async function start() {
  if (!(await isIsolated())) {
    return;
  }
  const canvas = document.getElementById("canvas");
  const asked = new URLSearchParams(location.hash.slice(1));
  const threads = Number(asked.get("threads")) || Math.max(1, Math.min(navigator.hardwareConcurrency || 2, 8));
  const id = pageId();
  const storage = new Worker("storage.js", { type: "module" });
  const workers = new Workers(1 + threads + AHEAD);
  const [module, stored, opened] = await Promise.all([
    compiled(),
    livingPages().then((living) => storedFiles(storage, living)),
    namedFiles(),
  ]);
  let memory;
  const thread = () => {
    const worker = workers.take();
    worker.onmessage = hear;
    worker.onerror = fail;
    worker.postMessage({ kind: "thread", module, memory, id });
  };
  const program = workers.take();
  const tell = (message, transfer = []) => program.postMessage(message, transfer);
  const told = {
    memory: (data) => (memory = data.memory),
    thread,
    painted: () => {
      welcome.hidden = true;
      document.body.dataset.state = "ready";
    },
    store: (data) => storage.postMessage(data, [data.bytes.buffer]),
    rename: (data) => storage.postMessage(data),
    remove: (data) => storage.postMessage(data),
    handOut: (data) => handOut(data.path, data.bytes),
    ask: async (data) => {
      const { text, bytes } = await answerQuestion(data);
      if (data.number) {
        tell({ kind: "answer", number: data.number, text, bytes: bytes ?? new Uint8Array() });
      }
    },
    cursor: (data) => (canvas.style.cursor = data.name),
    title: (data) => (document.title = data.title),
    address: (data) => window.open(data.address, "_blank", "noopener"),
    editText: (data) => input.editText(data),
    endText: () => input.endText(),
    failed: (data) => refuse(data.sentence),
  };
  const hear = ({ data }) => told[data.kind](data);
  const fail = (event) => refuse(`The program has stopped: ${event.message}. What you drew comes back when the page is loaded again.`);
  program.onmessage = hear;
  program.onerror = fail;
  const input = listen(canvas, document.getElementById("typed"), tell, notePaste);
  const offscreen = canvas.transferControlToOffscreen();
  const sample = asked.get("sample") ?? "";
  const isMac = /Mac|iPhone|iPad/.test(navigator.platform);
  const files = [...stored, ...opened];
  tell(
    { kind: "start", module, canvas: offscreen, id, threads, isMac, files, open: opened.slice(0, 1).map(([path]) => path), sample },
    [offscreen, ...files.map(([, bytes]) => bytes.buffer)],
  );
  input.resize();
  canvas.focus();
}

showFigure(document.getElementById("figure")).catch((error) => console.warn(error));
start().catch((error) => refuse(`Rilievo cannot start here: ${error.message}.`));
