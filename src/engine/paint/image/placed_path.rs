//! Paths as pictures on the canvas: unless they were moved, their points are canvas points. Floor 3.

use super::{PictureOrigin, PictureSource, PlacedImage, Placement};
use crate::math::{Affine2, PlaneMap, Rect, Size, Vec2, vec2};
use crate::paint::adjust::Adjust;
use crate::paint::path::LivePath;
use crate::surface::{Anchor, Bend};
use std::sync::Arc;

/// A difference of maps that nobody sees, px over the picture.
const SAME_PX: f32 = 1e-3;

/// A difference of sides that no outline shows, as a share.
const SAME_ASPECT: f32 = 1e-4;

impl PictureSource {
    /// The picture of a path, which [`LivePath::fits`].
    pub fn of_path(path: LivePath, adjust: Adjust) -> Self {
        let picture = path.picture();
        let origin = PictureOrigin::Path(Arc::new(path));
        Self { origin, ..Self::new(String::new(), picture, adjust) }
    }

    /// Where the points of a path are canvas points.
    pub(super) fn path_placement(&self, canvas: Size, path: &LivePath) -> Placement {
        Placement::at_own_size(canvas, &self.picture, middle(path.bounds()))
    }
}

impl PlacedImage {
    /// A path whose points are canvas points, pinned at its middle in case that it is bent.
    pub fn of_path(canvas: Size, path: LivePath) -> Self {
        let source = PictureSource::of_path(path, Adjust::default());
        let (placement, outside) = (source.default_placement(canvas), source.default_outside());
        let bend = Bend { anchors: vec![Anchor::pin(placement.center)], ..Bend::default() };
        Self { outside, bend, ..Self::new(source, placement) }
    }

    /// From the plane of a path to the frame; `None` for what is no path.
    pub fn frame_from_path(&self, canvas: Size) -> Option<Affine2> {
        let bounds = self.source.path()?.bounds();
        let corner = vec2(bounds.x0 as f32, bounds.y0 as f32);
        Some(self.frame_from_own(canvas) * Affine2::from_translation(-corner))
    }

    /// The point of the canvas that shows a point of the path's plane, before it is bent; `None` for
    /// what is no path, and beyond a horizon.
    pub fn canvas_from_path(&self, canvas: Size, point: Vec2) -> Option<Vec2> {
        self.frame.to_canvas(self.frame_from_path(canvas)?.transform_point2(point))
    }

    /// The other way.
    pub fn path_from_canvas(&self, canvas: Size, point: Vec2) -> Option<Vec2> {
        let (in_frame, _) = self.frame.from_canvas(point)?;
        Some(self.frame_from_path(canvas)?.inverse().transform_point2(in_frame))
    }

    /// Its path with the points, the outline and the dashes that it has on the canvas; `None` for
    /// what is no path, and where no path looks like it: bent, blurred or seen in perspective, or
    /// stretched with an outline.
    pub fn path_on_canvas(&self, canvas: Size) -> Option<LivePath> {
        let path = self.source.path()?;
        let is_plain = self.bend.operator.is_identity() && self.source.adjust == Adjust::default();
        if !is_plain {
            return None;
        }
        if self.frame == PlaneMap::IDENTITY && self.is_unmoved(canvas) {
            return Some(LivePath::clone(path));
        }
        let map = self.frame.as_affine()? * self.frame_from_path(canvas)?;
        let ([x, y], scale) = (map.matrix2.to_cols_array_2d(), map.matrix2.determinant());
        let (x, y, scale) = (Vec2::from(x), Vec2::from(y), scale.abs().sqrt());
        let is_stretched = (x.length() - y.length()).abs() > SAME_ASPECT * scale
            || x.dot(y).abs() > SAME_ASPECT * scale * scale;
        if is_stretched && path.outline > 0.0 {
            return None;
        }
        let lines = path.subpaths();
        let lines = lines.iter().map(|line| line.mapped(|p| map.transform_point2(p))).collect();
        Some(LivePath {
            outline: path.outline * scale,
            dashes: path.dashes.iter().map(|dash| dash * scale).collect(),
            ..path.with_lines(lines)
        })
    }

    /// Another path in the same plane, placed and bent as this one is; `None` for what is no path.
    pub fn with_path(&self, canvas: Size, path: LivePath) -> Option<Self> {
        let to_frame = self.frame_from_path(canvas)?;
        let bounds = path.bounds();
        let source = PictureSource::of_path(path, self.source.adjust);
        let by_itself = source.default_placement(canvas);
        let placement = match self.is_unmoved(canvas) {
            true => by_itself,
            false => {
                let enlarged = to_frame.matrix2.x_axis.length();
                let scale = by_itself.scale * enlarged;
                let scale = scale.max(*Placement::SCALE.start()).min(*Placement::SCALE.end());
                let center = to_frame.transform_point2(middle(bounds));
                Placement { center, scale, rotation: self.placement.rotation }
            }
        };
        let mut next = Self { source, placement, ..self.clone() };
        // An anchor that only says that the middle is pinned goes along.
        if let [anchor] = &mut next.bend.anchors[..]
            && *anchor == Anchor::pin(self.placement.center)
        {
            *anchor = Anchor::pin(placement.center);
        }
        Some(next)
    }

