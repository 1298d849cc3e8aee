//! What holds after every story: see `docs/PROJECTS.md`. Each broken promise has a kind, by which
//! stories that fail in one way are counted and shrunk.

use super::names;
use crate::document::{Document, MemoryUse, Progress, flatten, flatten_rounding_once};
use crate::io::export::ExportOptions;
use crate::io::export::high_depth::encode_document;
use crate::io::project::{self, Archive};
use crate::io::{Budget, picture, psd, recipe};
use crate::math::ColorProfile;
use crate::raster::picture::Texels;
use crate::session::actions::Action;
use crate::session::memory::HeldDocuments;
use crate::session::{Autosave, OpenDocument, Session, is_same};
use std::any::Any;
use std::path::Path;

/// A promise that was not kept.
#[derive(Clone, Debug)]
pub struct Broken {
    /// Of stories that fail in the same way; without numbers and names.
    pub kind: String,
    pub what: String,
}

impl Broken {
    pub fn new(kind: &str, what: String) -> Self {
        Self { kind: kind.into(), what }
    }

    /// One whose kind is also what was said, without numbers and what is in quotes.
    fn from_message(kind: &str, what: impl ToString) -> Self {
        let what = what.to_string();
        let mut is_quoted = false;
        let plain: String = what
            .chars()
            .filter(|&c| {
                is_quoted = (is_quoted || c == '“') && c != '”';
                !is_quoted && !c.is_ascii_digit()
            })
            .collect();
        Self { kind: format!("{kind}: {plain}"), what }
    }

    pub fn from_panic(panic: &(dyn Any + Send)) -> Self {
        let text = panic.downcast_ref::<String>().cloned();
        let text = text.or_else(|| panic.downcast_ref::<&str>().map(|text| (*text).to_owned()));
        Self::from_message("panic", text.unwrap_or_else(|| "without words".into()))
    }
}

type Kept = Result<(), Broken>;

/// A document as it was at some step, and what it was like.
pub struct Seen {
    document: Document,
    fingerprint: (String, u32),
}

impl Seen {
    pub fn now(session: &Session) -> Result<Option<Self>, Broken> {
        let document = session.active().map(|open| open.document().clone());
        document
            .map(|document| Ok(Self { fingerprint: fingerprint(&document)?, document }))
            .transpose()
    }
}

/// What a document is: its parameters and its picture.
fn fingerprint(document: &Document) -> Result<(String, u32), Broken> {
    Ok((recipe::write(document).to_string(), crc32fast::hash(&render(document)?)))
}

pub fn fingerprints(session: &Session) -> Result<Vec<(String, u32)>, Broken> {
    session.open_documents.iter().map(|open| fingerprint(open.document())).collect()
}

fn render(document: &Document) -> Result<Vec<u8>, Broken> {
    let tiles = flatten(document, &Progress::default());
    let tiles = tiles.ok_or_else(|| Broken::new("not rendered", String::new()))?;
    Ok(tiles.to_straight_rgba(document.size.rect()))
}

/// An action that failed changed nothing.
pub fn nothing_changed(session: &Session, before: Option<(usize, Document)>, why: &str) -> Kept {
    let now = session.active().map(|open| (open.key, open.document()));
    match (&before, now) {
        (Some((key, before)), Some((now_key, now))) if *key == now_key && is_same(before, now) => {
            Ok(())
        }
        (None, None) => Ok(()),
        _ => Err(Broken::from_message("failed, and yet changed", why)),
    }
}

/// What an edit accepted, files can hold, and what it changed is called by its name; what was
/// refused changed nothing, and is called by its name, too.
pub fn after_step(
    session: &Session,
    action: &Action,
    before: Option<(usize, Document)>,
    told: &[String],
) -> Kept {
    let Some(open) = session.active() else { return Ok(()) };
    let refused = told.iter().find(|note| note.ends_with("Nothing was changed."));
    let Some((_, before)) = before.filter(|(key, _)| *key == open.key) else { return Ok(()) };
    let is_changed = !is_same(&before, open.document());
    if let Some(note) = refused {
        names::refusal_is_named(action, &before, note)?;
        if is_changed {
            return Err(Broken::from_message("refused, and yet changed", note));
        }
    }
    if !is_changed {
        return Ok(());
    }
    names::difference_is_named(action, &before, open.document())?;
    open.document()
        .fits(None)
        .map_err(|why| Broken::from_message("accepted, and does not fit", why))
}

