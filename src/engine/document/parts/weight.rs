//! How much memory it takes to make the surface of parts, estimated before it begins. Floor 4. An
//! upper bound. Not here: how much memory there is (floors above).

use super::unchanged::split_whole_px;
use super::{OutlineSource, Part, PartKind};
use crate::document::{Content, Document};
use crate::math::{Affine2, Rect, Size, Vec2, vec2};
use crate::memory::{FORMS, room_for};
use crate::shape::inflate;
use std::sync::Arc;

/// Heights, normals, coverage and parts of all forms together, bytes a pixel of the canvas.
const RELIEF_BYTES: u64 = 21;
/// The surface while it is made of these.
const SURFACE_BYTES: u64 = 60;
/// Heights, normals and coverage of a form, bytes a pixel of its box.
const FORM_BYTES: u64 = 17;
/// Coverage of an outline, and what is inside.
const OUTLINE_BYTES: u64 = 2;
/// What flats are found through, bytes a pixel of their picture; and what each thread finds an
/// outline through.
const FLATS_BYTES: u64 = 64;
const SOUGHT_BYTES: u64 = 8;

/// The equation of a pillow on its grids, and the vectors of its search.
const PILLOW_BYTES: u64 = 90;
/// A pillow that fills so many pixels is found at half their resolution, if nothing in front frees
/// its rim.
const HALVED_PX: u64 = inflate::MOST_UNKNOWNS as u64;
const HALVED_BYTES: u64 = 50;

/// What a kind of part is made through, bytes a pixel of its box.
fn making_bytes(kind: &PartKind) -> u64 {
    match kind {
        PartKind::Inflate { inflation, .. } if inflation.profile <= 0.0 => PILLOW_BYTES,
        PartKind::Inflate { .. } => 130,
        PartKind::Bevel { .. } => 70,
        PartKind::Primitive(_) | PartKind::Lathe { .. } | PartKind::Sweep { .. } => 45,
        PartKind::Profiles { shadings, .. } => 180 + 4 * shadings.len() as u64,
        PartKind::Maps(_) => 60,
        PartKind::Touches { .. } | PartKind::Lines { .. } => 260,
        PartKind::Relief { .. } => 90,
        PartKind::Sculpt { .. } => 30,
    }
}

/// The sides of a box, px.
type Sides = [f64; 2];

fn sides(rect: Rect) -> Sides {
    [rect.width() as f64, rect.height() as f64]
}

fn sides_of(size: Size) -> Sides {
    [f64::from(size.width), f64::from(size.height)]
}

/// The box around some points, each with so much around it.
fn bound_points(points: impl Iterator<Item = (Vec2, f32)>) -> Sides {
    let (mut low, mut high) = (Vec2::INFINITY, Vec2::NEG_INFINITY);
    for (p, reach) in points {
        (low, high) = (low.min(p - reach), high.max(p + reach));
    }
    let side = |v: f32| f64::from(v.max(0.0)) + 1.0;
    [side(high.x - low.x), side(high.y - low.y)]
}

/// The box around a box that is seen through a map.
fn transformed_sides(map: Affine2, [w, h]: Sides) -> Sides {
    let [a, b, c, d] = map.matrix2.to_cols_array().map(|v| f64::from(v.abs()));
    [a * w + c * h, b * w + d * h]
}

impl Document {
    /// What making the surface of some parts is called where memory is asked for it.
    pub fn shape_work(&self, list: &[Arc<Part>]) -> String {
        let parts = if list.len() == 1 { "1 part".into() } else { format!("{} parts", list.len()) };
        format!("the shape of {parts} on {} pixels", self.size)
    }

    /// Whether as much memory is free as making its surface takes: a sentence without its full stop
    /// if not. Nothing is asked for where it is made already.
    ///
    /// * `free`: how many bytes there are.
    pub fn shape_fits_in(&self, free: u64) -> Result<(), String> {
        if self.has_its_surface() {
            return Ok(());
        }
        let list = &self.parts.list;
        room_for(&self.shape_work(list), self.shape_bytes(list), free)
    }

    /// Bytes that making the surface of some parts takes at most, what is kept of them included;
    /// the layers and maps that they are made of are the document's.
    pub fn shape_bytes(&self, list: &[Arc<Part>]) -> u64 {
        let canvas = self.size.area() as u64;
        let shown = || list.iter().filter(|part| part.visible && part.on().is_none());
        let (mut outlines, mut most, mut forms, mut flats) = (0u64, 0u64, 0u64, 0u64);
        let nearest = shown().rfind(|part| part.outline().is_some()).map(|part| &part.id);
        for part in shown() {
            let px = self.box_px(part);
            let making = match making_bytes(&part.kind) {
                PILLOW_BYTES if px > HALVED_PX && nearest == Some(&part.id) => HALVED_BYTES,
                bytes => bytes,
            };
            let modifiers =
                list.iter().filter(|other| other.visible && other.on() == Some(part.id.as_str()));
            let modifiers = modifiers
                .map(|other| making_bytes(&other.kind) + 2 * FORM_BYTES)
                .max()
                .unwrap_or(0);
            most = most.max(px * (FORM_BYTES + making.max(modifiers)));
            forms = forms.saturating_add(px * 2 * FORM_BYTES);
            if let Some(source) = part.outline() {
                outlines = outlines.saturating_add(px * OUTLINE_BYTES);
                let sought =
                    self.outline_sides(source).map_or(0, |sides| self.bytes_within_reach(sides));
                let threads = rayon::current_num_threads() as u64;
                let of_flats = matches!(source, OutlineSource::Layer { color: Some(_), .. });
                flats = flats.max(
                    sought * (SOUGHT_BYTES * threads + if of_flats { FLATS_BYTES } else { 0 }),
                );
            }
        }
        if shown().next().is_none() {
            return 0;
        }
        let maps = if self.maps_surface().is_some() { canvas * FORM_BYTES } else { 0 };
        let made = (canvas * RELIEF_BYTES + most.max(maps)).max(canvas * SURFACE_BYTES);
        outlines.saturating_add(flats.max(made)).saturating_add(forms.min(FORMS.room()))
    }

