//! Strokes in the making: samples come in, the tiles that they change come out. Each dab is laid once and painted once, over what
//! the stroke has left on its tiles so far; only the end of the curve, which the next sample may bend, is painted again.
//! Floor 3. Not here: what the pen did (`tools`).

use super::laid::{Laid, tiles_of};
use super::{Found, Sample, Stroke, pixels};
use crate::math::{Rect, Vec2, srgb::Color};
use crate::paint::brush::Brush;
use crate::paint::dab::{DabScratch, PlacedDab};
use crate::paint::laying::Laying;
use crate::paint::scene::Scene;
use crate::paint::tip::GrainTile;
use crate::paint::wash::{Manner, Wash};
use crate::raster::{Coverage, Mix, Paint, PlanarTile, Tile, TileAt, TileGrid};
use crate::surface::Operator;
use crate::surface::objects::Part;
use rayon::prelude::*;
use std::collections::{BTreeMap, HashMap};
use std::sync::{Arc, Mutex};

/// What strokes in hand are painted on.
pub enum Ground {
    /// A paint layer's pixels.
    Pixels(TileGrid),
    /// The strokes beneath in a stroke layer.
    Strokes(Vec<Arc<Stroke>>),
}

/// Strokes that are drawn together, the first lowest: one, or one and its mirror images.
///
/// However their samples come in batches, their pixels are those of the finished strokes painted at once. Takes 16 KiB for
/// every tile that a stroke touches (64 where its dabs vary in colour), and 64 where strokes lie beneath.
pub struct InHand {
    scene: Scene,
    ground: Ground,
    hands: Vec<Hand>,
    tiles: HashMap<TileAt, WetTile>,
}

/// One stroke in the making.
struct Hand {
    brush: Brush,
    operator: Operator,
    color: Color,
    samples: Vec<Sample>,
    laying: Laying,
    /// The settled dabs.
    laid: Laid,
    /// Where the last tail was shown.
    tail: Vec<TileAt>,
    bounds: Rect,
}

/// A tile under strokes in hand.
struct WetTile {
    /// The strokes beneath, once they were painted.
    beneath: Option<PlanarTile>,
    /// The settled dabs of each stroke in hand.
    washes: Vec<Option<Wash>>,
    /// What their grains leave.
    grains: Vec<Option<Box<GrainTile>>>,
}

/// What a batch of samples adds to one stroke.
struct Fresh<'s> {
    dabs: Vec<PlacedDab<'s>>,
    /// How many of them no later sample changes.
    settled: usize,
    /// Which of them may touch a tile, in their order.
    tiles: BTreeMap<TileAt, Vec<usize>>,
}

impl Hand {
    fn new(stroke: &Stroke, scene: &Scene) -> Self {
        let Stroke { brush, operator, color, .. } = stroke;
        Self {
            brush: brush.clone(),
            operator: *operator,
            color: *color,
            samples: Vec::new(),
            laying: Laying::new(brush, *operator, *color, scene),
            laid: Laid::empty(brush, scene),
            tail: Vec::new(),
            bounds: Rect::EMPTY,
        }
    }
    /// Lays what the samples settle, and the tail behind it.
    fn take<'s>(&mut self, samples: &[Sample], scene: &'s Scene) -> Fresh<'s> {
        self.samples.extend_from_slice(samples);
        self.laid.begin(&self.brush, &self.samples);
        let mut dabs = Vec::new();
        samples.iter().for_each(|sample| self.laying.push(sample, &mut dabs));
        let settled = dabs.len();
        dabs.extend(self.laying.tail());
        let laid = &self.laid;
        let placed: Vec<_> = dabs
            .par_iter()
            .map(|dab| {
                let placed = laid.place(*dab, scene);
                let tiles = tiles_of(&placed);
                (placed, tiles)
            })
            .collect();
        self.tail.clear();
        let mut fresh = Fresh { dabs: Vec::with_capacity(placed.len()), settled, tiles: BTreeMap::new() };
        for (i, (placed, tiles)) in placed.into_iter().enumerate() {
            for &at in &tiles {
                fresh.tiles.entry(at).or_default().push(i);
                self.bounds = self.bounds.union(at.rect());
            }
            match i < settled {
                true => self.laid.push(dabs[i], &tiles),
                false => self.tail.extend(tiles),
            }
            fresh.dabs.push(placed);
        }
        fresh
    }
    /// The wash of a tile as it is to be seen: with the tail. What is settled is added to `wash` for good.
    fn shown(
        &self,
        fresh: &Fresh,
        at: TileAt,
        (wash, grain): (&mut Option<Wash>, &mut Option<Box<GrainTile>>),
        scratch: &mut DabScratch,
    ) -> Option<Wash> {
        let here = fresh.tiles.get(&at).map_or(&[][..], Vec::as_slice);
        let (settled, tail) = here.split_at(here.partition_point(|&i| i < fresh.settled));
        if grain.is_none() && !here.is_empty() {
            *grain = self.laid.grain(at);
        }
        let mut add = |dabs: &[usize], wash: &mut Wash| {
            dabs.iter().for_each(|&i| self.laid.add(&fresh.dabs[i], at, grain.as_deref(), wash, scratch));
        };
        if !settled.is_empty() {
            add(settled, wash.get_or_insert_with(|| self.laid.wash()));
        }
        if tail.is_empty() {
            return wash.clone();
        }
        let mut shown = wash.clone().unwrap_or_else(|| self.laid.wash());
        add(tail, &mut shown);
        Some(shown)
    }
    fn part(&self, scene: &Scene) -> Part {
        let start = self.samples.first().map_or(Vec2::ZERO, |sample| sample.at);
        self.brush.bounded.from(scene.surface.as_ref(), start)
    }
    /// The stroke as far as it was drawn.
    fn stroke(&self, scene: &Scene) -> Stroke {
        let found = Found { laid: None, bounds: Some((scene.clone(), self.bounds)) };
        let Self { brush, operator, color, samples, .. } = self;
        let (brush, samples) = (brush.clone(), samples.clone());
        Stroke { brush, operator: *operator, color: *color, samples, found: Arc::new(Mutex::new(found)) }
    }
    /// The finished stroke, its dabs known already.
    fn finished(mut self, scene: &Scene) -> Stroke {
        for dab in self.laying.tail() {
            let tiles = tiles_of(&self.laid.place(dab, scene));
            self.laid.push(dab, &tiles);
        }
        let found = Found { laid: Some(Arc::new(self.laid)), bounds: None };
        let Self { brush, operator, color, samples, .. } = self;
        Stroke { brush, operator, color, samples, found: Arc::new(Mutex::new(found)) }
    }
}

