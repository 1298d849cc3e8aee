//! The unwrapped surface on the screen: its sheet, pulled from the painted tiles of the picture as they come.
//! Floor 7. Which point of the picture lies at each of its pixels is `surface::unwrap`'s.

use super::Canvas;
use super::sheet::TileSheet;
use crate::math::Vec2;
use crate::raster::{TILE, Tile, TileAt, TileGrid};
use crate::surface::unwrap::PlaneLayout;
use eframe::egui;
use rayon::prelude::*;
use std::collections::BTreeSet;
use std::sync::Arc;

/// The sheet as it is shown, and what it is made of.
#[derive(Default)]
pub struct UnwrappedSheet {
    layout: Option<Arc<PlaneLayout>>,
    pub shown: TileSheet,
    /// Each of its tiles, with the tiles of the picture that are seen in it.
    feeds: Vec<(TileAt, Vec<TileAt>)>,
    /// Tiles of the picture that changed since they were pulled; `None`: all.
    changed: Option<BTreeSet<TileAt>>,
}

impl UnwrappedSheet {
    /// Nothing is shown unwrapped any more.
    pub fn put_away(&mut self) {
        if self.layout.is_some() {
            *self = Self::default();
        }
    }
    /// The picture is another one.
    pub fn begin(&mut self) {
        self.changed = None;
    }
    /// Tiles of the picture were painted.
    pub fn changed(&mut self, tiles: impl Iterator<Item = TileAt>) {
        if let Some(changed) = &mut self.changed {
            changed.extend(tiles);
        }
    }
    /// Pulls what changed of the picture; whether anything did.
    pub fn follow(&mut self, ctx: &egui::Context, layout: &Arc<PlaneLayout>, picture: &TileGrid) -> bool {
        if !self.layout.as_ref().is_some_and(|known| Arc::ptr_eq(known, layout)) {
            self.shown.begin(layout.size());
            let tiles: Vec<TileAt> = TileAt::covering(layout.size().rect()).collect();
            self.feeds = tiles.into_par_iter().map(|at| (at, feeding(layout, at))).collect();
            (self.layout, self.changed) = (Some(layout.clone()), None);
        }
        let changed = self.changed.replace(BTreeSet::new());
        if changed.as_ref().is_some_and(BTreeSet::is_empty) {
            return self.shown.send(ctx, false);
        }
        let is_due =
            |feeds: &[TileAt]| changed.as_ref().is_none_or(|changed| feeds.iter().any(|at| changed.contains(at)));
        let due: Vec<TileAt> = self.feeds.iter().filter(|(_, feeds)| is_due(feeds)).map(|(at, _)| *at).collect();
        let pulled: Vec<_> = due.into_par_iter().map(|at| (at, pulled(layout, picture, at))).collect();
        self.shown.put(pulled);
        self.shown.send(ctx, false)
    }
}

impl Canvas {
    /// Brings the sheet of the unwrapped surface up to the picture, if it is shown.
    pub(super) fn follow_unwrapped(&mut self, ctx: &egui::Context, layout: Option<&Arc<PlaneLayout>>) {
        let was_shown = self.sheet.shown.size().is_some();
        match layout {
            Some(layout) => self.small_is_old |= self.sheet.follow(ctx, layout, &self.whole.grid),
            None => self.sheet.put_away(),
        }
        self.small_is_old |= was_shown != layout.is_some();
    }
}

/// The tiles of the picture that are seen in a tile of the sheet.
fn feeding(layout: &PlaneLayout, at: TileAt) -> Vec<TileAt> {
    let rect = at.rect();
    let pixels = (rect.y0..rect.y1).flat_map(|y| (rect.x0..rect.x1).map(move |x| (x, y)));
    let seen = pixels.filter_map(|(x, y)| layout.sheet().at(x, y)).flat_map(|point| {
        let corner = point - 0.5;
        [corner, corner + Vec2::ONE].map(|p| TileAt::of_pixel(p.x.floor() as i32, p.y.floor() as i32))
    });
    seen.collect::<BTreeSet<TileAt>>().into_iter().collect()
}

/// A tile of the sheet; premultiplied, between four pixels of the picture.
fn pulled(layout: &PlaneLayout, picture: &TileGrid, at: TileAt) -> Option<Arc<Tile>> {
    let rect = at.rect();
    let mut pixels = vec![0u8; TILE * TILE * 4];
    for (i, pixel) in pixels.chunks_exact_mut(4).enumerate() {
        let (x, y) = (rect.x0 + (i % TILE) as i32, rect.y0 + (i / TILE) as i32);
        let Some(point) = layout.sheet().at(x, y) else { continue };
        let corner = (point - 0.5).floor();
        let (share, x, y) = (point - 0.5 - corner, corner.x as i32, corner.y as i32);
        let [a, b, c, d] =
            [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(dx, dy)| picture.pixel(x + dx, y + dy).map(f32::from));
        for k in 0..4 {
            let (above, below) = (a[k] + share.x * (b[k] - a[k]), c[k] + share.x * (d[k] - c[k]));
            pixel[k] = (above + share.y * (below - above) + 0.5) as u8;
        }
    }
    Tile::from_pixels(pixels).map(Arc::new)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Size, Vec3, vec2, vec3};
    use crate::raster::Plane;
    use crate::surface::unwrap::UnwrapSettings;
    use crate::surface::{Maps, Surface};

    /// A board that leans back to the right.
    fn board() -> Surface {
        let size = Size::new(200, 100);
        let normals = Plane::from_fn(size, |_, _| vec3(0.6, 0.0, 0.8).normalize_or(Vec3::Z));
        let depth = Plane::from_fn(size, |x, _| x as f32 / 199.0);
        Surface::new(Maps { normals, depth, coverage: Plane::filled(size, 255) }).unwrap()
    }

    #[test]
    fn the_sheet_shows_the_picture_and_follows_the_tiles_that_change() {
        let surface = board();
        let layout = surface.plane_layout(UnwrapSettings { amount: 1.0, smooth_px: 0.0 }).unwrap();
        let (ctx, mut sheet) = (egui::Context::default(), UnwrappedSheet::default());
        let plain = TileGrid::from_straight_rgba(&[9, 90, 200, 255].repeat(20_000), 200, 100, 0, 0);
        assert!(sheet.follow(&ctx, &layout, &plain));
        let at = |q: Vec2| {
            let p = layout.sheet_at(&surface, q).unwrap();
            (p.x.floor() as i32, p.y.floor() as i32)
        };
        let (x, y) = at(vec2(150.0, 50.0));
        assert_eq!(sheet.shown.grid.pixel(x, y), [9, 90, 200, 255]);
        assert!(!sheet.follow(&ctx, &layout, &plain), "nothing changed");
        let mut painted = plain.clone();
        let tile = TileAt::of_pixel(150, 50);
        painted.set(tile, Tile::from_pixels([255, 0, 0, 255].repeat(TILE * TILE)).map(Arc::new));
        sheet.changed([tile].into_iter());
        assert!(sheet.follow(&ctx, &layout, &painted));
        assert_eq!(sheet.shown.grid.pixel(x, y), [255, 0, 0, 255]);
        let (x, y) = at(vec2(20.0, 50.0));
        assert_eq!(sheet.shown.grid.pixel(x, y), [9, 90, 200, 255]);
    }
}
