//! The theme: neutral grays, so that the window does not affect the perception of the picture's
//! colors, and one accent. Floor 7.

use crate::math::named::current_name;
use crate::math::srgb::Color;
use crate::math::{ColorProfile, ProfileConversion};
use eframe::egui::{self, Color32, CornerRadius, Stroke, Style, TextStyle, Theme, Visuals, vec2};
use std::cell::Cell;

/// What is selected or held.
pub const ACCENT: Color32 = Color32::from_rgb(0x4d, 0x9d, 0xe0);
/// The same as a thin line on a middle gray, and on a light one.
const ACCENT_ON_GRAY: Color32 = Color32::from_rgb(0x78, 0xbc, 0xf4);
const ACCENT_ON_LIGHT: Color32 = Color32::from_rgb(0x1a, 0x68, 0xb0);
/// The squares behind what is transparent.
pub const CHECKER: [Color32; 2] = [Color32::from_gray(0x9a), Color32::from_gray(0x7e)];

thread_local! {
    /// The color profile of the document in front.
    static PROFILE: Cell<ColorProfile> = const { Cell::new(ColorProfile::Srgb) };
}

/// Colors are shown as those of a document in a profile from now on.
pub fn show_profile(profile: ColorProfile) {
    PROFILE.set(profile);
}

/// How the document's colors become those of the window, which is sRGB; `None` if they are the same.
pub fn to_window() -> Option<&'static ProfileConversion> {
    PROFILE.get().conversion_to(ColorProfile::Srgb)
}

/// A color of the window, such as that of a pinned reference, in the document's profile.
pub fn from_window(color: Color) -> Color {
    ColorProfile::Srgb.conversion_to(PROFILE.get()).map_or(color, |by| by.color(color))
}

/// A color of the document as the window shows it.
pub fn color32(color: Color) -> Color32 {
    let Color { r, g, b, a } = to_window().map_or(color, |by| by.color(color));
    Color32::from_rgba_unmultiplied(r, g, b, a)
}

/// The looks of the window.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Look {
    #[default]
    Dark,
    /// Middle gray, for judging colors.
    Gray,
    Light,
}

impl Look {
    /// With the names that settings store.
    pub const ALL: [(Self, &'static str); 3] =
        [(Self::Dark, "dark"), (Self::Gray, "gray"), (Self::Light, "light")];

    pub fn name(self) -> &'static str {
        Self::ALL[self as usize].1
    }

    pub fn from_name(name: &str) -> Option<Self> {
        let name = current_name(name);
        Self::ALL.iter().find(|(_, known)| *known == name).map(|(look, _)| *look)
    }

    /// The one after it, around the end.
    pub fn next(self) -> Self {
        Self::ALL[(self as usize + 1) % Self::ALL.len()].0
    }

    fn grays(self) -> &'static Grays {
        match self {
            Self::Dark => &DARK,
            Self::Gray => &GRAY,
            Self::Light => &LIGHT,
        }
    }

    /// The look that is shown.
    fn of(visuals: &Visuals) -> Self {
        let is_shown = |look: Self| visuals.panel_fill == Color32::from_gray(look.grays().panel);
        Self::ALL.into_iter().map(|(look, _)| look).find(|look| is_shown(*look)).unwrap_or_default()
    }

    /// Shows the window so.
    pub fn show(self, ctx: &egui::Context) {
        // The toolkit has two themes; gray takes the place of the dark one.
        let (theme, visuals) = match self {
            Self::Dark | Self::Gray => (Theme::Dark, Visuals::dark()),
            Self::Light => (Theme::Light, Visuals::light()),
        };
        ctx.style_mut_of(theme, |style| apply_style(style, visuals, self.grays()));
        ctx.set_theme(theme);
    }
}

/// The accent as a thin line on the ground of panels.
pub fn accent(visuals: &Visuals) -> Color32 {
    match Look::of(visuals) {
        Look::Dark => ACCENT,
        Look::Gray => ACCENT_ON_GRAY,
        Look::Light => ACCENT_ON_LIGHT,
    }
}

/// The ground of a number's bar.
pub fn bar_ground(visuals: &Visuals) -> Color32 {
    visuals.widgets.inactive.weak_bg_fill
}

/// How far a number goes, on its bar: the accent only while it is held.
pub fn bar_fill(visuals: &Visuals, is_held: bool) -> Color32 {
    if is_held {
        visuals.selection.bg_fill
    } else {
        Color32::from_gray(Look::of(visuals).grays().filled)
    }
}