impl InHand {
    /// Begins strokes like these, whose samples do not count.
    pub fn new(strokes: &[Stroke], ground: Ground, scene: &Scene) -> Self {
        let hands = strokes.iter().map(|stroke| Hand::new(stroke, scene)).collect();
        Self { scene: scene.clone(), ground, hands, tiles: HashMap::new() }
    }
    /// Takes the next samples of each stroke in; gives the tiles of the layer that look different now.
    pub fn draw(&mut self, samples: &[Vec<Sample>]) -> Vec<(TileAt, Option<Arc<Tile>>)> {
        let Self { scene, ground, hands, tiles } = self;
        let mut changed: Vec<TileAt> = hands.iter().flat_map(|hand| hand.tail.iter().copied()).collect();
        let none = Vec::new();
        let samples = samples.iter().chain(std::iter::repeat(&none));
        let fresh: Vec<Fresh> =
            hands.iter_mut().zip(samples).map(|(hand, samples)| hand.take(samples, scene)).collect();
        changed.extend(fresh.iter().flat_map(|fresh| fresh.tiles.keys()));
        changed.sort_unstable();
        changed.dedup();
        let dry = || WetTile {
            beneath: None,
            washes: hands.iter().map(|_| None).collect(),
            grains: hands.iter().map(|_| None).collect(),
        };
        let mut wet: Vec<_> = changed.iter().map(|at| (*at, tiles.remove(at).unwrap_or_else(dry))).collect();
        let paint = |scratch: &mut DabScratch, (at, tile): &mut (TileAt, WetTile)| {
            let mut pixels = ground.pixels(scene, *at, &mut tile.beneath);
            let kept = tile.washes.iter_mut().zip(&mut tile.grains);
            for ((hand, fresh), kept) in hands.iter().zip(&fresh).zip(kept) {
                if let Some(mut shown) = hand.shown(fresh, *at, kept, scratch) {
                    shown.bound_to(&hand.part(scene), *at);
                    shown.lay_over(&mut pixels, Manner::of(&hand.brush, hand.color));
                }
            }
            (*at, pixels.quantised().map(Arc::new))
        };
        let painted = wet.par_iter_mut().map_init(DabScratch::default, paint).collect();
        tiles.extend(wet);
        painted
    }
    /// The strokes as far as they were drawn. They know their bounds; their dabs would be laid anew.
    pub fn strokes(&self) -> Vec<Stroke> {
        self.hands.iter().map(|hand| hand.stroke(&self.scene)).collect()
    }
    /// The finished strokes. Their dabs are known.
    pub fn finish(self) -> Vec<Stroke> {
        let Self { scene, hands, .. } = self;
        hands.into_iter().map(|hand| hand.finished(&scene)).collect()
    }
}

