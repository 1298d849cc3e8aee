//! What a drawing is before it has a shape: whether its background is transparent or of one color,
//! and whether it has flat colors. Floor 4. Not here: which parts are made of it (`flats`).

use super::from_flats::LEAST_FLAT;
use crate::math::srgb::Color;
use crate::math::{Rect, Size};
use crate::raster::grid::unpremultiply;
use crate::raster::{Plane, TileGrid, border};
use crate::shape::flats::color_distance::{is_near, share_on_the_way};
use crate::shape::flats::shares::{Flats, bytes};

/// What lies around the figure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FigureBackground {
    /// Nothing: the alpha is the outline.
    Transparent,
    /// One opaque color, along the whole border.
    Flat(Color),
    /// One opaque color, and nothing on it: there is no figure.
    Bare(Color),
    /// Many colors, as in a photograph: there is no outline.
    Painted,
    /// Neither figure nor outline.
    Empty,
}

/// What was found about a drawing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DrawingTraits {
    /// What is behind the figure.
    pub background: FigureBackground,
    /// Flat colors of the figure that are large enough to be parts.
    pub colors: usize,
    /// The share of the figure that lies in their areas, `[0, 1]`.
    pub flat_share: f32,
}

/// A pixel less opaque than this is background.
const OPAQUE: u8 = 128;
/// The share of the border that must have the color of a flat background.
const LEAST_BORDER: f32 = 0.9;
/// The share of the picture that must be transparent, so that the rest is a figure; and the share
/// that must be figure.
const LEAST_SHARE: f32 = 0.004;

impl FigureBackground {
    /// Of a picture as large as the canvas.
    pub fn of(tiles: &TileGrid, canvas: Size) -> Self {
        let all = canvas.area().max(1) as f32;
        let opaque = opaque(tiles, canvas) as f32 / all;
        match flat_ground(tiles, canvas) {
            _ if opaque < LEAST_SHARE => Self::Empty,
            _ if 1.0 - opaque >= LEAST_SHARE => Self::Transparent,
            Some(color) if is_all(tiles, canvas, color) => Self::Bare(color),
            Some(color) => Self::Flat(color),
            None => Self::Painted,
        }
    }
}

impl DrawingTraits {
    /// What is behind the figure of a drawing.
    pub fn of(tiles: &TileGrid, canvas: Size) -> Self {
        let background = FigureBackground::of(tiles, canvas);
        let without_colors = |background| Self { background, colors: 0, flat_share: 0.0 };
        let figure = match background {
            // A photograph has as many colors as pixels; none of them will be a part.
            FigureBackground::Empty | FigureBackground::Bare(_) | FigureBackground::Painted => {
                return without_colors(background);
            }
            FigureBackground::Flat(color) => without_background(tiles, canvas, color),
            FigureBackground::Transparent => tiles.clone(),
        };
        if let FigureBackground::Flat(color) = background
            && (opaque(&figure, canvas) as f32) < LEAST_SHARE * canvas.area().max(1) as f32
        {
            return without_colors(FigureBackground::Bare(color));
        }
        let Some(flats) = Flats::of(&figure, figure.bounds(), &[]) else {
            return without_colors(FigureBackground::Empty);
        };
        Self { background, colors: flats.colors().len(), flat_share: flats.flat_share() }
    }

    /// Whether it can be given a shape as it is.
    pub fn has_outline(&self) -> bool {
        matches!(self.background, FigureBackground::Transparent | FigureBackground::Flat(_))
    }

    /// Whether most of it is flat, so that lines are told from it.
    pub fn has_flats(&self) -> bool {
        self.flat_share >= LEAST_FLAT
    }

    /// Whether its colors are worth a part each.
    pub fn is_of_flats(&self) -> bool {
        self.colors > 1 && self.has_flats()
    }
}

/// How many pixels of the canvas are painted, px.
fn opaque(tiles: &TileGrid, canvas: Size) -> usize {
    let Rect { x0, y0, x1, y1 } = canvas.rect();
    (y0..y1).map(|y| (x0..x1).filter(|x| tiles.pixel(*x, y)[3] >= OPAQUE).count()).sum()
}

