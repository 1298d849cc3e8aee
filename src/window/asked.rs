//! What panels ask for: actions that the session does, and things that only a window can do.
//! Floor 7.

use super::files::Purpose;
use super::panels::Front;
use crate::session::Action;
use std::path::PathBuf;

/// Pushed by panels, done once a frame.
#[derive(Default)]
pub struct Asked {
    pub actions: Vec<Action>,
    pub window: Vec<WindowAsk>,
}

impl Asked {
    pub fn act(&mut self, action: Action) {
        self.actions.push(action);
    }
    pub fn ask(&mut self, ask: WindowAsk) {
        self.window.push(ask);
    }
}

/// What needs the window: dialogs, other threads, the clipboard.
#[derive(Clone, Debug, PartialEq)]
pub enum WindowAsk {
    NewDialog,
    OpenDialog,
    OpenMapsDialog,
    ReplaceMapsDialog,
    PlaceDialog,
    /// Opened on a thread of its own.
    Open(PathBuf),
    OpenSample,
    /// Asks for a file.
    Choose(Purpose),
    Save,
    SaveAs,
    ExportDialog,
    /// Asks where to, for a file of this ending.
    Export(&'static str),
    /// Asks first where there is unsaved work.
    Close(usize),
    Quit,
    CopyMerged,
    Paste,
    Palette,
    Shortcuts,
    About,
    TogglePanels,
    OtherSide,
    PanelsApart,
    /// A panel into a window of its own, or back.
    Float(Front),
    ToggleTheme,
    ResizeInterface {
        is_larger: bool,
    },
    Scale(f32),
    FullScreen,
}