/// Everything that holds at the end of a story.
pub fn at_end(session: &mut Session, seen: &[Seen], all_formats: bool) -> Kept {
    let before = fingerprints(session)?;
    for open in &session.open_documents {
        is_kept(open.document(), all_formats)?;
    }
    // What is kept for speed goes, and comes again.
    if let Some(held) = session.held_documents() {
        is_below_limit(session, &held)?;
        let kept = held.count(0).all.kept;
        let again = session.held_documents().map(|held| held.count(u64::MAX).all.kept);
        if again != Some(kept) {
            return Err(Broken::new("memory", format!("{kept} bytes were kept, then {again:?}")));
        }
    }
    if fingerprints(session)? != before {
        return Err(Broken::new("without what was kept for speed, another picture", String::new()));
    }
    session.open_documents.iter_mut().try_for_each(|open| steps(open, seen))
}

/// Beyond what is shown, no more is kept for speed than the limit and one more step.
fn is_below_limit(session: &Session, held: &HeldDocuments) -> Kept {
    let kept = |document: &Document| MemoryUse::of(document).kept;
    let shown: u64 = session.open_documents.iter().map(|open| kept(open.shown_document())).sum();
    // While a change is only shown, the document beneath it is one of them.
    let steps = session.open_documents.iter().flat_map(|open| {
        [open.document(), open.saved_document()].into_iter().chain(open.history.others())
    });
    let largest = steps.map(kept).max().unwrap_or_default();
    let limit = held.count(u64::MAX).all.kept / 2;
    let now = held.count(limit).all.kept;
    match now <= limit.max(shown).saturating_add(largest) {
        true => Ok(()),
        false => Err(Broken::new("memory", format!("{now} bytes are kept, beyond {limit}"))),
    }
}

/// Steps that are undone: each is drawn anew.
const STEPS: usize = 4;

/// Undone and made again, every document is the one that was.
fn steps(open: &mut OpenDocument, seen: &[Seen]) -> Kept {
    let last = open.document().clone();
    let ahead = open.history.future_labels().len() as i32;
    open.walk(ahead);
    let mut known = Vec::new();
    loop {
        let now = fingerprint(open.document())?;
        let was = seen.iter().find(|seen| is_same(&seen.document, open.document()));
        if let Some(was) = was.filter(|was| was.fingerprint != now) {
            let what = if was.fingerprint.0 == now.0 { "the picture" } else { "what it is" };
            return Err(Broken::new("undone, another document", what.into()));
        }
        known.push(now);
        if open.history.past_names().next().is_none() || known.len() > STEPS {
            break;
        }
        open.walk(-1);
    }
    for was in known.iter().rev().skip(1) {
        open.walk(1);
        if fingerprint(open.document())? != *was {
            return Err(Broken::new("redone, another document", String::new()));
        }
    }
    open.walk(-ahead);
    match is_same(&last, open.document()) {
        true => Ok(()),
        false => Err(Broken::new("walked, another document", String::new())),
    }
}

/// A document is saved and opened unchanged, by every way out.
fn is_kept(document: &Document, all_formats: bool) -> Kept {
    let (file, progress, budget) =
        (Path::new("a.ora"), Progress::default(), Budget::holding(document));
    let written = project::write(file, document, &progress)
        .map_err(|error| Broken::from_message("not saved", error))?;
    let bytes = written.unwrap_or_default();
    let read = project::read(file, &bytes, &budget)
        .map_err(|error| Broken::from_message("not opened", error))?;
    // What it says of itself is no loss.
    let own = document.notes_of_parts();
    if let Some(note) = read.notes.iter().find(|note| !own.contains(note)) {
        return Err(Broken::from_message("opened with a note", note));
    }
    if let Some(what) = document.difference(&read.document) {
        return Err(Broken::from_message("reopened, it differs in", what));
    }
    let picture = render(document)?;
    same_bytes("reopened, another picture", &picture, &render(&read.document)?)?;
    same_bytes("the merged picture", &picture, &read_merged(file, &bytes, document.profile)?)?;
    let again = project::write(file, &read.document, &progress)
        .map_err(|error| Broken::from_message("not saved again", error))?;
    if again.is_none_or(|again| again != bytes) {
        return Err(Broken::new("saved again, other bytes", String::new()));
    }
    compare_exports(document, &read.document, &picture, if all_formats { &[8, 16] } else { &[8] })?;
    if all_formats { is_kept_by_photoshop(document, &picture) } else { Ok(()) }
}

