//! The layout of the panels: on which side, which in front, which in separate windows. Floor 7. Not
//! here: keeping it from run to run (`settings`).

use super::harmony::Harmony;
use super::icons::Icon;
use crate::tools::ToolKind;

rilievo_engine::named! {
    /// A panel that can be next to the canvas or in a window of its own.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum PanelKind {
        Color = "Color",
        Brushes = "Brushes",
        Palettes = "Palettes",
        Properties = "Properties",
        Surface = "Surface",
        History = "History",
        Navigator = "Navigator",
        /// Below the others, like the parts of the shape.
        Layers = "Layers",
        Shape = "Shape",
    }
}

impl PanelKind {
    /// Its sign where its name has no room.
    pub fn icon(self) -> Icon {
        match self {
            PanelKind::Color => Icon::Tool(ToolKind::Eyedropper),
            PanelKind::Brushes => Icon::Tool(ToolKind::Brush),
            PanelKind::Palettes => Icon::Palette,
            PanelKind::Properties => Icon::Sliders,
            PanelKind::Surface => Icon::Normals,
            PanelKind::History => Icon::Clock,
            PanelKind::Navigator => Icon::Frame,
            PanelKind::Layers => Icon::Stack,
            PanelKind::Shape => Icon::Tool(ToolKind::Shape),
        }
    }

    /// Whether it shares its area with others, as a tab: all but the color, which is always in
    /// sight.
    pub fn is_tab(self) -> bool {
        self != PanelKind::Color
    }

    /// Whether it is below, where the layers are.
    pub fn is_below(self) -> bool {
        matches!(self, PanelKind::Layers | PanelKind::Shape)
    }
}

/// How the color is chosen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ColorView {
    /// A wheel of hues, not a bar.
    pub is_wheel: bool,
    /// With bars of lightness, chroma and hue.
    pub has_sliders: bool,
    /// With numbers and a palette.
    pub has_numbers: bool,
    /// Which colors are shown with the current one.
    pub harmony: Harmony,
}

/// The places of the panels.
#[derive(Clone, Debug, PartialEq)]
pub struct PanelLayout {
    pub side: PanelSide,
    pub is_hidden: bool,
    /// Which panel is in front above the layers.
    pub front: PanelKind,
    /// Which is in front below: the layers or the shape.
    pub below: PanelKind,
    /// Panels in windows of their own.
    pub floating: Vec<PanelKind>,
    pub width_pt: f32,
    /// Whether references are not shown.
    pub hides_references: bool,
}

impl PanelLayout {
    /// Moves the panels into a window of their own, or back.
    pub fn toggle_apart(&mut self) {
        let is_apart = self.side == PanelSide::Floating;
        self.side = if is_apart { PanelSide::Right } else { PanelSide::Floating };
    }

    /// Moves a panel into a window of its own, or back.
    pub fn toggle_floating(&mut self, panel: PanelKind) {
        let count = self.floating.len();
        self.floating.retain(|other| *other != panel);
        if self.floating.len() == count {
            self.floating.push(panel);
        }
    }

    /// Brings a panel into sight where it is; one in a window of its own is in sight.
    pub fn show(&mut self, panel: PanelKind) {
        self.is_hidden = false;
        if panel.is_below() {
            self.below = panel;
        } else if panel.is_tab() {
            self.front = panel;
        }
    }
}

/// On which side of the canvas.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PanelSide {
    Left,
    Right,
    /// In a window of their own.
    Floating,
}

impl PanelSide {
    pub fn other(self) -> Self {
        if self == PanelSide::Right { PanelSide::Left } else { PanelSide::Right }
    }
}

/// Each side with its name in settings.
pub const SIDES: [(PanelSide, &str); 3] =
    [(PanelSide::Left, "left"), (PanelSide::Right, "right"), (PanelSide::Floating, "apart")];

impl Default for PanelLayout {
    fn default() -> Self {
        Self {
            side: PanelSide::Right,
            is_hidden: false,
            front: PanelKind::Brushes,
            below: PanelKind::Layers,
            floating: Vec::new(),
            width_pt: 268.0,
            hides_references: false,
        }
    }
}
