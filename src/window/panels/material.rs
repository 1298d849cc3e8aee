//! Properties of shading layers and of radiance scaling: model, terms, lights, features.
//! Floor 7.

use super::setter::LayerSetter;
use super::{balls, colors, painter};
use crate::language::tr;
use crate::math::{Vec2, Vec3, vec2, vec3};
use crate::mood_pictures::MoodPictures;
use crate::session::actions::LayerAction;
use crate::session::{Action, PicturePart, Property};
use crate::shading::{
    BallStrokes, Environment, FeatureScale, Features, Light, LightKind, Model, Projection,
    RadianceScaling, Scaling, Shading, SolidGlass, Term,
};
use crate::tr;
use crate::widgets::{NumberField, ValueChange, check, choice_row, title};
use eframe::egui::{self, Color32, Sense, Shape, Stroke, Ui};

/// `canvas`: its sides, px.
pub fn shading(
    ui: &mut Ui,
    shading: &Shading,
    canvas: Vec2,
    moods: &MoodPictures,
    setter: &mut LayerSetter,
) {
    if let Some(model) = choice_row(ui, "Material", shading.model, &Model::LABELS) {
        setter.set(Property::ShadingModel { model }, true);
    }
    let is_painter = shading.model == Model::Painter;
    if is_painter {
        painter::moods(ui, shading, moods, setter);
    }
    let [ambient, diffuse, specular] = term_words(is_painter);
    term(ui, ambient, shading.ambient, setter, |term| Property::Ambient { term });
    term(ui, diffuse, shading.diffuse, setter, |term| Property::Diffuse { term });
    term(ui, specular, shading.specular, setter, |term| Property::Specular { term });
    if is_painter {
        painter::terms(ui, shading.painter, setter);
    }
    if shading.is_lighting_beneath() {
        painter::pixels(ui, &shading.pixel, setter);
    }
    highlight(ui, shading, setter);
    steps_and_rays(ui, shading, setter);
    pictures(ui, shading, setter);
    if shading.model.has_lamps() {
        lights(ui, &shading.lights, canvas, setter);
        painter::shadows(ui, shading.shadows, setter);
    }
    features(ui, &shading.features, setter);
}

/// The names of the three terms and what they are, for the painter's light and for other models.
fn term_words(is_painter: bool) -> [(&'static str, &'static str); 3] {
    match is_painter {
        true => [
            ("Soft light", "Light from all around; 0 turns it off"),
            ("Key", "Light of the lamps; 0 turns it off"),
            ("Shine", "Highlights of the lamps; 0 turns them off"),
        ],
        false => [
            ("Shadow", "What is there without a lamp (ambient); 0 turns it off"),
            ("Light", "Light of the lamps (diffuse); 0 turns it off"),
            ("Shine", "Highlights of the lamps (specular); 0 turns them off"),
        ],
    }
}

/// A row with a number of the model.
fn number(
    ui: &mut Ui,
    field: NumberField,
    value: f32,
    setter: &mut LayerSetter,
    put: impl Fn(f32) -> Property,
) {
    setter.take(field.row(ui, value).map(|change| change.map(put)));
}

/// How small highlights are, how flat the light is, how far glass bends.
fn highlight(ui: &mut Ui, shading: &Shading, setter: &mut LayerSetter) {
    match shading.model {
        Model::Phong | Model::Toon | Model::Painter => {
            let field = NumberField::new("Shininess", 1.0..=400.0, "How small the highlight is")
                .logarithmic()
                .decimals(0);
            number(ui, field, shading.shininess, setter, |to| Property::Shininess { to });
        }
        Model::SubLambertian => {
            let field = NumberField::new("Flatness", 0.0..=1.0, "1 is matt, 0 flat like the moon");
            number(ui, field, shading.exponent, setter, |to| Property::Exponent { to });
        }
        Model::Ashikhmin => {
            let (nu, nv) = (shading.nu, shading.nv);
            let field = |label| {
                NumberField::new(label, 1.0..=1000.0, "How narrow the highlight is").logarithmic()
            };
            number(ui, field("Along x"), nu, setter, |nu| Property::Anisotropy { nu, nv });
            number(ui, field("Along y"), nv, setter, |nv| Property::Anisotropy { nu, nv });
        }
        Model::Refraction => {
            let field = NumberField::new("Index", 1.0..=3.0, "Glass is 1.5");
            number(ui, field, shading.index, setter, |to| Property::RefractiveIndex { to });
            solid_glass(ui, shading.solid, setter);
        }
        _ => {}
    }
}

