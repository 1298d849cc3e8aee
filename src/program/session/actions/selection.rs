//! Actions on the selection of the document in front. What cannot be done says why. Floor 6. Not
//! here: selections made by the pen (`tools::select`), cutting and copying (`clipboard`).

use crate::document::Document;
use crate::math::range::clamp_to_range;
use crate::math::{COORDINATE, Vec2, vec2};
use crate::paint::Selection;
use crate::raster::CoverageGrid;
use crate::raster::coverage::{SelectionMode, edges};
use crate::session::replay::{actions, as_in_recipes, names, record};
use crate::session::{LayerPath, Session};
use crate::surface::region::{RegionKind, SurfaceRegion};
use crate::tools::{SelectSettings, select};

names!(SelectionMode);
names!(RegionKind);
as_in_recipes!(SurfaceRegion);
record!(SelectSettings { combine, wand, joined, region });

rilievo_engine::named! {
    /// How the edge of a selection is changed. The hint says what its number means.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    pub enum EdgeChange {
        Grow = "grow" => ("Grow selection", "How far the edge moves outward"),
        Shrink = "shrink" => ("Shrink selection", "How far the edge moves inward"),
        Border = "border" => ("Border of selection", "Width of the band about the edge"),
        Feather = "feather" => ("Feather selection", "How soft the edge becomes: the blur's standard deviation"),
        Smooth = "smooth" => ("Smooth selection", "How far corners are rounded: the blur's standard deviation"),
    }
}

impl EdgeChange {
    /// The range of its number, px.
    pub fn range(self) -> crate::math::Range {
        match self {
            EdgeChange::Grow | EdgeChange::Shrink | EdgeChange::Border => edges::DISTANCE_PX,
            EdgeChange::Feather | EdgeChange::Smooth => edges::SOFTNESS_PX,
        }
    }

    fn of(self, grid: &CoverageGrid, px: f32, canvas: crate::math::Rect) -> CoverageGrid {
        let px = clamp_to_range(px, &self.range());
        match self {
            EdgeChange::Grow => edges::grown(grid, px, canvas),
            EdgeChange::Shrink => edges::grown(grid, -px, canvas),
            EdgeChange::Border => edges::border(grid, px, canvas),
            EdgeChange::Feather => edges::feathered(grid, px, canvas),
            EdgeChange::Smooth => edges::smooth(grid, px, canvas),
        }
    }
}
names!(EdgeChange);

actions! {
    /// `how` says how a new selection is combined with the present one.
    SelectionAction {
        "all" All {}
        "none" None {}
        /// The last selection that was dropped.
        "again" Again {}
        "invert" Invert {}
        "change" Change { change: EdgeChange, px: f32 }
        /// By whole pixels; what is selected stays where it is.
        "move" Move { by: Vec2 }
        /// By the surface, about a point.
        "region" Region { region: SurfaceRegion, how: SelectionMode }
        /// Where a layer is opaque.
        "layer" Layer { layer: LayerPath, how: SelectionMode }
        /// What a layer's mask shows.
        "mask" Mask { layer: LayerPath, how: SelectionMode }
        /// The selection becomes a layer's mask.
        "to mask" ToMask { layer: LayerPath }
        /// Kept by a name, replacing one of that name.
        "keep" Keep { name: String }
        "take" Take { name: String, how: SelectionMode }
        "forget" Forget { name: String }
        /// Closes the lasso whose corners are being set, or drops it.
        "close lasso" CloseLasso {}
        "drop lasso" DropLasso {}
        /// The brush paints on the selection, under red, or on the layer again.
        "quick mask" QuickMask { on: bool }
        /// Hides the outline, or shows it again.
        "hide" Hide { on: bool }
        "settings" Settings { select: SelectSettings }
    }
}

const NOTHING: &str = "Nothing is selected.";

impl SelectionAction {
    /// Performs it.
    pub fn apply(&self, session: &mut Session) {
        match self {
            SelectionAction::Hide { on } => return session.hides_selection = *on,
            SelectionAction::Settings { select } => {
                return session.tools.select =
                    SelectSettings { region: clamp_to_ranges(&select.region), ..*select };
            }
            SelectionAction::DropLasso {} => return session.tools.lasso.clear(),
            _ => session.drop_gesture(),
        }
        let (lasso, settings) = (std::mem::take(&mut session.tools.lasso), session.tools.select);
        let Some(open) = session.active_mut() else { return session.say("There is no document.") };
        open.forget_preview();
        if let SelectionAction::QuickMask { on } = self {
            open.quick_mask = *on;
            return;
        }
        let last = open.last_selection.clone();
        let step = match self {
            SelectionAction::CloseLasso {} => {
                let closed = select::select_closed_lasso(open.document(), &lasso, &settings);
                closed.map(|next| ("Select", next)).ok_or("A lasso needs at least three corners.")
            }
            SelectionAction::Again {} if open.document().active_selection.is_none() => match last {
                Some(last) => Ok((
                    "Select again",
                    Document { active_selection: Some(last), ..open.document().clone() },
                )),
                None => Err("Nothing was selected before."),
            },
            _ => self.step(open.document()),
        };
        match step {
            Ok((label, next)) => {
                let is_emptied =
                    next.active_selection.is_none() && !matches!(self, SelectionAction::None {});
                let was_active = open.document().active_selection.is_some();
                if open.commit(label, next) && is_emptied && was_active {
                    session.say("Nothing is selected anymore.");
                }
            }
            Err(why) => session.say(why),
        }
    }

