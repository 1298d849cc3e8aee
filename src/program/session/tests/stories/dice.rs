//! Draws the values of actions: numbers, words, places, layers. What a value is for is known by the
//! action's word and the field's name. Not here: values that documents hold (`values`), parts
//! (`parts`), the pen (`gestures`).

use super::facts::Facts;
use crate::io::recipe::{LiveLook, PaintedBall, PartMaterial};
use crate::math::{Vec2, Vec3, srgb::Color, vec2, vec3};
use crate::session::{LayerPath, LayerPaths};
use std::path::PathBuf;

/// A value that stories can hold. If the compiler leads you here, add the new type to the story
/// tables: to `values`, or by `names!`, `record!` or `actions!`.
#[diagnostic::on_unimplemented(
    message = "add `{Self}` to the story tables (session/tests/stories/values.rs)"
)]
pub trait Roll: Sized {
    fn roll(dice: &mut Dice) -> Self;
}

/// Chance, which is the same for the same seed, and what it draws for.
pub struct Dice {
    state: u64,
    /// What there is in the session that the next action is for.
    pub facts: Facts,
    /// The action, record or property whose field is drawn, and the field's name.
    pub word: &'static str,
    pub field: &'static str,
    /// The kind of the layer that was drawn last.
    pub kind: &'static str,
}

/// Numbers at and beyond the ends of ranges.
const EDGES: [f32; 16] = [
    0.0, -0.0, 1.0, -1.0, 0.5, 2.0, 1e-6, 1e-3, 20.0, 90.0, 200.0, 300.0, -300.0, 1024.5, 5000.0,
    -2e6,
];

/// Numbers by action or record, and field; without an action, by the field alone.
const RANGES: &[(&str, &str, f32, f32)] = &[
    ("turn", "degrees", -180.0, 180.0),
    ("turn", "by_rad", -3.0, 3.0),
    ("Fill", "tolerance", 0.0, 0.6),
    ("Fill", "gap_px", 0.0, 6.0),
    ("Fill", "grow_px", -3.0, 4.0),
    ("ShapeSettings", "size", 3.0, 60.0),
    ("ShapeSettings", "height", 0.2, 6.0),
    ("ShapeSettings", "radius", 1.0, 20.0),
    ("ShapeSettings", "reach", 0.0, 40.0),
    ("LiquifySettings", "size", 5.0, 80.0),
    ("CanvasGrid", "spacing", 2.0, 40.0),
    ("size", "to", 1.0, 40.0),
    ("spacing", "to", 0.05, 1.0),
    ("rotation", "to", -180.0, 180.0),
    ("reach", "to", 0.0, 2.0),
    ("change", "px", 0.0, 12.0),
    ("occlusion", "to", 0.0, 20.0),
    ("shininess", "to", 1.0, 80.0),
    ("exponent", "to", 0.5, 8.0),
    ("index", "to", 1.0, 2.4),
    ("power", "to", 0.5, 4.0),
    ("anisotropy", "", 1.0, 60.0),
    ("axes", "turn", -90.0, 90.0),
    ("", "rotation", -180.0, 180.0),
    ("", "exposure", -2.0, 2.0),
    ("", "factor", 0.3, 3.0),
    ("", "zoom", 0.2, 6.0),
    ("", "px_per_pt", 0.3, 3.0),
];

impl Dice {
    pub fn new(seed: u64) -> Self {
        Self { state: seed, facts: Facts::default(), word: "", field: "", kind: "" }
    }

