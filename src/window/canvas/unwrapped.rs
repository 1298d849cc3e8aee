//! The unwrapped surface on the screen: its sheet, pulled from the painted tiles of the picture as
//! they come. Floor 7. Not here: which point of the picture lies at each of its pixels
//! (`surface::unwrap`).

use super::Canvas;
use super::navigator_picture::EVERYWHERE;
use super::sheet::TileSheet;
use crate::math::{Rect, Vec2, vec2};
use crate::raster::{TILE, Tile, TileAt, TileGrid};
use crate::surface::Surface;
use crate::surface::unwrap::PlaneLayout;
use eframe::egui;
use rayon::prelude::*;
use std::collections::BTreeSet;
use std::sync::Arc;

/// The sheet as shown, and what it is made of.
#[derive(Default)]
pub struct UnwrappedSheet {
    layout: Option<Arc<PlaneLayout>>,
    pub shown: TileSheet,
    /// Each of its tiles, with the tiles of the picture that it shows.
    feeds: Vec<(TileAt, Vec<TileAt>)>,
    /// Tiles of the picture that changed since they were pulled; `None`: all.
    changed: Option<BTreeSet<TileAt>>,
}

impl UnwrappedSheet {
    /// Stops showing the surface unwrapped.
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
    pub fn mark_changed(&mut self, tiles: impl Iterator<Item = TileAt>) {
        if let Some(changed) = &mut self.changed {
            changed.extend(tiles);
        }
    }

    /// Samples what changed in the picture; returns a rectangle around what did, on the sheet.
    pub fn follow(
        &mut self,
        ctx: &egui::Context,
        layout: &Arc<PlaneLayout>,
        picture: &TileGrid,
    ) -> Rect {
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
        let is_due = |feeds: &[TileAt]| {
            changed.as_ref().is_none_or(|changed| feeds.iter().any(|at| changed.contains(at)))
        };
        let due: Vec<TileAt> =
            self.feeds.iter().filter(|(_, feeds)| is_due(feeds)).map(|(at, _)| *at).collect();
        let pulled: Vec<_> =
            due.into_par_iter().map(|at| (at, pull_tile(layout, picture, at))).collect();
        self.shown.put(pulled);
        self.shown.send(ctx, false)
    }
}

/// Overlays of the picture on the sheet.
#[derive(Clone, Copy)]
pub struct OnSheet<'a> {
    pub layout: &'a PlaneLayout,
    pub surface: &'a Surface,
}

/// Lines bend every so many px of the picture.
const STEP_PX: f32 = 3.0;
/// Two of these points farther apart than this on the sheet lie on two sides of an edge.
const CUT_PX: f32 = 6.0 * STEP_PX;

impl OnSheet<'_> {
    /// The place of a point of the picture; `None` off the surface. A corner of pixels lies where
    /// one of them does.
    pub fn point(&self, p: Vec2) -> Option<Vec2> {
        let sides = [(0.25, 0.25), (-0.25, 0.25), (0.25, -0.25), (-0.25, -0.25)];
        let pixels = sides.map(|(x, y)| (p + vec2(x, y)).floor());
        let is_covered = |at: &Vec2| {
            self.surface
                .coverage_plane()
                .get(at.x as i32, at.y as i32)
                .is_some_and(|covered| covered > 0)
        };
        let middle = pixels.into_iter().find(is_covered)? + 0.5;
        let within = (p - middle).clamp(Vec2::splat(-0.499), Vec2::splat(0.499));
        self.layout.sheet_at(self.surface, middle + within)
    }

    /// A straight line of the picture, in short pieces, without those off the sheet.
    pub fn line(&self, from: Vec2, to: Vec2) -> impl Iterator<Item = [Vec2; 2]> {
        /// A line across the largest canvas needs fewer.
        const MOST_STEPS: f32 = 32_768.0;
        let steps = (from.distance(to) / STEP_PX).ceil().max(1.0).min(MOST_STEPS);
        let on_sheet = *self;
        let at = move |i: usize| on_sheet.point(from.lerp(to, i as f32 / steps));
        let mut last = at(0);
        (1..=steps as usize).filter_map(move |i| {
            let (before, next) = (last, at(i));
            last = next;
            before.zip(next).filter(|(a, b)| a.distance(*b) <= CUT_PX).map(|(a, b)| [a, b])
        })
    }
}

impl Canvas {
    /// Updates the sheet of the unwrapped surface to the picture, if it is shown.
    pub(super) fn follow_unwrapped(
        &mut self,
        ctx: &egui::Context,
        layout: Option<&Arc<PlaneLayout>>,
    ) {
        let was_shown = self.sheet.shown.size().is_some();
        let sent = match layout {
            Some(layout) => self.sheet.follow(ctx, layout, &self.whole.grid),
            None => {
                self.sheet.put_away();
                Rect::EMPTY
            }
        };
        let is_other = was_shown != layout.is_some();
        let changed = if is_other { EVERYWHERE } else { sent };
        self.small_changed = self.small_changed.union(changed);
    }
}