/// Whether light leaves glass again, and where.
fn solid_glass(ui: &mut Ui, solid: SolidGlass, setter: &mut LayerSetter) {
    let hint = "Light goes through the glass and leaves it at the back, and the front mirrors some; \
                off, it is bent once";
    if let Some(on) = check(ui, "Solid", hint, solid.on) {
        setter.set(Property::Solid { solid: SolidGlass { on, ..solid } }, true);
    }
    if solid.on {
        painter::settings(ui, SolidGlass::SETTINGS, solid, setter, |solid| Property::Solid {
            solid,
        });
    }
}

/// How many tones there are, how far occluders reach, how often rays bounce.
fn steps_and_rays(ui: &mut Ui, shading: &Shading, setter: &mut LayerSetter) {
    if shading.model == Model::Toon {
        let field = NumberField::new("Tones", 2.0..=12.0, "Flat bands of light").decimals(0);
        let put = |to: f32| Property::Bands { to: to as u32 };
        number(ui, field, shading.bands as f32, setter, put);
    }
    if matches!(shading.model, Model::AmbientOcclusion | Model::DiffuseEnvironment) {
        let hint = "Distance up to which occluders count, px";
        let field = NumberField::new("Distance", 0.0..=400.0, hint).decimals(0);
        let put = |to| Property::Occlusion { to };
        number(ui, field, shading.occlusion_radius_px, setter, put);
    }
    if shading.has_bounces() {
        let hint = "How often rays that meet the surface are reflected again; 0 shows the \
                    environment only";
        let most = *Shading::BOUNCES.end() as f32;
        let field = NumberField::new("Bounces", 0.0..=most, hint).decimals(0);
        let put = |to: f32| Property::Bounces { to: to as u32 };
        number(ui, field, shading.bounces as f32, setter, put);
    }
}

/// The environment or the lit spheres, if the model uses them.
fn pictures(ui: &mut Ui, shading: &Shading, setter: &mut LayerSetter) {
    let mut picture = |ui: &mut Ui, part: PicturePart, file: Option<&str>, none: &str| {
        title(ui, part.label());
        ui.horizontal_wrapped(|ui| {
            setter.choose(ui, part, "Choose…");
            match file {
                None => drop(ui.weak(tr(none))),
                Some(file) => {
                    ui.label(file);
                    if ui.small_button(tr("Remove")).clicked() {
                        setter.set(Property::Without { part }, true);
                    }
                }
            }
        });
    };
    if shading.model.is_lit_by_environment() || shading.model == Model::Ashikhmin {
        let file = shading.environment.as_ref().map(|environment| &*environment.file);
        let none = if shading.is_without_environment() {
            "None yet: the layer is black"
        } else {
            "None: lit by the lights"
        };
        picture(ui, PicturePart::Environment, file, none);
        if let Some(environment) = &shading.environment {
            surroundings(ui, environment, setter);
        }
    } else if shading.model == Model::LitSphere {
        picture(
            ui,
            PicturePart::Sphere,
            shading.sphere.as_ref().map(|sphere| &*sphere.file),
            "Gray clay",
        );
        picture(
            ui,
            PicturePart::ConcaveSphere,
            shading.sphere_concave.as_ref().map(|sphere| &*sphere.file),
            "The same",
        );
        balls::chooser(ui, setter);
        ball_strokes(ui, shading.strokes, setter);
        let button = ui.button(tr("Paint the ball"));
        let hint = "Opens the ball as a drawing of its own; each stroke on it repaints the shape";
        if button.on_hover_text(tr(hint)).clicked() {
            let paint = LayerAction::PaintBall { layer: setter.layer.clone(), hollows: false };
            setter.requests.act(Action::Layer(paint));
        }
    }
}

/// How the brush marks of a painted ball lie on the figure.
fn ball_strokes(ui: &mut Ui, strokes: BallStrokes, setter: &mut LayerSetter) {
    let hint = "Brush marks of the ball stay whole; off, each pixel looks its own normal up";
    if let Some(on) = check(ui, "Whole strokes", hint, strokes.on) {
        setter.set(Property::BallMarks { strokes: BallStrokes { on, ..strokes } }, true);
    }
    if strokes.on {
        painter::settings(ui, BallStrokes::SETTINGS, strokes, setter, |strokes| {
            Property::BallMarks { strokes }
        });
    }
}

fn surroundings(ui: &mut Ui, environment: &Environment, setter: &mut LayerSetter) {
    let Environment { projection, rotation, exposure, .. } = *environment;
    if let Some(projection) = choice_row(ui, "Projection", projection, &Projection::ALL) {
        setter.set(Property::Surrounded { projection, rotation, exposure }, true);
    }
    let turn = NumberField::new("Turn", -180.0..=180.0, "About the vertical axis")
        .degrees()
        .row(ui, rotation);
    setter.take(
        turn.map(|c| c.map(|rotation| Property::Surrounded { projection, rotation, exposure })),
    );
    let stops = NumberField::new("Exposure", -8.0..=8.0, "In stops").row(ui, exposure);
    setter.take(
        stops.map(|c| c.map(|exposure| Property::Surrounded { projection, rotation, exposure })),
    );
}

