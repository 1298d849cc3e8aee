//! What there is in a session, so that actions are drawn for it.

use crate::document::Part;
use crate::document::view::SurfaceView;
use crate::math::{Vec2, vec2};
use crate::session::replay::ReplayValue;
use crate::session::{LayerPath, Session};
use std::path::{Path, PathBuf};
use std::sync::Arc;

#[derive(Clone, Default)]
pub struct Facts {
    /// The canvas, px.
    pub size: Vec2,
    /// The layers of the document in front, with their kinds.
    pub layers: Vec<(LayerPath, &'static str)>,
    pub parts: Vec<Arc<Part>>,
    /// The most strokes of a layer.
    pub strokes: usize,
    pub documents: usize,
    pub presets: Vec<String>,
    pub palettes: Vec<String>,
    /// The views of a surface.
    pub views: Vec<String>,
    pub files: Arc<StoryFiles>,
    /// The names of its layers.
    pub names: Vec<String>,
}

/// A path that leads nowhere.
pub fn no_layer() -> LayerPath {
    LayerPath::read(&"97".into()).unwrap()
}

impl Facts {
    pub fn of(session: &Session, files: &Arc<StoryFiles>) -> Self {
        let presets = session.presets.iter().map(|preset| preset.key.clone()).collect();
        let palettes = session.palettes.names().map(str::to_owned).collect();
        let views = SurfaceView::ALL.iter().map(|(_, name)| (*name).to_owned()).collect();
        let (files, documents) = (files.clone(), session.open_documents.len());
        let none = Facts {
            size: vec2(90.0, 60.0),
            presets,
            palettes,
            views,
            files,
            documents,
            ..Facts::default()
        };
        let Some(open) = session.active() else { return none };
        let document = open.document();
        let walk = document.walk();
        let kinds = walk.iter().filter_map(|(_, layer)| {
            Some((LayerPath::of(document, layer.id)?, layer.content.kind_name()))
        });
        Facts {
            size: vec2(document.size.width as f32, document.size.height as f32),
            layers: kinds.collect(),
            parts: document.parts.list.clone(),
            strokes: walk
                .iter()
                .map(|(_, layer)| document.strokes(layer.id).len())
                .max()
                .unwrap_or_default(),
            names: walk.iter().map(|(_, layer)| layer.name.clone()).collect(),
            ..none
        }
    }
}

/// The folder of a story: what it begins with, and where it writes to.
#[derive(Default)]
pub struct StoryFiles {
    folder: PathBuf,
}

impl StoryFiles {
    pub fn new(folder: &Path) -> Self {
        Self { folder: folder.into() }
    }

    /// The files there, in a fixed order.
    fn there(&self) -> Vec<PathBuf> {
        let entries = std::fs::read_dir(&self.folder).into_iter().flatten().flatten();
        let mut files: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
        files.sort();
        files
    }

    /// A file for the field of an action.
    pub fn draw_file(&self, word: &str, field: &str, chance: u64) -> PathBuf {
        let name =
            |file: &PathBuf| file.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let found = |is_it: &dyn Fn(&str) -> bool| {
            let all: Vec<PathBuf> =
                self.there().into_iter().filter(|file| is_it(&name(file))).collect();
            all.get((chance % all.len().max(1) as u64) as usize).cloned().unwrap_or_default()
        };
        let new = |names: &[&str]| self.folder.join(names[(chance % names.len() as u64) as usize]);
        match (word, field) {
            (_, "normal") => found(&|name| name.starts_with("normal")),
            (_, "depth") => found(&|name| name.starts_with("depth")),
            ("save", _) => new(&["out-1.ora", "out-2.ora", "out-1.psd"]),
            ("export", _) => {
                new(&["out.png", "out.jpg", "out.exr", "out.tif", "out.webp", "out-2.psd"])
            }
            ("export maps", _) => new(&["out-maps.png", "out-maps.exr"]),
            ("export unwrapped", _) => new(&["out-sheet.png", "out-sheet.exr"]),
            ("export lines", _) => new(&["out-lines.svg"]),
            ("open", _) => found(&|name| {
                [".ora", ".psd", ".json", ".png", ".svg"].iter().any(|end| name.ends_with(end))
            }),
            ("export file", _) => new(&["out.gpl", "out.ase", "out.kpl", "out.pal"]),
            ("import file", _) => found(&|name| name.ends_with(".gpl") || name.ends_with(".kpl")),
            ("shape paths", _) => found(&|name| name.ends_with(".svg")),
            ("import brush", _) => found(&|name| name.starts_with("picture")),
            _ => found(&|name| {
                name.starts_with("picture") || name.starts_with("normal") || name == "gray.png"
            }),
        }
    }
}
