//! Patches: the piece of the image plane under each pixel, from D differenced within one piece of
//! surface. Floor 3. Not here: averaging a picture over them (`raster::sampler`).

use crate::math::{Affine2, Rect};
use crate::raster::sampler::PatchRow;
use crate::surface::{Scene, Surface, deformation::DeformedRect, links};

/// The four neighbors a pixel is differenced with, in the order of [`PatchRow::edges`].
const SIDES: [(u8, i32, i32); 4] =
    [(links::LEFT, -1, 0), (links::RIGHT, 1, 0), (links::UP, 0, -1), (links::DOWN, 0, 1)];

/// The patches of a row of pixels, refilled row by row.
#[derive(Default)]
pub struct Patches {
    bits: Vec<u8>,
    edges: [[Vec<f32>; 2]; 4],
}

impl Patches {
    /// The patches of row `y` of `rect`.
    ///
    /// * `positions`: P⁻¹(D(q)) of `rect` grown by one pixel on every side, in texels.
    /// * `texels_from_canvas`: P⁻¹. Toward a neighbor that does not continue the surface the maps
    ///   count as constant: the edge lies where an unbent picture's would.
    pub fn row<'a>(
        &'a mut self,
        scene: &Scene,
        rect: Rect,
        y: i32,
        positions: &'a DeformedRect,
        texels_from_canvas: Affine2,
    ) -> PatchRow<'a> {
        let n = rect.width();
        let stride = n + 2;
        self.bits.resize(n, 0);
        match &scene.surface {
            Some(surface) => links_or_outside(surface, rect.x0, y, &mut self.bits),
            None => self.bits.fill(15),
        }
        let here = (y - rect.y0 + 1) as usize * stride + 1;
        for edge in self.edges.iter_mut().flatten() {
            edge.resize(n, 0.0);
        }
        if are_linked(&self.bits) {
            // Most rows lie within one piece of surface.
            for (axis, plane) in [&positions.x, &positions.y].into_iter().enumerate() {
                let row = |dy: usize| &plane[here - stride + dy * stride..][..n];
                let [left, right, up, down] = self.edges.each_mut().map(|edge| &mut edge[axis][..]);
                fill_linked_edges(
                    &plane[here - 1..][..n + 2],
                    row(0),
                    row(2),
                    left,
                    right,
                    up,
                    down,
                );
            }
        } else {
            self.edges_where_linked(positions, (here, stride), texels_from_canvas);
        }
        let edges = self.edges.each_ref().map(|[x, y]| [&x[..], &y[..]]);
        PatchRow { x: &positions.x[here..here + n], y: &positions.y[here..here + n], edges }
    }

    /// The edges of a row whose first pixel is at `here`, if some neighbors do not continue the
    /// surface.
    fn edges_where_linked(
        &mut self,
        positions: &DeformedRect,
        (here, stride): (usize, usize),
        texels_from_canvas: Affine2,
    ) {
        let n = self.bits.len();
        for (edge, (bit, dx, dy)) in self.edges.iter_mut().zip(SIDES) {
            let there = here.wrapping_add_signed(dy as isize * stride as isize + dx as isize);
            let still =
                texels_from_canvas.matrix2.mul_vec2(crate::math::vec2(dx as f32, dy as f32)) * 0.5;
            for (axis, (plane, still)) in
                [(&positions.x, still.x), (&positions.y, still.y)].into_iter().enumerate()
            {
                half_edges(
                    &plane[here..here + n],
                    &plane[there..there + n],
                    &self.bits,
                    bit,
                    still,
                    &mut edge[axis],
                );
            }
        }
    }
}

/// Every pixel is linked to all its neighbors. Eight pixels a word: rows are short.
fn are_linked(bits: &[u8]) -> bool {
    let (words, rest) = bits.as_chunks::<8>();
    let all = words.iter().fold(u64::MAX, |all, word| all & u64::from_ne_bytes(*word));
    rest.iter().fold(u8::MAX, |all, bits| all & bits)
        & all.to_ne_bytes().into_iter().fold(u8::MAX, |a, b| a & b)
        & 15
        == 15
}

/// The links of a row's pixels. Off the surface D is smooth too: pixels there are linked to
/// neighbors that are also off it.
fn links_or_outside(surface: &Surface, x0: i32, y: i32, bits: &mut [u8]) {
    let (x1, map) = (x0 + bits.len() as i32, surface.size().rect());
    if map.contains(x0, y) && map.contains(x1 - 1, y) {
        let row = x0 as usize..x1 as usize;
        if surface.coverage_plane().row(y as usize)[row.clone()]
            .iter()
            .fold(u8::MAX, |least, &c| least.min(c))
            > 0
        {
            return bits.copy_from_slice(&surface.smooth_links_plane().row(y as usize)[row]);
        }
    }
    let covered = |x: i32, y: i32| surface.coverage_plane().get(x, y).is_some_and(|c| c > 0);
    for (x, bits) in (x0..).zip(bits) {
        *bits = if covered(x, y) {
            surface.smooth_links_plane().get(x, y).unwrap_or(0)
        } else {
            SIDES
                .iter()
                .filter(|(_, dx, dy)| !covered(x + dx, y + dy))
                .fold(0, |bits, side| bits | side.0)
        };
    }
}

crate::widest! {
    /// Halfway to the left, right, upper and lower neighbors of a row that is linked to all of
    /// them; `row` has one pixel more at each end.
    fn fill_linked_edges(
        row: &[f32],
        above: &[f32],
        below: &[f32],
        left: &mut [f32],
        right: &mut [f32],
        up: &mut [f32],
        down: &mut [f32],
    ) {
        let n = left.len();
        let (row, above, below) = (&row[..n + 2], &above[..n], &below[..n]);
        let (right, up, down) = (&mut right[..n], &mut up[..n], &mut down[..n]);
        for k in 0..n {
            let here = row[k + 1];
            left[k] = (row[k] - here) * 0.5;
            right[k] = (row[k + 2] - here) * 0.5;
            up[k] = (above[k] - here) * 0.5;
            down[k] = (below[k] - here) * 0.5;
        }
    }

    /// Halfway to the neighbor if it is linked, else `still`.
    fn half_edges(here: &[f32], there: &[f32], bits: &[u8], bit: u8, still: f32, out: &mut [f32]) {
        let n = out.len();
        let (here, there, bits) = (&here[..n], &there[..n], &bits[..n]);
        for k in 0..n {
            out[k] = if bits[k] & bit != 0 { (there[k] - here[k]) * 0.5 } else { still };
        }
    }
}
