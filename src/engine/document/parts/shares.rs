//! Which share of each pixel a flat colour takes: all of a pixel in a flat area, and a part of those that were mixed at
//! edges between two areas. Shares add up to the whole pixel, so that areas that touch leave no rim between them.
//! Floor 4. Not here: which colours are parts (`flats`).

use super::near::{NEAR, is_near, share_on_the_way};
use crate::math::srgb::Color;
use crate::math::{Rect, Size};
use crate::raster::{Plane, TileGrid};

/// Premultiplied.
type Pixel = [u8; 4];

/// How far from a mixed pixel the areas that it lies between are sought, px: edges are rarely blurred more.
const REACH: i32 = 3;
/// A pixel in a flat area has its colour in this many of its eight neighbours; along a straight edge two have it.
const LEAST_ALIKE: usize = 3;
/// A pixel farther than this from the line between two colours is no mixture of them, a sum of squares over the
/// channels.
const FARTHEST: i32 = (4 * NEAR) * (4 * NEAR);

/// The pixels of a flat picture.
pub struct Flats {
    pixels: Plane<Pixel>,
    /// Those in flat areas.
    is_flat: Plane<bool>,
}

impl Flats {
    /// The pixels of a rectangle.
    pub fn of(tiles: &TileGrid, rect: Rect) -> Self {
        let size = Size::new(rect.width() as u32, rect.height() as u32);
        let mut pixels = Plane::filled(size, [0u8; 4]);
        for y in 0..pixels.height() {
            for (x, pixel) in pixels.row_mut(y).iter_mut().enumerate() {
                *pixel = tiles.pixel(rect.x0 + x as i32, rect.y0 + y as i32);
            }
        }
        let is_flat = Plane::from_fn(size, |x, y| {
            let here = pixels.at(x, y);
            let alike =
                |&(dx, dy): &(i32, i32)| is_near(pixels.get(x as i32 + dx, y as i32 + dy).unwrap_or_default(), here);
            AROUND.iter().filter(|step| alike(step)).count() >= LEAST_ALIKE
        });
        let mut flats = Self { pixels, is_flat };
        flats.close_seams();
        flats
    }
    /// Whether a pixel lies in a flat area.
    pub fn is_flat(&self, x: usize, y: usize) -> bool {
        self.is_flat.at(x, y)
    }
    /// Those in flat areas, row by row.
    pub fn flat_pixels(&self) -> impl Iterator<Item = Pixel> + '_ {
        let both = self.pixels.values().iter().zip(self.is_flat.values());
        both.filter(|(_, is_flat)| **is_flat).map(|(pixel, _)| *pixel)
    }
    /// The share of each pixel that a colour takes together with others, 255 the whole. A pixel that is not between any
    /// two areas, as in the thinnest lines, counts where it has the colour.
    pub fn share_of(&self, color: Color, with: &[Color]) -> Plane<u8> {
        let own = bytes(color);
        let all: Vec<Pixel> = std::iter::once(own).chain(with.iter().copied().map(bytes)).collect();
        let counts = |pixel: Pixel| all.iter().any(|color| is_near(pixel, *color));
        Plane::from_fn(self.pixels.size(), |x, y| {
            let here = self.pixels.at(x, y);
            if self.is_flat(x, y) {
                // Areas of the other colours are not its own.
                return if is_near(here, own) { 255 } else { 0 };
            }
            let Some((from, to, share)) = self.between(x, y) else {
                return if is_near(here, own) { 255 } else { 0 };
            };
            // The others lie over it only where it has a share itself.
            match is_near(from, own) || is_near(to, own) {
                true => u8::from(counts(from)) * (255 - share) + u8::from(counts(to)) * share,
                false => 0,
            }
        })
    }
    /// The two areas that a mixed pixel lies between, and the share of the second; `None` where it lies between none.
    fn between(&self, x: usize, y: usize) -> Option<(Pixel, Pixel, u8)> {
        let mut beside: Vec<Pixel> = Vec::new();
        for reach in 1..=REACH {
            for (dx, dy) in ring(reach) {
                let (x, y) = (x as i32 + dx, y as i32 + dy);
                // There is nothing beyond the picture.
                let (pixel, is_flat) = match self.pixels.get(x, y) {
                    Some(pixel) => (pixel, self.is_flat(x as usize, y as usize)),
                    None => ([0; 4], true),
                };
                if is_flat && !beside.iter().any(|known| is_near(*known, pixel)) {
                    beside.push(pixel);
                }
            }
            if let Some(found) = nearest_way(self.pixels.at(x, y), &beside) {
                return Some(found);
            }
        }
        None
    }
    /// Gives the pixels of a seam that two areas left open between them to the nearer one.
    fn close_seams(&mut self) {
        let (w, h) = (self.pixels.width() as i32, self.pixels.height() as i32);
        let mut closed: Vec<(usize, usize, Pixel)> = Vec::new();
        let side = |x: i32, y: i32, (dx, dy): (i32, i32)| {
            (1..=REACH).find_map(|k| {
                let (x, y) = (x + k * dx, y + k * dy);
                let pixel = self.pixels.get(x, y)?;
                (pixel[3] == 255 && self.is_flat(x as usize, y as usize)).then_some((k, pixel))
            })
        };
        for (x, y) in (0..h).flat_map(|y| (0..w).map(move |x| (x, y))) {
            if self.pixels.at(x as usize, y as usize)[3] == 255 {
                continue;
            }
            let across = |(dx, dy): (i32, i32)| {
                let ((a, one), (b, other)) = (side(x, y, (dx, dy))?, side(x, y, (-dx, -dy))?);
                // A gap within one area is intended.
                let is_seam = a + b <= REACH + 1 && !is_near(one, other);
                is_seam.then_some(if a <= b { one } else { other })
            };
            if let Some(pixel) = across((1, 0)).or_else(|| across((0, 1))) {
                closed.push((x as usize, y as usize, pixel));
            }
        }
        for (x, y, pixel) in closed {
            self.pixels.set(x, y, pixel);
            self.is_flat.set(x, y, true);
        }
    }
}

