//! The palettes at hand: the one of the document in front, and the user's own, which lie in a
//! folder as GIMP's files. Floor 6. Not here: the formats (`io::palette`), what is done with them
//! (`actions::palettes`).

use super::Session;
use crate::document::Progress;
use crate::io::brush::plain;
use crate::io::fs::Disk;
use crate::io::palette::{self, PaletteFormat};
use crate::io::platform::{self, files};
use crate::io::replace::replace;
use crate::io::{Budget, Overwrite, Terms, files::read_file};
use crate::paint::ColorPalette;
use crate::paint::color_palette::tidy_name;
use crate::{Error, Result};
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

/// The one that comes with the program.
static BASIC: LazyLock<ColorPalette> = LazyLock::new(ColorPalette::basic);

/// A palette of the user's own.
struct OwnPalette {
    /// The name of its file, without the ending.
    stem: String,
    palette: ColorPalette,
}

/// The user's own palettes.
#[derive(Default)]
pub struct PaletteShelf {
    own: Vec<OwnPalette>,
    /// The name of the palette that is shown; `None`: that of the document.
    pub shown: Option<String>,
    /// Where they lie from one run to the next.
    folder: Option<PathBuf>,
}

impl PaletteShelf {
    /// The palettes of a folder, by name, and a sentence for each file that cannot be read. A
    /// folder that does not exist yet holds none.
    pub fn load(folder: &Path) -> (Self, Vec<String>) {
        let entries = files::read_dir(folder).into_iter().flatten().flatten();
        let mut files: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
        files.retain(|file| file.extension().is_some_and(|ending| ending == "gpl"));
        files.sort();
        let mut shelf = Self { folder: Some(folder.into()), ..Self::default() };
        let (mut notes, budget) = (Vec::new(), Budget::of_this_machine());
        for file in files {
            let read = read_file(&file, budget.json_bytes)
                .and_then(|bytes| palette::read(&file, &bytes, &budget));
            match read {
                Ok(read) => {
                    let name = shelf.free_name(&read.palette.name);
                    let stem = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
                    shelf
                        .own
                        .push(OwnPalette { stem, palette: ColorPalette { name, ..read.palette } });
                }
                Err(error) => notes.push(error.to_string()),
            }
        }
        (shelf, notes)
    }

    /// The names of all: the user's own, then the program's.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.own.iter().map(|own| own.palette.name.as_str()).chain([BASIC.name.as_str()])
    }

    /// A palette of the user's own, or of the program.
    pub fn get(&self, name: &str) -> Option<&ColorPalette> {
        let mut own = self.own.iter().map(|own| &own.palette);
        own.find(|own| own.name == name).or_else(|| (BASIC.name == name).then(|| &*BASIC))
    }

    /// Whether it comes with the program, and is not changed.
    pub fn is_fixed(&self, name: &str) -> bool {
        name == BASIC.name
    }

    /// Adds one, under its name or the next that is free; returns that.
    pub fn add(&mut self, palette: ColorPalette) -> Result<String> {
        let name = self.free_name(&palette.name);
        let plain_name = Some(plain(&name)).filter(|stem| !stem.is_empty());
        let base = plain_name.unwrap_or_else(|| "palette".into());
        let stem = first_free(&base, '-', |stem| {
            let file = self.folder.as_deref().map(|folder| file_of(folder, stem));
            self.own.iter().any(|own| own.stem == stem)
                || file.is_some_and(|file| platform::is_file(&file))
        });
        let palette = ColorPalette { name: name.clone(), ..palette };
        self.write(&stem, &palette)?;
        self.own.push(OwnPalette { stem, palette });
        Ok(name)
    }

    /// Changes one of the user's own; nothing if there is none of the name, or its change fits no
    /// file.
    pub fn change(
        &mut self,
        name: &str,
        change: impl FnOnce(&mut ColorPalette),
    ) -> Result<Result<(), String>> {
        let Some(at) = self.own.iter().position(|own| own.palette.name == name) else {
            return Ok(Err(format!("There is no palette “{name}” of your own")));
        };
        let mut next = self.own[at].palette.clone();
        change(&mut next);
        if next.name != name {
            next.name = self.free_name(&next.name);
        }
        if let Err(why) = next.fits() {
            return Ok(Err(why));
        }
        self.write(&self.own[at].stem, &next)?;
        if self.shown.as_deref() == Some(name) {
            self.shown = Some(next.name.clone());
        }
        self.own[at].palette = next;
        Ok(Ok(()))
    }

    /// Removes one of the user's own with its file; the document's is shown if it was.
    pub fn remove(&mut self, name: &str) -> Result<bool> {
        let Some(at) = self.own.iter().position(|own| own.palette.name == name) else {
            return Ok(false);
        };
        if let Some(folder) = &self.folder {
            let file = file_of(folder, &self.own[at].stem);
            match files::remove_file(&file) {
                Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
                    return Err(Error::io(file, error));
                }
                _ => {}
            }
        }
        self.own.remove(at);
        self.shown.take_if(|shown| shown == name);
        Ok(true)
    }

    fn write(&self, stem: &str, palette: &ColorPalette) -> Result<()> {
        let Some(folder) = &self.folder else { return Ok(()) };
        files::create_dir_all(folder).map_err(|error| Error::io(folder, error))?;
        let file = file_of(folder, stem);
        let bytes = palette::write(&file, palette, PaletteFormat::Gimp)?;
        let terms = Terms::export(Overwrite::Anything, Vec::new());
        replace(&Disk, &file, &bytes, &terms, &Progress::default()).map(drop)
    }

    /// A name that no palette has: “Sky”, “Sky 2”, …
    fn free_name(&self, name: &str) -> String {
        let tidy = Some(tidy_name(name)).filter(|name| !name.is_empty());
        let base = tidy.unwrap_or_else(|| "Palette".into());
        first_free(&base, ' ', |name| self.names().any(|known| known == name))
    }
}

