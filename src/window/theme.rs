//! The theme: neutral greys, so that the window does not affect the perception of the picture's
//! colours, and one accent. Floor 7.

use eframe::egui::{self, Color32, CornerRadius, Stroke, Style, TextStyle, Theme, Visuals, vec2};

/// What is selected or held.
pub const ACCENT: Color32 = Color32::from_rgb(0x4d, 0x9d, 0xe0);
/// What surrounds the canvas.
pub const SURROUND: [Color32; 2] = [Color32::from_gray(0x1e), Color32::from_gray(0xa8)];
/// The squares behind what is transparent.
pub const CHECKER: [Color32; 2] = [Color32::from_gray(0x9a), Color32::from_gray(0x7e)];

/// A colour of the document as the window shows it.
pub fn color32(color: crate::math::srgb::Color) -> Color32 {
    Color32::from_rgba_unmultiplied(color.r, color.g, color.b, color.a)
}

/// Greys from the deepest to the text.
struct Greys {
    deepest: u8,
    panel: u8,
    window: u8,
    idle: u8,
    hovered: u8,
    pressed: u8,
    line: u8,
    text: u8,
    strong: u8,
}

const DARK: Greys = Greys {
    deepest: 0x1a,
    panel: 0x2b,
    window: 0x2f,
    idle: 0x3a,
    hovered: 0x47,
    pressed: 0x52,
    line: 0x1f,
    text: 0xc8,
    strong: 0xf2,
};
const LIGHT: Greys = Greys {
    deepest: 0xf6,
    panel: 0xdc,
    window: 0xe4,
    idle: 0xce,
    hovered: 0xc0,
    pressed: 0xb2,
    line: 0xb4,
    text: 0x2c,
    strong: 0x08,
};

/// Sets the theme for dark and light.
pub fn install(ctx: &egui::Context) {
    ctx.style_mut_of(Theme::Dark, |style| apply_style(style, Visuals::dark(), &DARK));
    ctx.style_mut_of(Theme::Light, |style| apply_style(style, Visuals::light(), &LIGHT));
    ctx.set_theme(Theme::Dark);
    // Its zoom keys zoom the picture here.
    ctx.options_mut(|options| options.zoom_with_keyboard = false);
}

fn apply_style(style: &mut Style, mut visuals: Visuals, greys: &Greys) {
    let grey = Color32::from_gray;
    let radius = CornerRadius::same(4);
    visuals.panel_fill = grey(greys.panel);
    visuals.window_fill = grey(greys.window);
    visuals.window_stroke = Stroke::new(1.0, grey(greys.line));
    visuals.extreme_bg_color = grey(greys.deepest);
    visuals.faint_bg_color = grey(greys.panel.saturating_add(4));
    visuals.selection.bg_fill = ACCENT.gamma_multiply(0.55);
    visuals.selection.stroke = Stroke::new(1.0, grey(greys.strong));
    visuals.window_corner_radius = CornerRadius::same(8);
    visuals.menu_corner_radius = CornerRadius::same(6);
    let widgets = &mut visuals.widgets;
    for (widget, fill, text) in [
        (&mut widgets.noninteractive, greys.panel, greys.text),
        (&mut widgets.inactive, greys.idle, greys.text),
        (&mut widgets.hovered, greys.hovered, greys.strong),
        (&mut widgets.active, greys.pressed, greys.strong),
        (&mut widgets.open, greys.idle, greys.strong),
    ] {
        (widget.bg_fill, widget.weak_bg_fill) = (grey(fill), grey(fill));
        widget.bg_stroke = Stroke::NONE;
        widget.fg_stroke = Stroke::new(1.0, grey(text));
        widget.corner_radius = radius;
        widget.expansion = 0.0;
    }
    widgets.noninteractive.bg_stroke = Stroke::new(1.0, grey(greys.line));
    style.visuals = visuals;
    // A drag that misses a slider would select the text next to it.
    style.interaction.selectable_labels = false;
    style.spacing.item_spacing = vec2(6.0, 5.0);
    style.spacing.button_padding = vec2(7.0, 3.0);
    style.spacing.interact_size = vec2(36.0, 21.0);
    style.spacing.slider_width = 110.0;
    style.spacing.combo_width = 92.0;
    for (kind, size) in [
        (TextStyle::Body, 12.5),
        (TextStyle::Button, 12.5),
        (TextStyle::Small, 10.5),
        (TextStyle::Heading, 15.0),
        (TextStyle::Monospace, 12.0),
    ] {
        if let Some(font) = style.text_styles.get_mut(&kind) {
            font.size = size;
        }
    }
}
