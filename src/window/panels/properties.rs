//! Properties of the selected layer: its content, placement and bending. Floor 7. Not here:
//! materials and lights (`material`).

use super::setter::LayerSetter;
use super::{
    adjustment, attachment, colors, effects, form_drawing, mask, material, options, path, ramp,
    strokes, text,
};
use crate::document::{Content, DetailSource, Document, Histogram, Layer, NormalLayer, Progress};
use crate::file_purpose::FilePurpose;
use crate::language::tr;
use crate::math::{Vec2, vec2};
use crate::mood_pictures::MoodPictures;
use crate::operators::{OPERATORS, OfferedOperator};
use crate::paint::{
    Adjust, Gradient, ImageFilter, PictureOrigin, PlacedImage, Placement, RampStyle,
};
use crate::raster::Outside;
use crate::requests::{UiRequests, WindowRequest};
use crate::session::PicturePart;
use crate::session::actions::LayerAction;
use crate::session::{Property, Session};
use crate::shading::Model;
use crate::surface::{NoiseRelief, Weights};
use crate::tr;
use crate::widgets::{NumberField, check, choice_row, title};
use eframe::egui::{Id, Ui};
use std::sync::Arc;

pub fn show(ui: &mut Ui, session: &Session, moods: &mut MoodPictures, requests: &mut UiRequests) {
    let (Some(layer), Some(path)) = (session.layer(), session.layer_path()) else {
        ui.weak(tr("No layer is selected."));
        return;
    };
    let mut setter = LayerSetter { layer: path, requests };
    content(ui, session, layer, moods, &mut setter);
    ui.separator();
    let on_mask = session.active().is_some_and(|open| open.on_mask);
    if let Some(document) = session.shown_document() {
        attachment(ui, document, layer, &mut setter);
    }
    common(ui, layer, has_surface(session), on_mask, &mut setter);
    if let Some(document) = session.shown_document() {
        effects::show(ui, document, layer, &mut setter);
    }
}

/// The properties of what the layer holds.
fn content(
    ui: &mut Ui,
    session: &Session,
    layer: &Layer,
    moods: &mut MoodPictures,
    setter: &mut LayerSetter,
) {
    match &layer.content {
        Content::Fill(color) => {
            let changed = colors::picker(ui, "Fill color", *color);
            setter.take(changed.map(|c| c.map(|color| Property::Fill { color })));
        }
        Content::Pixels(_) => {
            ui.weak(tr("Paint. Strokes on it are pixels."));
        }
        Content::Ink(lines) => {
            ui.label(tr!(
                "The ink of “{layer}”, as it was drawn: no light falls on it. Draw on that layer, and \
                 the lines follow.",
                layer = lines.of
            ));
        }
        Content::Strokes(live) => {
            strokes::show(ui, session, &setter.layer, &live.params().strokes, setter.requests);
        }
        Content::FormDrawing(live) => {
            form_drawing::show(ui, session, live.params(), has_surface(session), setter);
        }
        Content::Image(live) => {
            if let Some(words) = live.params().source.text() {
                text::show(ui, layer.id, words, setter);
            }
            if let Some(path) = live.params().source.path() {
                path::show(ui, path, setter);
            }
            image(ui, live.params(), setter);
        }
        Content::Gradient(live) => gradient(ui, live.params(), setter),
        Content::Shading(live) => {
            let canvas =
                session.shown_document().map_or(Vec2::ONE, |document| 2.0 * document.size.center());
            if let (Model::Painter, Some(document)) =
                (live.params().model, session.shown_document())
            {
                moods.follow(ui.ctx(), document, layer);
            }
            material::shading(ui, live.params(), canvas, moods, setter);
        }
        Content::RadianceScaling(scaling) => material::radiance_scaling(ui, scaling, setter),
        Content::Adjustment(live) => {
            let histogram = histogram_beneath(ui, session, layer);
            let answer = adjustment::show(ui, live.params(), histogram.as_deref());
            setter.take(answer.changed.map(|c| c.map(|to| Property::Adjustment { to })));
            if answer.asks_for_table {
                setter.requests.request(WindowRequest::Choose(FilePurpose::ColorTable));
            }
        }
        Content::Filter(live) => {
            let changed = adjustment::show_filter(ui, live.params());
            setter.take(changed.map(|c| c.map(|to| Property::FilterLayer { to })));
        }
        Content::Normals(normals) => normal_layer(ui, normals, setter),
        Content::Group(group) => {
            let hint =
                "Blend each layer with what is below the group, as if the group were not there";
            if let Some(on) = check(ui, "Pass through", hint, group.pass_through) {
                setter.set(Property::PassThrough { on }, true);
            }
        }
    }
}

fn has_surface(session: &Session) -> bool {
    session.shown_document().is_some_and(|document| document.surface.is_some())
}