fn bytes(color: Color) -> Pixel {
    color.premultiplied().map(|v| (v * 255.0).round() as u8)
}

const AROUND: [(i32, i32); 8] = [(-1, -1), (0, -1), (1, -1), (-1, 0), (1, 0), (-1, 1), (0, 1), (1, 1)];

/// The steps to the pixels of a square's border.
fn ring(reach: i32) -> impl Iterator<Item = (i32, i32)> {
    let all = (-reach..=reach).flat_map(move |dy| (-reach..=reach).map(move |dx| (dx, dy)));
    all.filter(move |(dx, dy): &(i32, i32)| dx.abs().max(dy.abs()) == reach)
}

/// The pair of colours whose mixture a pixel is, and the share of the second.
fn nearest_way(pixel: Pixel, colors: &[Pixel]) -> Option<(Pixel, Pixel, u8)> {
    let pairs = colors.iter().enumerate().flat_map(|(i, a)| colors[i + 1..].iter().map(move |b| (*a, *b)));
    let off = |(a, b): (Pixel, Pixel)| {
        let share = share_on_the_way(pixel, a, b);
        let mixed =
            |c: usize| (i32::from(a[c]) * (255 - i32::from(share)) + i32::from(b[c]) * i32::from(share) + 127) / 255;
        let off = (0..4).map(|c| (i32::from(pixel[c]) - mixed(c)).pow(2)).sum::<i32>();
        (off, a, b, share)
    };
    let (off, a, b, share) = pairs.map(off).min_by_key(|(off, ..)| *off)?;
    (off <= FARTHEST).then_some((a, b, share))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::parts::flats::{PartFor, colors_of, parts_of_flats};
    use crate::document::{Content, Document, Inflation, Layer, PixelLayer};
    use crate::math::{Vec2, vec2};
    use std::sync::Arc;

    const SIZE: Size = Size::new(200, 160);
    const BODY: [u8; 4] = [200, 120, 60, 255];
    const WING: [u8; 4] = [90, 140, 60, 255];
    /// White and the pupil's colour mix to the body's, nearly.
    const EYE: [u8; 4] = [255, 255, 255, 255];
    const PUPIL: [u8; 4] = [145, 10, 0, 255];

    /// A creature of four flats that touch, the nearest last.
    fn at(p: Vec2) -> Pixel {
        let within = |centre: Vec2, half: Vec2| ((p - centre) / half).length() < 1.0;
        let shapes = [
            (PUPIL, within(vec2(122.0, 61.0), vec2(5.0, 6.0))),
            (EYE, within(vec2(120.0, 60.0), vec2(13.0, 14.0))),
            (BODY, within(vec2(100.0, 80.0), vec2(52.0, 45.0))),
            (WING, within(vec2(52.0, 50.0), vec2(44.0, 24.0))),
        ];
        shapes.into_iter().find(|(_, is_in)| *is_in).map_or([0; 4], |(color, _)| color)
    }
    /// Each pixel is the mean over a square about it: sides of 1 are anti-aliased, longer ones blurred.
    fn drawn(side: f32, at: impl Fn(Vec2) -> Pixel) -> TileGrid {
        const N: usize = 8;
        let mut rgba = Vec::with_capacity(SIZE.area() * 4);
        for i in 0..SIZE.area() {
            let centre = vec2((i % SIZE.width as usize) as f32, (i / SIZE.width as usize) as f32) + 0.5;
            let mut sum = [0u32; 4];
            for k in 0..N * N {
                let step = (vec2((k % N) as f32, (k / N) as f32) + 0.5) / N as f32 - 0.5;
                let [r, g, b, a] = at(centre + step * side);
                [r, g, b, a].into_iter().zip(&mut sum).for_each(|(v, sum)| *sum += u32::from(v));
            }
            let alpha = sum[3].max(1);
            rgba.extend(sum[..3].iter().map(|v| (v * 255 / alpha) as u8));
            rgba.push((sum[3] / (N * N) as u32) as u8);
        }
        TileGrid::from_straight_rgba(&rgba, SIZE.width as usize, SIZE.height as usize, 0, 0)
    }
    fn color([r, g, b, a]: Pixel) -> Color {
        Color { r, g, b, a }
    }

    #[test]
    fn the_shares_of_a_pixel_add_up_to_what_is_painted_of_it() {
        for side in [1.0, 2.2] {
            let tiles = drawn(side, at);
            let flats = Flats::of(&tiles, SIZE.rect());
            let shares = [BODY, WING, EYE, PUPIL].map(|own| flats.share_of(color(own), &[]));
            let mut wrong = 0;
            for (x, y) in (0..160).flat_map(|y| (0..200).map(move |x| (x, y))) {
                let sum: i32 = shares.iter().map(|share| i32::from(share.at(x, y))).sum();
                let painted = i32::from(tiles.pixel(x as i32, y as i32)[3]);
                // Where three meet, two of them take it all.
                wrong += i32::from((sum - painted).abs() > 24);
            }
            assert!(wrong <= 6, "{wrong} pixels, edges of {side} px");
        }
    }
    #[test]
    fn only_areas_are_colours() {
        // A long straight edge half-way through its pixels is a long row of one mixed colour.
        let halves = drawn(1.0, |p| if p.x < 90.5 { BODY } else { WING });
        assert_eq!(colors_of(&halves, SIZE.rect()).len(), 2);
        assert_eq!(colors_of(&drawn(2.2, at), SIZE.rect()).len(), 4);
    }
    #[test]
    fn a_creature_of_flats_that_touch_has_no_rims_and_no_stray_points() {
        for side in [1.0, 2.2] {
            let tiles = drawn(side, at);
            let parts = parts_of_flats(&tiles, "Flats", Inflation::default(), PartFor::Color);
            assert_eq!(parts.len(), 4);
            let pixels = PixelLayer { tiles: tiles.clone(), ..PixelLayer::default() };
            let layers = vec![Arc::new(Layer::new("Flats", Content::Pixels(pixels)))];
            let flat = Document { layers, ..Document::empty(SIZE) };
            let surface = flat.with_parts(parts.into_iter().map(Arc::new).collect()).surface.unwrap();
            assert_eq!(surface.objects().count(), 4, "edges of {side} px: every part is one piece");
            let mut open = 0;
            for (x, y) in (2..158).flat_map(|y| (2..198).map(move |x| (x, y))) {
                let is_whole = tiles.pixel(x as i32, y as i32)[3] == 255;
                open += i32::from(is_whole && surface.coverage(x, y) < 250);
            }
            assert!(open <= 4, "{open} pixels between flats are not covered, edges of {side} px");
        }
    }
    #[test]
    fn a_seam_between_two_flats_is_closed_and_a_gap_within_one_stays() {
        let seam = |p: Vec2| match (p.x * 0.2 + p.y < 80.0, (p.x * 0.2 + p.y - 80.0).abs() < 0.9, p.x > 150.0) {
            (_, true, false) => [0; 4],
            (is_above, _, _) if p.x < 150.0 => {
                if is_above {
                    BODY
                } else {
                    WING
                }
            }
            _ if (p.x - 170.0).abs() < 1.0 => [0; 4],
            _ => EYE,
        };
        let flats = Flats::of(&drawn(1.0, seam), SIZE.rect());
        let whole = |x: usize, y: usize| {
            [BODY, WING, EYE].iter().map(|own| u32::from(flats.share_of(color(*own), &[]).at(x, y))).sum::<u32>()
        };
        for x in [20, 60, 100, 130] {
            let y = 80 - x / 5;
            assert!((y - 3..y + 3).all(|y| whole(x, y) >= 250), "{x}");
        }
        assert!((168..172).any(|x| whole(x, 20) < 60), "a gap within one colour is drawn");
    }
    #[test]
    fn what_is_behind_goes_on_beneath_the_edge_of_what_lies_over_it() {
        let tiles = drawn(1.0, at);
        let flats = Flats::of(&tiles, SIZE.rect());
        let (alone, beneath) =
            (flats.share_of(color(BODY), &[]), flats.share_of(color(BODY), &[color(EYE), color(PUPIL)]));
        let edge: Vec<usize> = (100..112).filter(|x| (1..255).contains(&alone.at(*x, 66))).collect();
        assert!(!edge.is_empty() && edge.iter().all(|x| beneath.at(*x, 66) == 255), "{edge:?}");
        assert_eq!(beneath.at(120, 60), 0, "not beneath all of it");
    }
}
