//! The separate areas of a flat color, which nothing joins, or only a passage too narrow to be
//! meant. Floor 3. Not here: which share of a pixel a color takes (`shares`), the gap closing
//! (`paint::fill`).

use super::areas::{LEAST_SEEN, bound_all, least_area, plane_over, spread};
use super::shares::{Flats, MOSTLY};
use crate::math::srgb::Color;
use crate::math::{Rect, Size, Vec2, vec2};
use crate::raster::gaps::rooms;
use crate::raster::{Plane, distance};

/// How far around a color pixels are looked at, px: what lies over its edge belongs to its areas.
const BESIDE: i32 = 2;

/// The areas of one color of flats, numbered from 1.
pub struct ColorAreas {
    /// Of the flats.
    size: Size,
    /// Where the color is.
    bounds: Rect,
    /// The area of each pixel there that is mostly of the color; 0 elsewhere.
    labels: Plane<u32>,
    /// What each covers of these, and how many pixels that is; the first is area 1.
    areas: Vec<(Rect, usize)>,
}

impl ColorAreas {
    /// Where a color lies in a drawing.
    pub fn of(flats: &Flats, color: Color) -> Self {
        let all = flats.share_of(color, &[]);
        let size = all.size();
        let bounds = bound_all(&all, |share| share > 0).grown(BESIDE).intersect(size.rect());
        let share = plane_over(bounds, |x, y, _| all.at(x, y));
        // What a line separates stays apart.
        let inside = plane_over(bounds, |x, y, _| all.at(x, y) >= MOSTLY && !flats.is_given(x, y));
        let mut labels = rooms(&inside, flats.gap_px());
        let least = least_area(size);
        let areas = measure(&labels);
        // Fragments behind a narrow passage belong to the area at its other end.
        let is_fragment = |label: u32| label == 0 || areas[label as usize - 1].1 < least;
        let mut large = labels.map(|label| if is_fragment(label) { 0 } else { label });
        spread(&mut large, |x, y| labels.at(x, y) > 0);
        for (label, large) in labels.values_mut().iter_mut().zip(large.values()) {
            if *large > 0 {
                *label = *large;
            }
        }
        spread(&mut labels, |x, y| share.at(x, y) >= MOSTLY);
        let areas = measure(&labels);
        Self { size, bounds, labels, areas }
    }

    /// How many pixels it takes.
    pub fn pixels_held(&self) -> usize {
        self.labels.size().area()
    }

    /// The areas large enough for parts of their own, the largest first.
    pub fn large(&self) -> Vec<u32> {
        let least = least_area(self.size);
        let mut large: Vec<u32> =
            (1..=self.areas.len() as u32).filter(|area| self.pixels(*area) >= least).collect();
        large.sort_by_key(|area| (std::cmp::Reverse(self.pixels(*area)), *area));
        large
    }

    /// How many areas are seen that are too small for parts of their own.
    pub fn small(&self) -> usize {
        let least = least_area(self.size);
        self.areas.iter().filter(|(_, pixels)| (LEAST_SEEN..least).contains(pixels)).count()
    }

    /// How many pixels an area has.
    pub fn pixels(&self, area: u32) -> usize {
        self.areas.get((area as usize).wrapping_sub(1)).map_or(0, |(_, pixels)| *pixels)
    }

    /// The area at a point of the plane, px, or else the nearest one, and whether it is only that;
    /// `None` if there is none at all.
    pub fn nearest(&self, at: Vec2) -> Option<(u32, bool)> {
        let at = at - self.corner();
        let (x, y) = (at.x.floor(), at.y.floor());
        let here = self.labels.get(x as i32, y as i32).filter(|area| at.is_finite() && *area > 0);
        if let Some(area) = here {
            return Some((area, false));
        }
        let (w, h) = (self.labels.width(), self.labels.height());
        let mut best: Option<(f32, u32)> = None;
        for y in 0..h {
            let row = self.labels.row(y);
            for (x, area) in row.iter().enumerate().take(w).filter(|(_, area)| **area > 0) {
                let away = vec2(x as f32 + 0.5, y as f32 + 0.5).distance_squared(at);
                if best.is_none_or(|(least, _)| away < least) {
                    best = Some((away, *area));
                }
            }
        }
        best.map(|(_, area)| (area, true))
    }

