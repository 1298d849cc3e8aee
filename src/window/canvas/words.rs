//! Words over the picture, or in its place. Floor 7.

use crate::language::tr;
use eframe::egui::{Align2, Rect, TextStyle, Ui, Vec2};

/// What a picture is that shows the document as its file holds it.
pub const AS_SAVED: &str = "As saved";

/// Words over the picture, given in English, for what it is if it is not the document.
pub fn show_badge(ui: &Ui, area: Rect, text: &str) {
    const INSET_PT: f32 = 8.0;
    let font = TextStyle::Button.resolve(ui.style());
    let color = ui.visuals().strong_text_color();
    let words = ui.painter().layout_no_wrap(tr(text).to_owned(), font, color);
    let size = words.size() + Vec2::splat(2.0 * INSET_PT);
    let place = Align2::CENTER_TOP.align_size_within_rect(size, area.shrink(INSET_PT));
    let painter = ui.painter_at(area);
    painter.rect_filled(place, 4.0, ui.visuals().panel_fill);
    painter.galley(place.min + Vec2::splat(INSET_PT), words, color);
}

/// A sentence, given in English, in place of a picture.
pub fn show_sentence(ui: &Ui, area: Rect, text: &str) {
    let font = TextStyle::Heading.resolve(ui.style());
    ui.painter().text(
        area.center(),
        Align2::CENTER_CENTER,
        tr(text),
        font,
        ui.visuals().weak_text_color(),
    );
}
