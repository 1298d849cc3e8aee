//! Many strokes on many tiles, with a bounded number of dabs in flight: the dabs of each stroke are
//! placed once for all the tiles that wait for it, painted on them, and dropped. Floor 3. The same
//! pixels as tile by tile (`render_tile`), which places the dabs of a stroke that are not cached
//! once for each tile.

use super::Stroke;
use super::dabs::{StrokeDabs, TileReach};
use crate::math::parallel;
use crate::paint::dab::DabScratch;
use crate::paint::scene::Scene;
use crate::raster::{PlanarTile, Tile, TileAt};
use rayon::prelude::*;
use std::collections::HashMap;
use std::sync::Arc;

/// Dabs that are held at a time, apart from the last stroke's, which may exceed it: some 28 MB.
const DABS_IN_FLIGHT: usize = 1 << 18;
/// Tiles that are held at a time, in f32: 64 MB.
const TILES_IN_FLIGHT: usize = 1 << 10;

/// Whether [`render_tiles`] is better for this many tiles: some strokes cannot be cached, or there
/// are so many that looking up the strokes of each tile would take long. `None` if it is no longer
/// wanted.
pub fn are_heavy(
    strokes: &[Arc<Stroke>],
    scene: &Scene,
    tiles: usize,
    is_wanted: impl Fn() -> bool + Sync,
) -> Option<bool> {
    const MANY: usize = 1 << 16;
    if strokes.len().saturating_mul(tiles) > MANY {
        return is_wanted().then_some(true);
    }
    let front = scene.front();
    // The first that cannot be cached ends it: the others' dabs would be placed in vain.
    let lay = |stroke: &Arc<Stroke>| {
        if !is_wanted() {
            return Err(None);
        }
        stroke.support(&front);
        if stroke.is_laid(&front) { Ok(()) } else { Err(Some(true)) }
    };
    strokes.par_iter().try_for_each(lay).map_or_else(|end| end, |()| Some(false))
}

/// Renders tiles of a list of strokes, the first lowest, and hands each to `done`; `None` if it is
/// no longer wanted.
pub fn render_tiles(
    strokes: &[Arc<Stroke>],
    scene: &Scene,
    tiles: &[TileAt],
    is_wanted: impl Fn() -> bool,
    done: impl Fn(TileAt, Option<Tile>) + Sync,
) -> Option<()> {
    render_many(strokes, scene, tiles, is_wanted, |at, pixels| {
        done(at, pixels.and_then(|pixels| pixels.quantize()))
    })
}

/// The same before they are quantized.
pub fn render_many(
    strokes: &[Arc<Stroke>],
    scene: &Scene,
    tiles: &[TileAt],
    is_wanted: impl Fn() -> bool,
    done: impl Fn(TileAt, Option<PlanarTile>) + Sync,
) -> Option<()> {
    let front = scene.front();
    for part in tiles.chunks(TILES_IN_FLIGHT) {
        let places: HashMap<TileAt, usize> =
            part.iter().enumerate().map(|(i, &at)| (at, i)).collect();
        let mut active_tiles: Vec<Wet> =
            part.iter().map(|&at| Wet { at, pixels: None, here: Vec::new() }).collect();
        for batch in batches(strokes, |stroke| stroke.most_dabs(&front)) {
            is_wanted().then_some(())?;
            let laid: Vec<Option<Arc<StrokeDabs>>> =
                parallel::map(batch, |stroke| place_dabs(stroke, &front, part));
            for (i, stroke_dabs) in laid.iter().enumerate() {
                for place in stroke_dabs
                    .iter()
                    .flat_map(|dabs| dabs.tiles())
                    .filter_map(|at| places.get(&at))
                {
                    active_tiles[*place].here.push(i);
                }
            }
            parallel::for_each_with(
                &mut active_tiles,
                1,
                DabScratch::default,
                |scratch, active_tile| active_tile.paint(batch, &laid, scene, scratch),
            );
        }
        parallel::for_each(active_tiles, 1, |active_tiles| {
            done(active_tiles.at, active_tiles.pixels)
        });
    }
    Some(())
}

/// The dabs of a stroke; `None` if it is known to touch none of the tiles.
fn place_dabs(stroke: &Stroke, front: &Scene, tiles: &[TileAt]) -> Option<Arc<StrokeDabs>> {
    let misses = |support: Arc<TileReach>| !tiles.iter().any(|&at| support.can_touch(at));
    (!stroke.known_support(front).is_some_and(misses)).then(|| stroke.stroke_dabs(front))
}

/// A tile that strokes are being painted on.
struct Wet {
    at: TileAt,
    /// Present once a stroke has touched it.
    pixels: Option<PlanarTile>,
    /// The strokes of the batch that may touch it.
    here: Vec<usize>,
}

