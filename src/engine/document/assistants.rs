//! Assistants: lines, ellipses and perspectives that strokes are drawn along. Values of the
//! document, not part of the picture. Floor 4. Not here: which of their lines a stroke takes
//! (`tools::assistants`).

use crate::math::range::{at_most, check_range};
use crate::math::{COORDINATE, PlaneMap, Vec2};

/// An assistant with its handles.
#[derive(Clone, Debug, PartialEq)]
pub struct Assistant {
    /// What it draws along.
    pub kind: AssistantKind,
    /// As many as its kind has, canvas px.
    pub points: Vec<Vec2>,
}

crate::named! {
    /// What an assistant draws along.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum AssistantKind {
        /// From one handle to the other.
        Line = "line",
        /// All lines parallel to the one through both handles.
        Parallel = "parallel",
        /// Its first two handles are the ends of one axis, the third lies on it, at a right angle
        /// to that axis.
        Ellipse = "ellipse",
        /// All lines to one vanishing point, and the level and upright ones.
        OnePoint = "one-point",
        /// All lines to two vanishing points, and those across the horizon between them.
        TwoPoint = "two-point",
        /// All lines to three vanishing points.
        ThreePoint = "three-point",
    }
}

impl AssistantKind {
    /// How many handles it has.
    pub fn handles(self) -> usize {
        match self {
            AssistantKind::OnePoint => 1,
            AssistantKind::Line | AssistantKind::Parallel | AssistantKind::TwoPoint => 2,
            AssistantKind::Ellipse | AssistantKind::ThreePoint => 3,
        }
    }
}

/// What a stroke can be drawn along.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AssistantPath {
    /// A line without ends; `along` has the length 1.
    Line {
        /// A point of it.
        at: Vec2,
        /// Where it leads.
        along: Vec2,
    },
    /// Around an ellipse.
    Ellipse(EllipseFrame),
}

/// An ellipse by its middle and its half axes, which are at right angles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EllipseFrame {
    /// The middle.
    pub center: Vec2,
    /// The two half axes.
    pub axes: [Vec2; 2],
}

impl Assistant {
    /// The most in a document.
    pub const MOST: usize = 100;

    /// Refuses what files cannot hold.
    pub fn fits(&self) -> Result<(), String> {
        if self.points.len() != self.kind.handles() {
            let (is, must) = (self.points.len(), self.kind.handles());
            return Err(format!("an assistant has {is} handles; it must have {must}"));
        }
        let mut numbers = self.points.iter().flat_map(|point| point.to_array());
        numbers.try_for_each(|v| check_range("a handle of an assistant", v, &COORDINATE))
    }

    /// Refuses more of them than a file can hold, and those that files cannot hold.
    pub fn all_fit(all: &[Assistant]) -> Result<(), String> {
        at_most("Assistants", all.len(), Self::MOST)?;
        all.iter().try_for_each(Assistant::fits)
    }

    /// With a handle moved; that of an ellipse's second axis stays at a right angle to the first.
    pub fn with_handle(&self, index: usize, at: Vec2) -> Self {
        let mut next = self.clone();
        let half = self.ellipse().map(|ellipse| ellipse.axes[1].length());
        if let Some(point) = next.points.get_mut(index) {
            *point = at;
        }
        if let (Some(half), [a, b, c]) = (half, &mut next.points[..]) {
            let (center, across) = ((*a + *b) * 0.5, (*b - *a).perp().normalize_or(Vec2::Y));
            let reach = if index == 2 { (at - center).dot(across) } else { half };
            *c = center + across * reach;
        }
        next
    }

    /// Its ellipse, if it is one.
    pub fn ellipse(&self) -> Option<EllipseFrame> {
        let (AssistantKind::Ellipse, [a, b, c]) = (self.kind, &self.points[..]) else {
            return None;
        };
        let (center, half) = ((*a + *b) * 0.5, (*b - *a) * 0.5);
        let across = half.perp().normalize_or(Vec2::Y);
        Some(EllipseFrame { center, axes: [half, across * (*c - center).dot(across)] })
    }