    /// Whether the points of its path are points of its frame.
    fn is_unmoved(&self, canvas: Size) -> bool {
        self.frame_from_path(canvas).is_some_and(|map| {
            let size = self.source.picture.own_size().max_element();
            let turned = map.matrix2 - crate::math::Mat2::IDENTITY;
            let linear = turned.x_axis.length().max(turned.y_axis.length()) * size;
            linear < SAME_PX && map.translation.length() < SAME_PX.max(1e-6 * size)
        })
    }
}

fn middle(bounds: Rect) -> Vec2 {
    vec2((bounds.x0 + bounds.x1) as f32, (bounds.y0 + bounds.y1) as f32) * 0.5
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::srgb::Color;
    use crate::paint::Scene;
    use crate::paint::path::{Figure, FigureKind};
    use crate::raster::TileAt;

    const CANVAS: Size = Size::new(64, 48);

    fn star() -> LivePath {
        let (from, to) = (vec2(10.0, 8.0), vec2(50.0, 40.0));
        let figure = Figure { kind: FigureKind::Star, from, to, ..Figure::DEFAULT };
        LivePath::new(figure).with_fill(Color::BLACK)
    }

    #[test]
    fn points_of_a_path_are_canvas_points_until_it_is_moved() {
        let image = PlacedImage::of_path(CANVAS, star());
        let map = image.frame_from_path(CANVAS).unwrap();
        let p = vec2(17.0, 21.0);
        assert!(map.transform_point2(p).distance(p) < 1e-4);
        assert!(image.is_unmoved(CANVAS));
        let turned = Placement { rotation: 30.0, ..image.placement };
        assert!(!PlacedImage { placement: turned, ..image }.is_unmoved(CANVAS));
    }

    #[test]
    fn another_path_lies_where_the_plane_of_the_first_one_lay() {
        let image = PlacedImage::of_path(CANVAS, star());
        let moved = Placement {
            center: vec2(30.0, 12.0),
            scale: image.placement.scale * 0.7,
            rotation: 25.0,
        };
        let moved = PlacedImage { placement: moved, ..image };
        let larger = LivePath { outline: 9.0, ..star().moved(vec2(3.0, -2.0)) };
        let next = moved.with_path(CANVAS, larger).unwrap();
        let maps = [&moved, &next].map(|image| image.frame_from_path(CANVAS).unwrap());
        for p in [vec2(0.0, 0.0), vec2(60.0, 5.0), vec2(-7.0, 90.0)] {
            let [a, b] = maps.map(|map| map.transform_point2(p));
            assert!(a.distance(b) < 1e-3, "{a} {b}");
        }
        let same = PlacedImage::of_path(CANVAS, star()).with_path(CANVAS, star().moved(Vec2::X));
        let made = PlacedImage::of_path(CANVAS, star().moved(Vec2::X));
        assert!(same.is_some_and(|same| same == made), "what was not moved is as if made anew");
    }

    #[test]
    fn a_path_on_the_canvas_looks_like_the_picture_of_it() {
        let image = PlacedImage::of_path(CANVAS, LivePath { outline: 3.0, ..star() });
        let own = |path: &LivePath| Some((path.outline, path.subpaths()[0].nodes[1].at));
        let same = image.path_on_canvas(CANVAS);
        assert_eq!(same.as_ref(), image.source.path().map(|path| &**path));
        let turned =
            Placement { rotation: 90.0, scale: 2.0 * image.placement.scale, ..image.placement };
        let seen =
            PlacedImage { placement: turned, ..image.clone() }.path_on_canvas(CANVAS).unwrap();
        let (outline, at) = own(&seen).unwrap();
        let from = same.unwrap().subpaths()[0].nodes[1].at - image.placement.center;
        assert!((outline - 6.0).abs() < 1e-3, "{outline}");
        let meant = image.placement.center + 2.0 * vec2(from.y, -from.x);
        assert!(at.distance(meant) < 1e-3, "{at} {meant}");
        let stretched = PlaneMap::affine([2.0, 0.0, 0.0, 1.0, 0.0, 0.0]).unwrap();
        let wide = PlacedImage { frame: stretched, ..image.clone() };
        assert!(wide.path_on_canvas(CANVAS).is_none(), "a stretched outline is no outline");
        let bare = PlacedImage::of_path(CANVAS, star());
        let wide = PlacedImage { frame: stretched, ..bare }.path_on_canvas(CANVAS);
        let x = |path: &LivePath| path.subpaths()[0].nodes[0].at.x;
        assert!((x(&wide.unwrap()) - 2.0 * x(&star())).abs() < 1e-3);
    }

    #[test]
    fn edges_between_pixels_stay_sharp() {
        let (from, to) = (vec2(10.0, 8.0), vec2(50.0, 40.0));
        let path = LivePath::new(Figure { from, to, ..Figure::DEFAULT }).with_fill(Color::BLACK);
        let image = PlacedImage::of_path(CANVAS, path);
        let scene = Scene { size: CANVAS, surface: None };
        let tile = image.render_tile(&scene, TileAt::new(0, 0)).unwrap();
        let alpha = |x: usize, y: usize| tile.bytes()[(y * 64 + x) * 4 + 3];
        assert_eq!([alpha(9, 20), alpha(10, 20), alpha(49, 39), alpha(50, 39)], [0, 255, 255, 0]);
        assert_eq!([alpha(20, 7), alpha(20, 8), alpha(20, 40)], [0, 255, 0]);
    }
}
