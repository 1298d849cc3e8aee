//! Curvature of blurred normals near the ends of a surface. A blur along rows and then columns sees the stairs of a
//! contour: it ends in blocks and streaks there. Normals that flow to linked neighbours in small steps do not: the heat
//! equation, whose steps of variance 2 t add up to the Gaussian's, with nothing flowing over an end.
//! Floor 2.

use super::tile_rect::TileRect;
use super::{Rims, slope, tensor};
use crate::surface::{Surface, links};

/// What flows to each neighbour in a step; up to a quarter is stable.
const FLOW: f32 = 0.24;
/// Wider blurs take too many steps, and stay as they are.
const WIDEST_PX: f32 = 8.0;
/// Standard deviations from an end up to which its normals flow, and beyond which they need not.
const FROM: f32 = 2.0;
const TO: f32 = 3.0;

/// The blur near the ends of a surface.
pub(super) struct EndBlur<'s> {
    surface: &'s Surface,
    blur_px: f32,
    steps: usize,
    /// How far an end is felt, px.
    reach: usize,
    /// The ends' pixels, row by row.
    rims: &'s Rims,
}

/// A part of the canvas: the normals that flow in it, and over which sides.
struct FlowRegion {
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
}

impl<'s> EndBlur<'s> {
    /// `None` where there is nothing to do.
    pub fn new(surface: &'s Surface, rims: &'s Rims, blur_px: f32) -> Option<Self> {
        let steps = (blur_px * blur_px / (2.0 * FLOW)).round() as usize;
        let is_wanted = steps > 0 && blur_px <= WIDEST_PX && !rims.is_empty();
        is_wanted.then(|| Self { surface, blur_px, steps, reach: (TO * blur_px).ceil() as usize + 1, rims })
    }
    /// Puts the tensor of a tile in place, in a band of rows that begins at the tile's first.
    pub fn fill(&self, tile: TileRect, band: [&mut [f32]; 3]) {
        let size = self.surface.size();
        let (x0, y0) = (tile.x0.saturating_sub(self.reach), tile.y0.saturating_sub(self.reach));
        let x1 = (tile.x0 + tile.cols + self.reach).min(size.width as usize);
        let y1 = (tile.y0 + tile.rows + self.reach).min(size.height as usize);
        if !self.rims.are_in(x0..x1, y0..y1) {
            return;
        }
        let mut region = FlowRegion::of(self.surface, self.rims, [x0, y0, x1, y1]);
        region.flow(self.steps);
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
    fn of(surface: &Surface, rims: &Rims, [x0, y0, x1, y1]: [usize; 4]) -> Self {
        let (width, height) = (x1 - x0, y1 - y0);
        let copied =
            |plane: &crate::raster::Plane<f32>| (y0..y1).flat_map(|y| &plane.row(y)[x0..x1]).copied().collect();
        let links: Vec<u8> = (y0..y1).flat_map(|y| &surface.links_plane().row(y)[x0..x1]).copied().collect();
        let over = |bit: u8, is_inside: &dyn Fn(usize) -> bool| {
            let flow = |(i, &l): (usize, &u8)| if l & bit != 0 && is_inside(i) { FLOW } else { 0.0 };
            links.iter().enumerate().map(flow).collect()
        };
        Self {
            x0,
            y0,
            width,
            height,
            normal: surface.normal_planes().map(copied),
            right: over(links::RIGHT, &|i| i % width + 1 < width),
            down: over(links::DOWN, &|i| i + width < width * height),
            distance: rims.distances([x0, y0, x1, y1]),
            links,
        }
    }
    fn index(&self, x: usize, y: usize) -> usize {
        (y - self.y0) * self.width + x - self.x0
    }
    fn flow(&mut self, steps: usize) {
        let mut next = vec![0.0; self.width * self.height];
        let nothing = vec![0.0; self.width];
        for channel in &mut self.normal {
            for _ in 0..steps {
                for y in 0..self.height {
                    let row = y * self.width..(y + 1) * self.width;
                    let beside = |y: Option<usize>| {
                        let y = y.filter(|&y| y < self.height).unwrap_or(y_of(&row, self.width));
                        &channel[y * self.width..(y + 1) * self.width]
                    };
                    let upward = if y > 0 { &self.down[row.start - self.width..row.start] } else { &nothing };
                    let sides = Sides { right: &self.right[row.clone()], up: upward, down: &self.down[row.clone()] };
                    let rows = [beside(y.checked_sub(1)), &channel[row.clone()], beside(Some(y + 1))];
                    flow_row(rows, sides, &mut next[row]);
                }
                std::mem::swap(channel, &mut next);
            }
        }
    }
    /// H of a pixel by differences to linked neighbours in the region.
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
        let across = difference(to(links::LEFT, x > 0, i.wrapping_sub(1)), to(links::RIGHT, x + 1 < self.width, i + 1));
        let along = difference(
            to(links::UP, y > 0, i.wrapping_sub(self.width)),
            to(links::DOWN, y + 1 < self.height, i + self.width),
        );
        tensor(across, along)
    }
}

fn y_of(row: &std::ops::Range<usize>, width: usize) -> usize {
    row.start / width
}

/// What flows over the sides of a row's pixels.
#[derive(Clone, Copy)]
struct Sides<'r> {
    right: &'r [f32],
    up: &'r [f32],
    down: &'r [f32],
}

crate::widest! {
    /// One step of a row: each pixel moves toward its linked neighbours.
    fn flow_row(rows: [&[f32]; 3], sides: Sides, out: &mut [f32]) {
        let n = out.len();
        let [above, here, below] = rows.map(|row| &row[..n]);
        let (right, up, down) = (&sides.right[..n], &sides.up[..n], &sides.down[..n]);
        for i in 0..n {
            out[i] = here[i] + up[i] * (above[i] - here[i]) + down[i] * (below[i] - here[i]);
        }
        for i in 0..n.saturating_sub(1) {
            out[i] += right[i] * (here[i + 1] - here[i]);
        }
        for i in 1..n {
            out[i] += right[i - 1] * (here[i - 1] - here[i]);
        }
    }
}
