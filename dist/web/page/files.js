// Files that come from the user and go back: dialogs, downloads, the clipboard.

/** Where a file of the program goes when it is saved, by its path: handles that the user chose. */
const chosen = new Map();
/** How long what was pasted last counts as what the clipboard holds. */
const PASTED_MS = 3000;
let pasted = null;

/** Keeps a picture that was pasted, until the program asks for it. */
export function notePaste(data) {
  const file = [...data.files].find((file) => file.type.startsWith("image/"));
  pasted = file ? { file, at: performance.now() } : null;
}

/** Gives a finished file to the user. */
export async function handOut(path, bytes) {
  const handle = chosen.get(path);
  if (handle) {
    const writable = await handle.createWritable();
    await writable.write(bytes);
    return writable.close();
  }
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([bytes]));
  link.download = path.split("/").pop();
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
}

async function fileToOpen(endings) {
  const field = document.createElement("input");
  Object.assign(field, { type: "file", accept: endings });
  const file = await new Promise((resolve) => {
    field.onchange = () => resolve(field.files[0]);
    field.oncancel = () => resolve(null);
    field.click();
  });
  return file ? { text: file.name, bytes: new Uint8Array(await file.arrayBuffer()) } : {};
}

async function fileToSave(name, endings) {
  if (!window.showSaveFilePicker) {
    return { text: window.prompt("Save in the downloads as", name) ?? undefined };
  }
  const types = [{ accept: { "application/octet-stream": endings.split(",").filter(Boolean) } }];
  const handle = await window.showSaveFilePicker({ suggestedName: name, types });
  chosen.set(`/documents/${handle.name}`, handle);
  return { text: handle.name };
}

async function pastedPicture() {
  if (pasted && performance.now() - pasted.at < PASTED_MS) {
    const name = pasted.file.name || "Pasted.png";
    return { text: name, bytes: new Uint8Array(await pasted.file.arrayBuffer()) };
  }
  for (const item of await navigator.clipboard.read()) {
    const type = item.types.find((type) => type.startsWith("image/"));
    if (type) {
      const blob = await item.getType(type);
      return { text: `Pasted.${type.split("/")[1]}`, bytes: new Uint8Array(await blob.arrayBuffer()) };
    }
  }
  return {};
}

/** What the program asks, by the names that `io::platform::ask` is called with. */
const QUESTIONS = {
  "file to open": ({ details }) => fileToOpen(details.split("\n")[1]),
  "file to save": ({ details }) => fileToSave(...details.split("\n")),
  "pasted picture": pastedPicture,
  "copied text": ({ details }) => navigator.clipboard.writeText(details),
  "copied picture": ({ bytes }) =>
    navigator.clipboard.write([new ClipboardItem({ "image/png": new Blob([bytes], { type: "image/png" }) })]),
};

/** Answers a question; an answer without a text is a refusal. */
export async function answerQuestion(question) {
  try {
    return (await QUESTIONS[question.question](question)) ?? {};
  } catch (error) {
    if (error.name !== "AbortError") {
      console.warn(`${question.question}: ${error.message}`);
    }
    return {};
  }
}
