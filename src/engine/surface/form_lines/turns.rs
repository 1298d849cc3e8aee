//! How the values of a map turn from pixel to pixel, as the normals of a surface do, and the crests
//! where they turn most (Judd et al. 2007). Floor 2. Not here: lines along them (`fields`, `colors`).

use super::chains::{place, zero};
use super::smooth::gradient_row;
use crate::math::{Vec2, parallel, vec2};
use crate::raster::Plane;

/// The cosine of the angle between directions of neighbors from which they agree: 60°.
const AGREES: f32 = 0.5;

/// How fast the three values of a map change, as the normals of a surface turn: how fast at most,
/// per px, and which way.
pub(super) struct Turns {
    most: Plane<f32>,
    /// Unit; the sign is arbitrary.
    way: [Plane<f32>; 2],
    /// How the change grows along that way.
    growth: Plane<f32>,
}

/// The most of a change between two pixels.
pub(super) struct Crest {
    /// Where, `[0, 1]`.
    pub t: f32,
    /// How fast it is there, per px.
    pub most: f32,
    /// And beside it, on the side where it is faster.
    pub beside: f32,
}

impl Turns {
    /// q, the largest singular value of the derivative of three planes along links, its direction t,
    /// and ∂q/∂t.
    pub fn of(planes: [&Plane<f32>; 3], links: &Plane<u8>) -> Self {
        let size = links.size();
        let width = links.width().max(1);
        let [mut most, mut x, mut y, mut growth] = [0; 4].map(|_| Plane::full(size, 0.0f32));
        let ways = x.values_mut().chunks_mut(width).zip(y.values_mut().chunks_mut(width));
        let rows = most.values_mut().chunks_mut(width).zip(ways).enumerate();
        parallel::for_each_with(
            rows,
            1,
            || [0; 6].map(|_| vec![0.0f32; width]),
            |slopes, (row, (most, (x, y)))| {
                for (plane, slopes) in planes.iter().zip(slopes.as_chunks_mut::<2>().0) {
                    let [across, down] = slopes;
                    gradient_row(plane, links, row, across, down);
                }
                turn_row(slopes, most, x, y);
            },
        );
        let rows = growth.values_mut().chunks_mut(width).enumerate();
        parallel::for_each_with(
            rows,
            1,
            || [vec![0.0f32; width], vec![0.0f32; width]],
            |[across, down], (row, out)| {
                gradient_row(&most, links, row, across, down);
                growth_row([across, down], [x.row(row), y.row(row)], out);
            },
        );
        Self { most, way: [x, y], growth }
    }

    /// The direction at a pixel.
    pub fn way_at(&self, (x, y): (usize, usize)) -> Vec2 {
        vec2(self.way[0].at(x, y), self.way[1].at(x, y))
    }

    /// Where between two pixels the change is at its most along its way.
    pub fn crest(
        &self,
        a: (usize, usize),
        b: (usize, usize),
        links: &Plane<u8>,
        px: f32,
    ) -> Option<Crest> {
        let cos = self.way_at(a).dot(self.way_at(b));
        if cos.abs() < AGREES {
            return None;
        }
        let agreed = cos.signum() * self.growth.at(b.0, b.1);
        let t = zero(self.growth.at(a.0, a.1), agreed)?;
        let (from, to) = (self.most.at(a.0, a.1), self.most.at(b.0, b.1));
        let middle = place(a).lerp(place(b), t);
        let step = (self.way_at(a) + cos.signum() * self.way_at(b)).normalize_or_zero() * px;
        let beside = [middle + step, middle - step].map(|at| bilinear(&self.most, links, at, a));
        Some(Crest { t, most: from + t * (to - from), beside: beside[0].max(beside[1]) })
    }

    /// Marks the cells of a row that a crest as fast as `least`, per px, may cross.
    pub fn crest_cells(&self, least: f32) -> impl Fn(usize, &mut [u8]) + Sync {
        move |y, marks| {
            let [top, bottom] = [y, y + 1].map(|y| TurnRow {
                most: self.most.row(y),
                way: [self.way[0].row(y), self.way[1].row(y)],
                growth: self.growth.row(y),
            });
            mark_crests(&top, &bottom, least, marks);
        }
    }
}

