//! The faults that are known and being mended, so that stories look for others meanwhile. Empty when all is well.

/// Beginnings of the kinds of faults.
const FAULTS: &[&str] = &[
    // Recovered drawings with a shape are flat.
    "recovered, another picture",
    "recovered, it differs in: the selection",
    // Long strokes of sculpting.
    "opened with a note: the surface is lost",
    // Liquify or a mesh on the layer that outlines parts.
    "reopened, another picture",
    // The same, drawn or not drawn before the next step.
    "without what was kept for speed",
    "one thread and two differ",
    // Parts of maps, cropped or turned; maps replaced by others.
    "reopened, it differs in: the parts of its shape",
    "reopened, it differs in: the surface",
    // Maps of another size than the canvas.
    "reopened, another export",
    "saved again, other bytes",
    // Transformed, then scaled; on the canvas in a group that is on a part.
    "reopened, it differs in: ”: its opacity",
];

pub fn is_known(kind: &str) -> bool {
    FAULTS.iter().any(|known| kind.starts_with(known))
}
