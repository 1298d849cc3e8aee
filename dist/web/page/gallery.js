// The gallery: one card for each picture of docs/GALLERY.md that a recipe makes. A card opens its recipe in
// the program.

import { showFigure } from "./figure.js";

const PICTURE = /^!\[(?<words>[^\]]*)\]\((?<file>gallery\/[^)]+)\)/m;
const TITLE = /\*\*(?<title>[^*]+)\*\*/;
const RECIPE = /sample_normals\/(?<recipe>\w+\.json)/;

function card(section) {
  const [picture, title, recipe] = [PICTURE, TITLE, RECIPE].map((pattern) => pattern.exec(section)?.groups);
  if (!picture || !recipe) {
    return [];
  }
  const [link, image, words] = ["a", "img", "span"].map((name) => document.createElement(name));
  link.href = `./?open=sample_normals/${recipe.recipe}`;
  Object.assign(image, { src: picture.file, alt: picture.words, loading: "lazy" });
  words.textContent = title?.title ?? picture.words;
  link.append(image, words, Object.assign(document.createElement("b"), { textContent: "Open in Rilievo" }));
  return [link];
}

showFigure(document.getElementById("figure")).catch((error) => console.warn(error));
const page = await (await fetch("gallery.md")).text();
const sections = page.split(/^(?=!\[)/m);
document.getElementById("pictures").append(...sections.flatMap(card));
