//! Forms in order, the farthest first, as one surface: over, smooth union, add, cut. Floor 3. Order
//! gives depth; the part that is seen at a pixel is its object.

use super::Form;
use crate::math::{Range, Size, Vec3, parallel, vec3};
use crate::raster::Plane;
use crate::surface::{Maps, NearestCache, Surface, SurfaceError};
use rayon::prelude::*;
use std::collections::BTreeMap;

/// How a part joins what lies beneath it.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub enum Combine {
    /// In front of it, just far enough to hide it.
    #[default]
    Over,
    /// Merged with it, over so many px of height.
    Union {
        /// How widely the seam is rounded, px.
        smooth: f32,
    },
    /// Its height is added.
    Add,
    /// Its height is subtracted.
    Cut,
    /// In front of it, but level with it along the rim that lies on it.
    Join,
}

impl Combine {
    /// Every way with its name in documents; a union has a number, which `named!` cannot hold.
    pub const ALL: [(Combine, &'static str); 5] = [
        (Combine::Over, "over"),
        (Combine::Union { smooth: Combine::DEFAULT_SMOOTH }, "union"),
        (Combine::Add, "add"),
        (Combine::Cut, "cut"),
        (Combine::Join, "join"),
    ];
    /// px.
    pub const SMOOTH: Range = 0.0..=1024.0;
    /// How far a union is blended by default, px.
    pub const DEFAULT_SMOOTH: f32 = 8.0;

    /// Its name in documents.
    pub fn name(self) -> &'static str {
        let is_same =
            |(way, _): &&(Self, &str)| std::mem::discriminant(way) == std::mem::discriminant(&self);
        Self::ALL.iter().find(is_same).map_or("over", |(_, name)| name)
    }
}

/// What forms make together on a canvas.
#[derive(Clone, Debug, PartialEq)]
pub struct Relief {
    /// Toward the viewer, px.
    pub height: Plane<f32>,
    /// Unit, camera space (y up).
    pub normals: Plane<Vec3>,
    /// Where it is, one byte a pixel.
    pub coverage: Plane<u8>,
    /// Which part is seen, from 1 on; 0 where there is none.
    pub ids: Plane<u32>,
    /// For each part, the one whose piece of surface it belongs to: itself, or one that it is
    /// merged or level with.
    pub piece_of: Vec<u32>,
}

/// The least distance of a part before another, as a share of the canvas's longer side: enough for
/// a depth jump.
const GAP: f32 = 0.004;

impl Relief {
    /// One without a form.
    pub fn empty(size: Size) -> Self {
        Self {
            height: Plane::full(size, 0.0),
            normals: Plane::full(size, Vec3::Z),
            coverage: Plane::full(size, 0),
            ids: Plane::full(size, 0),
            piece_of: vec![0],
        }
    }

    /// With one more part in front; `id` from 1 on. Its share off the canvas is left out.
    pub fn add(&mut self, form: &Form, combine: Combine, id: u32) {
        // Nothing lies beneath the first part.
        let is_first = self.coverage.values().par_iter().all(|c| *c == 0);
        let piece = match combine {
            _ if is_first => None,
            Combine::Union { .. } | Combine::Join => {
                self.mostly_beneath(form).map(|other| self.piece(other))
            }
            Combine::Over | Combine::Add | Combine::Cut => None,
        };
        let known = self.piece_of.len() as u32;
        self.piece_of.extend(known..=id.max(known));
        self.piece_of[id as usize] = piece.unwrap_or(id);
        let offset = match combine {
            _ if is_first => 0.0,
            Combine::Over => self.offset(form),
            Combine::Join => self.level(form),
            Combine::Union { .. } | Combine::Add | Combine::Cut => 0.0,
        };
        let rect = form.rect().intersect(self.height.size().rect());
        if rect.is_empty() {
            return;
        }
        let width = self.height.width();
        let (first, last) = (rect.y0 as usize * width, rect.y1 as usize * width);
        let heights = self.height.values_mut()[first..last].chunks_mut(width);
        let normals = self.normals.values_mut()[first..last].chunks_mut(width);
        let coverages = self.coverage.values_mut()[first..last].chunks_mut(width);
        let ids = self.ids.values_mut()[first..last].chunks_mut(width);
        let rows = heights.zip(normals).zip(coverages).zip(ids).enumerate();
        parallel::for_each(rows, 1, |(row, (((heights, normals), covers), ids))| {
            let fy = (rect.y0 - form.corner.1) as usize + row;
            for x in rect.x0 as usize..rect.x1 as usize {
                let fx = (x as i32 - form.corner.0) as usize;
                let above = FormTexel {
                    height: form.height.at(fx, fy) + offset,
                    normal: form.normals.at(fx, fy),
                    coverage: form.coverage.at(fx, fy),
                    id,
                };
                let beneath = FormTexel {
                    height: heights[x],
                    normal: normals[x],
                    coverage: covers[x],
                    id: ids[x],
                };
                if above.coverage > 0 {
                    let met = beneath.combine_with(above, combine);
                    (heights[x], normals[x], covers[x], ids[x]) =
                        (met.height, met.normal, met.coverage, met.id);
                }
            }
        });
    }

