//! Actions on the canvas of the document in front: its borders, its size, its orientation. What
//! cannot be done says why. Floor 6. Not here: what a document becomes (`document::canvas_change`,
//! `document::scale`).

use crate::document::canvas_change::{CanvasAnchor, CanvasChange, CanvasMirror};
use crate::document::{Document, Progress, flatten};
use crate::io::Budget;
use crate::io::profile_change::{self, ProfileChange};
use crate::math::{ColorProfile, Rect, Size};
use crate::raster::{CoverageGrid, Resampling};
use crate::session::open_document::Edit;
use crate::session::replay::{actions, names, record};
use crate::session::{OpenDocument, Session};
use crate::tools::crop::CropAspect;
use std::path::Path;

names!(CropAspect);
record!(Rect { x0, y0, x1, y1 });
names!(CanvasAnchor);
names!(CanvasMirror);
names!(Resampling);
names!(ColorProfile);
names!(ProfileChange);

actions! {
    /// All except the area of the crop tool are steps that can be undone. Paint beyond the canvas is kept.
    CanvasAction {
        /// To a rectangle, which may reach beyond the canvas.
        "crop" Crop { to: Rect }
        "crop to selection" CropToSelection {}
        /// To the rectangle around all that is painted.
        "trim" Trim {}
        /// Borders move, the picture does not; `anchor` is what stays in place.
        "size" Size { width: u32, height: u32, anchor: CanvasAnchor }
        /// The picture becomes larger or smaller.
        "scale" Scale { width: u32, height: u32, filter: Resampling }
        /// Degrees, counter-clockwise.
        "turn" Turn { degrees: f32 }
        "mirror" Mirror { mirror: CanvasMirror }
        /// Another color profile: assigned, numbers stay; converted, colors stay.
        "profile" Profile { profile: ColorProfile, change: ProfileChange }
        /// The area that the crop tool cuts out, or none.
        "frame" CropArea { frame: Option<Rect> }
        /// The aspect that it keeps.
        "aspect" Aspect { aspect: CropAspect }
    }
}

impl CanvasAction {
    /// Performs it.
    pub fn apply(&self, session: &mut Session) {
        session.drop_gesture();
        match self {
            CanvasAction::CropArea { frame: area } => {
                return session.tools.crop.area =
                    area.map(limit_to_range).filter(|area| !area.is_empty());
            }
            CanvasAction::Aspect { aspect } => {
                session.tools.crop.aspect = *aspect;
                let canvas = session.active().map(|open| open.document().size);
                session.tools.crop.area = session
                    .tools
                    .crop
                    .area
                    .zip(canvas)
                    .map(|(area, canvas)| aspect.apply(area, canvas));
                return;
            }
            _ => session.tools.crop.area = None,
        }
        let Some(open) = session.active_mut() else { return session.say("There is no document.") };
        open.forget_preview();
        match self.step(open.document(), &Progress::default()) {
            Ok(Edit { label, document, note, .. }) => {
                if open.commit(label, document) {
                    forget_places(open);
                    note.into_iter().for_each(|note| session.say(note));
                }
            }
            Err(why) => session.say(&why),
        }
    }

