// What the user does, told to the program as it comes.

/** The keys that are held, as bits: `src/web/events.rs` reads them. */
function held(event) {
  return (event.shiftKey ? 1 : 0) | (event.ctrlKey ? 2 : 0) | (event.altKey ? 4 : 0) | (event.metaKey ? 8 : 0);
}

const PHASES = { pointerdown: 0, pointermove: 1, pointerup: 2, pointercancel: 3, pointerleave: 4 };
const [MOUSE, PEN, ERASER, FINGER] = [0, 1, 2, 3];
/** The button, and the bit of the pressed ones, of a pen's other end. */
const ERASER_BUTTON = 5;
const ERASER_BIT = 32;

function kindOf(event) {
  if (event.pointerType === "pen") {
    return event.button === ERASER_BUTTON || event.buttons & ERASER_BIT ? ERASER : PEN;
  }
  return event.pointerType === "touch" ? FINGER : MOUSE;
}

/** Whether the browser does something with a key that users need: reload, its own tools, pasting. */
function isOfBrowser(event) {
  const isCommand = event.ctrlKey || event.metaKey;
  const key = event.key.toLowerCase();
  if (["f5", "f11", "f12"].includes(key)) {
    return true;
  }
  return isCommand && (key === "v" || key === "r" || (event.shiftKey && "ijc".includes(key)));
}

/** Listens to a canvas, and to the field that texts are typed into. */
export function listen(canvas, typed, tell, notePaste) {
  let isEditing = false;

  const send = (phase, event, of = event) =>
    tell({
      kind: "pointer",
      args: [
        kindOf(event),
        phase,
        event.pointerId >>> 0,
        of.clientX,
        of.clientY,
        event.button === ERASER_BUTTON ? 0 : event.button,
        held(event),
        of.pressure,
        of.tiltX || 0,
        of.tiltY || 0,
      ],
    });
  for (const [name, phase] of Object.entries(PHASES)) {
    canvas.addEventListener(name, (event) => {
      if (name === "pointerdown") {
        canvas.setPointerCapture(event.pointerId);
        (isEditing ? typed : canvas).focus({ preventScroll: true });
      }
      const path = name === "pointermove" ? (event.getCoalescedEvents?.() ?? []) : [];
      (path.length ? path : [event]).forEach((of) => send(phase, event, of));
      event.preventDefault();
    });
  }
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  const wheel = (event) => {
    tell({ kind: "wheel", args: [event.deltaX, event.deltaY, event.deltaMode, held(event)] });
    event.preventDefault();
  };
  canvas.addEventListener("wheel", wheel, { passive: false });

  const key = (isDown) => (event) => {
    if (event.isComposing || event.keyCode === 229) {
      return;
    }
    tell({ kind: "key", args: [event.key, event.code, isDown, held(event)] });
    const isText = [...event.key].length === 1 && (event.getModifierState("AltGraph") || !(event.ctrlKey || event.metaKey));
    if (isText && isEditing) {
      return; // It comes by the field.
    }
    if (isText && isDown) {
      tell({ kind: "text", args: [event.key] });
    }
    if (!isOfBrowser(event)) {
      event.preventDefault();
    }
  };
  window.addEventListener("keydown", key(true));
  window.addEventListener("keyup", key(false));

  const takeTyped = () => {
    if (typed.value) {
      tell({ kind: "text", args: [typed.value] });
      typed.value = "";
    }
  };
  typed.addEventListener("input", (event) => event.isComposing || takeTyped());
  typed.addEventListener("compositionend", takeTyped);
  window.addEventListener("paste", (event) => {
    notePaste(event.clipboardData);
    const text = event.clipboardData.getData("text");
    if (isEditing && text) {
      tell({ kind: "paste", args: [text.replaceAll("\r\n", "\n")] });
    }
    event.preventDefault();
  });

  window.addEventListener("focus", () => tell({ kind: "focus", args: [true] }));
  window.addEventListener("blur", () => tell({ kind: "focus", args: [false] }));
  window.addEventListener("dragover", (event) => event.preventDefault());
  window.addEventListener("drop", async (event) => {
    event.preventDefault();
    const dropped = [...event.dataTransfer.files];
    const files = await Promise.all(
      dropped.map(async (file) => [`/documents/${file.name}`, new Uint8Array(await file.arrayBuffer())]),
    );
    tell({ kind: "drop", files, names: dropped.map((file) => file.name), x: event.clientX, y: event.clientY });
  });

  const resize = () => {
    const { clientWidth, clientHeight } = document.documentElement;
    tell({ kind: "resize", args: [clientWidth, clientHeight, devicePixelRatio] });
  };
  new ResizeObserver(resize).observe(document.documentElement);

  return {
    resize,
    /** A text is edited at a place. */
    editText({ x, y, height }) {
      Object.assign(typed.style, { left: `${x}px`, top: `${y}px`, height: `${height}px` });
      isEditing = true;
      typed.focus({ preventScroll: true });
    },
    /** No text is edited. */
    endText() {
      isEditing = false;
      typed.value = "";
      canvas.focus({ preventScroll: true });
    },
  };
}