    /// The paths that a stroke from a point can take. A line and an ellipse are paths only for
    /// strokes that begin within `near_px` of them; the others have lines through every point.
    pub fn paths(&self, from: Vec2, near_px: f32) -> Vec<AssistantPath> {
        let toward = |to: Vec2| line(from, to - from);
        match (self.kind, &self.points[..]) {
            (AssistantKind::Line, [a, b]) => {
                let near =
                    line(*a, *b - *a).filter(|line| line.nearest(from).distance(from) <= near_px);
                // The line ends at its handles.
                let is_beside = |line: &AssistantPath| match line {
                    AssistantPath::Line { at, along } => {
                        (-near_px..=a.distance(*b) + near_px).contains(&(from - *at).dot(*along))
                    }
                    AssistantPath::Ellipse(_) => false,
                };
                near.filter(is_beside).into_iter().collect()
            }
            (AssistantKind::Parallel, [a, b]) => line(from, *b - *a).into_iter().collect(),
            (AssistantKind::Ellipse, _) => {
                let path = self.ellipse().map(AssistantPath::Ellipse);
                path.filter(|path| path.nearest(from).distance(from) <= near_px)
                    .into_iter()
                    .collect()
            }
            (AssistantKind::OnePoint, [v]) => {
                [toward(*v), line(from, Vec2::X), line(from, Vec2::Y)]
                    .into_iter()
                    .flatten()
                    .collect()
            }
            (AssistantKind::TwoPoint, [v, w]) => {
                let across = line(from, (*w - *v).perp());
                [toward(*v), toward(*w), across].into_iter().flatten().collect()
            }
            (AssistantKind::ThreePoint, points) => {
                points.iter().filter_map(|v| toward(*v)).collect()
            }
            _ => Vec::new(),
        }
    }

    /// After a map of the canvas; `None` where a handle lies beyond its horizon.
    pub fn transformed(&self, map: &PlaneMap) -> Option<Self> {
        let points: Option<Vec<Vec2>> =
            self.points.iter().map(|point| map.to_canvas(*point)).collect();
        Some(Self { kind: self.kind, points: points? }).filter(|next| next.fits().is_ok())
    }

    /// On a canvas `per_axis` times as large.
    pub(super) fn scaled(&self, per_axis: Vec2) -> Self {
        Self {
            kind: self.kind,
            points: self.points.iter().map(|point| *point * per_axis).collect(),
        }
    }
}

fn line(at: Vec2, toward: Vec2) -> Option<AssistantPath> {
    toward.try_normalize().map(|along| AssistantPath::Line { at, along })
}

impl AssistantPath {
    /// The point of the path that is nearest to another.
    pub fn nearest(&self, to: Vec2) -> Vec2 {
        match self {
            AssistantPath::Line { at, along } => *at + *along * (to - *at).dot(*along),
            AssistantPath::Ellipse(ellipse) => ellipse.nearest(to),
        }
    }

    /// Distance from the path of the point that a stroke has reached, as a share of its length so
    /// far: 0 is along the path, 1 across.
    pub fn leaning(&self, from: Vec2, to: Vec2) -> f32 {
        let long = from.distance(to).max(f32::MIN_POSITIVE);
        let off = |p: Vec2| p - self.nearest(p);
        (off(to) - off(from)).length() / long
    }
}