/// Pictures of both are the same, and what is shown.
fn compare_exports(
    document: &Document,
    reopened: &Document,
    picture: &[u8],
    depths: &[u8],
) -> Kept {
    let (file, progress, budget) =
        (Path::new("a.png"), Progress::default(), Budget::holding(document));
    for &bits in depths {
        let options = ExportOptions { bits: Some(bits), ..ExportOptions::default() };
        let bytes = |document: &Document| {
            let bytes = encode_document(file, document, &options, &budget, &progress);
            bytes
                .map_err(|error| Broken::from_message("not exported", error))
                .map(Option::unwrap_or_default)
        };
        let bytes = [bytes(document)?, bytes(reopened)?];
        if bytes[0] != bytes[1] {
            return Err(Broken::new("reopened, another export", format!("{bits} bits")));
        }
        if bits == 8 {
            // Where blend modes are steep, exports are rounded once, and the screen layer by layer.
            let once = || {
                flatten_rounding_once(document, &progress)
                    .map(|tiles| tiles.to_straight_rgba(document.size.rect()))
            };
            let once = document.is_rounding_visible().then(once).flatten();
            same_bytes(
                "exported, another picture",
                once.as_deref().unwrap_or(picture),
                &decode(file, &bytes[0], document.profile)?,
            )?;
        }
    }
    Ok(())
}

/// Our Photoshop files hold the document as it is.
fn is_kept_by_photoshop(document: &Document, picture: &[u8]) -> Kept {
    let (file, progress, budget) =
        (Path::new("a.psd"), Progress::default(), Budget::holding(document));
    let written = psd::write(file, document, &progress)
        .map_err(|error| Broken::from_message("psd: not saved", error))?;
    let Some(written) = written else { return Ok(()) };
    let read = psd::read(file, &written.bytes, &budget)
        .map_err(|error| Broken::from_message("psd: not opened", error))?;
    let own = document.notes_of_parts();
    if let Some(note) = read.notes.iter().find(|note| !own.contains(note)) {
        return Err(Broken::from_message("psd: opened with a note", note));
    }
    if let Some(what) = document.difference(&read.document) {
        return Err(Broken::from_message("psd: reopened, it differs in", what));
    }
    same_bytes("psd: reopened, another picture", picture, &render(&read.document)?)
}

/// The picture in a project.
fn read_merged(file: &Path, bytes: &[u8], profile: ColorProfile) -> Result<Vec<u8>, Broken> {
    let archive = Archive::open(file, bytes, &Budget::default());
    let merged = archive.and_then(|archive| archive.bytes("mergedimage.png", u64::MAX));
    let merged = merged.map_err(|error| Broken::from_message("no merged picture", error))?;
    decode(file, &merged, profile)
}

/// The numbers of a picture in the profile of a document.
fn decode(file: &Path, bytes: &[u8], profile: ColorProfile) -> Result<Vec<u8>, Broken> {
    let picture = picture::decode(file, bytes, &Budget { profile, ..Budget::default() })
        .map_err(|error| Broken::from_message("not decoded", error))?;
    match picture.texels {
        Texels::Srgb8(texels) => Ok(texels.as_flattened().to_vec()),
        _ => Err(Broken::new("not decoded as bytes", String::new())),
    }
}

fn same_bytes(kind: &str, a: &[u8], b: &[u8]) -> Kept {
    let pixels = a.chunks(4).zip(b.chunks(4));
    let differing = pixels.filter(|(a, b)| a != b).count();
    if a.len() == b.len() && differing == 0 {
        return Ok(());
    }
    let most = a.iter().zip(b).map(|(a, b)| a.abs_diff(*b)).max().unwrap_or_default();
    Err(Broken::new(kind, format!("{differing} of {} pixels, by {most} at most", a.len() / 4)))
}

/// After a crash every document with edits that no file holds comes back as it was.
pub fn recover(session: &mut Session, folder: &Path) -> Kept {
    session.keep();
    let Some(autosave) = session.autosave.take() else { return Ok(()) };
    autosave.wait_until_written();
    drop(autosave);
    let lost = Autosave::new(folder.into()).find_lost_sessions();
    let mut back = Vec::new();
    for left in lost.list() {
        let recovered = lost.bring_back(left, &Progress::default());
        let recovered = recovered.map_err(|error| Broken::from_message("not recovered", error))?;
        back.extend(recovered.map(|recovered| recovered.open.document().clone()));
    }
    for open in session.open_documents.iter().filter(|open| open.is_dirty()) {
        let differences: Vec<_> =
            back.iter().map(|document| open.document().difference(document)).collect();
        let Some(index) = differences.iter().position(Option::is_none) else {
            let what = differences.into_iter().flatten().last();
            return Err(Broken::from_message(
                "recovered, it differs in",
                what.unwrap_or_else(|| "everything".into()),
            ));
        };
        same_bytes(
            "recovered, another picture",
            &render(open.document())?,
            &render(&back[index])?,
        )?;
    }
    Ok(())
}
