//! What lies around the picture and behind it, drawn only where it is seen. Floor 7. Where the
//! processor draws the window, each layer of color over the whole canvas takes as long as the
//! picture.

use crate::theme;
use eframe::egui::{
    ColorImage, Context, Mesh, Pos2, Rect, Shape, TextureHandle, TextureId, TextureOptions,
    TextureWrapMode, Visuals, pos2,
};

/// The squares behind what is transparent.
#[derive(Default)]
pub struct Checker(Option<TextureHandle>);

impl Checker {
    pub fn texture(&mut self, ctx: &Context) -> TextureId {
        let [light, dark] = theme::CHECKER;
        let texture = self.0.get_or_insert_with(|| {
            let image = ColorImage::new([2, 2], vec![light, dark, dark, light]);
            let options =
                TextureOptions { wrap_mode: TextureWrapMode::Repeat, ..TextureOptions::NEAREST };
            ctx.load_texture("checker", image, options)
        });
        texture.id()
    }
}

/// What surrounds the canvas in its area of the window: all of the area where the canvas is turned.
///
/// * `canvas`: its corners in order around it.
pub fn surround_shape(area: Rect, canvas: [Pos2; 4], visuals: &Visuals) -> Shape {
    let mut mesh = Mesh::default();
    parts_around(area, canvas)
        .into_iter()
        .filter(|part| part.is_positive())
        .for_each(|part| mesh.add_colored_rect(part, theme::surround(visuals)));
    Shape::mesh(mesh)
}

/// Above, below, left and right of the canvas.
fn parts_around(area: Rect, [a, b, c, d]: [Pos2; 4]) -> Vec<Rect> {
    let is_level = |a: Pos2, b: Pos2| a.y == b.y || a.x == b.x;
    if !(is_level(a, b) && is_level(b, c) && is_level(c, d) && is_level(d, a)) {
        return vec![area];
    }
    let inner = Rect::from_two_pos(a, c).intersect(area);
    if !inner.is_positive() {
        return vec![area];
    }
    let rect = |x0, y0, x1, y1| Rect::from_min_max(pos2(x0, y0), pos2(x1, y1));
    vec![
        rect(area.min.x, area.min.y, area.max.x, inner.min.y),
        rect(area.min.x, inner.max.y, area.max.x, area.max.y),
        rect(area.min.x, inner.min.y, inner.min.x, inner.max.y),
        rect(inner.max.x, inner.min.y, area.max.x, inner.max.y),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corners(rect: Rect) -> [Pos2; 4] {
        [rect.min, pos2(rect.max.x, rect.min.y), rect.max, pos2(rect.min.x, rect.max.y)]
    }

    #[test]
    fn the_parts_around_a_canvas_cover_all_of_the_area_but_it() {
        let area = Rect::from_min_max(pos2(10.0, 20.0), pos2(210.0, 120.0));
        for canvas in [
            Rect::from_min_max(pos2(30.5, 40.25), pos2(90.0, 80.75)),
            // Some of it, and all of the area, are beyond.
            Rect::from_min_max(pos2(-50.0, 40.0), pos2(90.0, 300.0)),
            Rect::from_min_max(pos2(-50.0, -40.0), pos2(900.0, 800.0)),
        ] {
            let mut parts = parts_around(area, corners(canvas));
            parts.retain(|part| part.is_positive());
            let own: f32 = parts.iter().map(|part| part.area()).sum();
            assert_eq!(own + canvas.intersect(area).area(), area.area(), "{canvas:?}");
            let inner = canvas.shrink(0.01);
            assert!(parts.iter().all(|part| !part.intersects(inner)), "{canvas:?}: {parts:?}");
        }
        let elsewhere = Rect::from_min_max(pos2(500.0, 0.0), pos2(600.0, 100.0));
        assert_eq!(parts_around(area, corners(elsewhere)), [area]);
        let turned = [pos2(50.0, 30.0), pos2(90.0, 60.0), pos2(60.0, 100.0), pos2(20.0, 70.0)];
        assert_eq!(parts_around(area, turned), [area]);
    }
}
