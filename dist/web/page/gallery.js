// The gallery: one card for each picture of docs/GALLERY.md that a recipe or a script makes. A card opens
// that in the program.

import { showFigure } from "./figure.js";

const PICTURE = /^!\[(?<words>[^\]]*)\]\((?<file>[^)]+)\)/m;
const TITLE = /\*\*(?<title>[^*]+)\*\*/;
const SOURCE = /(?<file>sample_normals\/[\w/]+\.jsonl?)/;

function card(section) {
  const [picture, title, source] = [PICTURE, TITLE, SOURCE].map((pattern) => pattern.exec(section)?.groups);
  if (!picture || !source) {
    return [];
  }
  const [link, image, words] = ["a", "img", "span"].map((name) => document.createElement(name));
  link.href = `./?open=${source.file}`;
  Object.assign(image, { src: picture.file, alt: picture.words, loading: "lazy" });
  words.textContent = title?.title ?? picture.words;
  link.append(image, words, Object.assign(document.createElement("b"), { textContent: "Open in Rilievo" }));
  return [link];
}

showFigure(document.getElementById("figure")).catch((error) => console.warn(error));
const page = await (await fetch("gallery.md")).text();
const sections = page.split(/^(?=!\[)/m);
document.getElementById("pictures").append(...sections.flatMap(card));