    fn piece(&self, id: u32) -> u32 {
        self.piece_of.get(id as usize).copied().unwrap_or(id)
    }

    /// The part beneath most of a form.
    fn mostly_beneath(&self, form: &Form) -> Option<u32> {
        let mut counts = BTreeMap::new();
        for (_, _, (x, y)) in self.pairs(form, self.shared_rows(form)) {
            let at = (x as i32 + form.corner.0, y as i32 + form.corner.1);
            *counts.entry(self.ids.at(at.0 as usize, at.1 as usize)).or_insert(0u32) += 1;
        }
        counts
            .into_iter()
            .filter(|(id, _)| *id > 0)
            .max_by_key(|(_, count)| *count)
            .map(|(id, _)| id)
    }

    /// The rows of the canvas that a form reaches.
    fn shared_rows(&self, form: &Form) -> std::ops::Range<i32> {
        let rect = form.rect().intersect(self.height.size().rect());
        rect.y0..rect.y1.max(rect.y0)
    }

    /// Pairs of a form's covered pixels in some rows and those beneath them: heights, and the place
    /// in the form.
    fn pairs<'a>(
        &'a self,
        form: &'a Form,
        rows: std::ops::Range<i32>,
    ) -> impl Iterator<Item = (f32, f32, (usize, usize))> + 'a {
        let rect = form.rect().intersect(self.height.size().rect());
        rows.flat_map(move |y| {
            (rect.x0..rect.x1).filter_map(move |x| {
                let (fx, fy) = ((x - form.corner.0) as usize, (y - form.corner.1) as usize);
                let (x, y) = (x as usize, y as usize);
                // A barely covered pixel shows its neighbor.
                let both = form.coverage.at(fx, fy) >= 128 && self.coverage.at(x, y) >= 128;
                both.then(|| (self.height.at(x, y), form.height.at(fx, fy), (fx, fy)))
            })
        })
    }

    /// The greatest height of anything beneath above a form where they overlap or touch, plus a
    /// gap; 0 where they do not.
    fn offset(&self, form: &Form) -> f32 {
        let more = |a: Option<f32>, b: Option<f32>| a.zip(b).map(|(a, b)| a.max(b)).or(a).or(b);
        let of_row = |y: i32| {
            let overlaps = self.pairs(form, y..y + 1).map(|(beneath, own, _)| beneath - own);
            overlaps.chain(self.touching(form, y)).fold(None, |most, rise| more(most, Some(rise)))
        };
        let rise = self.shared_rows(form).into_par_iter().map(of_row).reduce(|| None, more);
        rise.map_or(0.0, |rise| (rise + GAP * self.height.size().longer_side()).max(0.0))
    }

    /// The height of what lies next to a form's rim in a row above that rim: flats of a drawing
    /// touch and do not overlap.
    fn touching<'a>(&'a self, form: &'a Form, y: i32) -> impl Iterator<Item = f32> + 'a {
        const FAR: i32 = 2;
        let own = |x: i32, y: i32| {
            form.coverage.get(x - form.corner.0, y - form.corner.1).unwrap_or(0) >= 128
        };
        let rect = form.rect().intersect(self.height.size().rect());
        let rim = (rect.x0..rect.x1).map(move |x| (x, y)).filter(move |&(x, y)| {
            own(x, y) && !(own(x - 1, y) && own(x + 1, y) && own(x, y - 1) && own(x, y + 1))
        });
        rim.flat_map(move |(x, y)| {
            let height = form.height.at((x - form.corner.0) as usize, (y - form.corner.1) as usize);
            let around =
                (-FAR..=FAR).flat_map(move |dy| (-FAR..=FAR).map(move |dx| (x + dx, y + dy)));
            let beside = around
                .filter(move |&(x, y)| !own(x, y) && self.coverage.get(x, y).unwrap_or(0) >= 128);
            beside.map(move |(x, y)| self.height.at(x as usize, y as usize) - height)
        })
    }

    /// What brings the rim of a form to the mean height of what lies beneath that rim.
    fn level(&self, form: &Form) -> f32 {
        let at_rim = |&(_, _, (x, y)): &(f32, f32, (usize, usize))| {
            let bare = |dx: i32, dy: i32| {
                form.coverage.get(x as i32 + dx, y as i32 + dy).is_none_or(|c| c < 128)
            };
            bare(1, 0) || bare(-1, 0) || bare(0, 1) || bare(0, -1)
        };
        let (sum, count) = self
            .pairs(form, self.shared_rows(form))
            .filter(at_rim)
            .fold((0.0f64, 0u32), |(sum, n), (beneath, own, _)| {
                (sum + f64::from(beneath - own), n + 1)
            });
        if count == 0 { 0.0 } else { (sum / f64::from(count)) as f32 }
    }

    /// The surface, whose objects are the parts: heights become depths, 0 near … 1 far over all
    /// that is covered.
    ///
    /// * `known`: from the previous surface, so that the same need not be found again.
    pub fn into_surface(self, known: &mut NearestCache) -> Result<Surface, SurfaceError> {
        let Self { height, normals, coverage, ids, piece_of } = self;
        let covered = height.values().par_iter().zip(coverage.values()).filter(|(_, c)| **c > 0);
        let wider = |(a, b): (f32, f32), (c, d): (f32, f32)| (a.min(c), b.max(d));
        let (low, high) = covered.map(|(z, _)| (*z, *z)).reduce(|| (f32::MAX, f32::MIN), wider);
        let range = if high > low { high - low } else { 1.0 };
        let depth = height
            .updated(|x, y, z| if coverage.at(x, y) == 0 { f32::NAN } else { (high - z) / range });
        Surface::with_parts(Maps { normals, depth, coverage }, ids, &piece_of, known)
    }
}

