// A web server for trying the page: dist/web/serve FOLDER, then open http://localhost:8000.

import { createServer } from "node:http";
import { readFile } from "node:fs/promises";
import { extname, join, normalize } from "node:path";
import { pathToFileURL } from "node:url";

const TYPES = {
  ".html": "text/html; charset=utf-8",
  ".css": "text/css",
  ".js": "text/javascript",
  ".wasm": "application/wasm",
  ".svg": "image/svg+xml",
};

/** The headers that let a page share memory with its workers. */
const ISOLATING = {
  "Cross-Origin-Opener-Policy": "same-origin",
  "Cross-Origin-Embedder-Policy": "require-corp",
};

/** The bytes of a file in the first of these folders that has it. */
async function found(folders, name) {
  for (const folder of folders) {
    const bytes = await readFile(join(folder, name)).catch(() => null);
    if (bytes) {
      return bytes;
    }
  }
  return null;
}

/** Serves folders on a port of this machine, as one, with the two headers or without. */
export function serve(folders, port, isIsolating = true) {
  const server = createServer(async (request, response) => {
    const name = decodeURIComponent(new URL(request.url, "http://localhost").pathname);
    const file = normalize(name === "/" ? "/index.html" : name);
    const bytes = await found([folders].flat(), file);
    if (bytes) {
      const headers = { "Content-Type": TYPES[extname(file)] ?? "application/octet-stream" };
      response.writeHead(200, { ...headers, "Content-Length": bytes.length, ...(isIsolating ? ISOLATING : {}) });
      response.end(bytes);
    } else {
      response.writeHead(404).end();
    }
  });
  return new Promise((resolve) => server.listen(port, "127.0.0.1", () => resolve(server)));
}

if (import.meta.url === pathToFileURL(process.argv[1]).href) {
  await serve(process.argv[2] ?? ".", 8000);
  console.log("http://localhost:8000");
}
