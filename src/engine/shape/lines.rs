//! Lines as form: ink marks where a form turns (Johnston 2002, Lumo), as a ridge, a valley, or a
//! silhouette over or under what is next to it. Floor 3. No height is held at a line: an open line
//! pinned to a height would be a dent. Normals are held next to the line and spread over the form;
//! nothing spreads across the ink, so that the front does not pull the back along.

use super::touches::{spread_within, unproject_normal, with_normals};
use super::{Form, Outline, OutlineRim};
use crate::math::{Range, Vec2, vec2};
use crate::raster::Plane;

crate::named! {
    /// What a line means.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
    pub enum LineForm {
        /// The form falls away on both sides.
        #[default]
        Ridge = "ridge",
        /// The form rises on both sides.
        Valley = "valley",
        /// A silhouette: the form on the inner side of the line's bend turns away at it, in front
        /// of what lies on the outer one.
        Over = "over",
        /// The same for the form on the outer side.
        Under = "under",
    }
}

impl LineForm {}

/// How ink shapes a form.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lines {
    /// What the ink stands for.
    pub form: LineForm,
    /// Degrees that the form turns next to the line.
    pub angle_deg: f32,
    /// How far it reaches, px; 0: to the rim and the next lines.
    pub reach: f32,
}

impl Lines {
    /// Degrees that the form may turn.
    pub const ANGLE: Range = 1.0..=90.0;
    /// What a reach may be, px.
    pub const REACH: Range = 0.0..=16384.0;
}

impl Default for Lines {
    fn default() -> Self {
        Self { form: LineForm::default(), angle_deg: 45.0, reach: 0.0 }
    }
}

/// A pixel counts as ink from this coverage on.
const INKED: u8 = 128;
/// Half the side of the square in which a line's bend is measured, px, and at least this many line
/// widths.
const BEND_PX: i32 = 10;
const BEND_WIDTHS: i32 = 3;
/// A line whose ink lies no farther than this to its side is straight, px.
const STRAIGHT_PX: f32 = 0.1;
/// The widest line that is crossed, px.
const WIDEST_PX: i32 = 64;

/// A form with ink as lines of its shape.
///
/// * `ink`: coverage over the planes of the form.
pub fn add_lines(form: &Form, outline: &Outline, ink: &Plane<u8>, lines: Lines) -> Form {
    let inside = outline.inside_pixels();
    let size = inside.size();
    if form.normals.size() != size || ink.size() != size {
        return form.clone();
    }
    let inked = Plane::from_fn(size, |x, y| inside.at(x, y) && ink.at(x, y) >= INKED);
    if !inked.values().contains(&true) {
        return form.clone();
    }
    let bar = form.normals.map(|n| vec2(n.x, -n.y));
    let sums = InkSums::of(&inked);
    let turn =
        lines.angle_deg.max(*Lines::ANGLE.start()).min(*Lines::ANGLE.end()).to_radians().sin();
    let is_beside = |x: usize, y: usize| {
        let at = |dx: i32, dy: i32| inked.get(x as i32 + dx, y as i32 + dy).unwrap_or(false);
        inside.at(x, y) && !inked.at(x, y) && (at(1, 0) || at(-1, 0) || at(0, 1) || at(0, -1))
    };
    // n̄ next to the line; none where nothing is requested.
    let asked = Plane::from_fn(size, |x, y| {
        let away =
            is_beside(x, y).then(|| sums.direction_from_ink(x as i32, y as i32)).flatten()?;
        let inner = || sums.is_inner(&inked, (x as i32, y as i32), away);
        match lines.form {
            LineForm::Ridge => Some(away * turn),
            LineForm::Valley => Some(-away * turn),
            LineForm::Over => inner().then_some(-away * turn),
            LineForm::Under => (!inner()).then_some(-away * turn),
        }
    });
    let held = asked.map(|asked| asked.is_some());
    let wanted = Plane::from_fn(size, |x, y| {
        asked.at(x, y).map_or(Vec2::ZERO, |asked| asked - bar.at(x, y))
    });
    let cut = outline.without(&inked);
    let reach = if lines.reach > 0.0 { lines.reach } else { f32::INFINITY };
    let delta = filled(
        spread_within(&OutlineRim::with_joined_pixels(&cut, &inked), &held, &wanted, reach),
        &inked,
        inside,
    );
    let normals = Plane::from_fn(size, |x, y| {
        let n = form.normals.at(x, y);
        if inside.at(x, y) { unproject_normal(bar.at(x, y) + delta.at(x, y)) } else { n }
    });
    with_normals(form, outline, normals)
}

