//! Floor 5: tools. A tool turns the pen's events on the canvas into documents: a preview while the pen moves, and a
//! result when it lifts. Each tool is a file and a row of [`ToolKind::ALL`]. Not here: the current tool and the history
//! (`session`), screen coordinates (`window`).

pub mod anchors;
pub mod assistants;
pub mod brush;
mod context;
pub mod crop;
pub mod eyedropper;
pub mod fill;
pub mod gradient;
pub mod guides;
pub mod image;
pub mod lights;
pub mod liquify;
pub mod mask;
pub mod move_content;
pub mod outline;
mod retouch;
pub mod select;
pub mod shape;
pub mod snap;
pub mod strokes;
pub mod symmetry;
pub mod transform;
pub mod unwrapped;

use crate::document::{Document, LayerId};
use crate::math::{Rect, Vec2, Vec3, srgb::Color};
use crate::paint::Sample;
pub use context::ToolContext;
pub use select::SelectSettings;
pub use shape::ShapeSettings;
use snap::SnapLines;
pub use symmetry::Symmetry;

/// The tools.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum ToolKind {
    #[default]
    Brush,
    Eraser,
    Fill,
    Gradient,
    Image,
    Anchors,
    Move,
    Transform,
    Liquify,
    Assistants,
    Crop,
    Strokes,
    Shape,
    Touch,
    Sculpt,
    SelectRectangle,
    SelectEllipse,
    Lasso,
    Wand,
    SurfaceWand,
    Eyedropper,
    Hand,
    Zoom,
}

/// A tool's name, label, key and hint.
#[derive(Clone, Copy)]
pub struct ToolRow {
    pub kind: ToolKind,
    /// In replays.
    pub name: &'static str,
    /// On buttons.
    pub label: &'static str,
    /// The letter that selects it.
    pub key: char,
    /// What it does, for tooltips and the status bar.
    pub hint: &'static str,
}

