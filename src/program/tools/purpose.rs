//! What a stroke of brush or eraser is for, and what it changes. Floor 5.

/// What brush and eraser change.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum BrushTarget {
    /// The selected layer.
    #[default]
    Layer,
    /// The mask of the selected layer.
    Mask,
    /// The selection itself, under a quick mask.
    Selection,
}

/// The purpose of a stroke.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StrokePurpose {
    /// It adds paint.
    Paint,
    /// It takes paint away.
    Erase,
}