impl EllipseFrame {
    /// The nearest point of the ellipse: that at which a normal through `to` meets it. With half
    /// axes a ≥ b and the point (x, y) in their quarter, it is (a² x / (t + a²), b² y / (t + b²))
    /// for the largest root t of (a x / (t + a²))² + (b y / (t + b²))² = 1, which is found by
    /// halving.
    pub fn nearest(&self, to: Vec2) -> Vec2 {
        let [u, v] = self.axes;
        let (a, b) = (f64::from(u.length()), f64::from(v.length()));
        let (along, across) =
            (u.normalize_or(Vec2::X), v.normalize_or(u.perp().normalize_or(Vec2::Y)));
        let local = to - self.center;
        let (x, y) = (f64::from(local.dot(along)), f64::from(local.dot(across)));
        if !(a > 1e-6 && b > 1e-6) {
            // A line there and back.
            let x = x.max(-a).min(a);
            return self.center + along * x as f32;
        }
        let (px, py) = if a >= b {
            quarter(a, b, x.abs(), y.abs())
        } else {
            swap(quarter(b, a, y.abs(), x.abs()))
        };
        self.center + along * px.copysign(x) as f32 + across * py.copysign(y) as f32
    }
}

fn swap((x, y): (f64, f64)) -> (f64, f64) {
    (y, x)
}