/// A row of turns.
struct TurnRow<'t> {
    most: &'t [f32],
    way: [&'t [f32]; 2],
    growth: &'t [f32],
}

impl<'t> TurnRow<'t> {
    /// Its pixels from one on, so many.
    #[inline(always)]
    fn cut(&self, from: usize, count: usize) -> TurnRow<'t> {
        let cut = |row: &'t [f32]| &row[from..from + count];
        TurnRow {
            most: cut(self.most),
            way: [cut(self.way[0]), cut(self.way[1])],
            growth: cut(self.growth),
        }
    }

    /// Whether a crest lies between a pixel and one of another row.
    #[inline(always)]
    fn has_crest(&self, other: &TurnRow, x: usize) -> bool {
        let cos = self.way[0][x] * other.way[0][x] + self.way[1][x] * other.way[1][x];
        let is_below = if cos < 0.0 { other.growth[x] > 0.0 } else { other.growth[x] < 0.0 };
        (cos.abs() >= AGREES) & ((self.growth[x] < 0.0) != is_below)
    }
}

crate::widest! {
    /// q and t of each pixel of a row, of the derivatives of three planes across and down.
    fn turn_row(slopes: &[Vec<f32>; 6], most: &mut [f32], way_x: &mut [f32], way_y: &mut [f32]) {
        let n = most.len();
        let [ax, ay, bx, by, cx, cy] = slopes.each_ref().map(|row| &row[..n]);
        let (way_x, way_y) = (&mut way_x[..n], &mut way_y[..n]);
        for i in 0..n {
            let xx = ax[i] * ax[i] + bx[i] * bx[i] + cx[i] * cx[i];
            let yy = ay[i] * ay[i] + by[i] * by[i] + cy[i] * cy[i];
            let xy = ax[i] * ay[i] + bx[i] * by[i] + cx[i] * cy[i];
            let (mean, half) = (0.5 * (xx + yy), 0.5 * (xx - yy));
            let larger = mean + (half * half + xy * xy).sqrt();
            let x = if xx > yy { larger - yy } else { xy };
            let y = if xx > yy { xy } else { larger - xx };
            let per = 1.0 / (x * x + y * y).sqrt();
            let per = if per < f32::INFINITY { per } else { 0.0 };
            most[i] = larger.sqrt();
            way_x[i] = x * per;
            way_y[i] = y * per;
        }
    }

    /// The derivative along a direction.
    fn growth_row(slope: [&mut Vec<f32>; 2], way: [&[f32]; 2], out: &mut [f32]) {
        let n = out.len();
        let (slope, way) = (slope.map(|row| &row[..n]), way.map(|row| &row[..n]));
        for i in 0..n {
            out[i] = slope[0][i] * way[0][i] + slope[1][i] * way[1][i];
        }
    }

    /// Marks the cells between two rows on whose sides crests lie.
    fn mark_crests(top: &TurnRow, bottom: &TurnRow, least: f32, marks: &mut [u8]) {
        let n = marks.len();
        let [a, b, c, d] = [top.cut(0, n), top.cut(1, n), bottom.cut(0, n), bottom.cut(1, n)];
        for (x, mark) in marks.iter_mut().enumerate() {
            let has = a.has_crest(&b, x) | b.has_crest(&d, x) | c.has_crest(&d, x) | a.has_crest(&c, x);
            let is_fast = (a.most[x] > least) | (b.most[x] > least)
                | (c.most[x] > least) | (d.most[x] > least);
            *mark = u8::from(has & is_fast);
        }
    }
}