    /// Pixels of the box around a part, 0 if it is so large that none is made of it.
    fn box_px(&self, part: &Part) -> u64 {
        let own = match &part.kind {
            PartKind::Primitive(body) => {
                Some(bound_points([(body.center, body.reach() + 2.0)].into_iter()))
            }
            PartKind::Sweep { balls, .. } => {
                Some(bound_points(balls.iter().map(|ball| (ball.at, ball.radius + 2.0))))
            }
            PartKind::Maps(_) => Some(sides_of(self.size)),
            PartKind::Profiles { outline: None, shadings } => {
                shadings.first().map(|shading| sides_of(shading.picture.coverage.size()))
            }
            _ => part.outline().and_then(|source| self.outline_sides(source)),
        };
        own.map_or(0, |sides| {
            self.bytes_within_reach(transformed_sides(split_whole_px(part.matrix).0, sides))
        })
    }

    fn bytes_within_reach(&self, [w, h]: Sides) -> u64 {
        let px = (w + 3.0) * (h + 3.0);
        // Rounded up where it is made.
        if px <= 1.1 * self.most_px() as f64 { px as u64 } else { 0 }
    }

    /// The sides of the box around what an outline is found in.
    fn outline_sides(&self, source: &OutlineSource) -> Option<Sides> {
        let canvas = sides_of(self.size);
        Some(match source {
            OutlineSource::Layer { layer, .. } => {
                let layer = self.layer_named(layer)?;
                match &layer.content {
                    Content::Pixels(pixels) if !layer.is_warped() => {
                        let map = self.map_of(layer.id)?.plane;
                        let Rect { x0, y0, x1, y1 } = pixels.tiles.bounds();
                        let corner = |x: i32, y: i32| {
                            map.to_canvas(vec2(x as f32, y as f32)).map(|p| (p, 2.0))
                        };
                        let corners =
                            [corner(x0, y0), corner(x1, y0), corner(x1, y1), corner(x0, y1)];
                        match corners.into_iter().collect::<Option<Vec<_>>>() {
                            Some(corners) => bound_points(corners.into_iter()),
                            None => canvas,
                        }
                    }
                    // Tiles are whole.
                    _ => canvas.map(|side| side + 64.0),
                }
            }
            OutlineSource::File(file) => sides_of(file.coverage.size()),
            OutlineSource::Selection(name) => {
                let kept = &self.selections.iter().find(|kept| kept.name == *name)?.selection;
                if kept.made.is_some() { canvas } else { sides(kept.coverage.covered_rect()) }
            }
            OutlineSource::Path(points) => bound_points(points.iter().map(|p| (*p, 1.0))),
            OutlineSource::Object(_) => canvas,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::{Body, Primitive};

    #[test]
    fn a_part_weighs_by_its_box_and_those_that_are_never_made_nothing() {
        let document = Document::empty(Size::new(1000, 800));
        let ball = |radius: f32, matrix: Affine2| {
            let body =
                PartKind::Primitive(Primitive::new(Body::Sphere, vec2(300.0, 300.0), radius));
            Arc::new(Part { matrix, ..Part::new(format!("{radius}"), body) })
        };
        let weight = |list: &[Arc<Part>]| document.shape_bytes(list);
        let still = Affine2::IDENTITY;
        assert_eq!(weight(&[]), 0);
        let small = weight(&[ball(10.0, still)]);
        assert_eq!(small, 800_000 * SURFACE_BYTES + 28 * 28 * 2 * FORM_BYTES);
        let large = weight(&[ball(390.0, still)]);
        assert!(large > small + 15_000_000, "{large}");
        // The largest alone is being made; the others are kept as far as they may be.
        let both = weight(&[ball(390.0, still), ball(10.0, still)]);
        assert_eq!(both - large, 28 * 28 * 2 * FORM_BYTES);
        let turned = weight(&[ball(390.0, Affine2::from_angle(0.7))]);
        assert!(turned > large, "{turned}");
        assert_eq!(weight(&[ball(8000.0, still)]), 800_000 * SURFACE_BYTES, "beyond what is made");
    }
}