    /// The next number of splitmix64.
    pub fn number(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// `[0, end)`; 0 if that is empty.
    pub fn below(&mut self, end: usize) -> usize {
        (self.number() % end.max(1) as u64) as usize
    }

    pub fn is(&mut self, percent: usize) -> bool {
        self.below(100) < percent
    }

    pub fn one_of<T: Clone>(&mut self, all: &[T]) -> T {
        all[self.below(all.len())].clone()
    }

    pub fn one_or<T: Clone>(&mut self, all: &[T], other: T) -> T {
        if all.is_empty() { other } else { self.one_of(all) }
    }

    pub fn within(&mut self, low: f32, high: f32) -> f32 {
        let share = (self.number() >> 40) as f32 / (1u64 << 24) as f32;
        // Files keep some digits; the pen gives few.
        ((low + (high - low) * share) * 64.0).round() / 64.0
    }

    /// One by its weight; all weights 0 gives the first.
    pub fn pick_by_weight(&mut self, weights: &[u32]) -> usize {
        let mut left = self.below(weights.iter().sum::<u32>() as usize) as u32;
        weights
            .iter()
            .position(|weight| {
                left < *weight || {
                    left -= weight;
                    false
                }
            })
            .unwrap_or_default()
    }

    /// A place, mostly on the canvas.
    pub fn place(&mut self) -> Vec2 {
        let size = self.facts.size;
        let beyond = if self.is(85) { 0.0 } else { 0.6 };
        let mut along = |side: f32| self.within(-beyond * side, (1.0 + beyond) * side);
        vec2(along(size.x), along(size.y))
    }

    /// The value of a field of an action.
    pub fn value<T: Roll>(&mut self, word: &'static str, field: &'static str) -> T {
        let around = (self.word, self.field);
        (self.word, self.field) = (word, field);
        let value = T::roll(self);
        (self.word, self.field) = around;
        value
    }

    /// The position of the next variant among those of an enum of actions.
    pub fn variant(&mut self, words: &[&'static str], of: &'static str) -> usize {
        let weights: Vec<u32> =
            words.iter().map(|word| super::weights::weight(of, word, self)).collect();
        self.pick_by_weight(&weights)
    }

    /// The same for a choice that may be absent, or a list.
    fn several<T: Roll>(&mut self, least: usize, most: usize) -> Vec<T> {
        let count = least + self.below(most - least + 1);
        (0..count).map(|_| T::roll(self)).collect()
    }
}

impl Roll for bool {
    fn roll(dice: &mut Dice) -> Self {
        // Most of what has a preview is let go of.
        let percent = if matches!(dice.field, "done" | "visible" | "guides") { 85 } else { 50 };
        dice.is(percent)
    }
}

impl Roll for f32 {
    fn roll(dice: &mut Dice) -> Self {
        if dice.is(6) {
            return dice.one_of(&EDGES);
        }
        let fits = |(word, field, ..): &&(&str, &str, f32, f32)| {
            (word.is_empty() || *word == dice.word) && (field.is_empty() || *field == dice.field)
        };
        if let Some((_, _, low, high)) = RANGES.iter().find(fits) {
            return dice.within(*low, *high);
        }
        dice.within(0.0, 1.0)
    }
}

impl Roll for f64 {
    fn roll(dice: &mut Dice) -> Self {
        f32::roll(dice).into()
    }
}

/// A map of the canvas, near to one that moves nothing.
impl Roll for [f64; 6] {
    fn roll(dice: &mut Dice) -> Self {
        let mut near = |low: f32, high: f32| f64::from(dice.within(low, high));
        [
            near(0.6, 1.4),
            near(-0.4, 0.4),
            near(-0.4, 0.4),
            near(0.6, 1.4),
            near(-20.0, 20.0),
            near(-20.0, 20.0),
        ]
    }
}

impl Roll for usize {
    fn roll(dice: &mut Dice) -> Self {
        match dice.field {
            "columns" | "rows" => 2 + dice.below(3),
            "index" if matches!(dice.word, "tab" | "close") => dice.below(dice.facts.documents + 1),
            "stroke" | "strokes" => dice.below(dice.facts.strokes.max(1) + 1),
            _ => dice.below(4),
        }
    }
}

impl Roll for u32 {
    fn roll(dice: &mut Dice) -> Self {
        let whole = match (dice.word, dice.field) {
            (_, "width") => 40 + dice.below(110),
            (_, "height") => 30 + dice.below(80),
            (_, "scale") => 1 + dice.below(2),
            (_, "seed") => dice.below(1000),
            _ => dice.below(6),
        };
        whole as u32
    }
}

impl Roll for i32 {
    fn roll(dice: &mut Dice) -> Self {
        let size = dice.facts.size;
        match dice.field {
            "x0" | "y0" => dice.within(-15.0, 25.0) as i32,
            "x1" => size.x as i32 + dice.within(-30.0, 15.0) as i32,
            "y1" => size.y as i32 + dice.within(-30.0, 15.0) as i32,
            _ => dice.within(-4.0, 4.0) as i32,
        }
    }
}

impl Roll for u8 {
    fn roll(dice: &mut Dice) -> Self {
        if dice.field == "bits" { dice.one_of(&[8, 16]) } else { dice.one_of(&[60, 90, 100]) }
    }
}

impl Roll for String {
    fn roll(dice: &mut Dice) -> Self {
        let facts = &dice.facts;
        let known = match (dice.word, dice.field) {
            (_, "part") => facts.parts.iter().map(|part| part.id.clone()).collect(),
            ("preset" | "drawn with" | "second tip", _) => facts.presets.clone(),
            (_, "palette") => facts.palettes.clone(),
            ("keep" | "take" | "forget", _) => ["a", "b", "sky"].map(str::to_owned).to_vec(),
            ("overlay", _) => facts.views.clone(),
            ("look", _) => LiveLook::keys().map(str::to_owned).collect(),
            ("material", "name") => PartMaterial::keys().map(str::to_owned).collect(),
            ("guided by" | "tone of", _) => facts.names.clone(),
            ("painted ball", _) => PaintedBall::all().map(|ball| ball.key.to_owned()).collect(),
            _ => Vec::new(),
        };
        match (dice.field, dice.below(100)) {
            ("part", 0..10) => "canvas".into(),
            ("part", 10..13) => "part-99".into(),
            _ if !known.is_empty() => dice.one_of(&known),
            _ => dice
                .one_of(&["a", "b", "Ink", "é \"<&>'\n", "Strokes", "", "canvas", "part-1"])
                .into(),
        }
    }
}

impl Roll for PathBuf {
    fn roll(dice: &mut Dice) -> Self {
        let chance = dice.number();
        dice.facts.files.draw_file(dice.word, dice.field, chance)
    }
}

impl Roll for Color {
    fn roll(dice: &mut Dice) -> Self {
        let [r, g, b, a] = dice.number().to_le_bytes()[..4] else { return Color::BLACK };
        match dice.below(4) {
            0 => Color { r, g, b, a },
            1 => Color::WHITE,
            _ => Color { r, g, b, a: 255 },
        }
    }
}

impl Roll for Vec2 {
    fn roll(dice: &mut Dice) -> Self {
        match (dice.word, dice.field) {
            ("pivot", _) => vec2(dice.within(-0.2, 1.2), dice.within(-0.2, 1.2)),
            (_, "by") => vec2(dice.within(-20.0, 20.0), dice.within(-20.0, 20.0)),
            ("fit", _) => vec2(640.0, 480.0),
            _ => dice.place(),
        }
    }
}

impl Roll for Vec3 {
    fn roll(dice: &mut Dice) -> Self {
        vec3(dice.within(-1.0, 1.0), dice.within(-1.0, 1.0), dice.within(-0.2, 1.0))
    }
}

impl<T: Roll> Roll for Vec<T> {
    fn roll(dice: &mut Dice) -> Self {
        let least = usize::from(matches!(dice.field, "strokes" | "maps" | "stops" | "points"));
        dice.several(least, 3)
    }
}

impl<T: Roll> Roll for Option<T> {
    fn roll(dice: &mut Dice) -> Self {
        // Maps have normals.
        let percent = if dice.field == "normal" { 95 } else { 70 };
        dice.is(percent).then(|| T::roll(dice))
    }
}

impl Roll for LayerPath {
    fn roll(dice: &mut Dice) -> Self {
        let layers = dice.facts.layers.clone();
        match layers.is_empty() || dice.is(3) {
            true => super::facts::no_layer(),
            false => {
                let (path, kind) = dice.one_of(&layers);
                dice.kind = kind;
                path
            }
        }
    }
}

impl Roll for LayerPaths {
    fn roll(dice: &mut Dice) -> Self {
        match dice.is(75) {
            true => LayerPath::roll(dice).into(),
            false => LayerPaths::several(dice.several(1, 3)),
        }
    }
}
