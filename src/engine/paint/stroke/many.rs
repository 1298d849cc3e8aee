//! Many strokes on many tiles, with a bounded number of dabs in flight: each stroke is laid once for all the tiles that
//! wait for it, painted on them, and forgotten. Floor 3. The same pixels as tile by tile (`render_tile`), which lays a
//! stroke whose dabs are not kept once for each tile.

use super::Stroke;
use super::dabs::{StrokeDabs, TileReach};
use crate::paint::dab::DabScratch;
use crate::paint::scene::Scene;
use crate::raster::{PlanarTile, Tile, TileAt};
use rayon::prelude::*;
use std::sync::Arc;

/// Dabs that are held at a time, but for the last stroke's, which may go beyond: some 28 MB.
const DABS_IN_FLIGHT: usize = 1 << 18;
/// Tiles that are held at a time, in f32: 64 MB.
const TILES_IN_FLIGHT: usize = 1 << 10;

/// Lays all strokes once, to know where they lie; whether some had to be forgotten, so that [`render_tiles`] is to be
/// preferred. `None` if it is no longer wanted.
pub fn are_heavy(strokes: &[Arc<Stroke>], scene: &Scene, is_wanted: impl Fn() -> bool + Sync) -> Option<bool> {
    let front = scene.front();
    let heavy = |stroke: &Arc<Stroke>| {
        is_wanted().then(|| {
            stroke.support(&front);
            !stroke.is_laid(&front)
        })
    };
    strokes.par_iter().map(heavy).try_reduce(|| false, |a, b| Some(a | b))
}

/// Renders tiles of a list of strokes, the first lowest, and hands each to `done`; `None` if it is no longer wanted.
pub fn render_tiles(
    strokes: &[Arc<Stroke>],
    scene: &Scene,
    tiles: &[TileAt],
    is_wanted: impl Fn() -> bool,
    done: impl Fn(TileAt, Option<Tile>) + Sync,
) -> Option<()> {
    render_many(strokes, scene, tiles, is_wanted, |at, pixels| done(at, pixels.and_then(|pixels| pixels.quantised())))
}

/// The same before they are quantised.
pub fn render_many(
    strokes: &[Arc<Stroke>],
    scene: &Scene,
    tiles: &[TileAt],
    is_wanted: impl Fn() -> bool,
    done: impl Fn(TileAt, Option<PlanarTile>) + Sync,
) -> Option<()> {
    let front = scene.front();
    for part in tiles.chunks(TILES_IN_FLIGHT) {
        let mut active_tiles: Vec<Wet> = part.iter().map(|&at| Wet { at, pixels: None }).collect();
        let here: Vec<(&Stroke, Arc<TileReach>)> = strokes
            .par_iter()
            .map(|stroke| (stroke.as_ref(), stroke.support(&front)))
            .filter(|(_, support)| part.iter().any(|&at| support.touches(at)))
            .collect();
        for batch in batches(&here) {
            is_wanted().then_some(())?;
            let stroke_dabs: Vec<Flying> = batch
                .par_iter()
                .map(|(stroke, support)| Flying { stroke, support, stroke_dabs: stroke.stroke_dabs(&front) })
                .collect();
            active_tiles.par_iter_mut().for_each_init(DabScratch::default, |scratch, active_tiles| {
                active_tiles.paint(&stroke_dabs, scene, scratch)
            });
        }
        active_tiles.into_par_iter().for_each(|active_tiles| done(active_tiles.at, active_tiles.pixels));
    }
    Some(())
}

/// A stroke whose dabs are held.
struct Flying<'s> {
    stroke: &'s Stroke,
    support: &'s TileReach,
    stroke_dabs: Arc<StrokeDabs>,
}

/// A tile that strokes are being painted on.
struct Wet {
    at: TileAt,
    /// Once a stroke touched it.
    pixels: Option<PlanarTile>,
}

impl Wet {
    fn paint(&mut self, flying: &[Flying], scene: &Scene, scratch: &mut DabScratch) {
        for Flying { stroke, stroke_dabs, .. } in flying.iter().filter(|one| one.support.touches(self.at)) {
            let pixels = self.pixels.get_or_insert_with(PlanarTile::transparent);
            stroke.paint(stroke_dabs, scene, self.at, pixels, scratch);
        }
    }
}

