//! Files that belong together by their names: `pot_n.png`, `pot_depth.exr`, `pot_mask.png`.
//! Floor 5.

use std::path::{Path, PathBuf};

/// The kind of map that a file name indicates.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MapPart {
    /// Normals.
    Normal,
    /// Depth.
    Depth,
    /// Coverage.
    Mask,
}

const SUFFIXES: [(&str, MapPart); 13] = [
    ("normals", MapPart::Normal),
    ("normal", MapPart::Normal),
    ("nrm", MapPart::Normal),
    ("nor", MapPart::Normal),
    ("n", MapPart::Normal),
    ("depth", MapPart::Depth),
    ("zdepth", MapPart::Depth),
    ("height", MapPart::Depth),
    ("d", MapPart::Depth),
    ("z", MapPart::Depth),
    ("mask", MapPart::Mask),
    ("coverage", MapPart::Mask),
    ("alpha", MapPart::Mask),
];

/// Files of one object.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MapSet {
    /// The name without its ending.
    pub name: String,
    /// The normal map.
    pub normal: Option<PathBuf>,
    /// The depth map.
    pub depth: Option<PathBuf>,
    /// The mask.
    pub mask: Option<PathBuf>,
}

/// The object's name and the part: by the ending after the last `_`, `-` or `.`, else by a whole
/// word such as `normal` anywhere (`normal_gl16.png`). A bare `normal.png` has an empty name.
pub fn part_of(file: &Path) -> Option<(String, MapPart)> {
    let stem = file.file_stem()?.to_string_lossy().to_lowercase();
    let breaks = ['_', '-', '.', ' '];
    let (name, end) = stem.rsplit_once(breaks).unwrap_or(("", &stem));
    // Single letters mean something only after a name.
    let known = SUFFIXES
        .iter()
        .find(|(suffix, _)| *suffix == end && (suffix.len() > 1 || !name.is_empty()));
    if let Some((_, part)) = known {
        return Some((name.into(), *part));
    }
    let words: Vec<&str> = stem.split(breaks).collect();
    let plain = |word: &str| word.trim_end_matches(|c: char| c.is_ascii_digit()).to_owned();
    let found = words.iter().enumerate().find_map(|(i, word)| {
        let suffix =
            SUFFIXES.iter().find(|(suffix, _)| suffix.len() > 2 && *suffix == plain(word))?;
        Some((i, suffix.1))
    });
    found.map(|(at, part)| {
        let rest: Vec<&str> =
            words.iter().enumerate().filter(|(i, _)| *i != at).map(|(_, w)| *w).collect();
        (rest.join("_"), part)
    })
}

/// The words for conventions in names of files.
const CONVENTIONS: [&str; 8] = ["gl", "dx", "ogl", "opengl", "directx", "srgb", "linear", "map"];

/// Name of an object, from the file of one of its maps: without the words for maps and conventions;
/// if nothing is left, the folder's name. `pot_normal_gl.png` is “pot”, `bunny/normal_gl8.png`
/// “bunny”.
pub fn object_of(file: &Path) -> String {
    const BREAKS: [char; 4] = ['_', '-', '.', ' '];
    let is_map = |word: &str| SUFFIXES.iter().any(|(suffix, _)| *suffix == word);
    let is_of_map = |word: &str| {
        let word = word.to_lowercase();
        let plain = word.trim_end_matches(|c: char| c.is_ascii_digit());
        let after_map = SUFFIXES
            .iter()
            .find_map(|(suffix, _)| plain.strip_prefix(suffix).filter(|_| suffix.len() > 2));
        is_map(plain)
            || CONVENTIONS.contains(&plain)
            || after_map.is_some_and(|rest| CONVENTIONS.contains(&rest))
    };
    let stem = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let mut name = stem.as_str();
    while let Some((rest, _)) = name.rsplit_once(BREAKS).filter(|(_, word)| is_of_map(word)) {
        name = rest;
    }
    while let Some((_, rest)) = name.split_once(BREAKS).filter(|(word, _)| is_of_map(word)) {
        name = rest;
    }
    let folder = || {
        file.parent().and_then(Path::file_name).map(|folder| folder.to_string_lossy().into_owned())
    };
    let says_nothing = is_of_map(name) || !name.chars().any(char::is_alphabetic);
    says_nothing
        .then(folder)
        .flatten()
        .unwrap_or_else(|| if says_nothing { stem.clone() } else { name.to_owned() })
}

/// Groups files of the same folder and name; unrecognized files are left out, and so are sets of
/// one file.
pub fn sets(files: &[PathBuf]) -> Vec<MapSet> {
    let mut found: Vec<(PathBuf, MapSet)> = Vec::new();
    for file in files {
        let Some((name, part)) = part_of(file) else { continue };
        let folder = file.parent().unwrap_or(Path::new("")).to_path_buf();
        let at =
            found.iter().position(|(f, s)| *f == folder && s.name == name).unwrap_or_else(|| {
                found.push((folder.clone(), MapSet { name: name.clone(), ..MapSet::default() }));
                found.len() - 1
            });
        let set = &mut found[at].1;
        let place = match part {
            MapPart::Normal => &mut set.normal,
            MapPart::Depth => &mut set.depth,
            MapPart::Mask => &mut set.mask,
        };
        place.get_or_insert_with(|| file.clone());
    }
    let several = |s: &MapSet| [&s.normal, &s.depth, &s.mask].into_iter().flatten().count() > 1;
    found.into_iter().map(|(_, set)| set).filter(several).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_object_is_called_as_its_file_or_its_folder() {
        for (file, name) in [
            ("/art/pot_n.png", "pot"),
            ("/art/Old Pot_Normal_GL.png", "Old Pot"),
            ("/art/Bricks102_1K-JPG_NormalGL.jpg", "Bricks102_1K-JPG"),
            ("/art/bunny/normal_gl8.png", "bunny"),
            ("/art/bunny/normal.png", "bunny"),
            ("/art/turn/normal_007.png", "turn"),
            ("/art/bunny.exr", "bunny"),
            ("normal.png", "normal"),
        ] {
            assert_eq!(object_of(Path::new(file)), name, "{file}");
        }
    }

    #[test]
    fn endings_tell_the_part_and_the_rest_the_object() {
        let part = |name: &str| part_of(Path::new(name));
        assert_eq!(part("maps/Pot_N.png"), Some(("pot".into(), MapPart::Normal)));
        assert_eq!(part("pot-depth.exr"), Some(("pot".into(), MapPart::Depth)));
        assert_eq!(part("normal.png"), Some((String::new(), MapPart::Normal)));
        assert_eq!(part("normal_gl16.png"), Some(("gl16".into(), MapPart::Normal)));
        assert_eq!(part("depth16.png"), Some((String::new(), MapPart::Depth)));
        assert_eq!(part("d.png"), None);
        assert_eq!(part("sand.png"), None);
    }

    #[test]
    fn files_of_one_object_and_folder_make_a_set() {
        let files: Vec<PathBuf> = ["a/pot_nrm.png", "a/pot_z.exr", "b/pot_mask.png", "a/photo.jpg"]
            .map(Into::into)
            .into();
        let found = sets(&files);
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].depth.as_deref(), Some(Path::new("a/pot_z.exr")));
        assert_eq!(found[0].mask, None);
    }
}