/// The tiles of the picture that a tile of the sheet shows.
fn feeding(layout: &PlaneLayout, at: TileAt) -> Vec<TileAt> {
    let rect = at.rect();
    let pixels = (rect.y0..rect.y1).flat_map(|y| (rect.x0..rect.x1).map(move |x| (x, y)));
    let seen = pixels.filter_map(|(x, y)| layout.sheet().at(x, y)).flat_map(|point| {
        let corner = point - 0.5;
        [corner, corner + Vec2::ONE]
            .map(|p| TileAt::of_pixel(p.x.floor() as i32, p.y.floor() as i32))
    });
    seen.collect::<BTreeSet<TileAt>>().into_iter().collect()
}

/// A tile of the sheet; premultiplied, interpolated between four pixels of the picture.
fn pull_tile(layout: &PlaneLayout, picture: &TileGrid, at: TileAt) -> Option<Arc<Tile>> {
    let rect = at.rect();
    let mut pixels = vec![0u8; TILE * TILE * 4];
    for (i, pixel) in pixels.chunks_exact_mut(4).enumerate() {
        let (x, y) = (rect.x0 + (i % TILE) as i32, rect.y0 + (i / TILE) as i32);
        let Some(point) = layout.sheet().at(x, y) else { continue };
        let corner = (point - 0.5).floor();
        let (share, x, y) = (point - 0.5 - corner, corner.x as i32, corner.y as i32);
        let [a, b, c, d] = [(0, 0), (1, 0), (0, 1), (1, 1)]
            .map(|(dx, dy)| picture.pixel(x + dx, y + dy).map(f32::from));
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
    use crate::math::{Size, Vec3, vec3};
    use crate::raster::Plane;
    use crate::surface::Maps;
    use crate::surface::operator::UnwrapSettings;

    /// A board that leans back to the right.
    fn board() -> Surface {
        let size = Size::new(200, 100);
        let normals = Plane::from_fn(size, |_, _| vec3(0.6, 0.0, 0.8).normalize_or(Vec3::Z));
        let depth = Plane::from_fn(size, |x, _| x as f32 / 199.0);
        Surface::new(Maps { normals, depth, coverage: Plane::full(size, 255) }).unwrap()
    }

    #[test]
    fn lines_of_the_picture_lie_on_the_sheet_where_the_surface_does() {
        let surface = board();
        let layout = surface.plane_layout(UnwrapSettings { amount: 1.0, smooth_px: 0.0 }).unwrap();
        let on_sheet = OnSheet { layout: &layout, surface: &surface };
        let pieces: Vec<[Vec2; 2]> = on_sheet.line(vec2(20.0, 50.0), vec2(180.0, 50.0)).collect();
        let length: f32 = pieces.iter().map(|[a, b]| a.distance(*b)).sum();
        assert!((length / 200.0 - 1.0).abs() < 0.01, "as long as it is on the board: {length}");
        assert!(pieces.windows(2).all(|two| two[0][1] == two[1][0]), "it goes on");
        let beyond: Vec<[Vec2; 2]> = on_sheet.line(vec2(-400.0, 50.0), vec2(-10.0, 50.0)).collect();
        assert!(beyond.is_empty() && on_sheet.point(vec2(199.9, 100.0)).is_some());
    }

    #[test]
    fn the_sheet_shows_the_picture_and_follows_the_tiles_that_change() {
        let surface = board();
        let layout = surface.plane_layout(UnwrapSettings { amount: 1.0, smooth_px: 0.0 }).unwrap();
        let (ctx, mut sheet) = (egui::Context::default(), UnwrappedSheet::default());
        let plain = TileGrid::from_straight_rgba(&[9, 90, 200, 255].repeat(20_000), 200, 100, 0, 0);
        assert!(!sheet.follow(&ctx, &layout, &plain).is_empty());
        let at = |q: Vec2| {
            let p = layout.sheet_at(&surface, q).unwrap();
            (p.x.floor() as i32, p.y.floor() as i32)
        };
        let (x, y) = at(vec2(150.0, 50.0));
        assert_eq!(sheet.shown.grid.pixel(x, y), [9, 90, 200, 255]);
        assert!(sheet.follow(&ctx, &layout, &plain).is_empty(), "nothing changed");
        let mut painted = plain.clone();
        let tile = TileAt::of_pixel(150, 50);
        painted.set(tile, Tile::from_pixels([255, 0, 0, 255].repeat(TILE * TILE)).map(Arc::new));
        sheet.mark_changed([tile].into_iter());
        assert!(!sheet.follow(&ctx, &layout, &painted).is_empty());
        assert_eq!(sheet.shown.grid.pixel(x, y), [255, 0, 0, 255]);
        let (x, y) = at(vec2(20.0, 50.0));
        assert_eq!(sheet.shown.grid.pixel(x, y), [9, 90, 200, 255]);
    }
}