/// The tones beneath an adjustment, counted again when other layers change.
fn histogram_beneath(ui: &Ui, session: &Session, layer: &Layer) -> Option<Arc<Histogram>> {
    let document = session.active()?.document();
    let other = |(_, other): &(_, &Arc<Layer>)| {
        // A group is another one whenever what is in it changes.
        other.id != layer.id && other.content.group().is_none()
    };
    let others: Vec<_> =
        document.walk().iter().filter(|found| other(found)).map(|(_, l)| Arc::as_ptr(l)).collect();
    let key = Id::unique((layer.id, others));
    let kept = Id::unique("histogram beneath");
    let last = ui.data(|data| data.get_temp::<(Id, Option<Arc<Histogram>>)>(kept));
    if let Some((_, found)) = last.filter(|(known, _)| *known == key) {
        return found;
    }
    let found = Histogram::of_backdrop(document, layer.id, &Progress::default()).map(Arc::new);
    ui.data_mut(|data| data.insert_temp(kept, (key, found.clone())));
    found
}

/// Which part carries the layer.
fn attachment(ui: &mut Ui, document: &Document, layer: &Layer, setter: &mut LayerSetter) {
    let in_group = document.place_of(layer.id).is_some_and(|place| place.group.is_some());
    let around = if in_group { "As its group" } else { attachment::CANVAS };
    if let Some(part) = attachment::choice(ui, document, layer.on.as_ref(), around) {
        setter.act(|layer| LayerAction::Attach { layer: layer.into(), part });
    }
}

fn common(ui: &mut Ui, layer: &Layer, has_surface: bool, on_mask: bool, setter: &mut LayerSetter) {
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
    mask::show(ui, layer, on_mask, setter);
}

fn image(ui: &mut Ui, image: &PlacedImage, setter: &mut LayerSetter) {
    if image.source.origin == PictureOrigin::File {
        ui.horizontal_wrapped(|ui| {
            ui.weak(format!("{} · {}", image.source.file, image.source.picture.size));
            setter.choose(ui, PicturePart::Image, "Replace…");
        });
    }
    operator(ui, image.bend.operator, setter);
    placement(ui, image.placement, setter);
    if let Some(outside) = choice_row(ui, "Outside", image.outside, &Outside::ALL) {
        setter.set(Property::Beyond { outside }, true);
    }
    if let Some(filter) = choice_row(ui, "Filter", image.filter, &ImageFilter::ALL) {
        setter.set(Property::Filtered { filter }, true);
    }
    title(ui, "Anchors");
    let n = image.bend.anchors.len();
    ui.weak(match n {
        1 => tr("1 anchor; take the anchor tool (A) to move, add and remove them").to_owned(),
        _ => {
            tr!("{count} anchors; take the anchor tool (A) to move, add and remove them", count = n)
        }
    });
    if let Weights::Shepard { power } = image.bend.weights
        && n > 1
    {
        let number = NumberField::new(
            "Sharpness",
            0.5..=8.0,
            "How sharply the anchors divide the layer between them",
        );
        setter.take(number.row(ui, power).map(|c| c.map(|to| Property::Power { to })));
    }
    title(ui, "Adjust");
    adjust(ui, image.source.adjust, setter);
}

/// Detail: noise, or a map of normals.
fn normal_layer(ui: &mut Ui, normals: &NormalLayer, setter: &mut LayerSetter) {
    ui.label(tr("Normals combined with the surface, for all layers above."));
    let number = NumberField::new("Strength", 0.0..=4.0, "1 is the map as it is");
    setter.take(number.row(ui, normals.strength).map(|c| c.map(|to| Property::Strength { to })));
    ui.horizontal_wrapped(|ui| {
        let source = match &normals.source {
            DetailSource::Map { picture, .. } => {
                format!("{} · {}", picture.file, picture.picture.size)
            }
            DetailSource::Grain(_) => tr("Grain, made of noise").into(),
        };
        ui.weak(source);
        setter.choose(ui, PicturePart::Detail, "Normal map…");
        if matches!(normals.source, DetailSource::Map { .. }) && ui.button(tr("Grain")).clicked() {
            setter.set(Property::Grained { grain: NoiseRelief::default() }, true);
        }
    });
    if let DetailSource::Grain(grain) = normals.source {
        let size = NumberField::new("Bump size", 1.0..=400.0, "Of the largest bumps, px")
            .logarithmic()
            .decimals(0);
        let size =
            size.row(ui, grain.size_px).map(|c| c.map(|size_px| NoiseRelief { size_px, ..grain }));
        let rough = NumberField::new("Roughness", 0.0..=1.5, "0 is smooth, 1 rough")
            .row(ui, grain.roughness);
        let stretch =
            NumberField::new("Stretch", 0.05..=40.0, "How much longer the bumps are along x")
                .logarithmic();
        let stretch = stretch
            .row(ui, grain.stretch)
            .map(|c| c.map(|stretch| NoiseRelief { stretch, ..grain }));
        let changed = size
            .or(rough.map(|c| c.map(|roughness| NoiseRelief { roughness, ..grain })))
            .or(stretch);
        setter.take(changed.map(|c| c.map(|grain| Property::Grained { grain })));
    }
    placement(ui, normals.placement, setter);
}

