//! Links: which neighbouring pixels belong to the same piece of surface, so that nothing is differenced across a depth
//! jump or the mask's edge.
//! Floor 2.

use crate::raster::Plane;

/// The neighbour at the left (x − 1) continues this pixel's surface.
pub const LEFT: u8 = 1;
/// The neighbour at the right (x + 1).
pub const RIGHT: u8 = 2;
/// The neighbour above (y − 1).
pub const UP: u8 = 4;
/// The neighbour below (y + 1).
pub const DOWN: u8 = 8;

/// Slope of the surface in pixels of depth per pixel, image axes, away from the viewer.
///
/// A surface z(x, y) with normal n recedes by n̄/n_z (depth grows where n̄ points).
fn slope(nbar: f32, nz: f32) -> f32 {
    nbar / nz.max(0.05)
}

/// Z in pixels: the median ratio of the slope told by the normals to the step of the depth, over gently sloped pixels.
/// One canvas length where the two maps say nothing of each other.
pub fn depth_range_px(
    nbar_x: &Plane<f32>,
    nbar_y: &Plane<f32>,
    nz: &Plane<f32>,
    depth: &Plane<f32>,
    coverage: &Plane<u8>,
) -> f32 {
    let size = depth.size();
    // Every pixel of a small map, a spread sample of a large one: the median needs no more.
    let step = (size.area() / 250_000).max(1);
    let mut ratios: Vec<f32> = (0..size.area())
        .step_by(step)
        .filter_map(|i| {
            let (x, y) = (i % size.width as usize, i / size.width as usize);
            if x == 0 || y == 0 || x + 1 >= depth.width() || y + 1 >= depth.height() {
                return None;
            }
            let inside =
                [(x - 1, y), (x + 1, y), (x, y - 1), (x, y + 1)].iter().all(|&(x, y)| coverage.at(x, y) == 255);
            let told = slope(nbar_x.at(x, y), nz.at(x, y)).hypot(slope(nbar_y.at(x, y), nz.at(x, y)));
            let dx = (depth.at(x + 1, y) - depth.at(x - 1, y)) * 0.5;
            let dy = (depth.at(x, y + 1) - depth.at(x, y - 1)) * 0.5;
            let seen = dx.hypot(dy);
            (inside && (0.2..2.0).contains(&told) && seen > 1e-6).then(|| told / seen)
        })
        .collect();
    if ratios.len() < 16 {
        return size.longer_side();
    }
    let mid = ratios.len() / 2;
    *ratios.select_nth_unstable_by(mid, f32::total_cmp).1
}

/// Finds the links of every pixel.
///
/// Between two neighbours of a smooth surface the step in depth lies between the slopes that their normals tell (the
/// mean value theorem); a step far outside is a jump. Half a slope and 1.5 px are granted for curvature and coarse depth.
pub fn find(
    nbar_x: &Plane<f32>,
    nbar_y: &Plane<f32>,
    nz: &Plane<f32>,
    depth: &Plane<f32>,
    coverage: &Plane<u8>,
    depth_range_px: f32,
) -> Plane<u8> {
    let size = depth.size();
    let joined = |nbar: &Plane<f32>, a: (usize, usize), b: (usize, usize)| {
        if coverage.at(a.0, a.1) == 0 || coverage.at(b.0, b.1) == 0 {
            return false;
        }
        let (sa, sb) = (slope(nbar.at(a.0, a.1), nz.at(a.0, a.1)), slope(nbar.at(b.0, b.1), nz.at(b.0, b.1)));
        let step = (depth.at(b.0, b.1) - depth.at(a.0, a.1)) * depth_range_px;
        let tolerance = 1.5 + 0.5 * sa.abs().max(sb.abs());
        step > sa.min(sb) - tolerance && step < sa.max(sb) + tolerance
    };
    Plane::from_fn(size, |x, y| {
        let mut bits = 0;
        if x > 0 && joined(nbar_x, (x - 1, y), (x, y)) {
            bits |= LEFT;
        }
        if x + 1 < size.width as usize && joined(nbar_x, (x, y), (x + 1, y)) {
            bits |= RIGHT;
        }
        if y > 0 && joined(nbar_y, (x, y - 1), (x, y)) {
            bits |= UP;
        }
        if y + 1 < size.height as usize && joined(nbar_y, (x, y), (x, y + 1)) {
            bits |= DOWN;
        }
        bits
    })
}