/// One of the three terms of a material, by its name and what it is.
fn term(
    ui: &mut Ui,
    (label, hint): (&str, &str),
    term: Term,
    setter: &mut LayerSetter,
    put: fn(Term) -> Property,
) {
    ui.horizontal(|ui| {
        let color_label = tr!("{term} color", term = tr(label));
        let color = colors::button(ui, &color_label, term.color);
        setter.take(color.map(|c| c.map(|color| put(Term { color, ..term }))));
        let weight = NumberField::new(label, 0.0..=2.0, hint).row(ui, term.weight);
        setter.take(weight.map(|c| c.map(|weight| put(Term { weight, ..term }))));
    });
    let gamma = tr!("{term} relief", term = tr(label));
    let number =
        NumberField::new(&gamma, 0.0..=8.0, "How strongly features are enhanced in this term (γ)");
    let changed = number.row(ui, term.scaling.gamma_convex);
    setter.take(changed.map(|c| {
        c.map(|gamma| put(Term { scaling: Scaling::new(term.scaling.alpha, gamma), ..term }))
    }));
}

fn lights(ui: &mut Ui, lights: &[Light], canvas: Vec2, setter: &mut LayerSetter) {
    title(ui, "Lights");
    for i in 0..lights.len() {
        light(ui, lights, i, setter);
    }
    ui.horizontal_wrapped(|ui| {
        let far = LightKind::Directional { direction: vec3(-0.6, 0.2, 0.5) };
        let near = LightKind::Point {
            position: vec3(canvas.x * 0.3, canvas.y * 0.3, canvas.max_element() * 0.3),
        };
        for (text, kind) in [("Add light", far), ("Add light at a point", near)] {
            if ui.button(tr(text)).clicked() {
                let new = Light { kind, intensity: 0.5, ..Light::default() };
                let lights = lights.iter().copied().chain([new]).collect();
                setter.set(Property::Lights { lights }, true);
            }
        }
    });
    ui.weak(tr("The anchor tool (A) drags lights on the canvas."));
}

/// One of the lamps: its direction as a ball, its color, its strength and, of a lamp at a point,
/// its height.
fn light(ui: &mut Ui, lights: &[Light], i: usize, setter: &mut LayerSetter) {
    let own = lights[i];
    let put = |light: Light| {
        let mut lights = lights.to_vec();
        lights[i] = light;
        Property::Lights { lights }
    };
    let number_of = i + 1;
    ui.horizontal(|ui| {
        let direction = match own.kind {
            LightKind::Directional { direction } => direction,
            // A point light far enough away is a direction, which the ball shows.
            LightKind::Point { position } => position,
        };
        let turned = ball(ui, &tr!("Direction of light {number}", number = number_of), direction);
        if matches!(own.kind, LightKind::Directional { .. }) {
            let kind = |direction| LightKind::Directional { direction };
            setter.take(turned.map(|c| c.map(|to| put(Light { kind: kind(to), ..own }))));
        }
        ui.vertical(|ui| {
            ui.horizontal(|ui| {
                let label = tr!("Color of light {number}", number = number_of);
                let color = colors::button(ui, &label, own.color);
                setter.take(color.map(|c| c.map(|color| put(Light { color, ..own }))));
                if lights.len() > 1 && ui.small_button(tr("Remove")).clicked() {
                    let mut left = lights.to_vec();
                    left.remove(i);
                    setter.set(Property::Lights { lights: left }, true);
                }
            });
            let label = tr!("Light {number}", number = number_of);
            let field = NumberField::new(&label, 0.0..=4.0, "Intensity");
            let put_intensity = |intensity| put(Light { intensity, ..own });
            number(ui, field, own.intensity, setter, put_intensity);
            if let LightKind::Point { position } = own.kind {
                let label = tr!("Height {number}", number = number_of);
                let hint = "Height above the nearest point, px";
                let field = NumberField::new(&label, 0.0..=4000.0, hint).decimals(0);
                let kind = |z| LightKind::Point { position: vec3(position.x, position.y, z) };
                let put_height = |z| put(Light { kind: kind(z), ..own });
                number(ui, field, position.z, setter, put_height);
            }
        });
    });
}