fn operator(ui: &mut Ui, operator: crate::surface::Operator, setter: &mut LayerSetter) {
    ui.horizontal_wrapped(|ui| {
        for OfferedOperator { label, begins, hint } in OPERATORS {
            let is_on = operator.is_like(begins);
            if ui.selectable_label(is_on, tr(label)).on_hover_text(tr(hint)).clicked() && !is_on {
                setter.set(Property::Bend { operator: begins }, true);
            }
        }
    });
    if let Some(changed) = options::number_rows(ui, operator) {
        setter.take(Some(changed.map(|operator| Property::Bend { operator })));
    }
}

fn placement(ui: &mut Ui, placement: Placement, setter: &mut LayerSetter) {
    let scale = NumberField::new("Scale", 0.05..=10.0, "1 covers the canvas")
        .logarithmic()
        .row(ui, placement.scale);
    setter.take(
        scale.map(|c| {
            c.map(|scale| Property::Place { placement: Placement { scale, ..placement } })
        }),
    );
    let turn = NumberField::new("Rotation", -180.0..=180.0, "Counter-clockwise")
        .degrees()
        .row(ui, placement.rotation);
    setter.take(turn.map(|c| {
        c.map(|rotation| Property::Place { placement: Placement { rotation, ..placement } })
    }));
    ui.horizontal(|ui| {
        crate::widgets::name(ui, "Center");
        let at = placement.center;
        let x = NumberField::new("Center x", -20000.0..=20000.0, "Canvas px")
            .decimals(0)
            .field(ui, at.x);
        let y = NumberField::new("Center y", -20000.0..=20000.0, "Canvas px")
            .decimals(0)
            .field(ui, at.y);
        let center = x.map(|c| c.map(|x| vec2(x, at.y))).or(y.map(|c| c.map(|y| vec2(at.x, y))));
        setter.take(center.map(|c| {
            c.map(|center| Property::Place { placement: Placement { center, ..placement } })
        }));
    });
}

fn adjust(ui: &mut Ui, adjust: Adjust, setter: &mut LayerSetter) {
    type Put = fn(Adjust, f32) -> Adjust;
    let rows: [(&str, f32, std::ops::RangeInclusive<f32>, &str, Put); 6] = [
        (
            "Blur",
            adjust.blur,
            0.0..=80.0,
            "Blur in pixels of the picture: a rougher material",
            |a, blur| Adjust { blur, ..a },
        ),
        ("Exposure", adjust.exposure, -4.0..=4.0, "In stops", |a, exposure| Adjust {
            exposure,
            ..a
        }),
        ("Hue", adjust.hue, -180.0..=180.0, "In degrees", |a, hue| Adjust { hue, ..a }),
        ("Saturation", adjust.saturation, 0.0..=2.0, "1 leaves it", |a, saturation| Adjust {
            saturation,
            ..a
        }),
        ("Brightness", adjust.brightness, 0.0..=2.0, "1 leaves it", |a, brightness| Adjust {
            brightness,
            ..a
        }),
        ("Contrast", adjust.contrast, 0.0..=2.0, "1 leaves it", |a, contrast| Adjust {
            contrast,
            ..a
        }),
    ];
    for (label, value, range, hint, put) in rows {
        let changed = NumberField::new(label, range, hint).row(ui, value);
        setter.take(changed.map(|c| c.map(|to| Property::Adjusted { adjust: put(adjust, to) })));
    }
}

fn gradient(ui: &mut Ui, gradient: &Gradient, setter: &mut LayerSetter) {
    operator(ui, gradient.operator, setter);
    if let Some(style) = choice_row(ui, "Style", gradient.style, &RampStyle::LABELS) {
        setter.set(Property::Ramp { style }, true);
    }
    title(ui, "Stops");
    let changed = ramp::show(ui, &gradient.stops);
    setter.take(changed.map(|c| c.map(|stops| Property::Stops { stops })));
    ui.horizontal(|ui| {
        if let Some(stops) = super::gradient::stops_menu(ui, &gradient.stops) {
            setter.set(Property::Stops { stops }, true);
        }
        if ui.button(tr("Swap ends")).clicked() {
            setter.set(Property::Ends { from: gradient.to, to: gradient.from }, true);
        }
    });
    if let Some(filter) = choice_row(ui, "Filter", gradient.filter, &ImageFilter::ALL) {
        setter.set(Property::Filtered { filter }, true);
    }
}
