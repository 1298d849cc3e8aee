//! Fonts of this machine by the letters that they have. Floor 5.

use super::columns::has_letter;
use crate::svg;
use resvg::usvg::fontdb::{FaceInfo, ID, Stretch, Style};

/// A font of this machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct InstalledFont(ID);

impl InstalledFont {
    /// Its file, and which of the fonts in the file it is; `None` if the file is gone.
    pub fn read(self) -> Option<(Vec<u8>, u32)> {
        svg::fonts().with_face_data(self.0, |bytes, index| (bytes.to_vec(), index))
    }
}

/// A font that has all letters of a text: of the first of these families that there is, else any,
/// upright and as near to regular as there is.
pub fn find_font(letters: &str, families: &[&str]) -> Option<InstalledFont> {
    let fonts = svg::fonts();
    let has_all = |face: &FaceInfo| letters.chars().all(|c| has_letter(&fonts, face.id, c));
    let rank = |face: &FaceInfo| {
        let is_of = |family: &&str| face.families.iter().any(|(name, _)| name == family);
        let family = families.iter().position(is_of).unwrap_or(families.len());
        let is_odd = face.style != Style::Normal || face.stretch != Stretch::Normal;
        (family, is_odd, face.weight.0.abs_diff(400))
    };
    let mut faces: Vec<&FaceInfo> = fonts.faces().collect();
    faces.sort_by_key(|face| rank(face));
    faces.into_iter().find(|face| has_all(face)).map(|face| InstalledFont(face.id))
}
