//! Properties of the selected layer: what it is made of, where it lies, how it bends.
//! Floor 7. Materials and lights are `material`'s.

use super::{colors, material, options, strokes};
use crate::app::asked::Asked;
use crate::app::widgets::{Changed, Number, check, choice_row, title};
use crate::document::{Content, Layer, MaskKind};
use crate::math::vec2;
use crate::paint::{Adjust, Filter, Gradient, PlacedImage, Placement, Stop};
use crate::raster::Outside;
use crate::session::actions::LayerAction;
use crate::session::property::{DerivedMask, MaskNumbers};
use crate::session::{Action, LayerPath, Property, Session};
use crate::surface::Weights;
use eframe::egui::Ui;

/// Pushes changes of one layer.
pub struct Setter<'a> {
    layer: LayerPath,
    asked: &'a mut Asked,
}

impl Setter<'_> {
    pub fn set(&mut self, to: Property, done: bool) {
        self.asked.act(Action::Layer(LayerAction::Set { layer: self.layer.clone(), to, done }));
    }
    pub fn take(&mut self, changed: Option<Changed<Property>>) {
        if let Some(Changed { to, done }) = changed {
            self.set(to, done);
        }
    }
}

pub fn show(ui: &mut Ui, session: &Session, asked: &mut Asked) {
    let (Some(layer), Some(path)) = (session.layer(), session.layer_path()) else {
        ui.weak("No layer is selected.");
        return;
    };
    let mut setter = Setter { layer: path, asked };
    let has_surface = session.shown().is_some_and(|document| document.surface.is_some());
    match &layer.content {
        Content::Fill(color) => {
            let changed = colors::picker(ui, "Fill colour", *color);
            setter.take(changed.map(|c| c.map(|color| Property::Fill { color })));
        }
        Content::Pixels(_) => {
            ui.weak("Paint. Strokes on it are pixels.");
        }
        Content::Strokes(live) => {
            strokes::show(ui, session, &setter.layer, &live.params().strokes, setter.asked);
        }
        Content::Image(live) => image(ui, live.params(), &mut setter),
        Content::Gradient(live) => gradient(ui, live.params(), &mut setter),
        Content::Shading(live) => material::shading(ui, live.params(), &mut setter),
        Content::RadianceScaling(scaling) => material::radiance_scaling(ui, scaling, &mut setter),
        Content::Normals(normals) => {
            ui.label("Normals combined onto the surface: what stands above sees them.");
            let number = Number::new("Strength", 0.0..=4.0, "1 is the map as it is");
            setter.take(number.row(ui, normals.strength).map(|c| c.map(|to| Property::Strength { to })));
        }
        Content::Group(group) => {
            let hint = "Blend each layer with what lies beneath the group, as if the group were not there";
            if let Some(on) = check(ui, "Pass through", hint, group.pass_through) {
                setter.set(Property::PassThrough { on }, true);
            }
        }
    }
    ui.separator();
    common(ui, layer, has_surface, &mut setter);
}

fn common(ui: &mut Ui, layer: &Layer, has_surface: bool, setter: &mut Setter) {
    if has_surface {
        let hint = "Paint nothing outside the surface";
        if let Some(on) = check(ui, "Clip to surface", hint, layer.clip_to_surface) {
            setter.set(Property::ClipToSurface { on }, true);
        }
    }
    let hint = "Blend linear light instead of the encoded values";
    if let Some(on) = check(ui, "Blend linear light", hint, layer.blend_linear) {
        setter.set(Property::BlendLinear { on }, true);
    }
    mask(ui, layer, setter);
}

/// The kinds of mask that a panel makes; a picture's is kept as it is.
#[derive(Clone, Copy, PartialEq)]
enum MaskChoice {
    None,
    File,
    Fresnel,
    Curvature,
    Depth,
}