/// A map between pixels; of pixels that are not linked to any, the middle's value.
fn bilinear(plane: &Plane<f32>, links: &Plane<u8>, at: Vec2, middle: (usize, usize)) -> f32 {
    let at = at - 0.5;
    let (x, y) = (at.x.floor() as i32, at.y.floor() as i32);
    let (fx, fy) = (at.x - x as f32, at.y - y as f32);
    let own = plane.at(middle.0, middle.1);
    let value = |dx: i32, dy: i32| {
        let linked = links.get(x + dx, y + dy).unwrap_or(0);
        if linked == 0 { own } else { plane.at_clamped(x + dx, y + dy) }
    };
    let row = |dy: i32| value(0, dy) + fx * (value(1, dy) - value(0, dy));
    row(0) + fy * (row(1) - row(0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Size, hash};
    use crate::surface::form_lines::smooth::gradient_of;
    use crate::surface::links;

    const SIZE: Size = Size::new(37, 29);

    /// Three rough maps, and links of which some are missing.
    fn rough_maps() -> ([Plane<f32>; 3], Plane<u8>) {
        let value = |c: u32, x: usize, y: usize| hash::unit(c, x as u32, y as u32) - 0.5;
        let planes = [0, 1, 2].map(|c| Plane::from_fn(SIZE, |x, y| value(c, x, y)));
        let is_there =
            |axis: u32, x: usize, y: usize| hash::unit(7 + axis, x as u32, y as u32) > 0.2;
        let linked = Plane::from_fn(SIZE, |x, y| {
            let bit = |bit: u8, is: bool| if is { bit } else { 0 };
            bit(links::LEFT, x > 0 && is_there(0, x.saturating_sub(1), y))
                | bit(links::RIGHT, x + 1 < SIZE.width as usize && is_there(0, x, y))
                | bit(links::UP, y > 0 && is_there(1, x, y.saturating_sub(1)))
                | bit(links::DOWN, y + 1 < SIZE.height as usize && is_there(1, x, y))
        });
        (planes, linked)
    }

    #[test]
    fn a_row_of_slopes_has_the_bits_of_single_ones() {
        let ([plane, ..], links) = rough_maps();
        let width = plane.width();
        let (mut across, mut down) = (vec![9.0; width], vec![9.0; width]);
        for y in 0..plane.height() {
            gradient_row(&plane, &links, y, &mut across, &mut down);
            for x in 0..width {
                let expected = gradient_of(&plane, links.at(x, y), x, y);
                assert_eq!(vec2(across[x], down[x]), expected, "{x} {y}");
            }
        }
    }

    #[test]
    fn q_is_the_largest_change_and_t_its_direction() {
        let (planes, links) = rough_maps();
        let turns = Turns::of([&planes[0], &planes[1], &planes[2]], &links);
        for (x, y) in (0..29).flat_map(|y| (0..37).map(move |x| (x, y))) {
            let slopes = [0, 1, 2].map(|c| gradient_of(&planes[c], links.at(x, y), x, y));
            let along = |way: Vec2| slopes.iter().map(|s| s.dot(way).powi(2)).sum::<f32>().sqrt();
            let most = (0..720).map(|i| along(Vec2::from_angle(i as f32 * 0.5f32.to_radians())));
            let most = most.fold(0.0, f32::max);
            let (q, way) = (turns.most.at(x, y), turns.way_at((x, y)));
            assert!(
                (q - most).abs() < 1e-3 && (along(way) - q).abs() < 1e-3,
                "{x} {y}: {q} {most}"
            );
        }
    }

    #[test]
    fn every_cell_that_a_crest_crosses_is_marked() {
        let (planes, links) = rough_maps();
        let turns = Turns::of([&planes[0], &planes[1], &planes[2]], &links);
        let mut marks = vec![0u8; 36];
        let (mut crossed, mut marked) = (0, 0);
        for y in 0..28 {
            turns.crest_cells(0.4)(y, &mut marks);
            for (x, mark) in marks.iter().enumerate() {
                let sides = crate::surface::form_lines::chains::sides(x, y, 37);
                let has_crest = sides.iter().any(|(a, b, _)| {
                    turns.crest(*a, *b, &links, 1.0).is_some_and(|crest| crest.most > 0.4)
                });
                assert!(*mark > 0 || !has_crest, "{x} {y}");
                (crossed, marked) = (crossed + usize::from(has_crest), marked + usize::from(*mark));
            }
        }
        assert!(crossed > 100 && marked < 28 * 36, "{crossed} {marked}");
    }
}