impl ToolKind {
    pub const ALL: [ToolRow; 23] = [
        ToolRow {
            kind: ToolKind::Brush,
            name: "brush",
            label: "Brush",
            key: 'B',
            hint: "Paint; each dab bends over the surface. Shift joins the last stroke's end with a straight line",
        },
        ToolRow {
            kind: ToolKind::Eraser,
            name: "eraser",
            label: "Eraser",
            key: 'E',
            hint: "Erase with the current brush; on a stroke layer, Ctrl removes whole strokes that you touch",
        },
        ToolRow {
            kind: ToolKind::Fill,
            name: "fill",
            label: "Fill",
            key: 'F',
            hint: "Click to fill the area connected to the pixel you click; gaps in its border can be closed",
        },
        ToolRow {
            kind: ToolKind::Gradient,
            name: "gradient",
            label: "Gradient",
            key: 'G',
            hint: "Drag to create a gradient from the first colour to the second, or drag an end of the selected one",
        },
        ToolRow {
            kind: ToolKind::Image,
            name: "image",
            label: "Image",
            key: 'J',
            hint: "Drag to move the selected image before it is bent; Shift scales it, Ctrl turns it. Unwrapped: on \
                   one piece alone",
        },
        ToolRow {
            kind: ToolKind::Anchors,
            name: "anchors",
            label: "Anchors",
            key: 'A',
            hint: "Drag an anchor along the surface. Ctrl drags its content, Shift re-pins it; click adds, Alt removes",
        },
        ToolRow {
            kind: ToolKind::Move,
            name: "move",
            label: "Move",
            key: 'V',
            hint: "Drag the selected layer; on a stroke layer, the stroke under the pen (Shift: all of them)",
        },
        ToolRow {
            kind: ToolKind::Transform,
            name: "transform",
            label: "Transform",
            key: 'T',
            hint: "Drag corners, edges, the inside to move, the outside to turn. Shift keeps aspect or steps, Alt the \
                   middle, Ctrl skews and distorts; Enter applies it",
        },
        ToolRow {
            kind: ToolKind::Liquify,
            name: "liquify",
            label: "Liquify",
            key: 'K',
            hint: "Push, swell, twirl what the layer or group shows; it stays live. Ctrl turns a dab about (push: \
                   restores), Shift smooths",
        },
        ToolRow {
            kind: ToolKind::Assistants,
            name: "assistants",
            label: "Assistants",
            key: 'Y',
            hint: "Drag to lay an assistant, or a handle of one or of the symmetry's axes; Alt-click takes one away. \
                   Strokes go along them",
        },
        ToolRow {
            kind: ToolKind::Crop,
            name: "crop",
            label: "Crop",
            key: 'C',
            hint: "Drag a frame, also beyond the canvas, and its handles; Shift keeps the aspect. Enter crops, Escape \
                   gives up",
        },
        ToolRow {
            kind: ToolKind::Strokes,
            name: "strokes",
            label: "Strokes",
            key: 'S',
            hint: "Select strokes of a stroke layer and drag them; Shift selects more. Properties lists them too",
        },
        ToolRow {
            kind: ToolKind::Shape,
            name: "shape",
            label: "Shape",
            key: 'P',
            hint: "Click chooses a part of the shape, a drag moves it; handles scale, turn, puff (middle) and tilt it",
        },
        ToolRow {
            kind: ToolKind::Touch,
            name: "touch",
            label: "Touch",
            key: 'N',
            hint: "Click or drag to turn the surface the way the ball shows; drag a touch to move it. Alt removes one, \
                   or takes the surface's direction",
        },
        ToolRow {
            kind: ToolKind::Sculpt,
            name: "sculpt",
            label: "Sculpt",
            key: 'U',
            hint: "Paint height on a part; Ctrl lowers what raises, Shift smooths",
        },
        ToolRow {
            kind: ToolKind::SelectRectangle,
            name: "select rectangle",
            label: "Select rectangle",
            key: 'R',
            hint: "Drag a rectangle to select. Shift adds, Alt takes away, both intersect; a drag inside moves it",
        },
        ToolRow {
            kind: ToolKind::SelectEllipse,
            name: "select ellipse",
            label: "Select ellipse",
            key: 'O',
            hint: "Drag an ellipse to select; Ctrl makes it a circle. Shift adds, Alt takes away, both intersect",
        },
        ToolRow {
            kind: ToolKind::Lasso,
            name: "lasso",
            label: "Lasso",
            key: 'L',
            hint: "Drag to select freely, or click corner by corner; Enter or the first corner closes, Escape gives up",
        },
        ToolRow {
            kind: ToolKind::Wand,
            name: "wand",
            label: "Wand",
            key: 'W',
            hint: "Click to select what is like a pixel; drag right or left for more or less tolerance",
        },
        ToolRow {
            kind: ToolKind::SurfaceWand,
            name: "surface wand",
            label: "Surface wand",
            key: 'Q',
            hint: "Click the surface to select all that faces the same way; drag right or left for tolerance",
        },
        ToolRow {
            kind: ToolKind::Eyedropper,
            name: "eyedropper",
            label: "Eyedropper",
            key: 'I',
            hint: "Take a colour from the picture",
        },
        ToolRow { kind: ToolKind::Hand, name: "hand", label: "Hand", key: 'H', hint: "Drag the view" },
        ToolRow {
            kind: ToolKind::Zoom,
            name: "zoom",
            label: "Zoom",
            key: 'Z',
            hint: "Click to zoom in, Alt-click to zoom out",
        },
    ];
    pub fn row(self) -> &'static ToolRow {
        const ROWS: &[ToolRow] = &ToolKind::ALL;
        ROWS.iter().find(|row| row.kind == self).unwrap_or(&ROWS[0])
    }
    /// The pen snaps to guides, the grid and edges, whatever is done with it.
    pub fn snaps(self) -> bool {
        use ToolKind::{Assistants, Crop, Gradient, Move, SelectEllipse, SelectRectangle, Transform};
        matches!(self, Assistants | Crop | Gradient | Move | SelectEllipse | SelectRectangle | Transform)
    }
    /// It makes selections.
    pub fn selects(self) -> bool {
        use ToolKind::{Lasso, SelectEllipse, SelectRectangle, SurfaceWand, Wand};
        matches!(self, SelectRectangle | SelectEllipse | Lasso | Wand | SurfaceWand)
    }
    /// It works on the parts of the shape.
    pub fn shapes(self) -> bool {
        matches!(self, ToolKind::Shape | ToolKind::Touch | ToolKind::Sculpt)
    }
    pub fn name(self) -> &'static str {
        self.row().name
    }
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.iter().find(|row| row.name == name).map(|row| row.kind)
    }
}

/// One sample of the pen with the modifier keys held.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PenSample {
    pub sample: Sample,
    pub keys: ModifierKeys,
}

