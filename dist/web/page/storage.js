// Files that stay between two visits: settings, brushes, palettes, recovery. They are in the origin's private
// files, all in one folder, each under its whole path.

const open = new Map();
let folder;

async function folderOf() {
  folder ??= await (await navigator.storage.getDirectory()).getDirectoryHandle("rilievo", { create: true });
  return folder;
}

const nameOf = (path) => encodeURIComponent(path);

async function handleOf(path) {
  if (!open.has(path)) {
    const file = await (await folderOf()).getFileHandle(nameOf(path), { create: true });
    open.set(path, await file.createSyncAccessHandle());
  }
  return open.get(path);
}

function close(path) {
  open.get(path)?.close();
  open.delete(path);
}

async function bytesOf(path) {
  const handle = await handleOf(path);
  const bytes = new Uint8Array(handle.getSize());
  handle.read(bytes, { at: 0 });
  return bytes;
}

const doing = {
  /** All files, but for the recovery of pages that are open now. */
  async load({ living }) {
    const files = [];
    for await (const [name, handle] of (await folderOf()).entries()) {
      const path = decodeURIComponent(name);
      const isOfLiving = living.some((id) => path.includes(`-${id}-`));
      if (!isOfLiving && !path.endsWith(".lock")) {
        files.push([path, new Uint8Array(await (await handle.getFile()).arrayBuffer())]);
      }
    }
    self.postMessage(files, files.map(([, bytes]) => bytes.buffer));
  },
  async store({ path, from, bytes }) {
    const handle = await handleOf(path);
    handle.truncate(from);
    handle.write(bytes, { at: from });
    handle.flush();
  },
  async rename({ from, to }) {
    [from, to].forEach(close);
    const handle = await (await folderOf()).getFileHandle(nameOf(from));
    const isMoved = await handle.move?.(nameOf(to)).then(() => true, () => false);
    if (isMoved) {
      return;
    }
    const bytes = await bytesOf(from);
    await doing.store({ path: to, from: 0, bytes });
    await doing.remove({ path: from });
  },
  async remove({ path }) {
    close(path);
    await (await folderOf()).removeEntry(nameOf(path)).catch(() => {});
  },
};

// One after the other, in the order in which they came.
let last = Promise.resolve();
self.onmessage = ({ data }) => {
  last = last
    .then(() => doing[data.kind](data))
    .catch((error) => {
      console.warn(`${data.kind} ${data.path ?? ""}: ${error.message}`);
      if (data.kind === "load") {
        self.postMessage([]);
      }
    });
};