impl Wet {
    fn paint(
        &mut self,
        batch: &[Arc<Stroke>],
        laid: &[Option<Arc<StrokeDabs>>],
        scene: &Scene,
        scratch: &mut DabScratch,
    ) {
        for i in self.here.drain(..) {
            let Some(stroke_dabs) = &laid[i] else { continue };
            let pixels = self.pixels.get_or_insert_with(PlanarTile::transparent);
            batch[i].paint(stroke_dabs, scene, self.at, pixels, scratch);
        }
    }
}

/// Runs of strokes whose dabs together are few enough to be held.
fn batches<T>(strokes: &[T], most_dabs: impl Fn(&T) -> usize) -> impl Iterator<Item = &[T]> {
    let mut rest = strokes;
    std::iter::from_fn(move || {
        let mut dabs = 0usize;
        let full = rest.iter().position(|stroke| {
            dabs = dabs.saturating_add(most_dabs(stroke));
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
    use crate::paint::{Brush, DualBrush, DualSettings, Sample};
    use crate::raster::{BlendMode, Plane};
    use crate::surface::{Maps, Operator, Surface};
    use std::collections::BTreeMap;
    use std::sync::Mutex;

    const SIZE: Size = Size::new(300, 200);

    fn waves() -> Scene {
        let normals = Plane::from_fn(SIZE, |x, y| {
            vec3((0.05 * x as f32).sin(), (0.07 * y as f32).cos(), 1.0)
        });
        let maps =
            Maps { normals, depth: Plane::full(SIZE, 0.5), coverage: Plane::full(SIZE, 255) };
        Scene { size: SIZE, surface: Some(Arc::new(Surface::new(maps).unwrap())) }
    }

    /// Strokes across the canvas and beyond it that paint, have two tips, erase, mix and have grain in
    /// turn.
    fn strokes(n: u32) -> Vec<Arc<Stroke>> {
        let plain = Brush { size: 12.0, hardness: 0.4, flow: 0.6, ..Brush::default() };
        let second = DualSettings { size: 0.5, spacing: 0.8, ..DualSettings::DEFAULT };
        let second = DualBrush { settings: second, ..DualBrush::default() };
        let brushes = [
            plain.clone(),
            Brush { dual: Some(Arc::new(second)), ..plain.clone() },
            Brush { erases: true, ..plain.clone() },
            Brush { blend: BlendMode::Multiply, opacity: 0.7, ..plain.clone() },
            Brush { grain: Some(BrushGrain::default()), ..plain },
        ];
        let stroke = |i: u32| {
            let at = |j: u32| {
                vec2(360.0 * hash::unit(i, j, 0) - 30.0, 260.0 * hash::unit(i, j, 1) - 30.0)
            };
            let color = Color { r: (i * 40) as u8, g: 90, b: 255 - (i * 30) as u8, a: 255 };
            let operator = Operator::Normal { alpha: 0.2, beta: 1.0, detail: 0.0 };
            let operator = if i.is_multiple_of(2) { Operator::None } else { operator };
            let samples = (0..6).map(|j| Sample::at(at(j))).collect();
            Arc::new(Stroke::new(brushes[i as usize % 5].clone(), operator, color, samples))
        };
        (0..n).map(stroke).collect()
    }

    #[test]
    fn many_tiles_at_once_are_those_rendered_one_by_one() {
        let scene = waves();
        let (strokes, tiles) = (strokes(23), TileAt::covering(SIZE.rect()).collect::<Vec<_>>());
        let found = Mutex::new(BTreeMap::new());
        let done = |at, tile: Option<Tile>| {
            drop(found.lock().unwrap().insert(at, tile.map(|t| t.bytes().to_vec())))
        };
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
        let dabs = [1, DABS_IN_FLIGHT, 5, DABS_IN_FLIGHT / 2, DABS_IN_FLIGHT / 2, 7];
        assert_eq!(batches(&dabs, |dabs| *dabs).map(<[_]>::len).collect::<Vec<_>>(), [2, 3, 1]);
    }

    #[test]
    fn no_stroke_has_more_dabs_than_are_allowed_for() {
        let scene = waves();
        for stroke in strokes(8) {
            let (most, is) = (stroke.most_dabs(&scene), stroke.stroke_dabs(&scene).count());
            assert!(is > 10 && is <= most, "{is} of {most}");
        }
    }

    #[test]
    fn work_that_is_no_longer_wanted_ends() {
        let scene = Scene { size: SIZE, surface: None };
        assert!(
            render_tiles(&strokes(3), &scene, &[TileAt::new(0, 0)], || false, |_, _| ()).is_none()
        );
        assert!(are_heavy(&strokes(3), &scene, 1, || false).is_none());
    }
}