/// The modifier keys, as they are called on most keyboards.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct ModifierKeys {
    pub shift: bool,
    /// Ctrl, or Command.
    pub ctrl: bool,
    pub alt: bool,
}

impl PenSample {
    /// A mouse without keys.
    pub fn at(at: Vec2) -> Self {
        Self { sample: Sample::at(at), keys: ModifierKeys::default() }
    }
    pub fn place(&self) -> Vec2 {
        self.sample.at
    }
}

/// What a tool returns for an event of the pen.
pub enum Outcome {
    Idle,
    /// A preview until the next outcome.
    Preview(Document),
    /// A finished step with this name.
    Commit {
        label: String,
        document: Document,
        /// To be selected from now on.
        select: Option<LayerId>,
    },
    /// A selection made with settings that the pen changed: a preview, or a finished step.
    Tuned {
        document: Document,
        select: SelectSettings,
        is_done: bool,
    },
    /// The corners of a lasso that goes on.
    Lasso(Vec<Vec2>),
    /// These strokes of the selected layer are chosen from now on.
    Chosen(Vec<usize>),
    /// This part of the shape is chosen from now on.
    ChosenPart(String),
    /// Touches give this direction from now on.
    Direction(Vec3),
    /// The crop tool's frame from now on.
    Frame(Rect),
    /// Clone brushes copy from here from now on.
    CloneFrom(Vec2),
    /// Nothing was started, for a reason to show.
    Refused(&'static str),
    /// The frame of the chosen layers is turned about this point, by shares of its sides, from now on.
    Pivot(Vec2),
    /// These points of the layer's mesh are chosen from now on.
    MeshPoints(Vec<usize>),
    /// The axes of symmetry stand here from now on.
    Axes(symmetry::SymmetryAxes),
    /// A colour was picked.
    Picked(Color),
    /// The preview is to be dropped.
    Cancel,
}

/// A tool between the pen coming down and lifting. It holds a clone of the document it began with, which is cheap.
pub trait Gesture: Send {
    /// The pen's samples since the last call, in order.
    fn drag(&mut self, pens: &[PenSample]) -> Outcome;
    fn release(&mut self) -> Outcome;
    /// The lines that it snapped to, to be shown.
    fn snap_lines(&self) -> SnapLines {
        SnapLines::default()
    }
    /// Where it was last drawn to, if that is not where the pen is.
    fn end(&self) -> Option<Vec2> {
        None
    }
    /// Whether it moves a guide, which is taken away where it is dropped on a ruler.
    fn is_guide(&self) -> bool {
        false
    }
}

/// The start of a gesture, and its first outcome.
pub type GestureStart = (Option<Box<dyn Gesture>>, Outcome);

/// The pen comes down. Hand and zoom do not concern documents: they start no gesture.
pub fn press(kind: ToolKind, context: &ToolContext, pen: PenSample) -> GestureStart {
    match kind {
        ToolKind::Brush => brush::press(context, pen, brush::StrokePurpose::Paint),
        ToolKind::Eraser => brush::press(context, pen, brush::StrokePurpose::Erase),
        ToolKind::Fill => fill::press(context, pen),
        ToolKind::Gradient => gradient::press(context, pen),
        ToolKind::Image => image::press(context, pen),
        ToolKind::Anchors => anchors::press(context, pen),
        ToolKind::Move => move_content::press(context, pen),
        ToolKind::Transform => transform::press(context, pen),
        ToolKind::Liquify => liquify::press(context, pen),
        ToolKind::Assistants => assistants::press(context, pen),
        ToolKind::Crop => crop::press(context, pen),
        ToolKind::Strokes => strokes::press(context, pen),
        ToolKind::Shape => shape::part::press(context, pen),
        ToolKind::Touch => shape::touch::press(context, pen),
        ToolKind::Sculpt => shape::sculpt::press(context, pen),
        ToolKind::SelectRectangle
        | ToolKind::SelectEllipse
        | ToolKind::Lasso
        | ToolKind::Wand
        | ToolKind::SurfaceWand => select::press(kind, context, pen),
        ToolKind::Eyedropper => eyedropper::press(context, pen),
        ToolKind::Hand | ToolKind::Zoom => (None, Outcome::Idle),
    }
}

/// How near the pen must come to a handle, screen points.
pub const GRAB_PT: f32 = 10.0;