/// A field that is unknown at some pixels inside, filled there from their neighbors, ring by ring.
pub fn filled(mut field: Plane<Vec2>, inked: &Plane<bool>, inside: &Plane<bool>) -> Plane<Vec2> {
    let mut known_pixels = Plane::from_fn(inside.size(), |x, y| inside.at(x, y) && !inked.at(x, y));
    let mut left: Vec<(usize, usize)> = Vec::new();
    for y in 0..inked.height() {
        left.extend((0..inked.width()).filter(|x| inked.at(*x, y)).map(|x| (x, y)));
    }
    while !left.is_empty() {
        let mean = |&(x, y): &(usize, usize)| {
            let around =
                (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (x as i32 + dx, y as i32 + dy)));
            let known = around.filter(|(x, y)| known_pixels.get(*x, *y).unwrap_or(false));
            let (sum, count) = known.fold((Vec2::ZERO, 0u32), |(sum, count), (x, y)| {
                (sum + field.at(x as usize, y as usize), count + 1)
            });
            (count > 0).then(|| sum / count as f32)
        };
        let ring: Vec<((usize, usize), Vec2)> =
            left.iter().filter_map(|at| Some((*at, mean(at)?))).collect();
        if ring.is_empty() {
            break;
        }
        for ((x, y), mean) in ring {
            field.set(x, y, mean);
            known_pixels.set(x, y, true);
        }
        left.retain(|(x, y)| !known_pixels.at(*x, *y));
    }
    field
}

/// How much ink any square holds, and where.
struct InkSums {
    /// The number of pixels, and the sums of their columns and rows, above and left of a corner.
    sums: Vec<[u64; 3]>,
    width: i32,
    height: i32,
}

impl InkSums {
    fn of(inked: &Plane<bool>) -> Self {
        let (w, h) = (inked.width(), inked.height());
        let mut sums = vec![[0u64; 3]; (w + 1) * (h + 1)];
        for y in 0..h {
            let mut row = [0u64; 3];
            for x in 0..w {
                if inked.at(x, y) {
                    row = [row[0] + 1, row[1] + x as u64, row[2] + y as u64];
                }
                let above = sums[y * (w + 1) + x + 1];
                sums[(y + 1) * (w + 1) + x + 1] = std::array::from_fn(|c| above[c] + row[c]);
            }
        }
        Self { sums, width: w as i32, height: h as i32 }
    }

    /// The number of inked pixels in a square around a pixel, and the sums of their columns and
    /// rows.
    fn sums_in_square(&self, x: i32, y: i32, reach: i32) -> [f64; 3] {
        let column = |x: i32| x.max(0).min(self.width) as usize;
        let row = |y: i32| y.max(0).min(self.height) as usize * (self.width as usize + 1);
        let at = |x: i32, y: i32| self.sums[row(y) + column(x)];
        let (x0, x1, y0, y1) = (x - reach, x + reach + 1, y - reach, y + reach + 1);
        let (a, b, c, d) = (at(x1, y1), at(x0, y0), at(x0, y1), at(x1, y0));
        std::array::from_fn(|k| (a[k] + b[k] - c[k] - d[k]) as f64)
    }

    /// The direction from the ink to a pixel next to it, unit.
    fn direction_from_ink(&self, x: i32, y: i32) -> Option<Vec2> {
        const REACH: i32 = 2;
        let side = |dx: i32, dy: i32| self.sums_in_square(x + dx, y + dy, REACH)[0] as f32;
        vec2(side(-1, 0) - side(1, 0), side(0, -1) - side(0, 1)).try_normalize()
    }

