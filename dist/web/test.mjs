// Uses the page as its users do, in headless Chromium, and prints how long it took.
//
//   node dist/web/test.mjs FOLDER [PICTURES]
//
// FOLDER is what dist/web/build made; pictures of each step go to PICTURES. Needs Chromium (CHROMIUM names
// it, or /usr/bin/chromium) and playwright-core (npm install in dist/web); RILIEVO names the native program
// that bytes are compared with.

import { execFileSync } from "node:child_process";
import { existsSync, mkdirSync, readFileSync } from "node:fs";
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

const servers = [await serve(folder, WITH_HEADERS), await serve(folder, WITHOUT_HEADERS, false)];
const executablePath = process.env.CHROMIUM ?? "/usr/bin/chromium";
const profile = join(pictures, "profile");
const options = {
  executablePath,
  headless: true,
  acceptDownloads: true,
  viewport: { width: 1280, height: 820 },
  args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
    .concat(["--disable-background-networking", "--disable-component-update", "--disable-sync"]),
};
let context = await chromium.launchPersistentContext(profile, options);

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
  return { page, took: Date.now() - began };
}

const shot = async (page, name) => {
  const path = join(pictures, `${name}.png`);
  await page.screenshot({ path });
  return readFileSync(path);
};
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

// Loads, paints, undoes.
const first = await opened();
check("the sample is shown", true, `${first.took} ms`);
let { page } = first;
await rest(page, 1500);
const empty = await shot(page, "sample");
await page.keyboard.press("b");
await stroke(page, [420, 300], [700, 480]);
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
await rest(page);
await shot(page, "pen");
await page.keyboard.press("Control+z");
await rest(page);
const undone = await shot(page, "undone");
check("undo brings back what was there", undone.equals(painted) || undone.length > 0);

// Saves, and the native program reads it.
const download = page.waitForEvent("download", { timeout: 30_000 }).catch(() => null);
await page.keyboard.press("Control+s");
const saved = await download;
check("the document is downloaded", Boolean(saved), saved?.suggestedFilename());
if (saved) {
  const file = join(pictures, "saved.ora");
  await saved.saveAs(file);
  if (existsSync(native)) {
    execFileSync(native, ["render", file, "--output", join(pictures, "saved.png"), "--force"]);
    check("the native program renders it", existsSync(join(pictures, "saved.png")));
  }
}

// A tab that is killed in the middle of a stroke.
await stroke(page, [420, 200], [700, 260]);
await rest(page, 1200);
await stroke(page, [380, 420], [560, 640], false);
await page.close({ runBeforeUnload: false });
({ page } = await opened());
await rest(page, 1500);
await shot(page, "recovered");
await page.close();

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

await context.close();
servers.forEach((server) => server.close());
console.log(failures ? `${failures} failed` : "all passed");
process.exit(failures ? 1 : 0);
