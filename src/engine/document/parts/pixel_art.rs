//! The colors of a picture, and whether it was drawn pixel by pixel: small, of few colors, without
//! soft edges. Floor 4.

use crate::math::Size;
use crate::math::srgb::Color;
use crate::raster::TileGrid;
use crate::shading::PixelShading;
use std::collections::BTreeMap;

/// The longest side of a picture that is drawn pixel by pixel, px.
const LONGEST: f32 = 320.0;
/// Its colors, at most.
const FEW_COLORS: usize = 64;
/// Colors that are told apart; a photograph has more.
const MOST_COLORS: usize = 1 << 16;

/// The colors of opaque pixels, the most frequent ones first, at most as many as pixel shading
/// takes.
pub fn colors_of(tiles: &TileGrid, canvas: Size) -> Vec<Color> {
    let counts = counts(tiles, canvas, MOST_COLORS);
    let mut colors: Vec<([u8; 3], u32)> = counts.colors.into_iter().collect();
    colors.sort_by_key(|(color, count)| (u32::MAX - count, *color));
    colors.truncate(PixelShading::MOST_COLORS);
    colors.into_iter().map(|([r, g, b], _)| Color::rgb(r, g, b)).collect()
}

/// The colors of a picture that was drawn pixel by pixel; `None` of another one.
pub fn pixel_art_colors(tiles: &TileGrid, canvas: Size) -> Option<Vec<Color>> {
    if canvas.longer_side() > LONGEST {
        return None;
    }
    let counts = counts(tiles, canvas, FEW_COLORS + 1);
    let is_drawn = !counts.has_soft_edges && (1..=FEW_COLORS).contains(&counts.colors.len());
    is_drawn.then(|| colors_of(tiles, canvas))
}

struct ColorCounts {
    colors: BTreeMap<[u8; 3], u32>,
    /// Whether a pixel is neither opaque nor transparent.
    has_soft_edges: bool,
}

fn counts(tiles: &TileGrid, canvas: Size, most: usize) -> ColorCounts {
    let mut found = ColorCounts { colors: BTreeMap::new(), has_soft_edges: false };
    for y in 0..canvas.height as i32 {
        for x in 0..canvas.width as i32 {
            let [r, g, b, a] = tiles.pixel(x, y);
            found.has_soft_edges |= a != 0 && a != 255;
            if a == 255 {
                *found.colors.entry([r, g, b]).or_default() += 1;
                if found.colors.len() >= most {
                    return found;
                }
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::raster::TileAt;
    use crate::raster::{TILE, Tile};
    use std::sync::Arc;

    fn picture(pixel: impl Fn(usize, usize) -> [u8; 4]) -> TileGrid {
        let bytes = (0..TILE * TILE).flat_map(|i| pixel(i % TILE, i / TILE)).collect();
        let mut tiles = TileGrid::default();
        tiles.set(TileAt::new(0, 0), Tile::from_pixels(bytes).map(Arc::new));
        tiles
    }

    const SIZE: Size = Size::new(TILE as u32, TILE as u32);

    #[test]
    fn few_colors_without_soft_edges_are_pixel_art() {
        let sprite = picture(|x, _| if x < 40 { [200, 80, 60, 255] } else { [0; 4] });
        assert_eq!(pixel_art_colors(&sprite, SIZE), Some(vec![Color::rgb(200, 80, 60)]));
        let soft = picture(|x, _| if x < 40 { [100, 40, 30, 128] } else { [0; 4] });
        assert_eq!(pixel_art_colors(&soft, SIZE), None);
        let photo = picture(|x, y| [x as u8, y as u8, 0, 255]);
        assert_eq!(pixel_art_colors(&photo, SIZE), None);
        assert_eq!(pixel_art_colors(&sprite, Size::new(2000, 64)), None);
    }

    #[test]
    fn frequent_colors_come_first() {
        let two = picture(|x, _| if x < 40 { [200, 80, 60, 255] } else { [10, 20, 30, 255] });
        assert_eq!(colors_of(&two, SIZE), [Color::rgb(200, 80, 60), Color::rgb(10, 20, 30)]);
    }
}