impl Ground {
    /// What lies beneath a tile's strokes in hand, f32. `kept`: of strokes, painted once.
    fn pixels(&self, scene: &Scene, at: TileAt, kept: &mut Option<PlanarTile>) -> PlanarTile {
        match self {
            Ground::Pixels(grid) => {
                let mut pixels = PlanarTile::transparent();
                if let Some(tile) = grid.tile(at) {
                    pixels.blend(Mix::default(), Paint::Bytes(tile), &Coverage::FULL);
                }
                pixels
            }
            Ground::Strokes(strokes) if strokes.is_empty() => PlanarTile::transparent(),
            Ground::Strokes(strokes) => {
                let paint = || pixels(strokes, scene, at).unwrap_or_else(PlanarTile::transparent);
                kept.get_or_insert_with(paint).clone()
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Size, Vec2, hash, vec2, vec3};
    use crate::paint::grain::{Grain, Lies};
    use crate::paint::stroke::render_tile;
    use crate::paint::{Curve, Dynamics, Input, Jitter, Property, Tip};
    use crate::raster::{BlendMode, Plane};
    use crate::surface::{Maps, Surface};
    use proptest::prelude::*;

    const SIZE: Size = Size::new(300, 200);

    fn waves() -> Scene {
        let normals = Plane::from_fn(SIZE, |x, y| vec3((0.05 * x as f32).sin(), (0.07 * y as f32).cos(), 1.0));
        let depth = Plane::from_fn(SIZE, |x, _| 0.5 + 0.4 * (0.02 * x as f32).sin());
        let maps = Maps { normals, depth, coverage: Plane::filled(SIZE, 255) };
        Scene { size: SIZE, surface: Some(Arc::new(Surface::new(maps).unwrap())) }
    }
    fn samples(seed: u32, n: u32) -> Vec<Sample> {
        let random = |i, j| hash::unit(seed, i, j);
        let (mut at, mut time_secs) = (vec2(150.0, 100.0), 0.0);
        (0..n)
            .map(|i| {
                at = (at + 60.0 * (vec2(random(i, 0), random(i, 1)) - 0.5)).clamp(Vec2::ZERO, vec2(299.0, 199.0));
                time_secs += 0.01 * random(i, 2);
                Sample { pressure: random(i, 3), time_secs, ..Sample::at(at) }
            })
            .collect()
    }
    fn brushes() -> Vec<Brush> {
        let dynamics = Dynamics::default().with(Property::Size, Input::Speed, Curve::Share(0.8));
        let grain = Grain { size_px: 9.0, lies: Lies::Surface { gamma: 1.0 }, ..Grain::default() };
        let plain = Brush { size: 34.0, dynamics, ..Brush::default() };
        vec![
            plain.clone(),
            Brush { scatter: 0.6, jitter: Jitter { hue_degrees: 90.0, ..Jitter::default() }, ..plain.clone() },
            Brush { blend: BlendMode::Multiply, opacity: 0.6, ..plain.clone() },
            Brush { erases: true, ..plain.clone() },
            Brush { grain: Some(grain), tip: Tip::Square { ratio: 0.4 }, ..plain },
        ]
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(12))]
        #[test]
        fn a_stroke_in_hand_is_the_stroke_painted_at_once_however_its_samples_come(seed: u32, batch in 1usize..9) {
            let scene = waves();
            let operator = Operator::Normal { alpha: 0.3, beta: 1.0, detail: 0.0 };
            let beneath = Arc::new(Stroke::new(Brush::default(), operator, Color::parse("#c04020").unwrap(), samples(!seed, 6)));
            for brush in brushes() {
                let color = Color::parse("#20a0e0").unwrap();
                let samples = samples(seed, 17);
                let (all, mirrored) = (samples.clone(), samples.iter().map(|s| Sample { at: vec2(300.0 - s.at.x, s.at.y), ..*s }));
                let mirrored: Vec<Sample> = mirrored.collect();
                let like = [(); 2].map(|_| Stroke::new(brush.clone(), operator, color, Vec::new()));
                let mut hand = InHand::new(&like, Ground::Strokes(vec![beneath.clone()]), &scene);
                let mut shown: HashMap<TileAt, Option<Arc<Tile>>> = HashMap::new();
                for (batch, mirrored) in samples.chunks(batch).zip(mirrored.chunks(batch)) {
                    shown.extend(hand.draw(&[batch.to_vec(), mirrored.to_vec()]));
                }
                let once = [all, mirrored].map(|samples| Stroke::new(brush.clone(), operator, color, samples));
                let mut strokes = vec![beneath.clone()];
                strokes.extend(once.into_iter().map(Arc::new));
                let bounds = hand.strokes().iter().map(|s| s.bounds(&scene)).collect::<Vec<_>>();
                let mut finished = vec![beneath.clone()];
                finished.extend(hand.finish().into_iter().map(Arc::new));
                for at in TileAt::covering(SIZE.rect()) {
                    let whole = render_tile(&strokes, &scene, at);
                    let whole = whole.as_ref().map(|tile| tile.bytes());
                    let again = render_tile(&finished, &scene, at);
                    prop_assert_eq!(again.as_ref().map(|tile| tile.bytes()), whole, "{:?}, finished", at);
                    match shown.get(&at) {
                        Some(tile) => prop_assert_eq!(tile.as_ref().map(|tile| tile.bytes()), whole, "{:?}", at),
                        None => prop_assert!(strokes[1..].iter().all(|s| !s.touches(&scene, at)), "{:?} was left out", at),
                    }
                }
                for (stroke, bounds) in strokes[1..].iter().zip(bounds) {
                    let own = stroke.bounds(&scene);
                    prop_assert_eq!(own.intersect(bounds), own, "the bounds in hand hold the stroke");
                }
            }
        }
    }
}