    /// Whether a pixel lies on the inner side of the bend of the line next to it, where the middle
    /// of the ink around lies. For a straight line: the side below it, or on its right.
    fn is_inner(&self, inked: &Plane<bool>, (x, y): (i32, i32), away: Vec2) -> bool {
        let here = vec2(x as f32, y as f32);
        let is_inked = |k: i32| {
            let p = (here - away * k as f32).round();
            inked.get(p.x as i32, p.y as i32).unwrap_or(false)
        };
        let width = (1..WIDEST_PX).take_while(|k| is_inked(*k)).count() as i32;
        let line = here - away * (0.5 * (width + 1) as f32);
        let reach = BEND_PX.max(BEND_WIDTHS * width);
        let [count, columns, rows] =
            self.sums_in_square(line.x.round() as i32, line.y.round() as i32, reach);
        if count < 1.0 {
            return false;
        }
        let middle = vec2((columns / count) as f32, (rows / count) as f32);
        let toward = (middle - line).dot(away);
        if toward.abs() > STRAIGHT_PX {
            toward > 0.0
        } else {
            away.y > 0.5 || away.y > -0.5 && away.x > 0.0
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Size;
    use crate::math::Vec3;

    const SIZE: Size = Size::new(120, 90);

    /// A plate that faces the viewer.
    fn plate() -> (Form, Outline) {
        let coverage = Plane::from_fn(SIZE, |x, y| {
            if (10..110).contains(&x) && (10..80).contains(&y) { 255 } else { 0 }
        });
        let outline = Outline::new((0, 0), &coverage).unwrap();
        let form = Form {
            corner: outline.corner(),
            height: Plane::full(outline.size(), 0.0).into(),
            normals: Plane::full(outline.size(), Vec3::Z).into(),
            coverage: outline.coverage().clone(),
        };
        (form, outline)
    }

    /// Ink over the planes of the outline, given in px of the canvas.
    fn ink(outline: &Outline, is_inked: impl Fn(f32, f32) -> bool + Sync) -> Plane<u8> {
        let (x0, y0) = outline.corner();
        Plane::from_fn(outline.size(), |x, y| {
            let (x, y) = ((x as i32 + x0) as f32 + 0.5, (y as i32 + y0) as f32 + 0.5);
            if is_inked(x, y) { 255 } else { 0 }
        })
    }

    fn at(form: &Form, x: i32, y: i32) -> (f32, Vec3) {
        let (x, y) = ((x - form.corner.0) as usize, (y - form.corner.1) as usize);
        (form.height.at(x, y), form.normals.at(x, y))
    }

    /// Upright, 2 px wide, open at both ends.
    fn upright(x: f32, y: f32) -> bool {
        (x - 60.0).abs() < 1.0 && (30.0..60.0).contains(&y)
    }

    #[test]
    fn a_ridge_falls_away_on_both_sides_and_a_valley_rises() {
        let (form, outline) = plate();
        let ink = ink(&outline, upright);
        for (kind, sign) in [(LineForm::Ridge, 1.0), (LineForm::Valley, -1.0)] {
            let lines = Lines { form: kind, angle_deg: 40.0, reach: 0.0 };
            let lined = add_lines(&form, &outline, &ink, lines);
            let ((_, left), (_, right)) = (at(&lined, 57, 45), at(&lined, 62, 45));
            assert!(
                (right.x * sign - 40.0f32.to_radians().sin()).abs() < 0.12,
                "{kind:?}: {right}"
            );
            assert!((left.x * sign + 40.0f32.to_radians().sin()).abs() < 0.12, "{kind:?}: {left}");
            let rise = at(&lined, 60, 45).0 - at(&lined, 80, 45).0;
            assert!(rise * sign > 1.0, "{kind:?} rises by {rise}");
        }
    }

    #[test]
    fn over_a_silhouette_only_the_front_turns_and_the_back_stays() {
        let (form, outline) = plate();
        // A bend around (45, 45): its inner side is the left one.
        let bend = |x: f32, y: f32| ((x - 45.0).hypot(y - 45.0) - 20.0).abs() < 1.0 && x > 50.0;
        let ink = ink(&outline, bend);
        let lines = |form| Lines { form, angle_deg: 70.0, reach: 0.0 };
        let over = add_lines(&form, &outline, &ink, lines(LineForm::Over));
        let (front, back) = (at(&over, 62, 45).1, at(&over, 69, 45).1);
        assert!(front.x > 0.75, "the front turns to the line: {front}");
        assert!(back.x.abs() < 0.25 * front.x, "the back is not drawn along: {back}");
        let under = add_lines(&form, &outline, &ink, lines(LineForm::Under));
        assert!(at(&under, 67, 45).1.x < -0.75 && at(&under, 62, 45).1.x > -0.2);
    }

    #[test]
    fn an_open_line_makes_no_dent_and_one_without_ink_changes_nothing() {
        let (form, outline) = plate();
        let none = Plane::full(outline.size(), 0);
        assert!(add_lines(&form, &outline, &none, Lines::default()) == form);
        let ridge = add_lines(
            &form,
            &outline,
            &ink(&outline, upright),
            Lines { reach: 12.0, ..Lines::default() },
        );
        // Above the upper end the form continues evenly, and far away it is unchanged.
        let heights: Vec<f32> = (14..29).map(|y| at(&ridge, 60, y).0).collect();
        assert!(heights.windows(2).all(|pair| pair[1] >= pair[0] - 0.05), "{heights:?}");
        assert!(at(&ridge, 100, 20).1.z > 0.99);
        let all = ridge.normals.values().iter();
        assert!(all.into_iter().all(|n| n.is_finite() && (n.length() - 1.0).abs() < 1e-4));
    }

    #[test]
    fn any_ink_gives_unit_normals() {
        let (form, outline) = plate();
        for seed in 0..20u32 {
            let noise = |x: f32, y: f32| {
                crate::math::hash::unit(seed, x as u32, y as u32) < 0.04 * seed as f32
            };
            for (kind, _) in LineForm::ALL {
                let lines =
                    Lines { form: kind, angle_deg: 90.0, reach: f32::from(seed as u8 % 3) * 5.0 };
                let lined = add_lines(&form, &outline, &ink(&outline, noise), lines);
                let all = lined.normals.values().iter();
                assert!(all.into_iter().all(|n| n.is_finite() && (n.length() - 1.0).abs() < 1e-4));
                assert!(lined.height.values().iter().all(|z| z.is_finite()));
            }
        }
    }
}