fn file_of(folder: &Path, stem: &str) -> PathBuf {
    folder.join(format!("{stem}.gpl"))
}

/// A name, with the first number behind it that makes it free.
fn first_free(base: &str, between: char, is_taken: impl Fn(&str) -> bool) -> String {
    let mut name = base.to_owned();
    for i in 2.. {
        if !is_taken(&name) {
            break;
        }
        name = format!("{base}{between}{i}");
    }
    name
}

impl Session {
    /// A palette by its name, or that of the document in front.
    pub fn palette(&self, name: Option<&str>) -> Option<&ColorPalette> {
        match name {
            Some(name) => self.palettes.get(name),
            None => self.active().map(|open| &*open.document().palette),
        }
    }

    /// The palette that is shown.
    pub fn shown_palette(&self) -> Option<&ColorPalette> {
        self.palette(self.palettes.shown.as_deref())
    }

    /// The colors to choose from beside the picker: the palette that is shown, or the program's
    /// where that is empty.
    pub fn choice_of_colors(&self) -> &ColorPalette {
        self.shown_palette().filter(|palette| !palette.colors.is_empty()).unwrap_or(&BASIC)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::srgb::Color;

    #[test]
    fn the_users_own_palettes_lie_in_their_folder_from_one_run_to_the_next() {
        let home = tempfile::tempdir().unwrap();
        let folder = home.path().join("palettes");
        let (mut shelf, notes) = PaletteShelf::load(&folder);
        assert_eq!((shelf.names().collect::<Vec<_>>(), notes), (vec!["Basic"], vec![]));
        let sky = |name| ColorPalette::of_colors(name, &[Color::WHITE]);
        for (wanted, given) in
            [("Sky", "Sky"), ("sky", "sky"), ("Sky", "Sky 2"), ("Basic", "Basic 2")]
        {
            assert_eq!(shelf.add(sky(wanted)).unwrap(), given);
        }
        shelf.shown = Some("sky".into());
        shelf.change("sky", |palette| palette.name = "Sky".into()).unwrap().unwrap();
        assert_eq!(shelf.shown.as_deref(), Some("Sky 3"));
        assert!(shelf.change("Basic", |palette| palette.columns = 3).unwrap().is_err());
        let said = shelf.change("Sky", |palette| palette.columns = 999).unwrap().unwrap_err();
        assert!(said.contains("999"), "{said}");
        let names =
            |shelf: &PaletteShelf| -> Vec<String> { shelf.names().map(str::to_owned).collect() };
        let (read, notes) = PaletteShelf::load(&folder);
        let mut expected = names(&shelf);
        expected.sort();
        let mut found = names(&read);
        found.sort();
        assert_eq!((found, notes), (expected, Vec::<String>::new()));
        assert!(shelf.remove("Sky 3").unwrap() && !shelf.remove("Sky 3").unwrap());
        assert_eq!(shelf.shown, None);
        for name in ["Sky", "Sky 2", "Basic 2"] {
            assert!(shelf.remove(name).unwrap(), "{name}");
        }
        assert!(!shelf.remove("Basic").unwrap());
        assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 0);
    }

    #[test]
    fn a_broken_file_of_the_folder_is_told_of() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("a.gpl"), "GIMP Palette\nx\n").unwrap();
        std::fs::write(folder.path().join("b.gpl"), "GIMP Palette\n1 2 3\n").unwrap();
        let (shelf, notes) = PaletteShelf::load(folder.path());
        assert_eq!(shelf.names().collect::<Vec<_>>(), ["b", "Basic"]);
        assert!(notes.len() == 1 && notes[0].contains("a.gpl: cannot be read"), "{notes:?}");
    }
}
