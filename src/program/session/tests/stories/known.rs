//! The faults that are known and being mended, so that stories look for others meanwhile. Empty
//! when all is well.

/// Beginnings of the kinds of faults.
const FAULTS: &[&str] = &[
    // Parts by the place of a colour, in Photoshop's format.
    "psd: not saved: a.psd: not supported: the drawing would not come back as it is: ”",
];

pub fn is_known(kind: &str) -> bool {
    FAULTS.iter().any(|known| kind.starts_with(known))
}
