//! Pages of panels: their numbers, and in which order panels are read. Floor 3. Not here: the layers
//! of panels (`tools::panels`).

use super::half::box_of;
use super::live_path::{LivePath, PathGeometry};
use super::subpath::Subpath;
use super::{Figure, StraightCut};
use crate::math::number_settings::number_settings;
use crate::math::{Range, Vec2, srgb::Color, vec2};

/// The range of a margin and of a gutter, px.
const GAP: Range = 0.0..=4096.0;

/// A panel is at least so wide and so high, px.
const LEAST_PX: f32 = 2.0;

/// The share of a panel's length, in its middle, by which it lies beside another one: slanted cuts
/// let the boxes of neighbors overlap.
const CORE: f32 = 0.6;

crate::named! {
    /// What a drag with the panel tool does.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum PanelDrag {
        #[default]
        Cut = "cut" => "Cut",
        Draw = "draw" => "Draw",
    }
}

number_settings! {
    /// What a page of panels and new panels are like. Lengths are canvas px.
    pub struct PanelSettings {
        /// A whole number.
        rows: "Rows", "Rows of panels", 1.0..=20.0, 3.0;
        /// A whole number.
        columns: "Columns", "Panels side by side", 1.0..=20.0, 2.0;
        /// Of a page.
        margin: "Margin", "Around all panels, up to the edge of the page", GAP, 40.0, px;
        /// Between neighbors.
        gutter_across: "Gutter across", "Between panels side by side", GAP, 16.0, px;
        /// Between rows.
        gutter_down: "Gutter down", "Between panels one below the other", GAP, 30.0, px;
        /// Half of it lies inside.
        border: "Border", "The width of the line around a panel; 0: none", LivePath::OUTLINE, 5.0, px;
        and
        /// Of the line around a panel.
        border_color: Color = Color::BLACK;
        /// A color lies at the bottom of a new panel.
        paper: bool = true;
        /// That color.
        paper_color: Color = Color::WHITE;
        /// Rows are read from right to left.
        right_to_left: bool = false;
        /// What the panel tool does.
        drag: PanelDrag = PanelDrag::Cut;
    }
}

impl PanelSettings {
    /// The nearest settings that panels can have.
    pub fn clamp_to_ranges(self) -> Self {
        let mut near = Self { ..self };
        for setting in Self::SETTINGS {
            let to = (setting.get)(&self);
            setting.put(&mut near, if to.is_finite() { to } else { (setting.get)(&Self::DEFAULT) });
        }
        (near.rows, near.columns) = (near.rows.round(), near.columns.round());
        near
    }

    /// The width of a gutter along a cut: that between rows along a level one, that between
    /// neighbors along an upright one, and between both by the square of the slope.
    pub fn gutter_of(&self, along: Vec2) -> f32 {
        let along = along.normalize_or_zero();
        let level = along.x * along.x;
        self.gutter_across + (self.gutter_down - self.gutter_across) * level
    }

    /// A coordinate near to one at which an edge of its border lies between two pixels.
    fn crisp(&self, v: f32) -> f32 {
        let half = (0.5 * self.border).fract();
        // Only whole borders have edges between pixels.
        if self.border.fract() == 0.0 { (v - half).round() + half } else { v }
    }

    /// The sides of a gutter between two points of a drag: what lies to the left of either is one of
    /// both panels. Level and upright ones lie between pixels. `None` for a drag without a direction.
    pub fn cuts(&self, from: Vec2, to: Vec2) -> Option<[StraightCut; 2]> {
        let along = (to - from).try_normalize()?;
        let aside = 0.5 * self.gutter_of(along) * along.perp();
        let sides = [1.0, -1.0].map(|side| {
            let mut at = from + side * aside;
            if along.x.abs() < 1e-6 {
                at.x = self.crisp(at.x);
            }
            if along.y.abs() < 1e-6 {
                at.y = self.crisp(at.y);
            }
            at
        });
        // Going on, the right side has the panel on the right: its cut goes back.
        let [right, left] = sides;
        let level = level_direction(along);
        let left = StraightCut::between(left, left + level)?;
        Some([left, StraightCut::between(right, right + level)?.reversed()])
    }

    /// The panels of a page, row by row as they are read; or why there are none.
    pub fn divide_rectangle(&self, corners: [Vec2; 2]) -> Result<Vec<Figure>, String> {
        let (low, high) = (corners[0] + self.margin, corners[1] - self.margin);
        let cells = self.cells([low, high], corners[1] - corners[0])?;
        let figure = |[from, to]: [Vec2; 2]| {
            let crisp = |p: Vec2| vec2(self.crisp(p.x), self.crisp(p.y));
            Figure { from: crisp(from), to: crisp(to), ..Figure::DEFAULT }
        };
        Ok(cells.into_iter().map(figure).collect())
    }

