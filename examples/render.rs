//! Opens a painting, renders it, and renders one of its layers alone.
//!
//! `cargo run --example render -- [DOCUMENT [PICTURE]]`: a recipe (`.json`), a project (`.ora`) or
//! a picture; without arguments a sample, to the folder for temporary files.

use rilievo::document::flatten_layer;
use rilievo::files::export::{ExportOptions, OutputFile};
use rilievo::files::{Budget, Overwrite, Terms};
use rilievo::{Progress, Result, open, render};
use std::path::{Path, PathBuf};

fn main() -> Result<()> {
    let mut arguments = std::env::args_os().skip(1).map(PathBuf::from);
    let sample = || Path::new(env!("CARGO_MANIFEST_DIR")).join("sample_normals/bronze_muse.json");
    let document = arguments.next().unwrap_or_else(sample);
    let picture =
        arguments.next().unwrap_or_else(|| std::env::temp_dir().join("rilievo_render.png"));
    render_file(&document, &picture)?;
    println!("{}", picture.display());
    Ok(())
}

/// Renders a document to a picture, and its topmost layer to another beside it.
pub fn render_file(document: &Path, picture: &Path) -> Result<()> {
    // The budget says how large files and pictures may be, so that no file can exhaust the memory.
    let opened = open(document, &Budget::of_this_machine())?;
    for note in &opened.notes {
        eprintln!("{note}"); // what of the file could not be kept
    }
    let painting = opened.document;

    // The name chooses the format. `Terms` say what may be replaced, and name files that must never
    // be.
    let terms = Terms::export(Overwrite::Anything, vec![document.to_owned()]);
    let options = ExportOptions::default();
    let output = OutputFile::new(picture, terms.clone())?;
    output.write(&render(&painting), painting.size, &options, painting.profile)?;

    // Documents are values: a layer is looked up by name or id and never changes while it is
    // shared.
    if let Some(top) = painting.layers.last() {
        let alone = flatten_layer(&painting, top.id, &Progress::default()).unwrap_or_default();
        let beside = picture.with_extension("top.png");
        OutputFile::new(&beside, terms)?.write(
            &alone,
            painting.size,
            &options,
            painting.profile,
        )?;
    }
    Ok(())
}
