//! The mask of the selected layer.
//! Floor 7.

use super::select::{softness, tolerance};
use super::setter::LayerSetter;
use crate::document::{DerivedMask, Layer, MaskKind};
use crate::language::tr;
use crate::session::PicturePart;
use crate::session::Property;
use crate::session::actions::LayerAction;
use crate::surface::region::SurfaceRegion;
use crate::widgets::{NumberField, ValueChange, check, choice_row, title};
use eframe::egui::Ui;

/// The kinds of mask in the menu; a picture is kept as it is.
#[derive(Clone, Copy, PartialEq)]
enum MaskChoice {
    None,
    File,
    Fresnel,
    Curvature,
    Depth,
    Region,
}

/// The mask of a layer: its kind, whether it is enabled, and whether the brush paints on it.
pub fn show(ui: &mut Ui, layer: &Layer, on_mask: bool, setter: &mut LayerSetter) {
    title(ui, "Mask");
    choose_kind(ui, layer, setter);
    buttons(ui, layer, on_mask, setter);
    let Some(mask) = &layer.mask else { return };
    if let Some(numbers) = mask.derived_mask().and_then(|derived| mask_numbers(ui, derived)) {
        setter.take(Some(numbers.map(|derived| Property::Mask { mask: Some(derived) })));
    }
    if let Some(on) = check(ui, "Invert mask", "Paint where the mask is dark", mask.invert) {
        setter.set(Property::MaskInverted { on }, true);
    }
    if let Some(on) =
        check(ui, "Use mask", "Turn off to show the layer without its mask", !mask.disabled)
    {
        setter.set(Property::MaskDisabled { on: !on }, true);
    }
}

/// What the mask is made of.
fn choose_kind(ui: &mut Ui, layer: &Layer, setter: &mut LayerSetter) {
    let current = match layer.mask.as_ref().map(|mask| &mask.kind) {
        None => MaskChoice::None,
        Some(MaskKind::File { .. }) => MaskChoice::File,
        Some(MaskKind::Derived(DerivedMask::Fresnel { .. })) => MaskChoice::Fresnel,
        Some(MaskKind::Derived(DerivedMask::Curvature { .. })) => MaskChoice::Curvature,
        Some(MaskKind::Derived(DerivedMask::Depth { .. })) => MaskChoice::Depth,
        Some(MaskKind::Derived(DerivedMask::Region(_))) => MaskChoice::Region,
    };
    let all = [
        (MaskChoice::None, "none"),
        (MaskChoice::Fresnel, "fresnel"),
        (MaskChoice::Curvature, "curvature"),
        (MaskChoice::Depth, "depth"),
        (MaskChoice::File, "paint"),
        (MaskChoice::Region, "region"),
    ];
    let own = all.iter().copied().filter(|(choice, _)| *choice == current);
    let offered: Vec<_> =
        all[..4].iter().copied().chain(own.filter(|(choice, _)| is_made(*choice))).collect();
    if let Some(to) = choice_row(ui, "Made of", current, &offered) {
        let mask = match to {
            MaskChoice::Fresnel => Some(DerivedMask::FRESNEL),
            MaskChoice::Curvature => {
                Some(DerivedMask::Curvature { scale: 4.0, blur: 1.0, from: 0.0, to: 1.0 })
            }
            MaskChoice::Depth => Some(DerivedMask::RAMP_OF_DEPTH),
            MaskChoice::None | MaskChoice::File | MaskChoice::Region => None,
        };
        setter.set(Property::Mask { mask }, true);
    }
}