/// In the quarter of both half axes, a ≥ b > 0, x and y ≥ 0.
fn quarter(a: f64, b: f64, x: f64, y: f64) -> (f64, f64) {
    if y < 1e-9 {
        // Between the middles of curvature the nearest points lie next to the long axis.
        let reach = (a * a - b * b) / a;
        if x < reach {
            let at = a * a * x / (a * a - b * b);
            return (at, b * (1.0 - (at / a) * (at / a)).max(0.0).sqrt());
        }
        return (a, 0.0);
    }
    let beyond = |t: f64| {
        let (p, q) = (a * x / (t + a * a), b * y / (t + b * b));
        p * p + q * q > 1.0
    };
    // At the lower end the sum is at least 1, at the upper one at most.
    let (mut low, mut high) =
        (-b * b + b * y, -b * b + (a * a * x * x + b * b * y * y).sqrt().max(b * y));
    for _ in 0..80 {
        let middle = 0.5 * (low + high);
        if beyond(middle) { low = middle } else { high = middle }
    }
    let t = 0.5 * (low + high);
    (a * a * x / (t + a * a), b * b * y / (t + b * b))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vec2;
    use proptest::prelude::*;

    fn of(kind: AssistantKind, points: &[Vec2]) -> Assistant {
        Assistant { kind, points: points.to_vec() }
    }

    fn ellipse() -> Assistant {
        of(AssistantKind::Ellipse, &[vec2(20.0, 50.0), vec2(180.0, 50.0), vec2(100.0, 20.0)])
    }

    #[test]
    fn strokes_along_a_line_begin_beside_it_and_perspectives_have_lines_everywhere() {
        let rule = of(AssistantKind::Line, &[vec2(0.0, 0.0), vec2(100.0, 0.0)]);
        assert_eq!(rule.paths(vec2(50.0, 6.0), 8.0).len(), 1);
        assert_eq!(rule.paths(vec2(50.0, 9.0), 8.0).len(), 0);
        assert_eq!(rule.paths(vec2(120.0, 0.0), 8.0).len(), 0, "beyond its end");
        let all = [
            (AssistantKind::Parallel, 1),
            (AssistantKind::TwoPoint, 3),
            (AssistantKind::ThreePoint, 3),
        ];
        for (kind, count) in all {
            let points = [vec2(-500.0, 10.0), vec2(700.0, 20.0), vec2(90.0, 4000.0)];
            let paths = of(kind, &points[..kind.handles()]).paths(vec2(50.0, 60.0), 8.0);
            assert_eq!(paths.len(), count, "{kind:?}");
            for path in &paths {
                assert!(
                    path.nearest(vec2(50.0, 60.0)).distance(vec2(50.0, 60.0)) < 1e-3,
                    "through where it begins"
                );
            }
        }
        let toward =
            of(AssistantKind::OnePoint, &[vec2(10.0, 20.0)]).paths(vec2(50.0, 60.0), 8.0)[0];
        assert!(toward.nearest(vec2(10.0, 20.0)).distance(vec2(10.0, 20.0)) < 1e-3);
        assert!(
            of(AssistantKind::OnePoint, &[Vec2::ZERO]).paths(Vec2::ZERO, 8.0).len() == 2,
            "at its point"
        );
    }

    #[test]
    fn an_ellipse_goes_through_its_handles_and_stays_one_when_they_move() {
        let frame = ellipse().ellipse().unwrap();
        for handle in &ellipse().points {
            assert!(frame.nearest(*handle).distance(*handle) < 1e-3, "{handle}");
        }
        assert!(frame.nearest(vec2(100.0, 1000.0)).distance(vec2(100.0, 80.0)) < 1e-3);
        assert!(frame.nearest(vec2(400.0, 50.0)).distance(vec2(180.0, 50.0)) < 1e-3);
        let turned = ellipse().with_handle(1, vec2(20.0, 210.0));
        let moved = turned.ellipse().unwrap();
        assert!(
            (moved.axes[1].length() - 30.0).abs() < 1e-3
                && moved.axes[0].dot(moved.axes[1]).abs() < 1e-2
        );
        assert!(turned.points[2].distance(moved.nearest(turned.points[2])) < 1e-3);
        let flat = of(AssistantKind::Ellipse, &[Vec2::ZERO; 3]).ellipse().unwrap();
        assert!(flat.nearest(vec2(3.0, 4.0)).is_finite());
    }

    #[test]
    fn a_stroke_leans_toward_the_path_that_it_runs_along() {
        let paths =
            of(AssistantKind::OnePoint, &[vec2(1000.0, 1000.0)]).paths(vec2(100.0, 100.0), 8.0);
        let best = |to: Vec2| {
            let leaning = |path: &AssistantPath| path.leaning(vec2(100.0, 100.0), to);
            (0..3).min_by(|a, b| leaning(&paths[*a]).total_cmp(&leaning(&paths[*b]))).unwrap()
        };
        assert_eq!([vec2(106.0, 107.0), vec2(108.0, 101.0), vec2(99.0, 92.0)].map(best), [0, 1, 2]);
    }

    #[test]
    fn assistants_turn_with_the_canvas() {
        let map = PlaneMap::rotation(90.0, vec2(50.0, 50.0));
        let turned = of(AssistantKind::Line, &[vec2(50.0, 0.0), vec2(50.0, 40.0)])
            .transformed(&map)
            .unwrap();
        assert!(turned.points[0].distance(vec2(0.0, 50.0)) < 1e-3, "{turned:?}");
        assert!(of(AssistantKind::OnePoint, &[vec2(f32::NAN, 0.0)]).fits().is_err());
        assert!(of(AssistantKind::OnePoint, &[Vec2::ZERO; 2]).fits().is_err());
    }
    proptest! {
        #[test]
        fn no_point_of_an_ellipse_is_nearer_than_the_nearest(
            a in 0.5f32..400.0, b in 0.5f32..400.0, turn in 0.0f32..6.3, x in -900.0f32..900.0, y in -900.0f32..900.0,
        ) {
            let along = Vec2::from_angle(turn);
            let frame = EllipseFrame { center: vec2(30.0, -20.0), axes: [along * a, along.perp() * b] };
            let to = vec2(x, y);
            let found = frame.nearest(to);
            let on = |t: f32| frame.center + frame.axes[0] * t.cos() + frame.axes[1] * t.sin();
            let best = (0..3000).map(|i| on(i as f32 * 0.002_094_4).distance(to)).fold(f32::INFINITY, f32::min);
            prop_assert!(found.distance(to) <= best + 0.02, "{} and not {best}", found.distance(to));
            let local = found - frame.center;
            let round = (local.dot(along) / a).powi(2) + (local.dot(along.perp()) / b).powi(2);
            prop_assert!((round - 1.0).abs() < 1e-3, "it lies on it: {round}");
        }
    }
}
