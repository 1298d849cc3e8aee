//! The tools there are: what each is called, its key, and what it does.
//! Floor 5. What they do is in the files of their names.

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
