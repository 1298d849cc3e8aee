//! The blur along the lines as a draft: the four pixels of a block read along one line side by side,
//! so that lines are followed for a quarter of the pixels. Floor 3.

use super::lines::{FlowJump, FlowLines, FlowPoint};
use super::{FilterPlace, FilterSource, FilterWindow, FlowBlur};
use crate::math::{Rect, Vec2};

/// The side of a block, px of the picture.
const SIDE: i32 = 2;

/// The same as the blur itself, but for where the lines of a block part.
pub fn apply(blur: &FlowBlur, place: &FilterPlace, source: &dyn FilterSource) -> Vec<[f32; 4]> {
    let out = place.out;
    let Some((surface, curvature)) = blur.surface_of(place) else {
        return source.window(out).cropped(out);
    };
    let passes = blur.passes(out, source.bounds());
    let window = source.window(passes.reads);
    let around = passes.around.intersect(window.rect());
    let part = (blocks_of(window.rect()), SIDE * place.canvas_px);
    let lines = FlowLines::of(surface, &curvature, blur.across, part);
    let (mut steps, mut jumps) = (BlockReads::new(around, passes.steps), Vec::new());
    follow_steps(&lines, passes.steps as usize, &mut steps, &mut jumps);
    let mut first = Vec::with_capacity(around.width() * around.height());
    take_means(&window, &steps, around, &mut first);
    let first = FilterWindow::new(around, first);
    let mut hops = BlockReads::new(out, passes.jumps);
    follow_jumps(&lines, (&jumps, steps.rect), &mut hops);
    let mut all = Vec::with_capacity(out.width() * out.height());
    take_means(&first, &hops, out, &mut all);
    all
}

/// The blocks that a rectangle touches.
fn blocks_of(rect: Rect) -> Rect {
    let (low, high) = (|v: i32| v.div_euclid(SIDE), |v: i32| (v + SIDE - 1).div_euclid(SIDE));
    Rect::new(low(rect.x0), low(rect.y0), high(rect.x1), high(rect.y1))
}

/// What is read along the lines through the middles of blocks, each way.
struct BlockReads {
    /// Of blocks.
    rect: Rect,
    /// Of the readings each way, of which the outermost counts in part.
    half: f32,
    /// The same in whole ones.
    count: usize,
    /// From the middle of each block to what is read, px: along its line, then against it.
    offsets: Vec<Vec2>,
    /// How many there are each way before the line ends.
    found: Vec<[u32; 2]>,
}

impl BlockReads {
    /// * `count`: the readings both ways, and the middle.
    fn new(pixels: Rect, count: f32) -> Self {
        let (rect, half) = (blocks_of(pixels), 0.5 * (count - 1.0).max(0.0));
        let (blocks, count) = (rect.width() * rect.height(), half.ceil() as usize);
        let offsets = Vec::with_capacity(2 * count * blocks);
        Self { rect, half, count, offsets, found: Vec::with_capacity(blocks) }
    }

    /// What a block reads.
    #[inline(always)]
    fn of(&self, x: i32, y: i32) -> [&[Vec2]; 2] {
        let (x, y) = (x - self.rect.x0, y - self.rect.y0);
        let block = y as usize * self.rect.width() + x as usize;
        let first = 2 * self.count * block;
        let (along, against) = self.offsets[first..first + 2 * self.count].split_at(self.count);
        let [n, m] = self.found[block];
        [&along[..n as usize], &against[..m as usize]]
    }
}

