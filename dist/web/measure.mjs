// Measures the page in headless Chromium: how long it loads, how soon a stroke and a dragged picture are
// seen, how much memory a large document takes. The figures are in docs/notes/performance.md.
//
//   node dist/web/measure.mjs FOLDER
//
// FOLDER is what dist/web/build made. Needs what dist/web/test.mjs needs. Where Chromium has no GPU, painting
// the window takes longer than all else; so nothing is painted while frames are timed.

import { mkdtempSync, readFileSync, readdirSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { gzipSync } from "node:zlib";
import { chromium } from "playwright-core";
import { serve } from "./server.mjs";

const PORT = 8125;
const [folder] = process.argv.slice(2);
const scripts = mkdtempSync(join(tmpdir(), "rilievo-measure-"));

/** Documents of this many px, with so many layers painted on besides the base and a picture. */
function script(name, width, height, layers) {
  const lines = [
    { in: "file", do: "open maps", normal: "sample_normals/muse/normal.png", depth: "sample_normals/muse/depth.png" },
    { in: "canvas", do: "scale", width, height, filter: "smooth" },
    { in: "hand", do: "operator", operator: { kind: "normal", alpha: 0.6, beta: 1 } },
    { in: "file", do: "place", file: "sample_normals/pictures/knit.jpg", at: [width / 2, height / 2] },
    ...Array.from({ length: layers }, () => ({ in: "layer", do: "add", kind: "paint" })),
  ];
  writeFileSync(join(scripts, name), lines.map((line) => JSON.stringify(line)).join("\n"));
}
script("brush.jsonl", 1920, 1080, 1);
script("picture.jsonl", 1920, 1080, 0);
script("large.jsonl", 4096, 4096, 7);

/** In the program's worker, before it starts: notes when the first block of the picture is uploaded. */
function noteFirstBlock() {
  const plain = WebGL2RenderingContext.prototype.texImage2D;
  WebGL2RenderingContext.prototype.texImage2D = function (...args) {
    const [, , , width, height] = args;
    if (width <= 1024 && width * height > 50_000) {
      self.firstBlock ??= performance.timeOrigin + performance.now();
    }
    return plain.apply(this, args);
  };
}
const worker = readFileSync(join(folder, "worker.js"), "utf8");
const marked = worker.replace("program = new Program", "self.isProgram = true;\n      program = new Program");
writeFileSync(join(scripts, "worker.js"), `${marked}\n(${noteFirstBlock})();\n`);

const server = await serve([scripts, folder], PORT);
const launched = () =>
  chromium.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
      .concat(["--disable-background-networking", "--disable-component-update", "--disable-sync"]),
  });

/** Keeps what the program's memory is, to be asked for its size. */
function keepMemory() {
  const Plain = window.Worker;
  window.Worker = class extends Plain {
    constructor(...args) {
      super(...args);
      this.addEventListener("message", ({ data }) => {
        if (data.kind === "memory") {
          window.programMemory = data.memory;
        }
      });
    }
  };
}

/**
 * In the program's worker: notes how long frames take that hand new pixels to the screen, how long others
 * take while the pointer moves, and how long it is from a pointer's event to its pixels. A dab comes only
 * every few events.
 */
function noteTimes() {
  self.figures = { painting: [], others: [], seen: [] };
  let [since, before, isUploaded] = [null, null, false];
  const plain = WebGL2RenderingContext.prototype.texSubImage2D;
  WebGL2RenderingContext.prototype.texSubImage2D = function (...args) {
    const [, , , , width, height] = args;
    // Tiles of the picture, not letters.
    isUploaded ||= width >= 64 && height >= 64;
    return plain.apply(this, args);
  };
  // What a GPU does is not done here: without one it takes longer than the program.
  for (const name of ["drawElements", "clear"]) {
    WebGL2RenderingContext.prototype[name] = () => {};
  }
  const plainFrame = self.requestAnimationFrame.bind(self);
  self.requestAnimationFrame = (frame) =>
    plainFrame((now) => {
      const began = performance.now();
      frame(now);
      const ended = performance.now();
      if (isUploaded) {
        self.figures.painting.push(ended - began);
        self.figures.seen.push(ended - (since ?? before ?? began));
      } else if (since !== null) {
        self.figures.others.push(ended - began);
      }
      [since, before, isUploaded] = [null, since, false];
    });
  const hear = self.onmessage;
  self.onmessage = (event) => {
    if (event.data.kind === "pointer") {
      since ??= performance.now();
    }
    hear(event);
  };
}

async function opened(browser, query) {
  const context = await browser.newContext({ viewport: { width: 1920, height: 1080 } });
  const page = await context.newPage();
  await page.addInitScript(keepMemory);
  const began = Date.now();
  await page.goto(`http://localhost:${PORT}/${query}`);
  await page.waitForSelector("body[data-state=ready]", { timeout: 60_000 });
  const window = Date.now() - began;
  await page.waitForFunction(() => document.title.includes(" – "), null, { timeout: 120_000, polling: 20 });
  const whole = Date.now() - began;
  await page.waitForTimeout(50);
  const program = await programOf(page);
  const block = () => program.evaluate(() => self.firstBlock ?? 0);
  let seen = await block();
  for (; seen === 0; seen = await block()) {
    await page.waitForTimeout(20);
  }
  return { page, context, program, window, whole, seen: Math.round(seen - began) };
}