/// A ball on which a direction is dragged: toward the light, camera space (y up).
fn ball(ui: &mut Ui, label: &str, direction: Vec3) -> Option<ValueChange<Vec3>> {
    let (rect, response) = ui.allocate_exact_size(egui::vec2(58.0, 58.0), Sense::click_and_drag());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Slider, true, tr(label)));
    let (center, radius) = (rect.center(), 26.0);
    let l = direction.normalize_or(Vec3::Z);
    let painter = ui.painter();
    painter.circle_filled(center, radius, Color32::from_gray(0x3a));
    // A few discs toward the light: enough to see where it comes from.
    for i in 1..=6 {
        let t = i as f32 / 6.0;
        let at = center + egui::vec2(l.x, -l.y) * radius * 0.55 * t;
        painter.circle_filled(
            at,
            radius * (1.0 - 0.72 * t) * (0.75 + 0.25 * l.z.max(0.0)),
            Color32::from_white_alpha(26),
        );
    }
    painter.add(Shape::circle_stroke(center, radius, Stroke::new(1.0, Color32::from_gray(0x70))));
    let handle = center + egui::vec2(l.x, -l.y) * radius;
    painter.circle_filled(
        handle,
        4.0,
        if l.z >= 0.0 { Color32::WHITE } else { Color32::from_gray(0x90) },
    );
    let is_held =
        response.is_pointer_button_down_on() || response.drag_stopped() || response.clicked();
    let response = response.on_hover_text(tr("Drag: the middle faces you, the rim grazes"));
    let pos = response.interact_pointer_pos().filter(|_| is_held)?;
    let at = (pos - center) / radius;
    let flat = vec2(at.x, -at.y).clamp_length_max(0.999);
    let to = vec3(flat.x, flat.y, (1.0 - flat.length_squared()).max(0.0).sqrt());
    Some(ValueChange { to, done: response.drag_stopped() || response.clicked() })
}

fn features(ui: &mut Ui, features: &Features, setter: &mut LayerSetter) {
    title(ui, "Features");
    let Some(&scale) = features.scales.first() else { return };
    let with = |scale: FeatureScale| {
        let mut features = features.clone();
        if let Some(first) = features.scales.first_mut() {
            *first = scale;
        }
        Property::Features { features }
    };
    let number =
        NumberField::new("Width", 0.0..=40.0, "Features this many pixels wide count in full");
    let changed = number.row(ui, scale.curvature_scale_px);
    setter.take(
        changed.map(|c| {
            c.map(|curvature_scale_px| with(FeatureScale { curvature_scale_px, ..scale }))
        }),
    );
    let changed =
        NumberField::new("Blur", 0.0..=20.0, "Blur of the normals, px").row(ui, scale.blur_px);
    setter.take(changed.map(|c| c.map(|blur_px| with(FeatureScale { blur_px, ..scale }))));
    let hint = "0: all features, 1: those along the light, −1: those across it";
    let changed = NumberField::new("Direction", -1.0..=1.0, hint).row(ui, features.lambda);
    setter.take(changed.map(|c| {
        c.map(|lambda| Property::Features { features: Features { lambda, ..features.clone() } })
    }));
}

pub fn radiance_scaling(ui: &mut Ui, scaling: &RadianceScaling, setter: &mut LayerSetter) {
    let now = scaling.scaling;
    let gamma = NumberField::new("Strength", 0.0..=12.0, "How strongly relief is enhanced (γ)")
        .row(ui, now.gamma_convex);
    setter.take(
        gamma.map(|c| c.map(|gamma| Property::Scaled { scaling: Scaling::new(now.alpha, gamma) })),
    );
    let concave = NumberField::new("In hollows", 0.0..=12.0, "The strength on concave features")
        .row(ui, now.gamma_concave);
    let with = |gamma_concave| Property::Scaled { scaling: Scaling { gamma_concave, ..now } };
    setter.take(concave.map(|c| c.map(with)));
    let hint = "Light of this brightness stays as it is (α)";
    let alpha = NumberField::new("Unchanged tone", 0.02..=0.98, hint).row(ui, now.alpha);
    setter
        .take(alpha.map(|c| c.map(|alpha| Property::Scaled { scaling: Scaling { alpha, ..now } })));
    let hint = "Keep the mean brightness over the surface";
    if let Some(on) = check(ui, "Keep brightness", hint, scaling.keep_mean) {
        setter.set(Property::KeepMean { on }, true);
    }
    features(ui, &scaling.features, setter);
    if scaling.features.lambda != 0.0 {
        title(ui, "The light that the direction refers to");
        let changed = ball(ui, "Direction of the light", scaling.light);
        setter.take(changed.map(|c| c.map(|light| Property::ScalingLight { light })));
    }
}
