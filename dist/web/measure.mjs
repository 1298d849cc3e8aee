// Measures the page in headless Chromium: how long it loads, how soon a stroke and a dragged picture are
// seen, how much memory a large document takes. The figures are in docs/notes/performance.md.
//
//   node dist/web/measure.mjs FOLDER
//
// FOLDER is what dist/web/build made. Needs what dist/web/test.mjs needs. Where Chromium has no GPU, painting
// the window takes longer than all else; so nothing is painted while frames are timed.

import { mkdtempSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
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

const server = await serve([folder, scripts], PORT);
const browser = await chromium.launch({
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

/** In the program's worker: notes how long frames take, and from a pointer's event to its pixels. */
function noteTimes() {
  self.figures = { frames: [], seen: [] };
  let [since, isUploaded] = [null, false];
  for (const name of ["texSubImage2D", "texImage2D"]) {
    const plain = WebGL2RenderingContext.prototype[name];
    WebGL2RenderingContext.prototype[name] = function (...args) {
      isUploaded = true;
      return plain.apply(this, args);
    };
  }
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
      if (ended - began > 0.3) {
        self.figures.frames.push(ended - began);
      }
      if (isUploaded && since !== null) {
        self.figures.seen.push(ended - since);
        since = null;
      }
      isUploaded = false;
    });
  const hear = self.onmessage;
  self.onmessage = (event) => {
    if (event.data.kind === "pointer") {
      since ??= performance.now();
    }
    hear(event);
  };
}

async function opened(query) {
  const context = await browser.newContext({ viewport: { width: 1920, height: 1080 } });
  const page = await context.newPage();
  await page.addInitScript(keepMemory);
  const began = Date.now();
  await page.goto(`http://localhost:${PORT}/${query}`);
  await page.waitForSelector("body[data-state=ready]", { timeout: 60_000 });
  const window = Date.now() - began;
  await page.waitForFunction(() => document.title.includes(" – "), null, { timeout: 120_000, polling: 20 });
  return { page, context, window, whole: Date.now() - began };
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
async function dragged(name, query, keys) {
  const { page, context } = await opened(query);
  await page.waitForTimeout(1500);
  const program = page.workers()[1];
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
  const { frames, seen } = await program.evaluate(() => self.figures);
  console.log(`${name}: frame ${spread(frames)}, seen after ${spread(seen)}`);
  await context.close();
}

const loads = [];
for (let i = 0; i < 5; i++) {
  const { context, window, whole, page } = await opened("");
  loads.push([window, whole]);
  if (i === 4) {
    console.log(`memory with the sample: ${await megabytes(page)} MB`);
  }
  await context.close();
}
console.log(`window, sample: ${loads.map((load) => load.join(" ")).join("; ")} ms`);
for (const threads of [1, 2]) {
  const larger = Array.from({ length: Number(process.env.LARGER ?? 12) }, () => "BracketRight");
  const on = `#threads=${threads}`;
  await dragged(`brush, ${threads} threads`, `?open=brush.jsonl${on}`, ["b", "F3", ...larger]);
  await dragged(`picture, ${threads} threads`, `?open=picture.jsonl${on}`, ["j"]);
}
const { page, context, whole } = await opened("?open=large.jsonl");
await page.waitForTimeout(4000);
await page.keyboard.press("b");
await drag(page);
await page.waitForTimeout(3000);
console.log(`4096² of ten layers: opened in ${whole} ms, ${await megabytes(page)} MB`);
await page.screenshot({ path: join(scripts, "large.png") });
await context.close();
await browser.close();
server.close();
console.log(`pictures in ${scripts}`);