/** The worker that the program runs in: the one that paints. */
async function programOf(page) {
  for (const worker of page.workers()) {
    // A thread that waits for work never answers.
    const silence = new Promise((resolve) => setTimeout(resolve, 300, false));
    const asked = worker.evaluate(() => self.isProgram === true).catch(() => false);
    if (await Promise.race([asked, silence])) {
      return worker;
    }
  }
  throw new Error("no worker is the program");
}

/** Memory that the browser's processes for the page hold and share with none, MB. */
async function heldMemory(browser) {
  const client = await browser.newBrowserCDPSession();
  const { processInfo } = await client.send("SystemInfo.getProcessInfo");
  const held = processInfo.filter(({ type }) => type === "renderer").map(({ id }) => {
    const lines = readFileSync(`/proc/${id}/smaps_rollup`, "utf8");
    return Number(/^Pss:\s+(\d+)/m.exec(lines)[1]) / 1024;
  });
  return Math.round(Math.max(...held));
}

const at = (sorted, share) => sorted[Math.min(sorted.length - 1, Math.floor(sorted.length * share))] ?? NaN;
const spread = (values) => {
  const sorted = [...values].sort((a, b) => a - b);
  return `${at(sorted, 0.5).toFixed(1)} ms, ninth decile ${at(sorted, 0.9).toFixed(1)} (${sorted.length})`;
};
const megabytes = (page) => page.evaluate(() => Math.round(window.programMemory.buffer.byteLength / 2 ** 20));

/** Drags as a hand does: some thousand px a second, in steps of 8 ms. */
async function drag(page, moves = 240) {
  const began = performance.now();
  const place = (i) => {
    const turn = (i / 600) * 2 * Math.PI;
    return [760 + 260 * Math.sin(3 * turn), 480 + 200 * Math.cos(4 * turn)];
  };
  await page.mouse.move(...place(0));
  await page.mouse.down();
  for (let i = 1; i <= moves; i++) {
    await page.mouse.move(...place(i));
    await page.waitForTimeout(Math.max(0, began + 8 * i - performance.now()));
  }
  await page.mouse.up();
}

/** Drags across a document; `keys` come before. */
async function dragged(browser, name, query, keys) {
  const { page, context, program } = await opened(browser, query);
  await page.waitForTimeout(1500);
  await program.evaluate(noteTimes);
  for (const key of keys) {
    await page.keyboard.press(key);
    await page.waitForTimeout(60);
  }
  await drag(page, 60);
  await page.waitForTimeout(1500);
  await program.evaluate(() => Object.values(self.figures).forEach((list) => list.splice(0)));
  await drag(page);
  await page.waitForTimeout(500);
  const { painting, others, seen } = await program.evaluate(() => self.figures);
  console.log(`${name}: painting ${spread(painting)}, others ${spread(others)}, seen after ${spread(seen)}`);
  await context.close();
}

const first = readdirSync(folder).filter((name) => /\.(wasm|js|css)$|^index\.html$/.test(name));
const sizes = first.map((name) => gzipSync(readFileSync(join(folder, name)), { level: 9 }).length);
console.log(`what is loaded first, compressed: ${(sizes.reduce((a, b) => a + b) / 1e6).toFixed(2)} MB`);

// Each in a browser that has never seen the page, then once more in the same one.
const loads = [];
for (let i = 0; i < Number(process.env.LOADS ?? 5); i++) {
  const browser = await launched();
  const first = await opened(browser, "");
  await first.page.waitForTimeout(6000);
  const megabytesNow = await megabytes(first.page);
  await first.context.close();
  const again = await opened(browser, "");
  loads.push([first, again].map(({ window, whole, seen }) => [window, whole, seen].join(" ")).join(", again "));
  if (i === 0) {
    console.log(`memory with the sample: ${megabytesNow} MB`);
  }
  await browser.close();
}
console.log(`window, document, its pixels: ${loads.join("; ")} ms`);
for (const threads of (process.env.THREADS ?? "1 2").split(" ")) {
  const browser = await launched();
  const larger = Array.from({ length: Number(process.env.LARGER ?? 12) }, () => "BracketRight");
  const on = `#threads=${threads}`;
  await dragged(browser, `brush, gloss, ${threads} threads`, `?open=brush.jsonl${on}`, ["b", "F3", ...larger]);
  await dragged(browser, `brush, flat, ${threads} threads`, `?open=brush.jsonl${on}`, ["b", "F1", ...larger]);
  await dragged(browser, `picture, ${threads} threads`, `?open=picture.jsonl${on}`, ["j"]);
  await browser.close();
}
const browser = await launched();
const { page, context, whole, seen } = await opened(browser, "?open=large.jsonl");
await page.waitForTimeout(4000);
await page.keyboard.press("b");
await drag(page);
await page.waitForTimeout(3000);
const large = `${await megabytes(page)} MB of the program's, ${await heldMemory(browser)} MB of its process`;
console.log(`4096² of ten layers: opened in ${whole} ms, seen after ${seen}, ${large}`);
await page.screenshot({ path: join(scripts, "large.png") });
await context.close();
await browser.close();
server.close();
console.log(`pictures in ${scripts}`);