crate::widest! {
    /// Readings a pixel apart, and where lines lead in so many steps, in blocks.
    fn follow_steps(
        lines: &FlowLines,
        steps: usize,
        reads: &mut BlockReads,
        jumps: &mut Vec<[FlowJump; 2]>
    ) {
        const STEP: f32 = 1.0 / SIDE as f32;
        for y in reads.rect.y0..reads.rect.y1 {
            for x in reads.rect.x0..reads.rect.x1 {
                let start = lines.start(x, y);
                let (mut ways, mut found) = ([FlowJump::default(); 2], [0; 2]);
                for (i, heading) in [start.heading, -start.heading].into_iter().enumerate() {
                    let mut here = FlowPoint { heading, ..start };
                    let (first, mut is_whole) = (reads.offsets.len(), heading != Vec2::ZERO);
                    for step in 0..steps {
                        let next = lines.reach(here, here.at + STEP * here.heading, here.heading);
                        let Some(next) = next.filter(|_| is_whole) else {
                            is_whole = false;
                            break;
                        };
                        here = next;
                        if step < reads.count {
                            reads.offsets.push(SIDE as f32 * (here.at - start.at));
                            found[i] += 1;
                        }
                    }
                    reads.offsets.resize(first + reads.count, Vec2::ZERO);
                    if is_whole {
                        ways[i] = FlowJump { by: here.at - start.at, heading: here.heading };
                    }
                }
                reads.found.push(found);
                jumps.push(ways);
            }
        }
    }

    /// Readings a jump apart.
    ///
    /// * `jumps`: from each block of a rectangle.
    fn follow_jumps(lines: &FlowLines, jumps: (&[[FlowJump; 2]], Rect), reads: &mut BlockReads) {
        for y in reads.rect.y0..reads.rect.y1 {
            for x in reads.rect.x0..reads.rect.x1 {
                let start = lines.start(x, y);
                let mut found = [0; 2];
                for (i, heading) in [start.heading, -start.heading].into_iter().enumerate() {
                    let mut here = FlowPoint { heading, ..start };
                    let first = reads.offsets.len();
                    for _ in 0..if heading == Vec2::ZERO { 0 } else { reads.count } {
                        let Some(next) = lines.jump(here, jumps.0, jumps.1) else { break };
                        here = next;
                        reads.offsets.push(SIDE as f32 * (here.at - start.at));
                        found[i] += 1;
                    }
                    reads.offsets.resize(first + reads.count, Vec2::ZERO);
                }
                reads.found.push(found);
            }
        }
    }

    /// Means of what blocks read.
    fn take_means(
        window: &FilterWindow,
        reads: &BlockReads,
        out: Rect,
        means: &mut Vec<[f32; 4]>
    ) {
        means.resize(out.width() * out.height(), [0.0; 4]);
        let blocks = blocks_of(out);
        for y in blocks.y0..blocks.y1 {
            for x in blocks.x0..blocks.x1 {
                let corner = (SIDE * x, SIDE * y);
                let mut sums = pixels_of(corner).map(|(x, y)| window.at(x, y));
                let mut weight = 1.0;
                for offsets in reads.of(x, y) {
                    let mut left = reads.half;
                    for by in offsets {
                        let share = left.min(1.0);
                        add_readings(window, corner, *by, share, &mut sums);
                        (left, weight) = (left - 1.0, weight + share);
                    }
                }
                let per_weight = 1.0 / weight;
                for ((x, y), sum) in pixels_of(corner).into_iter().zip(&sums) {
                    if out.contains(x, y) {
                        let place = (y - out.y0) as usize * out.width() + (x - out.x0) as usize;
                        for k in 0..4 {
                            means[place][k] = per_weight * sum[k];
                        }
                    }
                }
            }
        }
    }
}

/// The pixels of the block with this corner.
#[inline(always)]
fn pixels_of((x, y): (i32, i32)) -> [(i32, i32); 4] {
    [(x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1)]
}

/// Adds a share of what each pixel of a block reads at an offset, bilinear: all of them lie alike
/// between those that they read.
#[inline(always)]
fn add_readings(
    window: &FilterWindow,
    corner: (i32, i32),
    by: Vec2,
    share: f32,
    sums: &mut [[f32; 4]; 4],
) {
    let (left, top) = (by.x.floor(), by.y.floor());
    let (fx, fy) = (by.x - left, by.y - top);
    let first = (corner.0 + left as i32, corner.1 + top as i32);
    let Some([upper, middle, lower]) = window.three_rows(first) else {
        for ((x, y), sum) in pixels_of(corner).into_iter().zip(sums) {
            let reading = window.sample(x as f32 + 0.5 + by.x, y as f32 + 0.5 + by.y);
            for k in 0..4 {
                sum[k] += share * reading[k];
            }
        }
        return;
    };
    let (above, below) = (share * (1.0 - fy), share * fy);
    let weights = [above * (1.0 - fx), above * fx, below * (1.0 - fx), below * fx];
    for (pair, rows) in sums.chunks_exact_mut(2).zip([[upper, middle], [middle, lower]]) {
        for (i, sum) in pair.iter_mut().enumerate() {
            let [a, b, c, d] = [rows[0][i], rows[0][i + 1], rows[1][i], rows[1][i + 1]];
            for k in 0..4 {
                sum[k] += (weights[0] * a[k] + weights[1] * b[k])
                    + (weights[2] * c[k] + weights[3] * d[k]);
            }
        }
    }
}