/// Whether every pixel of the canvas has a color, as nearly as one can tell.
fn is_all(tiles: &TileGrid, canvas: Size, color: Color) -> bool {
    let (color, Rect { x0, y0, x1, y1 }) = (bytes(color), canvas.rect());
    (y0..y1).all(|y| (x0..x1).all(|x| is_near(tiles.pixel(x, y), color)))
}

/// The opaque color that nearly all of the canvas's border has.
fn flat_ground(tiles: &TileGrid, canvas: Size) -> Option<Color> {
    let (w, h) = (canvas.width as i32, canvas.height as i32);
    let border: Vec<[u8; 4]> = (0..w)
        .flat_map(|x| [(x, 0), (x, h - 1)])
        .chain((0..h).flat_map(|y| [(0, y), (w - 1, y)]))
        .map(|(x, y)| tiles.pixel(x, y))
        .collect();
    let like = |color: [u8; 4]| border.iter().filter(|pixel| is_near(**pixel, color)).count();
    // In a background with noise any pixel will do; some are tried, all along the border.
    let tried = (0..16).map(|i| border[i * border.len() / 16]).filter(|pixel| pixel[3] == 255);
    let best = tried.max_by_key(|color| like(*color))?;
    let is_most = like(best) as f32 >= LEAST_BORDER * border.len() as f32;
    let [r, g, b, a] = best;
    is_most.then_some(Color { r, g, b, a })
}

/// A picture without its flat background, as far as that is joined to the border. Over the
/// background's color it looks as before: pixels at its edge lose just the background's share in
/// them.
pub fn without_background(tiles: &TileGrid, canvas: Size, background: Color) -> TileGrid {
    let color = bytes(background);
    let side = canvas.width as usize;
    let open = border::connected_to_border(canvas, |i| {
        is_near(tiles.pixel((i % side) as i32, (i / side) as i32), color)
    });
    let pixel = |x: usize, y: usize| {
        let (x, y) = (x as i32, y as i32);
        let here = tiles.pixel(x, y);
        if open.at(x as usize, y as usize) {
            return [0; 4];
        }
        let around = (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (x + dx, y + dy)));
        let (mut is_edge, mut other) = (false, here);
        for (x, y) in around {
            is_edge |= open.get(x, y).unwrap_or(false);
            let pixel = tiles.pixel(x, y);
            if squared_difference(pixel, color) > squared_difference(other, color) {
                other = pixel;
            }
        }
        if is_edge { unmix(here, color, share_on_the_way(here, other, color)) } else { here }
    };
    let (width, height) = (canvas.width as usize, canvas.height as usize);
    let rows: Plane<[u8; 4]> = Plane::from_fn(canvas, pixel);
    let mut straight = vec![0u8; 4 * width * height];
    unpremultiply(rows.values().as_flattened(), &mut straight);
    TileGrid::from_straight_rgba(&straight, width, height, 0, 0)
}

fn squared_difference(a: [u8; 4], b: [u8; 4]) -> i32 {
    a.iter().zip(b).map(|(a, b)| (i32::from(*a) - i32::from(b)).pow(2)).sum()
}

/// A premultiplied pixel without a share (of 255) of another color.
fn unmix(pixel: [u8; 4], of: [u8; 4], share: u8) -> [u8; 4] {
    let part = |c: usize| (f32::from(of[c]) * f32::from(share) / 255.0).round() as u8;
    let alpha = pixel[3].saturating_sub(part(3));
    std::array::from_fn(|c| pixel[c].saturating_sub(part(c)).min(alpha))
}

#[cfg(test)]
mod tests {
    use super::*;

    const CANVAS: Size = Size { width: 60, height: 50 };