/// What can be done with the mask as it is.
fn buttons(ui: &mut Ui, layer: &Layer, on_mask: bool, setter: &mut LayerSetter) {
    ui.horizontal_wrapped(|ui| {
        match &layer.mask {
            None => {
                for (text, hides, hint) in [
                    ("Show all", false, "A mask to paint on that shows the whole layer: paint black to hide"),
                    ("Hide all", true, "A mask to paint on that hides the whole layer: paint white to show"),
                ] {
                    if ui.button(tr(text)).on_hover_text(tr(hint)).clicked() {
                        setter.act(|layer| LayerAction::PaintMask { layer, hides });
                    }
                }
            }
            Some(mask) if matches!(mask.kind, MaskKind::File { .. }) => {
                let hint = "The brush and the eraser change the mask: white shows, black and the eraser hide";
                if ui.selectable_label(on_mask, tr("Paint on mask")).on_hover_text(tr(hint)).clicked() {
                    setter.act(|layer| LayerAction::OnMask { layer, on: !on_mask });
                }
            }
            Some(_) => {
                let hint = "Turns the mask into a picture that the brush can change; it no longer follows the surface";
                if ui.button(tr("Paint on it")).on_hover_text(tr(hint)).clicked() {
                    setter.act(|layer| LayerAction::PaintMask { layer, hides: false });
                }
            }
        }
        setter.choose(ui, PicturePart::Mask, "From a picture…");
        if layer.mask.is_some() && ui.button(tr("Delete mask")).clicked() {
            setter.set(Property::Mask { mask: None }, true);
        }
    });
}

/// It is made elsewhere, and listed only if present.
fn is_made(choice: MaskChoice) -> bool {
    matches!(choice, MaskChoice::File | MaskChoice::Region)
}

fn mask_numbers(ui: &mut Ui, mask: DerivedMask) -> Option<ValueChange<DerivedMask>> {
    match mask {
        DerivedMask::Region(region) => {
            let a = tolerance(region).row(ui, region.tolerance);
            let b = softness().row(ui, region.softness);
            a.map(|c| c.map(|tolerance| DerivedMask::Region(SurfaceRegion { tolerance, ..region })))
                .or(b.map(|c| {
                    c.map(|softness| DerivedMask::Region(SurfaceRegion { softness, ..region }))
                }))
        }
        DerivedMask::Fresnel { f0, power } => {
            let a = NumberField::new("Facing", 0.0..=1.0, "Coverage where the surface faces you")
                .row(ui, f0);
            let b = NumberField::new("Power", 0.2..=10.0, "How closely it follows the rim")
                .row(ui, power);
            a.map(|c| c.map(|f0| DerivedMask::Fresnel { f0, power }))
                .or(b.map(|c| c.map(|power| DerivedMask::Fresnel { f0, power })))
        }
        DerivedMask::Curvature { scale, blur, from, to } => {
            let a = NumberField::new("Scale", 0.0..=40.0, "Features this wide count in full, px")
                .row(ui, scale);
            let b = NumberField::new("Blur", 0.0..=20.0, "Blur of the normals, px").row(ui, blur);
            let c = NumberField::new("From", -1.0..=1.0, "Curvature at which nothing is painted")
                .row(ui, from);
            let d = NumberField::new("To", -1.0..=1.0, "Curvature at which everything is painted")
                .row(ui, to);
            a.map(|v| v.map(|scale| DerivedMask::Curvature { scale, blur, from, to }))
                .or(b.map(|v| v.map(|blur| DerivedMask::Curvature { scale, blur, from, to })))
                .or(c.map(|v| v.map(|from| DerivedMask::Curvature { scale, blur, from, to })))
                .or(d.map(|v| v.map(|to| DerivedMask::Curvature { scale, blur, from, to })))
        }
        DerivedMask::Depth { from, to } => {
            let a = NumberField::new("From", 0.0..=1.0, "Depth at which nothing is painted")
                .row(ui, from);
            let b = NumberField::new("To", 0.0..=1.0, "Depth at which everything is painted")
                .row(ui, to);
            a.map(|c| c.map(|from| DerivedMask::Depth { from, to }))
                .or(b.map(|c| c.map(|to| DerivedMask::Depth { from, to })))
        }
    }
}