/// The surface at one pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
struct FormTexel {
    height: f32,
    normal: Vec3,
    coverage: u8,
    id: u32,
}

impl FormTexel {
    fn combine_with(self, above: FormTexel, combine: Combine) -> FormTexel {
        let both = 255 - (255 - u32::from(self.coverage)) * (255 - u32::from(above.coverage)) / 255;
        let coverage = both as u8;
        if self.coverage == 0 {
            // Nothing to add to or to cut from: the part alone; a hole has no shape.
            return if combine == Combine::Cut { self } else { above };
        }
        match combine {
            // Where a part covers less than half of a pixel, what lies beneath is seen.
            Combine::Over if above.coverage < 128 => FormTexel { coverage, ..self },
            Combine::Over => FormTexel { coverage, ..above },
            Combine::Join if above.coverage < 128 => FormTexel { coverage, ..self },
            Combine::Join => FormTexel { coverage, ..above },
            Combine::Union { smooth } => {
                let (height, share) = smooth_max(self.height, above.height, smooth);
                let id = if share < 0.5 { above.id } else { self.id };
                FormTexel {
                    height,
                    normal: mean_normal(self.normal, above.normal, share),
                    coverage,
                    id,
                }
            }
            Combine::Add => self.sum(above, 1.0),
            Combine::Cut => self.sum(above, -1.0),
        }
    }

    /// Heights and slopes added, the part's times `sign`.
    fn sum(self, above: FormTexel, sign: f32) -> FormTexel {
        let (a, b) = (self.normal, above.normal);
        // An added wall stays steep, but not so steep that nothing else is seen.
        let (az, bz) = (a.z.max(0.02), b.z.max(0.02));
        let normal = vec3(a.x * bz + sign * b.x * az, a.y * bz + sign * b.y * az, az * bz)
            .normalize_or(Vec3::Z);
        FormTexel { height: self.height + sign * above.height, normal, ..self }
    }
}

/// The greater of two heights with its edge rounded, and the first one's share of the slope.
///
/// max(a, b) + k/4 · h² with h = max(k − |a − b|, 0)/k.
pub fn smooth_max(a: f32, b: f32, smooth: f32) -> (f32, f32) {
    if smooth <= 0.0 {
        return (a.max(b), if a >= b { 1.0 } else { 0.0 });
    }
    let h = (smooth - (a - b).abs()).max(0.0) / smooth;
    let share = (0.5 + (a - b) / (2.0 * smooth)).max(0.0).min(1.0);
    (a.max(b) + 0.25 * smooth * h * h, share)
}

