//! Properties of the painter's light, its moods, and the shadows of every model with lamps. Floor
//! 7.

use super::colors;
use super::setter::LayerSetter;
use crate::language::tr;
use crate::math::srgb::Color;
use crate::mood_pictures::MoodPictures;
use crate::session::Property;
use crate::session::actions::LayerAction;
use crate::shading::{Mood, NumberSetting, Painter, PixelShading, Shading, Shadows};
use crate::tr;
use crate::widgets::{NumberField, check, set_accessible_name, title};
use eframe::egui::{self, Ui};

/// One of the colors of the light.
type ColorOf = fn(&mut Painter) -> &mut Color;

/// A row for each number of a table.
pub fn settings<T: Copy + 'static>(
    ui: &mut Ui,
    table: impl IntoIterator<Item = &'static NumberSetting<T>>,
    all: T,
    setter: &mut LayerSetter,
    put: fn(T) -> Property,
) {
    for setting in table {
        let number = NumberField::new(setting.label, setting.range.clone(), setting.hint);
        let changed = number.row(ui, (setting.get)(&all));
        setter.take(changed.map(|c| {
            c.map(|to| {
                let mut next = all;
                setting.put(&mut next, to);
                put(next)
            })
        }));
    }
}

/// The moods, each as the drawing looks in it.
pub fn moods(ui: &mut Ui, shading: &Shading, pictures: &MoodPictures, setter: &mut LayerSetter) {
    title(ui, "Moods");
    ui.horizontal_wrapped(|ui| {
        for (mood, _) in Mood::ALL {
            let is_on = mood.is_of(shading);
            let text = egui::RichText::new(tr(mood.label())).small();
            let button = match pictures.picture(mood) {
                Some((texture, size)) => {
                    let shown = size * (64.0 / size.max_elem().max(1.0));
                    egui::Button::image_and_text(
                        egui::load::SizedTexture::new(texture, shown),
                        text,
                    )
                }
                None => egui::Button::new(text),
            };
            let response =
                ui.add(button.selected(is_on)).on_hover_text(tr("Lamps, shadows and all"));
            set_accessible_name(&response, &tr!("Mood: {mood}", mood = tr(mood.label())));
            if response.clicked() && !is_on {
                setter.set(Property::InMood { mood }, true);
            }
        }
    });
}

/// The painter's own terms.
pub fn terms(ui: &mut Ui, painter: Painter, setter: &mut LayerSetter) {
    let hint = "Light the picture beneath, not a color of its own";
    if let Some(beneath) = check(ui, "Light what is beneath", hint, painter.beneath) {
        setter.set(Property::Painted { painter: Painter { beneath, ..painter } }, true);
    }
    settings(ui, Painter::SETTINGS, painter, setter, |painter| Property::Painted { painter });
    let colors: [(&str, Color, ColorOf); 3] = [
        ("Fill color", painter.fill_color, |p| &mut p.fill_color),
        ("Bounce color", painter.bounce_color, |p| &mut p.bounce_color),
        ("Rim color", painter.rim_color, |p| &mut p.rim_color),
    ];
    ui.horizontal(|ui| {
        for (label, color, of) in colors {
            let changed = colors::button(ui, label, color);
            setter.take(changed.map(|c| {
                c.map(|color| {
                    let mut painter = painter;
                    *of(&mut painter) = color;
                    Property::Painted { painter }
                })
            }));
        }
    });
}

/// Light in a few tones of each color.
pub fn pixels(ui: &mut Ui, pixel: &PixelShading, setter: &mut LayerSetter) {
    title(ui, "Pixel shading");
    let hint = "A few tones of each color without soft edges, for pictures drawn pixel by pixel";
    if let Some(on) = check(ui, "Flat tones", hint, pixel.is_on()) {
        if on && pixel.colors.is_empty() {
            return setter.act(|layer| LayerAction::PixelColors { layer });
        }
        let bands = if on { PixelShading::USUAL_BANDS } else { 0 };
        setter.set(Property::Pixeled { pixel: PixelShading { bands, ..pixel.clone() } }, true);
    }
    if !pixel.is_on() {
        return;
    }
    let (low, high) = (*PixelShading::BANDS.start() as f32, *PixelShading::BANDS.end() as f32);
    let bands = NumberField::new("Tones", low..=high, "Tones of each color").decimals(0);
    setter.take(bands.row(ui, pixel.bands as f32).map(|c| {
        c.map(|to| Property::Pixeled {
            pixel: PixelShading { bands: to.round() as u32, ..pixel.clone() },
        })
    }));
    let hint = "How far two tones mix in a checkerboard where they meet";
    let dither = NumberField::new("Dither", PixelShading::DITHER, hint);
    setter.take(dither.row(ui, pixel.dither).map(|c| {
        c.map(|dither| Property::Pixeled { pixel: PixelShading { dither, ..pixel.clone() } })
    }));
    ui.horizontal(|ui| {
        let hint = "Take tones from the colors of the picture beneath, as it is now";
        if ui.button(tr("Colors of the picture")).on_hover_text(tr(hint)).clicked() {
            setter.act(|layer| LayerAction::PixelColors { layer });
        }
        let hint = "Make every tone: shade darker and cooler, light paler and warmer";
        let made = egui::Button::new(tr("Made colors")).selected(pixel.colors.is_empty());
        if ui.add(made).on_hover_text(tr(hint)).clicked() {
            let pixel = PixelShading { colors: Vec::new(), ..pixel.clone() };
            setter.set(Property::Pixeled { pixel }, true);
        }
    });
}

/// The shadows that lamps cast.
pub fn shadows(ui: &mut Ui, shadows: Shadows, setter: &mut LayerSetter) {
    title(ui, "Shadows");
    let hint = "Parts cast shadows on what lies behind them";
    if let Some(on) = check(ui, "Cast shadows", hint, shadows.on) {
        setter.set(Property::Shadowed { shadows: Shadows { on, ..shadows } }, true);
    }
    if !shadows.on {
        return;
    }
    settings(ui, Shadows::SETTINGS, shadows, setter, |shadows| Property::Shadowed { shadows });
    let changed = colors::button(ui, "Color of cast shadows", shadows.color);
    setter.take(
        changed
            .map(|c| c.map(|color| Property::Shadowed { shadows: Shadows { color, ..shadows } })),
    );
}