    /// A point of an area, as far from its rim as one can be (of several such points, the one
    /// nearest to its center of gravity): the center of a pixel, px of the plane.
    pub fn middle(&self, area: u32) -> Vec2 {
        let Some((rect, pixels)) = self.areas.get((area as usize).wrapping_sub(1)) else {
            return Vec2::ZERO;
        };
        let around = rect.grown(1);
        let size = Size::new(around.width() as u32, around.height() as u32);
        let is_own = |x: usize, y: usize| {
            self.labels.get(x as i32 + around.x0, y as i32 + around.y0) == Some(area)
        };
        let rim = Plane::from_fn(size, |x, y| u8::from(!is_own(x, y)));
        let deep = distance::squared_distances(&rim, distance::FARTHEST);
        let own = || {
            (0..size.area())
                .map(|i| (i % rim.width(), i / rim.width()))
                .filter(|(x, y)| rim.at(*x, *y) == 0)
        };
        let sum = own().fold([0u64; 2], |sum, (x, y)| [sum[0] + x as u64, sum[1] + y as u64]);
        let mean = sum.map(|sum| sum as f32 / (*pixels).max(1) as f32);
        let away = |(x, y): (usize, usize)| vec2(x as f32, y as f32).distance_squared(mean.into());
        let best = own().reduce(|a, b| {
            let order = deep.at(b.0, b.1).cmp(&deep.at(a.0, a.1)).then(away(a).total_cmp(&away(b)));
            if order.is_gt() { b } else { a }
        });
        let middle =
            |(x, y)| vec2((x as i32 + around.x0) as f32 + 0.5, (y as i32 + around.y0) as f32 + 0.5);
        best.map_or(Vec2::ZERO, |at| self.corner() + middle(at))
    }

    /// Where its planes begin in the flats, px.
    fn corner(&self) -> Vec2 {
        vec2(self.bounds.x0 as f32, self.bounds.y0 as f32)
    }

    /// Writes a number to the pixels of an area.
    pub fn mark(&self, area: u32, numbers: &mut Plane<u32>, number: u32) {
        let columns = self.bounds.x0 as usize..self.bounds.x1 as usize;
        for y in 0..self.labels.height() {
            let to = &mut numbers.row_mut(y + self.bounds.y0 as usize)[columns.clone()];
            let both = to.iter_mut().zip(self.labels.row(y));
            both.filter(|(_, label)| **label == area).for_each(|(to, _)| *to = number);
        }
    }

    /// The share of each pixel that each of some areas takes of what the color takes: mixed
    /// pixels go to the nearest area.
    pub fn shares(&self, areas: &[u32], share: &Plane<u8>) -> Vec<Plane<u8>> {
        let mut labels = self.labels.clone();
        let (x0, y0) = (self.bounds.x0 as usize, self.bounds.y0 as usize);
        spread(&mut labels, |x, y| share.at(x + x0, y + y0) > 0);
        let label =
            |x: usize, y: usize| labels.get(x as i32 - self.bounds.x0, y as i32 - self.bounds.y0);
        let of = |x: usize, y: usize, area: u32| {
            if label(x, y) == Some(area) { share.at(x, y) } else { 0 }
        };
        areas.iter().map(|area| Plane::from_fn(share.size(), |x, y| of(x, y, *area))).collect()
    }
}

/// The areas that a part of a color can be split into.
pub struct SplitAreas {
    areas: ColorAreas,
    large: Vec<u32>,
    /// Where the plane lies in the part's frame.
    corner: Vec2,
}

impl SplitAreas {
    /// Of the picture in a rectangle of the part's frame.
    pub fn of(flats: &Flats, color: Color, rect: Rect) -> Self {
        let areas = ColorAreas::of(flats, color);
        Self { large: areas.large(), areas, corner: vec2(rect.x0 as f32, rect.y0 as f32) }
    }

    /// A point of each area, px of the part's frame, the largest area first.
    pub fn points(&self) -> Vec<Vec2> {
        self.large.iter().map(|area| self.corner + self.areas.middle(*area)).collect()
    }

    /// Which of these areas is at a point or nearest to it.
    pub fn nearest(&self, at: Vec2) -> usize {
        let found = self.areas.nearest(at - self.corner).map(|(area, _)| area);
        self.large.iter().position(|area| Some(*area) == found).unwrap_or(0)
    }
}

/// What each label covers, and how many pixels that is.
fn measure(labels: &Plane<u32>) -> Vec<(Rect, usize)> {
    let count = labels.values().iter().copied().max().unwrap_or(0) as usize;
    let mut areas = vec![(Rect::EMPTY, 0usize); count];
    for y in 0..labels.height() {
        for (x, label) in labels.row(y).iter().enumerate().filter(|(_, label)| **label > 0) {
            let (rect, pixels) = &mut areas[*label as usize - 1];
            *rect = rect.union(Rect::new(x as i32, y as i32, x as i32 + 1, y as i32 + 1));
            *pixels += 1;
        }
    }
    areas
}