/// The normal whose slope is the mean of two, weighted by the first one's share.
fn mean_normal(a: Vec3, b: Vec3, share: f32) -> Vec3 {
    let (wa, wb) = (share * b.z, (1.0 - share) * a.z);
    if share >= 1.0 {
        return a;
    }
    if share <= 0.0 {
        return b;
    }
    vec3(a.x * wa + b.x * wb, a.y * wa + b.y * wb, a.z * b.z).normalize_or(if share > 0.5 {
        a
    } else {
        b
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Vec2, vec2};
    use crate::shape::primitive::{Body, Primitive};

    fn ball(center: Vec2, radius: f32) -> Form {
        Primitive::new(Body::Sphere, center, radius).form(1 << 20).unwrap()
    }
    const SIZE: Size = Size::new(200, 120);

    #[test]
    fn order_gives_depth_and_every_part_is_an_object() {
        let mut relief = Relief::empty(SIZE);
        let (back, front) = (ball(vec2(80.0, 60.0), 50.0), ball(vec2(120.0, 60.0), 30.0));
        relief.add(&back, Combine::Over, 1);
        relief.add(&front, Combine::Over, 2);
        assert_eq!((relief.ids.at(60, 60), relief.ids.at(120, 60), relief.ids.at(0, 0)), (1, 2, 0));
        // No point of the front part lies behind what it covers.
        let mut alone = Relief::empty(SIZE);
        alone.add(&back, Combine::Over, 1);
        for (x, y) in (0..120).flat_map(|y| (0..200).map(move |x| (x, y))) {
            if relief.ids.at(x, y) == 2 && alone.ids.at(x, y) == 1 && alone.coverage.at(x, y) >= 128
            {
                assert!(relief.height.at(x, y) > alone.height.at(x, y), "({x}, {y})");
            }
        }
        let surface = relief.into_surface(&mut NearestCache::default()).unwrap();
        assert_eq!(surface.objects().count(), 2);
        let object = |x, y| surface.objects().at(x, y);
        assert_ne!(object(60, 60), object(120, 60));
        assert_eq!(object(60, 60), object(80, 20));
    }

    #[test]
    fn a_part_beside_the_others_keeps_its_height_and_one_off_the_canvas_adds_nothing() {
        let mut relief = Relief::empty(SIZE);
        relief.add(&ball(vec2(30.0, 60.0), 20.0), Combine::Over, 1);
        relief.add(&ball(vec2(150.0, 60.0), 20.0), Combine::Over, 2);
        assert!((relief.height.at(150, 60) - 20.0).abs() < 0.1);
        let before = relief.clone();
        relief.add(&ball(vec2(-400.0, 900.0), 20.0), Combine::Over, 3);
        assert!(
            relief.height == before.height
                && relief.ids == before.ids
                && relief.coverage == before.coverage
        );
        // Half of it is on the canvas.
        relief.add(&ball(vec2(0.0, 0.0), 20.0), Combine::Over, 4);
        assert_eq!(relief.ids.at(0, 0), 4);
    }

    #[test]
    fn a_smooth_union_is_smooth_and_never_below_either() {
        for i in 0..100 {
            let (a, b) = (i as f32 * 0.3, 12.0);
            let (top, share) = smooth_max(a, b, 8.0);
            assert!(top >= a.max(b) && top <= a.max(b) + 2.0 + 1e-6);
            let slope = (smooth_max(a + 0.01, b, 8.0).0 - smooth_max(a - 0.01, b, 8.0).0) / 0.02;
            assert!((slope - share).abs() < 0.02, "{slope} and not {share} at {a}");
        }
        assert_eq!(smooth_max(3.0, 5.0, 0.0), (5.0, 0.0));
    }

    #[test]
    fn what_is_added_and_cut_changes_heights_and_leaves_the_object() {
        let mut relief = Relief::empty(SIZE);
        relief.add(&ball(vec2(80.0, 60.0), 50.0), Combine::Over, 1);
        let before = relief.height.at(80, 60);
        relief.add(&ball(vec2(80.0, 60.0), 10.0), Combine::Add, 2);
        assert!((relief.height.at(80, 60) - before - 10.0).abs() < 0.1);
        relief.add(&ball(vec2(80.0, 60.0), 10.0), Combine::Cut, 3);
        assert!((relief.height.at(80, 60) - before).abs() < 0.1);
        assert_eq!(relief.ids.at(80, 60), 1);
        let covered = relief.coverage.clone();
        relief.add(&ball(vec2(180.0, 20.0), 10.0), Combine::Cut, 4);
        assert_eq!(relief.coverage, covered, "nothing is cut out of nothing");
    }
}
