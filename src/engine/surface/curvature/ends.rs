//! Curvature of blurred normals near the ends of a surface. A blur along rows and then columns sees
//! the stairs of a contour: it ends in blocks and streaks there. Normals that flow to linked
//! neighbors in small steps do not: the heat equation, whose steps of variance 2 t add up to the
//! Gaussian's, with nothing flowing over an end. Floor 2.

use super::tile_rect::TileRect;
use super::{CurvatureRims, slope, tensor};
use crate::surface::{Surface, links};
use std::ops::Range;

/// What flows to each neighbor in a step; up to a quarter is stable.
const FLOW: f32 = 0.24;
/// Wider blurs take too many steps, and stay as they are.
const WIDEST_PX: f32 = 8.0;
/// Standard deviations from an end up to which its normals flow, and beyond which they need not.
const FROM: f32 = 2.0;
const TO: f32 = 3.0;
/// Standard deviations from an end beyond which nothing flows: farther pixels have no effect where
/// the flow is used.
const FLOWING: f32 = 5.2;

/// The blur near the ends of a surface.
pub(super) struct EndBlur<'s> {
    surface: &'s Surface,
    blur_px: f32,
    steps: usize,
    /// How far an end is felt, px.
    reach: usize,
    /// The ends' pixels, row by row.
    rims: &'s CurvatureRims,
}

/// A part of the canvas: the normals that flow in it, and over which sides. A thread uses one from
/// tile to tile.
#[derive(Default)]
pub(super) struct FlowRegion {
    x0: usize,
    y0: usize,
    width: usize,
    height: usize,
    /// n̄_x, n̄_y, n_z.
    normal: [Vec<f32>; 3],
    /// [`FLOW`] where a pixel is linked to the one at its right, or below, else 0.
    right: Vec<f32>,
    down: Vec<f32>,
    links: Vec<u8>,
    /// Distance to the nearest end in thirds of a pixel, at most.
    distance: Vec<u16>,
    /// What a step writes.
    next: Vec<f32>,
}

impl<'s> EndBlur<'s> {
    /// `None` where there is nothing to do.
    pub fn new(surface: &'s Surface, rims: &'s CurvatureRims, blur_px: f32) -> Option<Self> {
        let steps = (blur_px * blur_px / (2.0 * FLOW)).round() as usize;
        let is_wanted = steps > 0 && blur_px <= WIDEST_PX && !rims.is_empty();
        is_wanted.then(|| Self {
            surface,
            blur_px,
            steps,
            reach: (TO * blur_px).ceil() as usize + 1,
            rims,
        })
    }

    /// Puts the tensor of a tile in place, in a band of rows that begins at the tile's first.
    pub fn fill(&self, tile: TileRect, region: &mut FlowRegion, band: [&mut [f32]; 3]) {
        let size = self.surface.size();
        let (x0, y0) = (tile.x0.saturating_sub(self.reach), tile.y0.saturating_sub(self.reach));
        let x1 = (tile.x0 + tile.cols + self.reach).min(size.width as usize);
        let y1 = (tile.y0 + tile.rows + self.reach).min(size.height as usize);
        if !self.rims.are_in(x0..x1, y0..y1) {
            return;
        }
        region.read(self.surface, self.rims, [x0, y0, x1, y1]);
        region.flow(self.steps, (3.0 * FLOWING * self.blur_px) as u16);
        let [hxx, hxy, hyy] = band;
        let (near, far) = (3.0 * FROM * self.blur_px, 3.0 * TO * self.blur_px);
        for y in tile.y0..tile.y0 + tile.rows {
            for x in tile.x0..tile.x0 + tile.cols {
                let i = region.index(x, y);
                let share = ((far - f32::from(region.distance[i])) / (far - near)).min(1.0);
                if share <= 0.0 || region.links[i] == 0 {
                    continue;
                }
                let h = region.tensor_at(i);
                let at = (y - tile.y0) * size.width as usize + x;
                for (to, from) in [&mut hxx[at], &mut hxy[at], &mut hyy[at]].into_iter().zip(h) {
                    *to += share * (from - *to);
                }
            }
        }
    }
}

impl FlowRegion {
    /// What lies in a rectangle, from column and row to column and row.
    fn read(&mut self, surface: &Surface, rims: &CurvatureRims, [x0, y0, x1, y1]: [usize; 4]) {
        (self.x0, self.y0, self.width, self.height) = (x0, y0, x1 - x0, y1 - y0);
        for (to, plane) in self.normal.iter_mut().zip(surface.normal_planes()) {
            to.clear();
            (y0..y1).for_each(|y| to.extend_from_slice(&plane.row(y)[x0..x1]));
        }
        [&mut self.right, &mut self.down].into_iter().for_each(Vec::clear);
        self.links.clear();
        let flow = |links: u8, bit: u8| if links & bit != 0 { FLOW } else { 0.0 };
        for y in y0..y1 {
            let links = &surface.links_plane().row(y)[x0..x1];
            self.links.extend_from_slice(links);
            self.right.extend(links[..links.len() - 1].iter().map(|&l| flow(l, links::RIGHT)));
            self.right.push(0.0);
            let is_last = y + 1 == y1;
            self.down
                .extend(links.iter().map(|&l| if is_last { 0.0 } else { flow(l, links::DOWN) }));
        }
        rims.distances([x0, y0, x1, y1], &mut self.distance);
    }