    /// The panels of a closed shape, row by row as they are read; or why there are none.
    pub fn divide_shape(&self, lines: &[Subpath]) -> Result<Vec<PathGeometry>, String> {
        let Some(corners) = box_of(lines) else { return Err("the path has no inside".into()) };
        let cells = self.cells(corners, corners[1] - corners[0])?;
        let is_panel = |lines: &Vec<Subpath>| {
            lines.iter().map(Subpath::area_px).sum::<f32>() >= LEAST_PX * LEAST_PX
        };
        if cells.len() == 1 {
            let whole = Some(lines.to_vec()).filter(is_panel);
            return Ok(whole.into_iter().map(PathGeometry::of_lines).collect());
        }
        let cell = |[low, high]: [Vec2; 2]| {
            // Around it with the inside on the left.
            let corners = [low, vec2(low.x, high.y), high, vec2(high.x, low.y)];
            let mut inside = lines.to_vec();
            for (i, corner) in corners.into_iter().enumerate() {
                let cut = StraightCut::between(corner, corners[(i + 1) % corners.len()])?;
                inside = cut.left_of(&inside);
            }
            Some(inside).filter(is_panel).map(PathGeometry::of_lines)
        };
        Ok(cells.into_iter().filter_map(cell).collect())
    }

    /// The corners of the cells of a box, row by row as they are read.
    ///
    /// * `within`: the size to name where they do not fit.
    fn cells(&self, [low, high]: [Vec2; 2], within: Vec2) -> Result<Vec<[Vec2; 2]>, String> {
        let (rows, columns) = (self.rows.round().max(1.0), self.columns.round().max(1.0));
        let gutter = vec2(self.gutter_across, self.gutter_down);
        let count = vec2(columns, rows);
        let side = (high - low - gutter * (count - 1.0)) / count;
        if !(side.x >= LEAST_PX && side.y >= LEAST_PX) {
            let [across, down] = [columns, rows].map(|n| n as usize);
            return Err(format!(
                "{across} × {down} panels, their gutters and the margin do not fit in {} × {} px",
                within.x.round(),
                within.y.round()
            ));
        }
        let cell = |row: usize, column: usize| {
            let column = if self.right_to_left { columns as usize - 1 - column } else { column };
            let from = low + (side + gutter) * vec2(column as f32, row as f32);
            [from, from + side]
        };
        let places =
            (0..rows as usize).flat_map(|row| (0..columns as usize).map(move |c| (row, c)));
        Ok(places.map(|(row, column)| cell(row, column)).collect())
    }
}

/// A direction that is level or upright if it is nearly so.
fn level_direction(along: Vec2) -> Vec2 {
    let level = |v: f32| if v.abs() < 1e-6 { 0.0 } else { v };
    vec2(level(along.x), level(along.y))
}

/// In which order panels are read, by the corners of the boxes around them: row by row, and where
/// panels lie beside several rows, column by column.
pub fn order_panels(boxes: &[[Vec2; 2]], right_to_left: bool) -> Vec<usize> {
    let mut order: Vec<usize> = (0..boxes.len()).collect();
    let cores: Vec<[Vec2; 2]> = boxes
        .iter()
        .map(|[low, high]| {
            let aside = 0.5 * (1.0 - CORE) * (*high - *low);
            let (low, high) = (*low + aside, *high - aside);
            match right_to_left {
                true => [vec2(-high.x, low.y), vec2(-low.x, high.y)],
                false => [low, high],
            }
        })
        .collect();
    order_group(&mut order, &cores);
    order
}

