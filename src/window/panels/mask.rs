//! The mask of the selected layer.
//! Floor 7.

use super::properties::Setter;
use crate::document::{Layer, MaskKind};
use crate::session::Property;
use crate::session::actions::LayerAction;
use crate::session::actions::pictures::Part;
use crate::session::property::{DerivedMask, MaskNumbers};
use crate::widgets::{Changed, Number, check, choice_row, title};
use eframe::egui::Ui;

/// The kinds of mask that a panel makes; a picture's is kept as it is.
#[derive(Clone, Copy, PartialEq)]
enum MaskChoice {
    None,
    File,
    Fresnel,
    Curvature,
    Depth,
}

/// The mask of a layer: of what it is made, whether it counts, and whether the brush paints on it.
pub fn show(ui: &mut Ui, layer: &Layer, on_mask: bool, setter: &mut Setter) {
    title(ui, "Mask");
    let current = match layer.mask.as_ref().map(|mask| &mask.kind) {
        None => MaskChoice::None,
        Some(MaskKind::File { .. }) => MaskChoice::File,
        Some(MaskKind::Fresnel { .. }) => MaskChoice::Fresnel,
        Some(MaskKind::Curvature { .. }) => MaskChoice::Curvature,
        Some(MaskKind::Depth { .. }) => MaskChoice::Depth,
    };
    let all = [
        (MaskChoice::None, "none"),
        (MaskChoice::Fresnel, "fresnel"),
        (MaskChoice::Curvature, "curvature"),
        (MaskChoice::Depth, "depth"),
        (MaskChoice::File, "paint"),
    ];
    let offered = if current == MaskChoice::File { &all[..] } else { &all[..4] };
    if let Some(to) = choice_row(ui, "Made of", current, offered) {
        let numbers = match to {
            MaskChoice::Fresnel => Some(MaskNumbers::Fresnel { f0: 0.04, power: 5.0 }),
            MaskChoice::Curvature => Some(MaskNumbers::Curvature { scale: 4.0, blur: 1.0, from: 0.0, to: 1.0 }),
            MaskChoice::Depth => Some(MaskNumbers::Depth { from: 0.0, to: 1.0 }),
            MaskChoice::None | MaskChoice::File => None,
        };
        setter.set(Property::Mask { mask: numbers.map(DerivedMask) }, true);
    }
    ui.horizontal_wrapped(|ui| {
        match &layer.mask {
            None => {
                for (text, hides, hint) in [
                    ("Show all", false, "A mask to paint on that shows the whole layer: paint black to hide"),
                    ("Hide all", true, "A mask to paint on that hides the whole layer: paint white to show"),
                ] {
                    if ui.button(text).on_hover_text(hint).clicked() {
                        setter.act(|layer| LayerAction::PaintMask { layer, hides });
                    }
                }
            }
            Some(mask) if matches!(mask.kind, MaskKind::File { .. }) => {
                let hint = "The brush and the eraser change the mask: white shows, black and the eraser hide";
                if ui.selectable_label(on_mask, "Paint on mask").on_hover_text(hint).clicked() {
                    setter.act(|layer| LayerAction::OnMask { layer, on: !on_mask });
                }
            }
            Some(_) => {
                let hint = "Make paint of it, to be changed with the brush; it follows the surface no longer";
                if ui.button("Paint on it").on_hover_text(hint).clicked() {
                    setter.act(|layer| LayerAction::PaintMask { layer, hides: false });
                }
            }
        }
        setter.choose(ui, Part::Mask, "From a picture…");
        if layer.mask.is_some() && ui.button("Delete mask").clicked() {
            setter.set(Property::Mask { mask: None }, true);
        }
    });
    let Some(mask) = &layer.mask else { return };
    if let Some(numbers) = mask_numbers(ui, &mask.kind) {
        setter.take(Some(numbers.map(|numbers| Property::Mask { mask: Some(DerivedMask(numbers)) })));
    }
    if let Some(on) = check(ui, "Invert mask", "Paint where the mask is dark", mask.invert) {
        setter.set(Property::MaskInverted { on }, true);
    }
    if let Some(on) = check(ui, "Use mask", "Without it the layer shows as if it had none", !mask.disabled) {
        setter.set(Property::MaskDisabled { on: !on }, true);
    }
}

fn mask_numbers(ui: &mut Ui, kind: &MaskKind) -> Option<Changed<MaskNumbers>> {
    match *kind {
        MaskKind::File { .. } => None,
        MaskKind::Fresnel { f0, power } => {
            let a = Number::new("Facing", 0.0..=1.0, "Coverage where the surface faces you").row(ui, f0);
            let b = Number::new("Power", 0.2..=10.0, "How near the rim it stays").row(ui, power);
            a.map(|c| c.map(|f0| MaskNumbers::Fresnel { f0, power }))
                .or(b.map(|c| c.map(|power| MaskNumbers::Fresnel { f0, power })))
        }
        MaskKind::Curvature { scale, blur, from, to } => {
            let a = Number::new("Scale", 0.0..=40.0, "Features this wide count in full, px").row(ui, scale);
            let b = Number::new("Blur", 0.0..=20.0, "Of the normals before, px").row(ui, blur);
            let c = Number::new("From", -1.0..=1.0, "Curvature where nothing is painted").row(ui, from);
            let d = Number::new("To", -1.0..=1.0, "Curvature where all is painted").row(ui, to);
            a.map(|v| v.map(|scale| MaskNumbers::Curvature { scale, blur, from, to }))
                .or(b.map(|v| v.map(|blur| MaskNumbers::Curvature { scale, blur, from, to })))
                .or(c.map(|v| v.map(|from| MaskNumbers::Curvature { scale, blur, from, to })))
                .or(d.map(|v| v.map(|to| MaskNumbers::Curvature { scale, blur, from, to })))
        }
        MaskKind::Depth { from, to } => {
            let a = Number::new("From", 0.0..=1.0, "Depth where nothing is painted").row(ui, from);
            let b = Number::new("To", 0.0..=1.0, "Depth where all is painted").row(ui, to);
            a.map(|c| c.map(|from| MaskNumbers::Depth { from, to }))
                .or(b.map(|c| c.map(|to| MaskNumbers::Depth { from, to })))
        }
    }
}