    /// A disc with a soft edge and a hole of the background's color, on a background.
    fn drawn(background: [u8; 4], disc: [f32; 3]) -> TileGrid {
        let pixel = |i: usize| {
            let (x, y) = ((i % 60) as f32 + 0.5, (i / 60) as f32 + 0.5);
            let away = ((x - 30.0).powi(2) + (y - 25.0).powi(2)).sqrt();
            let share = (18.5 - away).max(0.0).min(1.0);
            if away < 4.0 {
                return [background[0], background[1], background[2], 255];
            }
            let mixed = |c: usize| {
                (disc[c] * share + f32::from(background[c]) * (1.0 - share)).round() as u8
            };
            match background[3] {
                0 => [disc[0] as u8, disc[1] as u8, disc[2] as u8, (255.0 * share).round() as u8],
                _ => [mixed(0), mixed(1), mixed(2), 255],
            }
        };
        let rgba: Vec<u8> = (0..3000).flat_map(pixel).collect();
        TileGrid::from_straight_rgba(&rgba, 60, 50, 0, 0)
    }

    #[test]
    fn a_ground_is_told_from_the_figure_by_alpha_or_by_its_one_color() {
        let cut_out = DrawingTraits::of(&drawn([255, 255, 255, 0], [200.0, 60.0, 20.0]), CANVAS);
        assert_eq!(
            (cut_out.background, cut_out.is_of_flats()),
            (FigureBackground::Transparent, true)
        );
        let white = Color { r: 255, g: 255, b: 255, a: 255 };
        let on_white = DrawingTraits::of(&drawn([255; 4], [200.0, 60.0, 20.0]), CANVAS);
        assert_eq!(
            (on_white.background, on_white.has_outline()),
            (FigureBackground::Flat(white), true)
        );
        assert_eq!(on_white.colors, 2, "the hole is no background: it is not joined to the border");
        let noise = |i: u32| crate::math::hash::unit(5, i, 3).mul_add(255.0, 0.0) as u8;
        let photo: Vec<u8> = (0..3000u32)
            .flat_map(|i| [noise(i), noise(i + 9000), noise(i + 20_000), 255])
            .collect();
        let photo = DrawingTraits::of(&TileGrid::from_straight_rgba(&photo, 60, 50, 0, 0), CANVAS);
        assert_eq!((photo.background, photo.is_of_flats()), (FigureBackground::Painted, false));
        assert_eq!(
            DrawingTraits::of(&TileGrid::default(), CANVAS).background,
            FigureBackground::Empty
        );
        let paper = TileGrid::from_straight_rgba(&[255; 12_000], 60, 50, 0, 0);
        assert_eq!(
            DrawingTraits::of(&paper, CANVAS).background,
            FigureBackground::Bare(white),
            "paper is no figure"
        );
        let speck = |i: usize| if i == 1500 { [0, 0, 0, 255] } else { [255; 4] };
        let speck = TileGrid::from_straight_rgba(
            &(0..3000).flat_map(speck).collect::<Vec<u8>>(),
            60,
            50,
            0,
            0,
        );
        assert_eq!(
            DrawingTraits::of(&speck, CANVAS).background,
            FigureBackground::Bare(white),
            "nor is a speck on it"
        );
    }

    #[test]
    fn a_drawing_without_its_ground_over_that_ground_is_what_it_was() {
        let background = Color { r: 240, g: 235, b: 220, a: 255 };
        let drawn = drawn([240, 235, 220, 255], [30.0, 60.0, 120.0]);
        let bare = without_background(&drawn, CANVAS, background);
        assert_eq!(bare.pixel(2, 2), [0; 4]);
        assert_eq!(bare.pixel(30, 25), [240, 235, 220, 255], "the hole stays");
        let mut soft = 0;
        for (x, y) in (0..50).flat_map(|y| (0..60).map(move |x| (x, y))) {
            let (over, was) = (bare.pixel(x, y), drawn.pixel(x, y));
            soft += usize::from(over[3] > 0 && over[3] < 255);
            for (c, under) in [240.0f32, 235.0, 220.0].into_iter().enumerate() {
                let seen = f32::from(over[c]) + under * (1.0 - f32::from(over[3]) / 255.0);
                assert!(
                    (seen - f32::from(was[c])).abs() < 3.0,
                    "{x} {y} {c}: {seen} for {}",
                    was[c]
                );
            }
        }
        assert!(soft > 60, "the edge is soft: {soft}");
    }
}