/// Orders some boxes in rows, or else in columns, and what is in each of them in the same way.
fn order_group(group: &mut [usize], cores: &[[Vec2; 2]]) {
    let ends = |i: usize, down: bool| {
        let [low, high] = cores[i];
        if down { (low.y, high.y) } else { (low.x, high.x) }
    };
    for down in [true, false] {
        group.sort_by(|a, b| ends(*a, down).0.total_cmp(&ends(*b, down).0).then(a.cmp(b)));
        let mut starts = vec![0];
        let mut reach = f32::NEG_INFINITY;
        for (place, i) in group.iter().enumerate() {
            let (low, high) = ends(*i, down);
            if place > 0 && low >= reach {
                starts.push(place);
            }
            reach = reach.max(high);
        }
        if starts.len() > 1 {
            starts.push(group.len());
            for pair in starts.windows(2) {
                order_group(&mut group[pair[0]..pair[1]], cores);
            }
            return;
        }
    }
    // They lie over each other: by their middles.
    let middle = |i: usize| cores[i][0] + cores[i][1];
    group.sort_by(|a, b| {
        let (a_at, b_at) = (middle(*a), middle(*b));
        a_at.y.total_cmp(&b_at.y).then(a_at.x.total_cmp(&b_at.x)).then(a.cmp(b))
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corners(figures: &[Figure]) -> Vec<[f32; 4]> {
        figures.iter().map(|f| [f.from.x, f.from.y, f.to.x, f.to.y]).collect()
    }

    #[test]
    fn a_page_is_divided_within_its_margin_by_its_gutters() {
        let settings = PanelSettings {
            rows: 2.0,
            columns: 2.0,
            margin: 10.0,
            gutter_across: 4.0,
            gutter_down: 8.0,
            border: 4.0,
            ..PanelSettings::DEFAULT
        };
        let page = [Vec2::ZERO, vec2(100.0, 200.0)];
        let panels = settings.divide_rectangle(page).unwrap();
        assert_eq!(
            corners(&panels),
            [
                [10.0, 10.0, 48.0, 96.0],
                [52.0, 10.0, 90.0, 96.0],
                [10.0, 104.0, 48.0, 190.0],
                [52.0, 104.0, 90.0, 190.0]
            ]
        );
        let manga = PanelSettings { right_to_left: true, ..settings };
        assert_eq!(corners(&manga.divide_rectangle(page).unwrap())[0], [52.0, 10.0, 90.0, 96.0]);
        // The edges of a border of an odd width lie between pixels, too.
        let odd = PanelSettings { border: 3.0, ..settings };
        assert_eq!(corners(&odd.divide_rectangle(page).unwrap())[0], [10.5, 10.5, 48.5, 96.5]);
        let why = settings.divide_rectangle([Vec2::ZERO, vec2(25.0, 200.0)]).unwrap_err();
        assert_eq!(why, "2 × 2 panels, their gutters and the margin do not fit in 25 × 200 px");
    }

    #[test]
    fn a_shape_is_divided_as_its_box_is() {
        let (from, to) = (Vec2::ZERO, vec2(100.0, 100.0));
        let figure = |kind| Figure { kind, from, to, ..Figure::DEFAULT };
        let settings =
            PanelSettings { rows: 1.0, gutter_across: 10.0, border: 2.0, ..PanelSettings::DEFAULT };
        let circle = figure(super::super::FigureKind::Ellipse).subpaths();
        let halves = settings.divide_shape(&circle).unwrap();
        assert_eq!(halves.len(), 2);
        for half in halves {
            let PathGeometry::Nodes(lines) = half else { panic!("half a circle is no figure") };
            let area = lines[0].area_px();
            // Half of the circle without half of the gutter's strip, as a polygon.
            assert!((area - 3427.8).abs() < 7.0, "{area}");
        }
        let whole = PanelSettings { columns: 1.0, ..settings };
        assert_eq!(whole.divide_shape(&circle).unwrap(), [PathGeometry::Nodes(circle)]);
        assert!(settings.divide_shape(&[]).is_err());
    }

    #[test]
    fn gutters_follow_the_slope_of_the_cut() {
        let settings = PanelSettings {
            gutter_across: 10.0,
            gutter_down: 30.0,
            border: 2.0,
            ..PanelSettings::DEFAULT
        };
        assert_eq!(settings.gutter_of(Vec2::X), 30.0);
        assert_eq!(settings.gutter_of(Vec2::NEG_Y), 10.0);
        assert!((settings.gutter_of(vec2(5.0, 5.0)) - 20.0).abs() < 1e-4);
        let square = [Subpath::polygon(
            [(0.0, 0.0), (100.0, 0.0), (100.0, 100.0), (0.0, 100.0)].map(|(x, y)| vec2(x, y)),
        )];
        let boxes = settings.cuts(vec2(-5.0, 50.3), vec2(120.0, 50.3)).unwrap();
        let boxes = boxes.map(|cut| box_of(&cut.left_of(&square)).unwrap());
        let expected = [[0.0, 0.0, 100.0, 35.0], [0.0, 65.0, 100.0, 100.0]];
        for (found, expected) in boxes.as_flattened().iter().zip(expected.as_flattened().chunks(2))
        {
            assert!((*found - vec2(expected[0], expected[1])).length() < 1e-3, "{found}");
        }
        assert!(settings.cuts(Vec2::ONE, Vec2::ONE).is_none());
    }

    #[test]
    fn panels_are_read_row_by_row_and_beside_rows_column_by_column() {
        let boxes = |all: &[[f32; 4]]| -> Vec<[Vec2; 2]> {
            all.iter().map(|[a, b, c, d]| [vec2(*a, *b), vec2(*c, *d)]).collect()
        };
        let grid = boxes(&[
            [50.0, 50.0, 90.0, 90.0],
            [0.0, 0.0, 40.0, 40.0],
            [50.0, 0.0, 90.0, 40.0],
            [0.0, 50.0, 40.0, 90.0],
        ]);
        assert_eq!(order_panels(&grid, false), [1, 2, 3, 0]);
        assert_eq!(order_panels(&grid, true), [2, 1, 0, 3]);
        // A high panel beside two low ones.
        let tall =
            boxes(&[[50.0, 50.0, 90.0, 90.0], [50.0, 0.0, 90.0, 40.0], [0.0, 0.0, 40.0, 90.0]]);
        assert_eq!(order_panels(&tall, false), [2, 1, 0]);
        assert_eq!(order_panels(&tall, true), [1, 0, 2]);
        // A slanted cut: the boxes overlap.
        let slanted = boxes(&[[0.0, 35.0, 90.0, 90.0], [0.0, 0.0, 90.0, 50.0]]);
        assert_eq!(order_panels(&slanted, false), [1, 0]);
        assert_eq!(order_panels(&[], false), [0; 0]);
    }
}