    /// What a long step is doing, which the window therefore runs on another thread.
    pub fn takes_long(&self) -> Option<&'static str> {
        match self {
            CanvasAction::Trim {} => Some("Trimming the canvas"),
            CanvasAction::Profile { .. } => Some("Changing the color profile"),
            _ => None,
        }
    }

    /// The step on a document, or why there is none; `None` once it is canceled.
    pub fn long_step(
        &self,
        document: &Document,
        progress: &Progress,
    ) -> Option<Result<Edit, String>> {
        let edit = self.step(document, progress);
        (!progress.is_canceled()).then_some(edit)
    }

    /// The step, or why there is none.
    fn step(&self, document: &Document, progress: &Progress) -> Result<Edit, String> {
        let edit = |label, document| Edit { label, document, select: Vec::new(), note: None };
        let size = document.size;
        let (label, change) = match self {
            CanvasAction::Crop { to } => ("Crop", crop_to(size, *to)?),
            CanvasAction::CropToSelection {} => {
                let selected =
                    document.active_coverage().ok_or("Nothing is selected.")?.covered_rect();
                ("Crop to selection", crop_to(size, selected.intersect(size.rect()))?)
            }
            CanvasAction::Trim {} => {
                let nothing = || "There is no paint to trim to.".to_owned();
                let painted = flatten(document, progress).ok_or_else(nothing)?;
                let painted =
                    CoverageGrid::of_alpha(&painted).covered_rect().intersect(size.rect());
                if painted.is_empty() {
                    return Err(nothing());
                }
                if painted == size.rect() {
                    return Err(
                        "There is nothing to trim: the picture reaches every border.".into()
                    );
                }
                ("Trim", crop_to(size, painted)?)
            }
            CanvasAction::Size { width, height, anchor } => {
                let to = check_size(*width, *height)?;
                let change = CanvasChange::resize(size, to, *anchor);
                ("Canvas size", change.ok_or("A canvas has at least one pixel.")?)
            }
            CanvasAction::Scale { width, height, filter } => {
                let to = check_size(*width, *height)?;
                if to == size {
                    return Err("The picture already has that size.".into());
                }
                let next = document
                    .resampled(to, *filter)
                    .map_err(|why| format!("The picture was not changed: {why}."));
                return Ok(edit("Image size", next?));
            }
            CanvasAction::Turn { degrees } => {
                let change = CanvasChange::turn(size, f64::from(*degrees));
                check_size(change.size().width, change.size().height)?;
                ("Turn canvas", change)
            }
            CanvasAction::Mirror { mirror } => {
                ("Mirror canvas", CanvasChange::mirror(size, *mirror))
            }
            CanvasAction::Profile { profile, change } => {
                return change_profile(document, *profile, *change);
            }
            CanvasAction::CropArea { .. } | CanvasAction::Aspect { .. } => {
                return Err("There is no frame.".into());
            }
        };
        if change.is_none() {
            return Err("The canvas would stay the same.".into());
        }
        Ok(edit(label, document.on_other_canvas(&change)?))
    }
}

/// The document in another color profile.
fn change_profile(
    document: &Document,
    profile: ColorProfile,
    change: ProfileChange,
) -> Result<Edit, String> {
    if document.profile == profile {
        return Err(format!("The document's color profile is {} already.", profile.label()));
    }
    let (label, document, note) = match change {
        ProfileChange::Assign => {
            ("Assign color profile", profile_change::assign(document, profile), None)
        }
        ProfileChange::Convert => {
            let budget = Budget::of_this_machine();
            let made = profile_change::convert(document, profile, &budget);
            let note = "Some colors are more saturated than the profile allows; they became the \
                        nearest it has.";
            ("Convert color profile", made.document, made.is_clamped.then_some(note))
        }
    };
    Ok(Edit { label, document, select: Vec::new(), note })
}

/// Places on the old canvas mean nothing on another one.
pub fn forget_places(open: &mut OpenDocument) {
    (open.last_end, open.clone_source, open.last_selection) = (None, None, None);
}

/// An area within the range of pixels.
fn limit_to_range(area: Rect) -> Rect {
    const FAR: i32 = 1_000_000;
    let [x0, y0, x1, y1] = [area.x0, area.y0, area.x1, area.y1].map(|v| v.clamp(-FAR, FAR));
    Rect::new(x0, y0, x1, y1)
}

fn crop_to(from: Size, to: Rect) -> Result<CanvasChange, String> {
    let change = CanvasChange::crop(from, limit_to_range(to))
        .ok_or("The frame contains no pixel of the canvas.")?;
    check_size(change.size().width, change.size().height)?;
    Ok(change)
}

/// A size that fits this machine's memory.
fn check_size(width: u32, height: u32) -> Result<Size, String> {
    let budget = Budget::of_this_machine();
    budget
        .size(Path::new("canvas"), width.into(), height.into())
        .map_err(|error| format!("{error}."))
}