fn mask(ui: &mut Ui, layer: &Layer, setter: &mut Setter) {
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
        (MaskChoice::File, "picture"),
    ];
    let offered = if current == MaskChoice::File { &all[..] } else { &all[..4] };
    if let Some(to) = choice_row(ui, "Mask", current, offered) {
        let numbers = match to {
            MaskChoice::Fresnel => Some(MaskNumbers::Fresnel { f0: 0.04, power: 5.0 }),
            MaskChoice::Curvature => Some(MaskNumbers::Curvature { scale: 4.0, blur: 1.0, from: 0.0, to: 1.0 }),
            MaskChoice::Depth => Some(MaskNumbers::Depth { from: 0.0, to: 1.0 }),
            MaskChoice::None | MaskChoice::File => None,
        };
        setter.set(Property::Mask { mask: numbers.map(DerivedMask) }, true);
    }
    let Some(mask) = &layer.mask else { return };
    if let Some(numbers) = mask_numbers(ui, &mask.kind) {
        setter.take(Some(numbers.map(|numbers| Property::Mask { mask: Some(DerivedMask(numbers)) })));
    }
    if let Some(on) = check(ui, "Invert mask", "Paint where the mask is dark", mask.invert) {
        setter.set(Property::MaskInverted { on }, true);
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

const FILTERS: [(Filter, &str); 2] = [(Filter::Antialias, "antialias"), (Filter::Bilinear, "bilinear")];

fn image(ui: &mut Ui, image: &PlacedImage, setter: &mut Setter) {
    ui.weak(format!("{} · {}", image.source.file, image.source.picture.size));
    operator(ui, image.bend.operator, setter);
    placement(ui, image.placement, setter);
    const OUTSIDE: [(Outside, &str); 4] =
        [(Outside::Mirror, "mirror"), (Outside::Repeat, "repeat"), (Outside::Clamp, "clamp"), (Outside::None, "none")];
    if let Some(outside) = choice_row(ui, "Outside", image.outside, &OUTSIDE) {
        setter.set(Property::Beyond { outside }, true);
    }
    if let Some(filter) = choice_row(ui, "Filter", image.filter, &FILTERS) {
        setter.set(Property::Filtered { filter }, true);
    }
    title(ui, "Anchors");
    let n = image.bend.anchors.len();
    ui.weak(format!(
        "{n} {}; take the anchor tool (A) to move, add and remove them",
        if n == 1 { "anchor" } else { "anchors" }
    ));
    if let Weights::Shepard { power } = image.bend.weights
        && n > 1
    {
        let number = Number::new("Sharpness", 0.5..=8.0, "How sharply the anchors divide the surface");
        setter.take(number.row(ui, power).map(|c| c.map(|to| Property::Power { to })));
    }
    title(ui, "Adjust");
    adjust(ui, image.source.adjust, setter);
}

fn operator(ui: &mut Ui, operator: crate::surface::Operator, setter: &mut Setter) {
    ui.horizontal_wrapped(|ui| {
        for (label, begins, hint) in crate::app::commands::operators() {
            let is_on = std::mem::discriminant(&operator) == std::mem::discriminant(&begins);
            if ui.selectable_label(is_on, label).on_hover_text(hint).clicked() && !is_on {
                setter.set(Property::Bend { operator: begins }, true);
            }
        }
    });
    if let Some(changed) = options::number_rows(ui, operator) {
        setter.take(Some(changed.map(|operator| Property::Bend { operator })));
    }
}

fn placement(ui: &mut Ui, placement: Placement, setter: &mut Setter) {
    let scale = Number::new("Scale", 0.05..=10.0, "1 covers the canvas").logarithmic().row(ui, placement.scale);
    setter.take(scale.map(|c| c.map(|scale| Property::Place { placement: Placement { scale, ..placement } })));
    let turn = Number::new("Rotation", -180.0..=180.0, "Counter-clockwise").degrees().row(ui, placement.rotation);
    setter.take(turn.map(|c| c.map(|rotation| Property::Place { placement: Placement { rotation, ..placement } })));
    ui.horizontal(|ui| {
        crate::app::widgets::name(ui, "Centre");
        let at = placement.center;
        let x = Number::new("Centre x", -20000.0..=20000.0, "Canvas px").decimals(0).field(ui, at.x);
        let y = Number::new("Centre y", -20000.0..=20000.0, "Canvas px").decimals(0).field(ui, at.y);
        let center = x.map(|c| c.map(|x| vec2(x, at.y))).or(y.map(|c| c.map(|y| vec2(at.x, y))));
        setter.take(center.map(|c| c.map(|center| Property::Place { placement: Placement { center, ..placement } })));
    });
}

fn adjust(ui: &mut Ui, adjust: Adjust, setter: &mut Setter) {
    type Put = fn(Adjust, f32) -> Adjust;
    let rows: [(&str, f32, std::ops::RangeInclusive<f32>, &str, Put); 6] = [
        ("Blur", adjust.blur, 0.0..=80.0, "A rougher material, in pixels of the picture", |a, blur| Adjust {
            blur,
            ..a
        }),
        ("Exposure", adjust.exposure, -4.0..=4.0, "In stops", |a, exposure| Adjust { exposure, ..a }),
        ("Hue", adjust.hue, -180.0..=180.0, "In degrees", |a, hue| Adjust { hue, ..a }),
        ("Saturation", adjust.saturation, 0.0..=2.0, "1 leaves it", |a, saturation| Adjust { saturation, ..a }),
        ("Brightness", adjust.brightness, 0.0..=2.0, "1 leaves it", |a, brightness| Adjust { brightness, ..a }),
        ("Contrast", adjust.contrast, 0.0..=2.0, "1 leaves it", |a, contrast| Adjust { contrast, ..a }),
    ];
    for (label, value, range, hint, put) in rows {
        let changed = Number::new(label, range, hint).row(ui, value);
        setter.take(changed.map(|c| c.map(|to| Property::Adjusted { adjust: put(adjust, to) })));
    }
}

fn gradient(ui: &mut Ui, gradient: &Gradient, setter: &mut Setter) {
    operator(ui, gradient.operator, setter);
    title(ui, "Stops");
    let with = |i: usize, stop: Stop| {
        let mut stops = gradient.stops.clone();
        if let Some(slot) = stops.get_mut(i) {
            *slot = stop;
        }
        stops.sort_by(|a, b| a.t.total_cmp(&b.t));
        Property::Stops { stops }
    };
    let mut gone = None;
    for (i, stop) in gradient.stops.iter().enumerate() {
        ui.horizontal(|ui| {
            let color = colors::button(ui, &format!("Colour of stop {}", i + 1), stop.color);
            setter.take(color.map(|c| c.map(|color| with(i, Stop { color, ..*stop }))));
            let place = format!("Place of stop {}", i + 1);
            let t = Number::new(&place, 0.0..=1.0, "0 at the first end, 1 at the second").field(ui, stop.t);
            setter.take(t.map(|c| c.map(|t| with(i, Stop { t, ..*stop }))));
            if gradient.stops.len() > 1 && ui.small_button("Remove").clicked() {
                gone = Some(i);
            }
        });
    }
    if let Some(i) = gone {
        let mut stops = gradient.stops.clone();
        stops.remove(i);
        setter.set(Property::Stops { stops }, true);
    }
    ui.horizontal(|ui| {
        if ui.button("Add stop").clicked() {
            let mut stops = gradient.stops.clone();
            let color = stops.last().map_or(crate::math::srgb::Color::WHITE, |stop| stop.color);
            stops.push(Stop { t: 0.5, color });
            stops.sort_by(|a, b| a.t.total_cmp(&b.t));
            setter.set(Property::Stops { stops }, true);
        }
        if ui.button("Swap ends").clicked() {
            setter.set(Property::Ends { from: gradient.to, to: gradient.from }, true);
        }
    });
    if let Some(filter) = choice_row(ui, "Filter", gradient.filter, &FILTERS) {
        setter.set(Property::Filtered { filter }, true);
    }
}
