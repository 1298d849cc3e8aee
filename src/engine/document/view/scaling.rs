//! The view of the scaling function: σ over δ for several κ, at a low and at a high
//! scaling-invariant point (RS fig. 2). Floor 4. It needs no document.

use crate::math::{Size, Vec2, Vec3, vec2};
use crate::raster::Picture;
use crate::shading::Scaling;
use tiny_skia::{Color, Paint, Path, PathBuilder, Pixmap, Stroke, StrokeDash, Transform};

/// α of the plots, left to right.
const ALPHAS: [f32; 2] = [0.2, 0.8];
/// Concave to convex.
const KAPPAS: [f32; 5] = [-1.0, -0.5, 0.0, 0.5, 1.0];
const GAMMA: f32 = 1.0;

/// One plot's side and the margin around it, px.
const SIDE: f32 = 320.0;
const MARGIN: f32 = 20.0;
/// The largest σ shown: e, which is σ(1, 1) for γ = 1.
const MOST: f32 = std::f32::consts::E;

/// Draws the plots: δ from 0 to 1 rightward, σ from 0 to e upward, a line across at σ = 1 and one
/// down at δ = α, and every curve passes through their crossing. Blue is convex, red concave, gray
/// flat; the stronger the color the larger
/// |κ|.
pub(super) fn plots() -> Option<Picture> {
    let size = Size::new(
        (ALPHAS.len() as f32 * (SIDE + MARGIN) + MARGIN) as u32,
        (SIDE + 2.0 * MARGIN) as u32,
    );
    let mut pixmap = Pixmap::new(size.width, size.height)?;
    pixmap.fill(Color::WHITE);
    for (i, alpha) in ALPHAS.into_iter().enumerate() {
        let corner = vec2(MARGIN + i as f32 * (SIDE + MARGIN), MARGIN);
        let place = |delta: f32, sigma: f32| corner + SIDE * vec2(delta, 1.0 - sigma / MOST);
        let gray = Vec3::splat(0.55);
        let dashes = StrokeDash::new(vec![4.0, 4.0], 0.0);
        for guide in [[place(0.0, 1.0), place(1.0, 1.0)], [place(alpha, 0.0), place(alpha, MOST)]] {
            draw(
                &mut pixmap,
                &guide,
                gray,
                Stroke { width: 1.0, dash: dashes.clone(), ..Stroke::default() },
            );
        }
        for kappa in KAPPAS {
            let scaling = Scaling::new(alpha, GAMMA);
            let curve = (0..=160)
                .map(|i| i as f32 / 160.0)
                .map(|delta| place(delta, scaling.sigma(kappa, delta)));
            let points: Vec<Vec2> = curve.collect();
            draw(&mut pixmap, &points, color_of(kappa), Stroke { width: 2.5, ..Stroke::default() });
        }
        let frame = [place(0.0, MOST), place(0.0, 0.0), place(1.0, 0.0)];
        draw(&mut pixmap, &frame, Vec3::splat(0.15), Stroke { width: 1.5, ..Stroke::default() });
    }
    let mut straight = vec![[0; 4]; size.area()];
    crate::raster::grid::unpremultiply(pixmap.data(), straight.as_flattened_mut());
    Picture::srgb8(size, straight)
}

/// As the view of curvature: convex blue, concave red.
fn color_of(kappa: f32) -> Vec3 {
    let flat = Vec3::splat(0.45);
    let strong = if kappa > 0.0 { super::maps::CONVEX } else { super::maps::CONCAVE };
    flat.lerp(strong, kappa.abs())
}

fn draw(pixmap: &mut Pixmap, points: &[Vec2], color: Vec3, stroke: Stroke) {
    let Some(path) = line_through(points) else { return };
    let mut paint = Paint { anti_alias: true, ..Paint::default() };
    let [r, g, b] = color.to_array().map(crate::math::srgb::quantize);
    paint.set_color_rgba8(r, g, b, 255);
    pixmap.stroke_path(&path, &paint, &stroke, Transform::identity(), None);
}

fn line_through(points: &[Vec2]) -> Option<Path> {
    let (first, rest) = points.split_first()?;
    let mut path = PathBuilder::new();
    path.move_to(first.x, first.y);
    rest.iter().for_each(|p| path.line_to(p.x, p.y));
    path.finish()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::raster::picture::Texels;

    #[test]
    fn convex_curves_end_high_and_concave_ones_begin_high() {
        let picture = plots().unwrap();
        let Texels::Srgb8(texels) = &picture.texels else { panic!("views are encoded bytes") };
        let at = |delta: f32, sigma: f32| {
            let (x, y) = (MARGIN + SIDE * delta, MARGIN + SIDE * (1.0 - sigma / MOST));
            texels[y as usize * picture.size.width as usize + x as usize]
        };
        // σ(1, ½) = 1.767 at α = 0.2, and σ(−1, ½) its reciprocal.
        let ([r, _, b, _], [r2, _, b2, _]) = (at(0.5, 1.767_286), at(0.5, 1.0 / 1.767_286));
        assert!(b > 150 && r < 100 && r2 > 150 && b2 < 100, "{r} {b} {r2} {b2}");
        assert_eq!(at(0.5, 2.4), [255; 4]);
    }
}