    fn index(&self, x: usize, y: usize) -> usize {
        (y - self.y0) * self.width + x - self.x0
    }

    /// `within`: thirds of a pixel from an end up to which normals flow.
    fn flow(&mut self, steps: usize, within: u16) {
        let Self { width, height, normal, right, down, next, distance, .. } = self;
        let (width, last) = (*width, *height - 1);
        let row = |y: usize| y * width..(y + 1) * width;
        // The columns of each row from the first to the last pixel that flows.
        let spans: Vec<Range<usize>> = (0..=last)
            .map(|y| {
                let flows = |d: &u16| *d <= within;
                let first = distance[row(y)].iter().position(flows).unwrap_or(width);
                first..distance[row(y)].iter().rposition(flows).map_or(width, |x| x + 1)
            })
            .collect();
        let nothing = vec![0.0; width];
        for channel in normal {
            next.clone_from(channel);
            for _ in 0..steps {
                for (y, span) in spans.iter().enumerate().filter(|(_, span)| !span.is_empty()) {
                    let up = if y > 0 { &down[row(y - 1)] } else { &nothing[..] };
                    let sides = SideFlows { right: &right[row(y)], up, down: &down[row(y)] };
                    let rows =
                        [y.saturating_sub(1), y, (y + 1).min(last)].map(|y| &channel[row(y)]);
                    flow_row(rows, sides, span.clone(), &mut next[row(y)]);
                }
                std::mem::swap(channel, next);
            }
        }
    }

    /// H of a pixel by differences to linked neighbors in the region.
    fn tensor_at(&self, i: usize) -> [f32; 3] {
        let slope_at = |i: usize| {
            let [x, y, z] = self.normal.each_ref().map(|channel| channel[i]);
            slope(x, y, z)
        };
        let difference = |back: Option<usize>, forth: Option<usize>| {
            let steps = [back, forth].iter().flatten().count().max(1) as f32;
            let [a, b] = [back, forth].map(|end| slope_at(end.unwrap_or(i)));
            ((b.0 - a.0) / steps, (b.1 - a.1) / steps)
        };
        let (x, y, l) = (i % self.width, i / self.width, self.links[i]);
        let to = |bit: u8, inside: bool, j: usize| (l & bit != 0 && inside).then_some(j);
        let across = difference(
            to(links::LEFT, x > 0, i.wrapping_sub(1)),
            to(links::RIGHT, x + 1 < self.width, i + 1),
        );
        let along = difference(
            to(links::UP, y > 0, i.wrapping_sub(self.width)),
            to(links::DOWN, y + 1 < self.height, i + self.width),
        );
        tensor(across, along)
    }
}

/// What flows over the sides of a row's pixels.
#[derive(Clone, Copy)]
struct SideFlows<'r> {
    right: &'r [f32],
    up: &'r [f32],
    down: &'r [f32],
}

/// One step of some columns of a row: each pixel moves toward its linked neighbors.
fn flow_row(rows: [&[f32]; 3], sides: SideFlows, span: Range<usize>, out: &mut [f32]) {
    let (n, [above, here, below]) = (out.len(), rows);
    let mut at_border = |x: usize| {
        let toward = |flow: f32, value: f32| flow * (value - here[x]);
        let mut flown = here[x] + toward(sides.up[x], above[x]) + toward(sides.down[x], below[x]);
        if x + 1 < n {
            flown += toward(sides.right[x], here[x + 1]);
        }
        if x > 0 {
            flown += toward(sides.right[x - 1], here[x - 1]);
        }
        out[x] = flown;
    };
    [0, n - 1].into_iter().filter(|x| span.contains(x)).for_each(&mut at_border);
    let (from, to) = (span.start.max(1), span.end.min(n - 1));
    if from < to {
        let left = &sides.right[from - 1..to - 1];
        let flows = [&sides.up[from..to], &sides.down[from..to], &sides.right[from..to], left];
        let beside =
            [&above[from..to], &below[from..to], &here[from + 1..to + 1], &here[from - 1..to - 1]];
        flow_inside(flows, beside, &here[from..to], &mut out[from..to]);
    }
}

crate::widest! {
    /// Pixels move toward their neighbors above, below, at the right and at the left.
    fn flow_inside(flows: [&[f32]; 4], beside: [&[f32]; 4], here: &[f32], out: &mut [f32]) {
        let n = out.len();
        let [up, down, right, left] = flows.map(|flow| &flow[..n]);
        let [above, below, after, before] = beside.map(|value| &value[..n]);
        let here = &here[..n];
        for i in 0..n {
            let h = here[i];
            let upright = h + up[i] * (above[i] - h) + down[i] * (below[i] - h);
            out[i] = upright + right[i] * (after[i] - h) + left[i] * (before[i] - h);
        }
    }
}