/// Where the value of a number is, on its bar.
pub fn mark_on_bar(visuals: &Visuals) -> Color32 {
    visuals.strong_text_color()
}

/// What surrounds the canvas.
pub fn surround(visuals: &Visuals) -> Color32 {
    Color32::from_gray(Look::of(visuals).grays().surround)
}

/// Shades of gray, from the deepest ground to the text. `weak`: hints and what is said about a row.
struct Grays {
    surround: u8,
    deepest: u8,
    panel: u8,
    window: u8,
    idle: u8,
    hovered: u8,
    pressed: u8,
    /// The part of a number's bar that is full.
    filled: u8,
    line: u8,
    /// The outline of an empty box or ring to tick.
    outline: u8,
    weak: u8,
    text: u8,
    strong: u8,
    /// How much of the accent the ground of what is selected takes.
    selected: f32,
}

const DARK: Grays = Grays {
    surround: 0x1e,
    deepest: 0x1a,
    panel: 0x2b,
    window: 0x2f,
    idle: 0x3a,
    hovered: 0x47,
    pressed: 0x52,
    filled: 0x54,
    line: 0x1f,
    outline: 0x82,
    weak: 0xa4,
    text: 0xd0,
    strong: 0xf4,
    selected: 0.5,
};
const GRAY: Grays = Grays {
    surround: 0x77,
    deepest: 0x3c,
    panel: 0x4c,
    window: 0x50,
    idle: 0x58,
    hovered: 0x60,
    pressed: 0x66,
    filled: 0x68,
    line: 0x38,
    outline: 0xa4,
    weak: 0xc4,
    text: 0xe8,
    strong: 0xff,
    selected: 0.35,
};
const LIGHT: Grays = Grays {
    surround: 0xa8,
    deepest: 0xf6,
    panel: 0xdc,
    window: 0xe4,
    idle: 0xce,
    hovered: 0xc0,
    pressed: 0xb2,
    filled: 0xb0,
    line: 0xb4,
    outline: 0x76,
    weak: 0x58,
    text: 0x2c,
    strong: 0x08,
    selected: 0.55,
};

/// Sizes of the interface to choose from; 1 is the system's.
pub const SCALES: [f32; 10] = [0.75, 0.9, 1.0, 1.1, 1.25, 1.5, 1.75, 2.0, 2.5, 3.0];

/// The height of controls, points of the interface.
const CONTROL_PT: f32 = 21.0;
/// The height of a control for fingers, points of an interface that is not enlarged.
const FINGER_PT: f32 = 32.0;

/// Controls as high as fingers need where the interface is enlarged, or where the user wants it so.
pub fn enlarge_targets(ctx: &egui::Context, always: bool) {
    let zoom = ctx.zoom_factor();
    let finger_pt = (FINGER_PT / zoom).max(CONTROL_PT);
    let height_pt = if always || zoom > 1.0 { finger_pt } else { CONTROL_PT };
    let now_pt = ctx.global_style().spacing.interact_size.y;
    if (now_pt - height_pt).abs() > 0.01 {
        ctx.all_styles_mut(|style| style.spacing.interact_size.y = height_pt);
    }
}

/// Sets the theme of the first start.
pub fn install(ctx: &egui::Context) {
    Look::default().show(ctx);
    // Its zoom keys zoom the picture here.
    ctx.options_mut(|options| options.zoom_with_keyboard = false);
}

/// Errors, warnings and links on dark grounds, and on light ones.
type SignalColors = (Color32, Color32, Color32);
const WARM: SignalColors = (
    Color32::from_rgb(0xff, 0xb0, 0xa4),
    Color32::from_rgb(0xff, 0xc0, 0x60),
    Color32::from_rgb(0xa8, 0xd4, 0xff),
);
const COLD: SignalColors = (
    Color32::from_rgb(0xa8, 0x10, 0x10),
    Color32::from_rgb(0x76, 0x42, 0x00),
    Color32::from_rgb(0x08, 0x4a, 0x96),
);

/// `share` of `over` on `ground`, as the screen mixes them.
fn mix(ground: Color32, over: Color32, share: f32) -> Color32 {
    let one = |a: u8, b: u8| (f32::from(a) + (f32::from(b) - f32::from(a)) * share).round() as u8;
    Color32::from_rgb(
        one(ground.r(), over.r()),
        one(ground.g(), over.g()),
        one(ground.b(), over.b()),
    )
}

