// A figure whose light follows the pointer: what the program is about, before it is loaded. One picture
// holds its colors on the left and its normals on the right (x to the right, y up, z to the viewer): those
// that the program makes of src/window/tour/robin.svg.

/** How far the lamp is before the picture, in its widths. */
const LAMP_HEIGHT = 0.35;
/** How far light reaches around a form, of a half turn. */
const WRAP = 0.3;
const [SHADE, LIGHT] = [
  [0.5, 0.5, 0.66],
  [1.1, 1.05, 0.97],
];
const SHINE = 0.22;
const SHININESS = 20;
/** Colors darker than this are ink, and no light falls on them. */
const INK = 60;

const unit = ([x, y, z]) => {
  const length = Math.hypot(x, y, z) || 1;
  return [x / length, y / length, z / length];
};

/** A lit picture of colors and normals, written into `out`; the lamp is at a place in px. */
function light(colors, normals, out, width, lamp) {
  const height = LAMP_HEIGHT * width;
  for (let at = 0; at < colors.length; at += 4) {
    const [x, y] = [(at / 4) % width, Math.floor(at / 4 / width)];
    out[at + 3] = colors[at + 3];
    if (colors[at + 3] === 0) {
      continue;
    }
    const isInk = Math.max(colors[at], colors[at + 1], colors[at + 2]) < INK;
    const normal = [0, 1, 2].map((i) => normals[at + i] / 127.5 - 1);
    const to = unit([lamp.x - x, y - lamp.y, height]);
    const cosine = normal[0] * to[0] + normal[1] * to[1] + normal[2] * to[2];
    const lit = Math.max(0, (cosine + WRAP) / (1 + WRAP));
    const half = unit([to[0], to[1], to[2] + 1]);
    const facing = Math.max(0, normal[0] * half[0] + normal[1] * half[1] + normal[2] * half[2]);
    const shine = isInk ? 0 : 255 * SHINE * facing ** SHININESS;
    for (let i = 0; i < 3; i++) {
      const tone = isInk ? 1 : SHADE[i] + (LIGHT[i] - SHADE[i]) * lit;
      out[at + i] = colors[at + i] * tone + shine;
    }
  }
}

/** Shows the figure on a canvas, and lets its light follow the pointer from now on. */
export async function showFigure(canvas) {
  const picture = new Image();
  picture.src = "figure.webp";
  await picture.decode();
  const [width, height] = [picture.width / 2, picture.height];
  Object.assign(canvas, { width, height });
  const context = canvas.getContext("2d", { willReadFrequently: true });
  const pixelsAt = (x) => {
    context.clearRect(0, 0, width, height);
    context.drawImage(picture, -x, 0);
    return context.getImageData(0, 0, width, height).data;
  };
  const [colors, normals] = [pixelsAt(0), pixelsAt(width)];
  const shown = context.createImageData(width, height);
  let isDue = false;
  const paint = (lamp) => {
    isDue = false;
    light(colors, normals, shown.data, width, lamp);
    context.putImageData(shown, 0, 0);
  };
  const ask = (lamp) => {
    if (!isDue) {
      isDue = true;
      requestAnimationFrame(() => paint(lamp));
    }
  };
  ask({ x: 0.15 * width, y: 0.05 * height });
  window.addEventListener("pointermove", ({ clientX, clientY }) => {
    const box = canvas.getBoundingClientRect();
    if (box.width > 0) {
      ask({ x: ((clientX - box.left) * width) / box.width, y: ((clientY - box.top) * height) / box.height });
    }
  });
}
