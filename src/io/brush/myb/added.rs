//! A setting of MyPaint's: a number, and what inputs of ours add to it.
//! Floor 5.

use super::curves::{STEPS, add_curves, level, straightened};
use crate::math::{Vec2, vec2};
use crate::paint::dynamics::{Curve, Input, MOST_ADDED};

/// A setting: a base value and what inputs add to it.
#[derive(Clone)]
pub struct Added {
    pub base: f32,
    pub rows: Vec<AddedInput>,
}

/// What an input of ours adds.
#[derive(Clone)]
pub struct AddedInput {
    pub input: Input,
    /// From left to right.
    pub points: Vec<Vec2>,
}

impl Added {
    pub fn add(&mut self, row: AddedInput) {
        match self.rows.iter_mut().find(|known| known.input == row.input) {
            Some(known) => known.points = add_curves(&known.points, &row.points),
            None => self.rows.push(row),
        }
    }

    /// Multiplied as a whole.
    pub fn times(mut self, factor: f32) -> Self {
        self.base *= factor;
        self.rows.iter_mut().flat_map(|row| &mut row.points).for_each(|p| p.y *= factor);
        self
    }

    /// The base within a range; what it loses is added by a row.
    pub fn within(mut self, least: f32, most: f32) -> Self {
        let base = self.base.max(least).min(most);
        let rest = self.base - base;
        if rest != 0.0 && !self.rows.is_empty() {
            self.rows[0].points.iter_mut().for_each(|p| p.y += rest);
        }
        self.base = base;
        self
    }

    /// Its least and its most.
    pub fn range(&self) -> [f32; 2] {
        let ends = |row: &AddedInput| {
            let all = row.points.iter().map(|p| p.y);
            [all.clone().fold(f32::INFINITY, f32::min), all.fold(f32::NEG_INFINITY, f32::max)]
        };
        self.rows
            .iter()
            .map(ends)
            .fold([self.base; 2], |sum, [least, most]| [sum[0] + least, sum[1] + most])
    }

    /// The value where all that drives it is halfway.
    pub fn middle_value(&self) -> f32 {
        self.base + self.rows.iter().map(AddedInput::middle_value).sum::<f32>()
    }

    /// The row that changes it most.
    pub fn main_row(&self) -> Option<usize> {
        (0..self.rows.len()).max_by(|&a, &b| self.rows[a].span().total_cmp(&self.rows[b].span()))
    }

    /// The value for one place of one input, while all others add nothing.
    pub fn at(&self, row: &AddedInput, x: f32) -> f32 {
        self.base + level(&row.points, x)
    }
}

impl AddedInput {
    /// What the curve adds at a place of its input.
    pub fn at(&self, x: f32) -> f32 {
        level(&self.points, x)
    }

    pub fn middle_value(&self) -> f32 {
        self.at(0.5)
    }

    /// The most that it adds.
    pub fn most(&self) -> f32 {
        self.points.iter().map(|p| p.y).fold(f32::NEG_INFINITY, f32::max)
    }

    fn span(&self) -> f32 {
        self.most() - self.points.iter().map(|p| p.y).fold(f32::INFINITY, f32::min)
    }

    /// As a curve that adds; `None` if it adds nothing measurable.
    pub fn curve(&self) -> Option<Curve> {
        let points = self.points.iter().map(|p| vec2(p.x, p.y.max(-MOST_ADDED).min(MOST_ADDED)));
        Curve::additive(straightened(&points.collect::<Vec<_>>()))
    }

    /// As a curve of factors; `value`: what a place makes of the whole, `[0, 1]`.
    pub fn factors(&self, value: impl Fn(f32) -> f32) -> Option<Curve> {
        let steps =
            (0..=STEPS).map(|i| i as f32 / STEPS as f32).chain(self.points.iter().map(|p| p.x));
        let mut places: Vec<f32> = steps.collect();
        places.sort_by(f32::total_cmp);
        places.dedup();
        let points: Vec<Vec2> =
            places.into_iter().map(|x| vec2(x, value(x).max(0.0).min(1.0))).collect();
        Curve::through(straightened(&points))
    }
}