/// A box or a ring to tick has an outline while it is empty, unlike buttons.
pub fn outline(ui: &mut egui::Ui) {
    let gray = Color32::from_gray(Look::of(ui.visuals()).grays().outline);
    ui.visuals_mut().widgets.inactive.bg_stroke = Stroke::new(1.0, gray);
}

/// On the ground of a selected row, hints are as strong as its name: fainter ones are not legible.
pub fn strengthen_hints(ui: &mut egui::Ui) {
    let strong = ui.visuals().strong_text_color();
    ui.visuals_mut().weak_text_color = Some(strong);
}

fn apply_style(style: &mut Style, mut visuals: Visuals, grays: &Grays) {
    let gray = Color32::from_gray;
    let radius = CornerRadius::same(4);
    visuals.panel_fill = gray(grays.panel);
    visuals.window_fill = gray(grays.window);
    visuals.window_stroke = Stroke::new(1.0, gray(grays.line));
    visuals.extreme_bg_color = gray(grays.deepest);
    visuals.faint_bg_color = gray(grays.panel.saturating_add(4));
    visuals.weak_text_color = Some(gray(grays.weak));
    visuals.selection.bg_fill = mix(gray(grays.panel), ACCENT, grays.selected);
    visuals.selection.stroke = Stroke::new(1.0, gray(grays.strong));
    visuals.window_corner_radius = CornerRadius::same(8);
    visuals.menu_corner_radius = CornerRadius::same(6);
    let widgets = &mut visuals.widgets;
    for (widget, fill, text) in [
        (&mut widgets.noninteractive, grays.panel, grays.text),
        (&mut widgets.inactive, grays.idle, grays.text),
        (&mut widgets.hovered, grays.hovered, grays.strong),
        (&mut widgets.active, grays.pressed, grays.strong),
        (&mut widgets.open, grays.idle, grays.strong),
    ] {
        (widget.bg_fill, widget.weak_bg_fill) = (gray(fill), gray(fill));
        widget.bg_stroke = Stroke::NONE;
        widget.fg_stroke = Stroke::new(1.0, gray(text));
        widget.corner_radius = radius;
        widget.expansion = 0.0;
    }
    let alarm = if grays.text > 0x80 { &WARM } else { &COLD };
    (visuals.error_fg_color, visuals.warn_fg_color, visuals.hyperlink_color) = *alarm;
    let widgets = &mut visuals.widgets;
    widgets.noninteractive.bg_stroke = Stroke::new(1.0, gray(grays.line));
    style.visuals = visuals;
    // A drag that misses a slider would select the text next to it.
    style.interaction.selectable_labels = false;
    style.spacing.item_spacing = vec2(6.0, 5.0);
    style.spacing.button_padding = vec2(7.0, 3.0);
    style.spacing.interact_size = vec2(36.0, CONTROL_PT);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::srgb;

    fn luminance(color: Color32) -> f32 {
        let [r, g, b] = [color.r(), color.g(), color.b()].map(srgb::decode_u8);
        srgb::luminance(r, g, b)
    }

    /// The ratio of WCAG 2: (the lighter + 0.05) / (the darker + 0.05).
    fn contrast(a: Color32, b: Color32) -> f32 {
        let (a, b) = (luminance(a) + 0.05, luminance(b) + 0.05);
        a.max(b) / a.min(b)
    }

    /// Every pair of text and ground that the window shows, by its name.
    fn pairs(visuals: &Visuals) -> Vec<(&'static str, Color32, Color32)> {
        let (panel, window) = (visuals.panel_fill, visuals.window_fill);
        let (text, weak) = (visuals.text_color(), visuals.weak_text_color());
        let strong = visuals.strong_text_color();
        let grounds = [("panel", panel), ("window", window), ("row", visuals.faint_bg_color)];
        let mut found = Vec::new();
        for (_, ground) in grounds {
            found.push(("text", text, ground));
            found.push(("hint", weak, ground));
            found.push(("strong", strong, ground));
            found.push(("error", visuals.error_fg_color, ground));
            found.push(("warning", visuals.warn_fg_color, ground));
            found.push(("link", visuals.hyperlink_color, ground));
        }
        found.push(("text typed", text, visuals.extreme_bg_color));
        found.push(("hint in a field", weak, visuals.extreme_bg_color));
        found.push(("a selected row's name", strong, visuals.selection.bg_fill));
        found.push(("a selected row", visuals.selection.stroke.color, visuals.selection.bg_fill));
        for is_held in [false, true] {
            found.push(("a number on its bar", strong, bar_fill(visuals, is_held)));
        }
        found.push(("a name on a bar", text, bar_fill(visuals, false)));
        let widgets = &visuals.widgets;
        let states = [&widgets.inactive, &widgets.hovered, &widgets.active, &widgets.open];
        found.extend(states.map(|state| ("button", state.text_color(), state.weak_bg_fill)));
        found
    }

    #[test]
    fn all_text_has_a_contrast_of_four_and_a_half_in_every_look() {
        for (look, name) in Look::ALL {
            let ctx = egui::Context::default();
            look.show(&ctx);
            let visuals = ctx.global_style().visuals.clone();
            for (what, text, ground) in pairs(&visuals) {
                let found = contrast(text, ground);
                assert!(found >= 4.5, "{name}: {what} {text:?} on {ground:?}: {found:.2}");
            }
        }
    }

    /// WCAG 2 asks for 3 where a shape says what a control is.
    #[test]
    fn controls_are_as_high_as_fingers_need_in_a_larger_interface_and_by_choice() {
        let height_of = |zoom: f32, always: bool| {
            let ctx = egui::Context::default();
            ctx.set_zoom_factor(zoom);
            // The zoom is that of the next frame.
            ctx.run_ui(egui::RawInput::default(), |_| {}).textures_delta.clear();
            Look::Light.show(&ctx);
            enlarge_targets(&ctx, always);
            ctx.global_style().spacing.interact_size.y * zoom
        };
        assert_eq!(height_of(1.0, false), CONTROL_PT);
        for (zoom, always) in [(1.0, true), (1.25, false), (1.5, false), (2.0, false)] {
            assert!(height_of(zoom, always) > FINGER_PT - 0.1, "{zoom}");
        }
    }

    #[test]
    fn the_outline_of_an_empty_box_is_seen() {
        for (look, name) in Look::ALL {
            let grays = look.grays();
            // Panels, windows and popups, and the rows of lists.
            for ground in [grays.panel, grays.window, grays.panel.saturating_add(4)] {
                let found = contrast(Color32::from_gray(grays.outline), Color32::from_gray(ground));
                assert!(found >= 3.0, "{name}: {found:.2}");
            }
        }
    }

    #[test]
    fn the_line_of_the_tab_in_front_and_the_mark_of_a_bar_are_seen() {
        for (look, name) in Look::ALL {
            let ctx = egui::Context::default();
            look.show(&ctx);
            let visuals = ctx.global_style().visuals.clone();
            let found = contrast(accent(&visuals), visuals.panel_fill);
            assert!(found >= 3.0, "{name}: {found:.2}");
            let mark = contrast(mark_on_bar(&visuals), bar_fill(&visuals, false));
            assert!(mark >= 3.0, "{name}, on a bar: {mark:.2}");
        }
    }

    #[test]
    fn a_boxs_outline_is_what_empty_boxes_show() {
        for (look, name) in Look::ALL {
            let ctx = egui::Context::default();
            look.show(&ctx);
            let mut output = ctx.run_ui(egui::RawInput::default(), |ui| {
                outline(ui);
                let shown = ui.visuals().widgets.inactive.bg_stroke.color;
                assert_eq!(shown, Color32::from_gray(look.grays().outline), "{name}");
                strengthen_hints(ui);
                let on_row =
                    contrast(ui.visuals().weak_text_color(), ui.visuals().selection.bg_fill);
                assert!(on_row >= 4.5, "{name}: the kind of the selected row {on_row:.2}");
            });
            output.textures_delta.clear();
        }
    }

    #[test]
    fn a_look_is_known_by_its_name_and_by_what_is_shown() {
        for (look, name) in Look::ALL {
            assert_eq!((Look::from_name(name), look.name()), (Some(look), name));
            let ctx = egui::Context::default();
            look.show(&ctx);
            assert_eq!(Look::of(&ctx.global_style().visuals), look);
        }
        assert_eq!(Look::from_name("grey"), Some(Look::Gray), "as settings of 0.1 spell it");
    }
}
