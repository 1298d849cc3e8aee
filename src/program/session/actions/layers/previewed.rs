//! Changes of layers that are shown while they are chosen, and become a step when they are done.
//! Floor 6.

use super::texts;
use crate::document::{Document, LayerId};
use crate::math::PlaneMap;
use crate::paint::{ColorAdjustment, EffectLight, LiveAdjustment, LiveFilter, PictureFilter};
use crate::session::{LayerPaths, OpenDocument, Property, Session};
use crate::tools::gizmo::TransformTarget;
use crate::tools::path;
use crate::tools::transform::mapped;

/// A property of layers: a step, or a preview of one. Fails with a reason to tell.
pub fn set(
    open: &mut OpenDocument,
    layers: &LayerPaths,
    to: &Property,
    done: bool,
) -> Result<(), String> {
    let Some(ids) = layers.find(open.document()) else {
        open.forget_preview();
        return Ok(());
    };
    let next = match to {
        Property::Drawn { path } => path::replace_paths(open.document(), &ids, path)?,
        Property::Worded { text } => {
            texts::replace_texts(open.document(), open.shown_document(), &ids, text)
                .map_err(|why| why.to_string())?
        }
        _ => open.document().with_layers(&ids, |layer| to.apply(layer)),
    };
    match next {
        Some(document) if done => drop(open.commit(to.label(), document)),
        Some(document) if matches!(to, Property::Worded { .. }) => {
            open.show_typed(to.label(), document);
        }
        Some(document) => open.show(to.label(), document),
        None => {}
    }
    Ok(())
}

/// Another light of effects: a step, or a preview of one.
pub fn light_effects(open: &mut OpenDocument, light: EffectLight, done: bool) {
    const LABEL: &str = "Light of effects";
    let effect_light = light.clamp_to_ranges();
    let next = Document { effect_light, ..open.document().clone() };
    if done {
        open.commit(LABEL, next);
    } else {
        open.show(LABEL, next);
    }
}

/// The paint of layers adjusted: a step, or a preview of one. Layers that are no paint, or locked,
/// stay as they are.
pub fn adjust(session: &mut Session, layers: &LayerPaths, by: &ColorAdjustment, done: bool) {
    let live = LiveAdjustment::new(by.clone());
    let refused = "Select a paint layer that is not locked, or add an adjustment layer.";
    let change = |document: &Document, id| document.with_paint_adjusted(id, &live);
    change_paint(session, layers, (by.label(), refused), done, change);
}

/// The same, filtered.
pub fn filter_paint(session: &mut Session, layers: &LayerPaths, by: &PictureFilter, done: bool) {
    let live = LiveFilter::new(by.clone());
    let refused = "Select a paint layer that is not locked, or add a filter layer.";
    let change = |document: &Document, id| document.with_paint_filtered(id, &live);
    change_paint(session, layers, (by.label(), refused), done, change);
}

/// `label`: the name of the step, and what is said where there is no paint.
fn change_paint(
    session: &mut Session,
    layers: &LayerPaths,
    (label, refused): (&'static str, &str),
    done: bool,
    change: impl Fn(&Document, LayerId) -> Option<Document>,
) {
    let Some(open) = session.active_mut() else { return };
    let document = open.document();
    let (mut next, mut is_any) = (document.clone(), false);
    for id in layers.find(document).unwrap_or_default() {
        if let Some(changed) = change(&next, id) {
            (next, is_any) = (changed, true);
        }
    }
    match (is_any, done) {
        (true, true) => drop(open.commit(label, next)),
        (true, false) => open.show(label, next),
        (false, _) => {
            open.forget_preview();
            session.say(refused);
        }
    }
}

/// The document with what layers show moved by a map of the canvas: a step, or a preview of one.
pub fn take_along(session: &mut Session, layers: &LayerPaths, by: [f64; 6], done: bool) {
    let Some(open) = session.active_mut() else { return };
    open.hold_gizmo(TransformTarget::Paint);
    let document = open.document();
    let ids = layers.find(document).map(|ids| document.outermost(&ids)).unwrap_or_default();
    let map = PlaneMap::affine(by).filter(|_| !ids.is_empty());
    let next = map
        .and_then(|map| ids.iter().try_fold(document.clone(), |next, id| mapped(&next, *id, map)));
    match next {
        Some(next) if done => drop(open.commit("Transform", next)),
        Some(next) => open.show("Transform", next),
        None => open.forget_preview(),
    }
}
