//! What panels request: actions that the session performs, and things that only a window can do.
//! Floor 7.

use super::file_purpose::FilePurpose;
use super::panel_layout::PanelKind;
use super::preferences::PreferencePage;
use crate::io::palette::PaletteFormat;
use crate::paint::{ColorAdjustment, PictureFilter};
use crate::session::Action;
use crate::session::actions::{EdgeChange, PasteTo};
use std::path::PathBuf;

/// Pushed by panels, done once a frame.
#[derive(Default)]
pub struct UiRequests {
    pub actions: Vec<Action>,
    pub window: Vec<WindowRequest>,
}

impl UiRequests {
    pub fn act(&mut self, action: Action) {
        self.actions.push(action);
    }

    pub fn request(&mut self, ask: WindowRequest) {
        self.window.push(ask);
    }
}

/// What a dialog does to the paint of the selected layers.
#[derive(Clone, Debug, PartialEq)]
pub enum PaintChange {
    Adjust(ColorAdjustment),
    Filter(PictureFilter),
}

/// What needs the window: dialogs, other threads, the clipboard.
#[derive(Clone, Debug, PartialEq)]
pub enum WindowRequest {
    NewDialog,
    OpenDialog,
    OpenMapsDialog,
    ReplaceMapsDialog,
    /// For a part of the shape.
    PartMapsDialog,
    PlaceDialog,
    /// For the drawing of the document in front.
    ShapeDialog,
    /// Opened on a thread of its own.
    Open(PathBuf),
    /// By its place among the samples.
    OpenSample(usize),
    /// Asks for a file.
    Choose(FilePurpose),
    Save,
    SaveAs,
    ExportDialog,
    /// As the document was exported last.
    ExportAgain,
    ExportMapsDialog,
    /// Asks where to, for the maps of the shape.
    ExportMaps,
    /// Sways the picture by its depth, until a key or a click.
    Wobble,
    /// The share of the machine's memory that may be kept for speed.
    KeptShare(f32),
    /// Puts a text into the clipboard.
    CopyText(String),
    /// A sentence in the status bar.
    Say(String),
    /// Asks where to, for a file of this extension.
    Export(&'static str),
    /// Asks where to, for the palette that is shown.
    ExportPalette(PaletteFormat),
    ExportUnwrappedDialog,
    /// Asks where to.
    ExportUnwrapped,
    /// Asks where to, for the lines of the form.
    ExportLines,
    /// Shows the surface unwrapped, once that is computed.
    Unwrap,
    /// Asks first if there is unsaved work.
    Close(usize),
    Quit,
    /// For the paint of the selected layers.
    PaintChangeDialog(Box<PaintChange>),
    EdgeDialog(EdgeChange),
    KeepDialog,
    GridDialog,
    /// A page of panels, of the selected path or the selection if there is one.
    PanelsDialog,
    LooksDialog,
    MaterialsDialog,
    CanvasSizeDialog,
    ImageSizeDialog,
    TurnDialog,
    ProfileDialog,
    Paste(PasteTo),
    Palette,
    /// The preferences, at a page.
    Preferences(PreferencePage),
    News,
    About,
    /// Opens the menus, for the arrow keys.
    Menus,
    /// Opens or closes the second view of the document.
    SecondView,
    /// Shows the picture as it will be printed, or in its own colors.
    ToggleProof,
    /// Shows what is in the clipboard over the canvas.
    PasteReference,
    /// Shows or hides the references.
    ToggleReferences,
    /// Removes all references.
    ClearReferences,
    TogglePanels,
    OtherSide,
    PanelsApart,
    /// A panel into a window of its own, or back.
    Float(PanelKind),
    /// Brings a panel to the front, where it is.
    ShowPanel(PanelKind),
    /// Shows the settings of the brush in hand in the panel of brushes.
    EditBrush,
    NextLook,
    /// Shows or hides in the status bar what is measured.
    ToggleDetails,
    /// One of the sizes to choose from.
    ScaleInterface(f32),
    ResizeInterface {
        is_larger: bool,
    },
    Scale(f32),
    FullScreen,
}