/// Runs of strokes whose dabs together are few enough to be held.
fn batches<'a, 'b>(
    strokes: &'a [(&'b Stroke, Arc<TileReach>)],
) -> impl Iterator<Item = &'a [(&'b Stroke, Arc<TileReach>)]> {
    let mut rest = strokes;
    std::iter::from_fn(move || {
        let mut dabs = 0;
        let full = rest.iter().position(|(_, support)| {
            dabs += support.dabs;
            dabs >= DABS_IN_FLIGHT
        });
        let (batch, after) = rest.split_at(full.map_or(rest.len(), |last| last + 1));
        rest = after;
        (!batch.is_empty()).then_some(batch)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Size, hash, srgb::Color, vec2, vec3};
    use crate::paint::grain::BrushGrain;
    use crate::paint::stroke::render_tile;
    use crate::paint::{Brush, Sample};
    use crate::raster::{BlendMode, Plane};
    use crate::surface::{Maps, Operator, Surface};
    use std::collections::BTreeMap;
    use std::sync::Mutex;

    const SIZE: Size = Size::new(300, 200);

    fn waves() -> Scene {
        let normals = Plane::from_fn(SIZE, |x, y| vec3((0.05 * x as f32).sin(), (0.07 * y as f32).cos(), 1.0));
        let maps = Maps { normals, depth: Plane::filled(SIZE, 0.5), coverage: Plane::filled(SIZE, 255) };
        Scene { size: SIZE, surface: Some(Arc::new(Surface::new(maps).unwrap())) }
    }
    /// Strokes across the canvas and beyond it, in turn painting, erasing, mixing and grained.
    fn strokes(n: u32) -> Vec<Arc<Stroke>> {
        let plain = Brush { size: 12.0, hardness: 0.4, flow: 0.6, ..Brush::default() };
        let brushes = [
            plain.clone(),
            Brush { erases: true, ..plain.clone() },
            Brush { blend: BlendMode::Multiply, opacity: 0.7, ..plain.clone() },
            Brush { grain: Some(BrushGrain::default()), ..plain },
        ];
        let stroke = |i: u32| {
            let at = |j: u32| vec2(360.0 * hash::unit(i, j, 0) - 30.0, 260.0 * hash::unit(i, j, 1) - 30.0);
            let color = Color { r: (i * 40) as u8, g: 90, b: 255 - (i * 30) as u8, a: 255 };
            let operator = Operator::Normal { alpha: 0.2, beta: 1.0, detail: 0.0 };
            let operator = if i.is_multiple_of(2) { Operator::None } else { operator };
            let samples = (0..6).map(|j| Sample::at(at(j))).collect();
            Arc::new(Stroke::new(brushes[i as usize % 4].clone(), operator, color, samples))
        };
        (0..n).map(stroke).collect()
    }

    #[test]
    fn many_tiles_at_once_are_those_rendered_one_by_one() {
        let scene = waves();
        let (strokes, tiles) = (strokes(23), TileAt::covering(SIZE.rect()).collect::<Vec<_>>());
        let found = Mutex::new(BTreeMap::new());
        let done = |at, tile: Option<Tile>| drop(found.lock().unwrap().insert(at, tile.map(|t| t.bytes().to_vec())));
        render_tiles(&strokes, &scene, &tiles, || true, done).unwrap();
        let found = found.into_inner().unwrap();
        assert_eq!(found.len(), tiles.len());
        for (at, tile) in found {
            let one = render_tile(&strokes, &scene, at).map(|t| t.bytes().to_vec());
            assert!(tile == one, "{at:?}");
        }
    }
    #[test]
    fn batches_hold_every_stroke_once_and_few_dabs() {
        let (scene, strokes) = (Scene { size: SIZE, surface: None }, strokes(1));
        let support = |dabs| Arc::new(TileReach::new(scene.clone(), dabs, [TileAt::new(0, 0)].into_iter()));
        let dabs = [1, DABS_IN_FLIGHT, 5, DABS_IN_FLIGHT / 2, DABS_IN_FLIGHT / 2, 7];
        let all: Vec<(&Stroke, Arc<TileReach>)> = dabs.map(|dabs| (strokes[0].as_ref(), support(dabs))).into();
        assert_eq!(batches(&all).map(<[_]>::len).collect::<Vec<_>>(), [2, 3, 1]);
    }
    #[test]
    fn work_that_is_no_longer_wanted_ends() {
        let scene = Scene { size: SIZE, surface: None };
        assert!(render_tiles(&strokes(3), &scene, &[TileAt::new(0, 0)], || false, |_, _| ()).is_none());
        assert!(are_heavy(&strokes(3), &scene, || false).is_none());
    }
}
