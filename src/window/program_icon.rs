//! The icon of the program, for the title bar and the task bar. The packages take the same file. Floor 7.

use crate::io::{Budget, svg};
use crate::math::Rect;
use eframe::egui::IconData;
use std::path::Path;

/// The drawing, 64 × 64 px.
const DRAWING: &[u8] = include_bytes!("program_icon/rilievo.svg");

/// The icon as straight RGBA, or `None` if its drawing cannot be read.
pub fn program_icon() -> Option<IconData> {
    let painted = svg::decode_paint(Path::new("rilievo.svg"), DRAWING, 0, 0, &Budget::default());
    let painted = painted.ok()?;
    let (width, height) = (painted.size.width, painted.size.height);
    let rgba = painted.tiles.to_straight_rgba(Rect::new(0, 0, width as i32, height as i32));
    Some(IconData { rgba, width, height })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_icon_is_a_ball_on_a_dark_square_with_round_corners() {
        let icon = program_icon().expect("an icon");
        assert_eq!([icon.width, icon.height], [64, 64]);
        let texel = |x: usize, y: usize| &icon.rgba[4 * (64 * y + x)..][..4];
        assert_eq!(texel(0, 0)[3], 0, "the corner");
        let [dark, clay] = [texel(4, 32), texel(24, 16)];
        assert!(dark[0] < 60 && clay[0] > 180, "{dark:?}, {clay:?}");
    }
}
