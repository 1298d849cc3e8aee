//! The list of tools: the name, key and description of each. Floor 5. Not here: what they do (the
//! files of their names).

rilievo_engine::named! {
    /// The tools, each with its name in replays, its label on buttons, and what it does, for
    /// tooltips and the status bar.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
    pub enum ToolKind {
        #[default]
        Brush = "brush" => (
            "Brush",
            "Paint; each dab bends over the surface. Shift joins the last stroke's end with a straight line",
        ),
        Eraser = "eraser" => (
            "Eraser",
            "Erase with the current brush; on a stroke layer, Ctrl removes whole strokes that you touch",
        ),
        Fill = "fill" => (
            "Fill",
            "Click to fill the area connected to the pixel you click; gaps in its border can be closed",
        ),
        Gradient = "gradient" => (
            "Gradient",
            "Drag from the first color to the second, into the paint layer or as a live layer, or drag an end of the \
             selected live gradient",
        ),
        Image = "image" => (
            "Image",
            "Drag to move the selected image before it is bent; Shift scales it, Ctrl turns it. Unwrapped: on one \
             piece alone",
        ),
        Anchors = "anchors" => (
            "Anchors",
            "Drag an anchor along the surface. Ctrl drags its content, Shift re-pins it; click adds, Alt removes",
        ),
        Text = "text" => (
            "Text",
            "Click to write, or on a text to change it; its type is in Properties",
        ),
        Figure = "figure" => (
            "Figure",
            "Drag to draw a rectangle, ellipse, polygon, star, line or arrow; Shift makes it regular, Alt begins at \
             its middle. Handles change the selected one, Ctrl turns it",
        ),
        Path = "path" => (
            "Path",
            "Click for corners, drag for smooth nodes; the first node closes, Enter ends. Drag nodes and handles \
             later; Ctrl breaks a handle, Alt deletes a node",
        ),
        Panels = "panels" => (
            "Comic panels",
            "Drag across a comic's panels to cut them, or drag new ones; Shift turns a cut in steps of 15°, makes a \
             panel a square. Click a panel to select its frame",
        ),
        Move = "move" => (
            "Move",
            "Drag the selected layer; on a stroke layer, the stroke under the pen (Shift: all of them)",
        ),
        Transform = "transform" => (
            "Transform",
            "Drag corners or edges to scale, the inside to move, the outside to turn. Shift keeps \
             the aspect or turns in steps, Alt keeps the middle, Ctrl skews and distorts; Enter \
             applies it",
        ),
        Liquify = "liquify" => (
            "Liquify",
            "Push, enlarge or twirl what the layer or group shows; it stays live. Ctrl inverts a \
             dab (push: restores), Shift smooths",
        ),
        Assistants = "assistants" => (
            "Assistants",
            "Drag to add an assistant, or to move a handle of one or of the axes of symmetry; Alt-click removes \
             one. Strokes follow them",
        ),
        Crop = "crop" => (
            "Crop",
            "Drag a frame, which may extend beyond the canvas, or its handles; Shift keeps the \
             aspect. Enter crops, Escape cancels",
        ),
        Strokes = "strokes" => (
            "Strokes",
            "Select strokes of a stroke layer and drag them; Shift selects more. Properties lists them too",
        ),
        Shape = "shape" => (
            "Shape",
            "Click to select a part of the shape, drag to move it; handles scale, turn, puff \
             (middle) and tilt it",
        ),
        Touch = "touch" => (
            "Touch",
            "Click or drag to turn the surface the way the ball shows; drag a touch to move it. Alt removes one, or \
             takes the surface's direction",
        ),
        Sculpt = "sculpt" => ("Sculpt", "Paint height on a part; Ctrl lowers what raises, Shift smooths"),
        SelectRectangle = "select rectangle" => (
            "Select rectangle",
            "Drag a rectangle to select. Shift adds, Alt subtracts, both intersect; dragging inside moves it",
        ),
        SelectEllipse = "select ellipse" => (
            "Select ellipse",
            "Drag an ellipse to select; Ctrl makes it a circle. Shift adds, Alt subtracts, both intersect",
        ),
        Lasso = "lasso" => (
            "Lasso",
            "Drag to select freely, or click corner by corner; Enter or the first corner closes it, Escape cancels",
        ),
        Wand = "wand" => (
            "Wand",
            "Click to select similar pixels; drag right or left for more or less tolerance",
        ),
        SurfaceWand = "surface wand" => (
            "Surface wand",
            "Click the surface to select everything that faces the same way; drag right or left \
             for more or less tolerance",
        ),
        Eyedropper = "eyedropper" => ("Eyedropper", "Take a color from the picture"),
        Hand = "hand" => ("Hand", "Drag the view"),
        Zoom = "zoom" => ("Zoom", "Click to zoom in, Alt-click to zoom out"),
    }
}

impl ToolKind {
    /// The letter that selects it.
    pub fn key(self) -> char {
        match self {
            ToolKind::Brush => 'B',
            ToolKind::Eraser => 'E',
            ToolKind::Fill => 'F',
            ToolKind::Gradient => 'G',
            ToolKind::Image => 'J',
            ToolKind::Anchors => 'A',
            ToolKind::Move => 'V',
            // With Shift.
            ToolKind::Text | ToolKind::Transform => 'T',
            ToolKind::Figure => 'U',
            ToolKind::Path => 'P',
            ToolKind::Panels => 'C',
            ToolKind::Liquify => 'K',
            ToolKind::Assistants => 'Y',
            ToolKind::Crop => 'C',
            ToolKind::Strokes => 'S',
            ToolKind::Shape => 'P',
            ToolKind::Touch => 'N',
            ToolKind::Sculpt => 'U',
            ToolKind::SelectRectangle => 'R',
            ToolKind::SelectEllipse => 'O',
            ToolKind::Lasso => 'L',
            ToolKind::Wand => 'W',
            ToolKind::SurfaceWand => 'Q',
            ToolKind::Eyedropper => 'I',
            ToolKind::Hand => 'H',
            ToolKind::Zoom => 'Z',
        }
    }

    /// Whether that letter is pressed with Shift.
    pub fn is_key_shifted(self) -> bool {
        matches!(self, ToolKind::Text | ToolKind::Figure | ToolKind::Path | ToolKind::Panels)
    }

    /// Whether the pen snaps to guides, the grid and edges in all uses.
    pub fn is_snapping_tool(self) -> bool {
        use ToolKind::{
            Assistants, Crop, Figure, Gradient, Move, Panels, Path, SelectEllipse, SelectRectangle,
            Transform,
        };
        matches!(
            self,
            Assistants
                | Crop
                | Figure
                | Gradient
                | Move
                | Panels
                | Path
                | SelectEllipse
                | SelectRectangle
                | Transform
        )
    }

    /// Whether it makes selections.
    pub fn is_selection_tool(self) -> bool {
        use ToolKind::{Lasso, SelectEllipse, SelectRectangle, SurfaceWand, Wand};
        matches!(self, SelectRectangle | SelectEllipse | Lasso | Wand | SurfaceWand)
    }

    /// Whether it works on the parts of the shape.
    pub fn is_shape_tool(self) -> bool {
        matches!(self, ToolKind::Shape | ToolKind::Touch | ToolKind::Sculpt)
    }
}
