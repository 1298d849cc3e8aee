//! Palettes: the document's, whose changes are steps, and the user's own. Floor 6. In every action
//! `palette` is the name of one of the user's own; without it, the document's is meant.

use crate::document::{Document, Progress, flatten};
use crate::io::fs::Disk;
use crate::io::palette::{self, PaletteFormat};
use crate::io::replace::replace;
use crate::io::{Budget, Overwrite, Terms, files::read_file};
use crate::math::Rect;
use crate::math::srgb::Color;
use crate::paint::color_palette::{ColorCounter, tidy_name};
use crate::paint::{ColorPalette, NamedColor};
use crate::session::Session;
use crate::session::actions::files::unless_forced;
use crate::session::replay::{actions, as_in_recipes, names};
use crate::{Error, Result};
use std::path::{Path, PathBuf};
use std::sync::Arc;

names!(PaletteFormat);
as_in_recipes!(ColorPalette);

actions! {
    PaletteAction {
        "show" Show { palette: Option<String> }
        /// An empty one of the user's own, which is then shown.
        "new" New { name: String }
        /// Replaces the document's palette by this one, or with a name makes one of the user's own.
        "copy" Copy { palette: Option<String>, to: Option<String> }
        "delete" Delete { palette: Option<String> }
        "rename" Rename { palette: Option<String>, name: String }
        /// How many colors stand in a row; 0 is as many as there is room for.
        "columns" Columns { palette: Option<String>, to: u32 }
        /// The whole palette; one of the user's own keeps its name.
        "set" Set { palette: Option<String>, to: ColorPalette }
        /// In front of the color at `index`; without it, at the end.
        "add" Add { palette: Option<String>, color: Color, name: String, index: Option<usize> }
        "remove" Remove { palette: Option<String>, index: usize }
        /// To a place among the others.
        "move" Move { palette: Option<String>, index: usize, to: usize }
        "name" Name { palette: Option<String>, index: usize, name: String }
        "recolor" Recolor { palette: Option<String>, index: usize, color: Color }
        /// At most so many colors that stand for those of the picture replace the palette's.
        "from picture" FromPicture { palette: Option<String>, count: u32 }
        /// Of another program; it becomes one of the user's own, which is then shown.
        "import file" Import { file: PathBuf }
        /// Without a format, the ending says it.
        "export file" Export { palette: Option<String>, file: PathBuf, format: Option<PaletteFormat> }
    }
}

impl PaletteAction {
    /// The most colors that are taken from a picture.
    pub const MOST_OF_PICTURE: u32 = 256;

    /// Performs it.
    pub fn apply(&self, session: &mut Session) -> Result<()> {
        session.drop_gesture();
        match self {
            PaletteAction::Show { palette } => {
                let known = palette.clone().filter(|name| session.palettes.get(name).is_some());
                session.palettes.shown = known;
            }
            PaletteAction::New { name } => {
                let made = ColorPalette { name: tidy_name(name), ..ColorPalette::default() };
                session.palettes.shown = Some(session.palettes.add(made)?);
            }
            PaletteAction::Copy { palette, to } => {
                copy(session, palette.as_deref(), to.as_deref())?
            }
            PaletteAction::Delete { palette: Some(name) } => {
                if !session.palettes.remove(name)? {
                    session.say("Only palettes of your own can be deleted.");
                }
            }
            PaletteAction::Delete { palette: None } => {
                edit(session, None, "Delete palette", |palette| *palette = Default::default())?
            }
            PaletteAction::Set { palette, to } => {
                edit(session, palette.as_deref(), "Palette", |own| {
                    let name = if palette.is_some() { own.name.clone() } else { to.name.clone() };
                    *own = ColorPalette { name, ..to.clone() };
                })?;
            }
            PaletteAction::Rename { palette, name } => {
                let name = tidy_name(name);
                edit(session, palette.as_deref(), "Rename palette", |own| own.name = name)?;
            }
            PaletteAction::Columns { palette, to } => {
                let to = (*to).min(ColorPalette::MOST_COLUMNS);
                edit(session, palette.as_deref(), "Columns of the palette", |own| {
                    own.columns = to
                })?;
            }
            PaletteAction::FromPicture { palette, count } => {
                take_colors(session, palette.as_deref(), *count)?
            }
            PaletteAction::Import { file } => import(session, file)?,
            PaletteAction::Export { palette, file, format } => {
                let format = format.or_else(|| PaletteFormat::of_extension(file));
                let format = format.ok_or_else(|| unknown_ending(file))?;
                export(session, palette.as_deref(), file, format, unless_forced(session))?;
            }
            of_color => of_color.change_color(session)?,
        }
        Ok(())
    }