    /// The step: its name and the resulting document; or why there is none.
    fn step(&self, document: &Document) -> Result<(&'static str, Document), &'static str> {
        let canvas = document.size.rect();
        let selected = || document.active_coverage().ok_or(NOTHING);
        let with = |coverage: CoverageGrid| document.with_selection(Some(Selection::new(coverage)));
        let layer =
            |path: &LayerPath| path.find(document).cloned().ok_or("There is no such layer.");
        Ok(match self {
            SelectionAction::All {} => ("Select all", with(CoverageGrid::full(canvas))),
            SelectionAction::None {} => {
                selected()?;
                ("Deselect", document.with_selection(None))
            }
            SelectionAction::Invert {} => match document.active_coverage() {
                Some(grid) => ("Invert selection", with(grid.inverted(canvas))),
                // All of the canvas may be changed, so the inverse is empty.
                None => return Err("Nothing is selected, so there is nothing to invert."),
            },
            SelectionAction::Change { change, px } => {
                (change.label(), with(change.of(selected()?, *px, canvas)))
            }
            SelectionAction::Move { by } => {
                let by = vec2(clamp_to_range(by.x, &COORDINATE), clamp_to_range(by.y, &COORDINATE))
                    .round();
                ("Move selection", with(selected()?.shifted(by.x as i32, by.y as i32)))
            }
            SelectionAction::Region { region, how } => {
                if document.surface.is_none() {
                    return Err("There is no surface to select by.");
                }
                let found = Selection::of_region(clamp_to_ranges(region), &document.scene());
                if found.is_empty() {
                    return Err("That point is not on the surface.");
                }
                ("Select", document.with_combined(found, *how))
            }
            SelectionAction::Layer { layer: path, how } => {
                let found = layer_alpha(document, &*layer(path)?);
                if found.is_empty() {
                    return Err("The layer is empty: there is nothing to select.");
                }
                ("Select layer", document.with_combined(Selection::new(found), *how))
            }
            SelectionAction::Mask { layer: path, how } => {
                let layer = layer(path)?;
                if layer.mask.is_none() {
                    return Err("The layer has no mask.");
                }
                let shown =
                    document.with_transform_applied(layer.id).ok_or("There is no such layer.")?;
                let layer = shown.layer(layer.id).ok_or("There is no such layer.")?;
                let found = shown.mask_coverage(layer);
                ("Select mask", document.with_combined(Selection::new(found), *how))
            }
            SelectionAction::ToMask { layer: path } => {
                let (mask, layer) = (document.selection_as_mask().ok_or(NOTHING)?, layer(path)?);
                let shown =
                    document.with_transform_applied(layer.id).ok_or("There is no such layer.")?;
                let next = shown.with_layer(layer.id, |layer| layer.mask = Some(mask));
                ("Mask from selection", next.ok_or("There is no such layer.")?)
            }
            SelectionAction::Keep { name } => {
                ("Keep selection", document.with_kept_selection(name).ok_or(NOTHING)?)
            }
            SelectionAction::Take { name, how } => {
                let kept = document.selections.iter().find(|kept| kept.name == *name);
                let selection =
                    kept.ok_or("There is no selection with that name.")?.selection.clone();
                let next = match how {
                    // The very same selection, so that it is stored once.
                    SelectionMode::Replace => {
                        Document { active_selection: Some(selection), ..document.clone() }
                    }
                    _ => document.with_combined(Selection::clone(&selection), *how),
                };
                ("Select", next)
            }
            SelectionAction::Forget { name } => {
                let next = document
                    .without_kept_selection(name)
                    .ok_or("There is no selection with that name.")?;
                ("Forget selection", next)
            }
            SelectionAction::Again {} => {
                return Err("Something is selected. “Select again” restores the last selection \
                            after it was dropped.");
            }
            SelectionAction::CloseLasso {}
            | SelectionAction::DropLasso {}
            | SelectionAction::QuickMask { .. }
            | SelectionAction::Hide { .. }
            | SelectionAction::Settings { .. } => return Err(NOTHING),
        })
    }
}

/// A region whose numbers are those that a document may hold.
fn clamp_to_ranges(region: &SurfaceRegion) -> SurfaceRegion {
    SurfaceRegion {
        tolerance: clamp_to_range(region.tolerance, &region.kind.tolerances()),
        softness: clamp_to_range(region.softness, &SurfaceRegion::SOFTNESS),
        ..*region
    }
}

/// How opaque a layer is without its opacity and mask.
fn layer_alpha(document: &Document, layer: &crate::document::Layer) -> CoverageGrid {
    use crate::document::{Content, Progress, flatten_layer};
    // Where it shows.
    let Some(document) = &document.with_transform_applied(layer.id) else {
        return CoverageGrid::default();
    };
    let Some(layer) = document.layer(layer.id) else { return CoverageGrid::default() };
    if let Content::Pixels(pixels) = &layer.content {
        return CoverageGrid::of_alpha(&pixels.tiles).within(document.size.rect());
    }
    let bare = document.with_layer(layer.id, |layer| {
        (layer.opacity, layer.mask, layer.visible, layer.clip_below) = (1.0, None, true, false);
    });
    let painted = bare.and_then(|bare| flatten_layer(&bare, layer.id, &Progress::default()));
    painted.map_or_else(CoverageGrid::default, |tiles| {
        CoverageGrid::of_alpha(&tiles).within(document.size.rect())
    })
}
