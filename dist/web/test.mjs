// Uses the page as its users do, in headless Chromium, and prints how long it took.
//
//   node dist/web/test.mjs FOLDER [PICTURES]
//
// FOLDER is what dist/web/build made; pictures of each step go to PICTURES. Needs Chromium (CHROMIUM names
// it, or /usr/bin/chromium) and playwright-core (npm install in dist/web); RILIEVO names the native program
// that bytes are compared with, and STORIES a folder of stories (RILIEVO_STORIES=FOLDER cargo test -p
// rilievo-program stories_are_written -- --ignored), which are played and compared with their pictures.

import { execFileSync } from "node:child_process";
import { existsSync, mkdirSync, readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import { chromium } from "playwright-core";
import { serve } from "./server.mjs";

const [folder, pictures = "/tmp/rilievo-web"] = process.argv.slice(2);
mkdirSync(pictures, { recursive: true });
const native = process.env.RILIEVO ?? "target/release/rilievo";
const [WITH_HEADERS, WITHOUT_HEADERS] = [8123, 8124];

let failures = 0;
function check(name, isRight, detail = "") {
  console.log(`${isRight ? "ok  " : "FAIL"} ${name}${detail === "" ? "" : `: ${detail}`}`);
  failures += isRight ? 0 : 1;
}

const served = [folder, process.env.STORIES].filter(Boolean);
const servers = [await serve(served, WITH_HEADERS), await serve(served, WITHOUT_HEADERS, false)];
const executablePath = process.env.CHROMIUM ?? "/usr/bin/chromium";
const options = {
  executablePath,
  headless: true,
  acceptDownloads: true,
  viewport: { width: 1280, height: 820 },
  args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
    .concat(["--disable-background-networking", "--disable-component-update", "--disable-sync"]),
};
let context = await chromium.launchPersistentContext(join(pictures, "profile"), options);

/** A page that shows the program, and how long that took. */
async function opened(port = WITH_HEADERS, query = "", viewport = options.viewport) {
  const page = await context.newPage();
  await page.setViewportSize(viewport);
  page.on("console", (line) => console.log(`     page: ${line.text()}`));
  page.on("pageerror", (error) => console.log(`     page: ${error.message}`));
  // Files are saved as downloads, under the proposed name.
  await page.addInitScript(() => delete window.showSaveFilePicker);
  page.on("dialog", (dialog) => dialog.accept(dialog.defaultValue()));
  const began = Date.now();
  await page.goto(`http://localhost:${port}/${query}`);
  await page.waitForSelector("body[data-state=ready]", { timeout: 60_000 });
  const started = Date.now() - began;
  // The title has the name of the document in front, once one is there.
  const isOpen = page.waitForFunction(() => document.title.includes(" – "), null, { timeout: 60_000 });
  await isOpen.catch(() => null);
  return { page, started, took: Date.now() - began };
}

const shot = async (page, name) => {
  const path = join(pictures, `${name}.png`);
  await page.screenshot({ path });
  return readFileSync(path);
};
/** Where the button *Recover all* is in a window of this size. */
const RECOVER_ALL = [447, 487];
const rest = (page, ms = 700) => page.waitForTimeout(ms);

async function stroke(page, from, to, release = true) {
  await page.mouse.move(...from);
  await page.mouse.down();
  for (let i = 1; i <= 24; i++) {
    await page.mouse.move(from[0] + ((to[0] - from[0]) * i) / 24, from[1] + ((to[1] - from[1]) * i) / 24);
  }
  if (release) {
    await page.mouse.up();
  }
}

/** The next file that the page gives out after `act`, under a name among the pictures. */
async function downloaded(page, name, act) {
  const download = page.waitForEvent("download", { timeout: 30_000 }).catch(() => null);
  await act();
  const file = join(pictures, name);
  await (await download)?.saveAs(file);
  return existsSync(file) ? file : null;
}

/** The document in front as a PNG. */
const exportedPicture = (page, name) =>
  downloaded(page, name, async () => {
    await page.keyboard.press("Control+Alt+e");
    await rest(page, 1500);
    await page.keyboard.press("Enter");
  });

/** The picture of a document, by the native program. */
function rendered(file, name) {
  const picture = join(pictures, name);
  execFileSync(native, ["render", file, "--output", picture, "--force"]);
  return readFileSync(picture);
}

const hasNative = existsSync(native);
if (!hasNative) {
  console.log(`     no bytes are compared: ${native} is not there`);
}

// Loads, paints, undoes.
const first = await opened();
check("the sample is shown", true, `${first.took} ms, the window ${first.started} ms`);
let { page } = first;
await page.mouse.move(30, 780);
await rest(page, 1500);
const empty = await shot(page, "sample");
await page.keyboard.press("b");
await stroke(page, [420, 300], [700, 480]);
await page.mouse.move(30, 780);
await rest(page);
const painted = await shot(page, "painted");
check("a stroke shows", !painted.equals(empty));

// A pen's pressure.
const client = await context.newCDPSession(page);
const pen = (type, x, y, force) =>
  client.send("Input.dispatchMouseEvent", { type, x, y, force, button: "left", buttons: 1, clickCount: 1, pointerType: "pen" });
await pen("mousePressed", 420, 520, 0.05);
for (let i = 0; i <= 40; i++) {
  await pen("mouseMoved", 420 + i * 8, 520, i / 40);
}
await pen("mouseReleased", 740, 520, 0);
await page.mouse.move(30, 780);
await rest(page);
check("a pen's stroke shows", !(await shot(page, "pen")).equals(painted));

// Saves, and the native program reads it.
const saved = await downloaded(page, "saved.ora", () => page.keyboard.press("Control+s"));
check("the document is downloaded", Boolean(saved));
const before = saved && hasNative ? rendered(saved, "saved.png") : null;

// The lowest step is the first stroke: two undos bring the sample back, two redos the strokes.
const undo = async (keys) => {
  await page.keyboard.press(keys);
  await rest(page);
};
await undo("Control+z");
await undo("Control+z");
const bare = await downloaded(page, "undone.ora", () => page.keyboard.press("Control+s"));
await undo("Control+Shift+Z");
await undo("Control+Shift+Z");
const redone = await downloaded(page, "redone.ora", () => page.keyboard.press("Control+s"));
if (hasNative) {
  check("undo takes both strokes away", Boolean(bare) && !rendered(bare, "undone.png").equals(before));
  check("redo brings them back", Boolean(redone) && rendered(redone, "redone.png").equals(before));
}

// A tab that is killed in the middle of a stroke.
await stroke(page, [420, 200], [700, 260]);
await rest(page, 300);
await stroke(page, [380, 420], [560, 640], false);
await page.close({ runBeforeUnload: false });
({ page } = await opened());
await rest(page, 1500);
await shot(page, "recovery");
await page.mouse.click(...RECOVER_ALL);
await page.waitForFunction(() => /recovered/i.test(document.title), null, { timeout: 10_000 }).catch(() => null);
await rest(page, 1500);
await shot(page, "recovered");
const again = await downloaded(page, "recovered.ora", () => page.keyboard.press("Control+s"));
check("what was drawn before the tab was killed comes back", Boolean(again));
if (again && hasNative) {
  check("with its last stroke", !rendered(again, "recovered_picture.png").equals(before));
}
await page.close();

// As a new user from here on.
await context.close();
context = await chromium.launchPersistentContext(join(pictures, "profile of another"), options);

// The same bytes as the native program's.
const recipe = "sample_normals/bronze_muse.json";
const muse = await opened(WITH_HEADERS, `?open=${recipe}`);
await rest(muse.page, 3000);
await shot(muse.page, "muse");
const exported = await exportedPicture(muse.page, "muse_exported.png");
await shot(muse.page, "exported");
check("a recipe and the files that it names are opened, and exported", Boolean(exported), `${muse.took} ms`);
if (exported && hasNative) {
  const same = readFileSync(exported).equals(rendered(join(folder, recipe), "muse_native.png"));
  check("the exported picture has the native program's bytes", same);
}
await muse.page.close();

// The stories of the tests.
// Each in a browser of its own: what another left is not offered for recovery there.
const stories = process.env.STORIES ? readdirSync(process.env.STORIES).filter((name) => name.endsWith(".jsonl")) : [];
await context.close();
const browser = await chromium.launch({ executablePath, args: options.args });
for (const story of stories) {
  context = await browser.newContext({ viewport: options.viewport, acceptDownloads: true });
  const { page, took } = await opened(WITH_HEADERS, `?open=${story}`);
  await rest(page, 1000);
  const picture = await exportedPicture(page, `${story}.png`);
  const expected = readFileSync(join(process.env.STORIES, story.replace(".jsonl", ".png")));
  check(`${story} ends with the same bytes`, Boolean(picture) && readFileSync(picture).equals(expected), `${took} ms`);
  await shot(page, `${story} shown`);
  await context.close();
}
context = await browser.newContext({ viewport: options.viewport });

// Without the two headers; on a tablet and on a phone.
const plain = await opened(WITHOUT_HEADERS);
check("a server without the headers serves it, too", true, `${plain.took} ms`);
await plain.page.close();
for (const [name, width, height] of [["tablet", 820, 1180], ["phone", 390, 844]]) {
  const small = await opened(WITH_HEADERS, "", { width, height });
  await rest(small.page, 1500);
  await shot(small.page, name);
  await small.page.close();
}

await browser.close();
servers.forEach((server) => server.close());
console.log(failures ? `${failures} failed` : "all passed");
process.exit(failures ? 1 : 0);