    /// What changes one color. Places beyond the last change nothing.
    fn change_color(&self, session: &mut Session) -> Result<()> {
        match self {
            PaletteAction::Add { palette, color, name, index } => {
                edit(session, palette.as_deref(), "Add color", |own| {
                    let at = index.unwrap_or(usize::MAX).min(own.colors.len());
                    own.colors.insert(at, NamedColor::new(*color, name));
                })
            }
            PaletteAction::Remove { palette, index } => {
                edit(session, palette.as_deref(), "Remove color", |own| {
                    if *index < own.colors.len() {
                        own.colors.remove(*index);
                    }
                })
            }
            PaletteAction::Move { palette, index, to } => {
                edit(session, palette.as_deref(), "Move color", |own| {
                    if *index < own.colors.len() {
                        let moved = own.colors.remove(*index);
                        own.colors.insert((*to).min(own.colors.len()), moved);
                    }
                })
            }
            PaletteAction::Name { palette, index, name } => {
                edit(session, palette.as_deref(), "Name color", |own| {
                    if let Some(named) = own.colors.get_mut(*index) {
                        named.name = tidy_name(name);
                    }
                })
            }
            PaletteAction::Recolor { palette, index, color } => {
                edit(session, palette.as_deref(), "Change color", |own| {
                    if let Some(named) = own.colors.get_mut(*index) {
                        *named = NamedColor::new(*color, &named.name);
                    }
                })
            }
            _ => Ok(()),
        }
    }
}

/// Changes one of the user's own, or the document's as a step.
fn edit(
    session: &mut Session,
    name: Option<&str>,
    label: &str,
    change: impl FnOnce(&mut ColorPalette),
) -> Result<()> {
    let Some(name) = name else {
        let Some(open) = session.active_mut() else {
            session.say("There is no document.");
            return Ok(());
        };
        let document = open.document();
        let mut palette = ColorPalette::clone(&document.palette);
        change(&mut palette);
        if palette != *document.palette {
            let next = Document { palette: Arc::new(palette), ..document.clone() };
            open.commit(label, next);
        }
        return Ok(());
    };
    if session.palettes.is_fixed(name) {
        session.say(&format!("“{name}” comes with the program; copy it to change it."));
        return Ok(());
    }
    if let Err(why) = session.palettes.change(name, change)? {
        session.notes.push(format!("{why}."));
    }
    Ok(())
}

fn copy(session: &mut Session, from: Option<&str>, to: Option<&str>) -> Result<()> {
    let Some(palette) = session.palette(from).cloned() else {
        session.say("There is no such palette.");
        return Ok(());
    };
    match to {
        Some(name) => {
            let made = ColorPalette { name: tidy_name(name), ..palette };
            session.palettes.shown = Some(session.palettes.add(made)?);
        }
        None => {
            edit(session, None, "Palette", |own| *own = palette)?;
            session.palettes.shown = None;
        }
    }
    Ok(())
}

/// Rows of the picture that are counted at a time.
const BAND: i32 = 64;

fn take_colors(session: &mut Session, name: Option<&str>, count: u32) -> Result<()> {
    let Some(open) = session.active() else {
        session.say("There is no document.");
        return Ok(());
    };
    let document = open.document();
    let of_all = document.flattening_bytes();
    let budget = Budget::of_this_machine();
    if let Err(why) = budget.room_for("taking colors from the picture", of_all) {
        session.notes.push(format!("{why}."));
        return Ok(());
    }
    // Nothing here cancels.
    let Some(grid) = flatten(document, &Progress::default()) else { return Ok(()) };
    let (canvas, mut counter) = (document.size.rect(), ColorCounter::default());
    for y0 in (0..canvas.y1).step_by(BAND as usize) {
        let band = Rect { y0, y1: (y0 + BAND).min(canvas.y1), ..canvas };
        counter.add(&grid.to_straight_rgba(band));
    }
    let colors = counter.colors(count.min(PaletteAction::MOST_OF_PICTURE) as usize);
    if colors.is_empty() {
        session.say("The picture has no colors yet.");
        return Ok(());
    }
    edit(session, name, "Palette from the picture", |own| {
        own.colors = colors.into_iter().map(NamedColor::from).collect();
    })
}

fn import(session: &mut Session, file: &Path) -> Result<()> {
    let budget = Budget::of_this_machine();
    let bytes = read_file(file, budget.json_bytes)?;
    let read = palette::read(file, &bytes, &budget)?;
    let said = read.notes.iter().map(|note| format!("{}: {note}.", read.palette.name));
    session.notes.extend(said);
    session.palettes.shown = Some(session.palettes.add(read.palette)?);
    Ok(())
}

fn unknown_ending(file: &Path) -> Error {
    let endings = PaletteFormat::EXTENSIONS.map(|ending| format!(".{ending}")).join(", ");
    Error::unsupported_file(file, format!("the name must end in one of {endings}"))
}

/// Writes a palette as a file; nothing if there is none of the name.
pub fn export(
    session: &Session,
    name: Option<&str>,
    file: &Path,
    format: PaletteFormat,
    over: Overwrite,
) -> Result<()> {
    let Some(palette) = session.palette(name) else { return Ok(()) };
    let bytes = palette::write(file, palette, format)?;
    let terms = Terms::export(over, session.reads());
    replace(&Disk, file, &bytes, &terms, &Progress::default()).map(drop)
}
