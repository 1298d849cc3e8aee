//! The blur along the lines as a draft: the four pixels of a block follow one line side by side, so
//! that lines are found for a quarter of the pixels. Floor 3.

use super::lines::{FlowJump, FlowLines, FlowPoint};
use super::{FilterPlace, FilterSource, FilterWindow, FlowBlur};
use crate::math::{Rect, Vec2, vec2};

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
    let mut ways = BlockWays::new(blocks_of(around), passes.steps);
    ways.follow(&lines);
    let mut means = Vec::with_capacity(around.width() * around.height());
    mean_along(&window, &ways, around, &mut means);
    let first = FilterWindow::new(around, means);
    let mut all = Vec::with_capacity(out.width() * out.height());
    mean_of_jumps(&lines, (&first, &ways), out, passes.jumps, &mut all);
    all
}

/// The blocks that a rectangle touches.
fn blocks_of(rect: Rect) -> Rect {
    let (low, high) = (|v: i32| v.div_euclid(SIDE), |v: i32| (v + SIDE - 1).div_euclid(SIDE));
    Rect::new(low(rect.x0), low(rect.y0), high(rect.x1), high(rect.y1))
}

/// Where the lines through the middles of blocks lead.
struct BlockWays {
    /// Of blocks.
    rect: Rect,
    /// Steps of a pixel in a jump.
    steps: f32,
    /// How many of them are read, each way.
    readings: usize,
    /// Of each block and each of both ways, from its middle to what is read, px; and how many there
    /// are before the line ends.
    reads: Vec<Vec2>,
    counts: Vec<[u32; 2]>,
    /// Jumps, in blocks.
    jumps: Vec<[FlowJump; 2]>,
}

impl BlockWays {
    fn new(rect: Rect, steps: f32) -> Self {
        let (count, readings) =
            (rect.width() * rect.height(), (0.5 * (steps - 1.0)).ceil().max(0.0) as usize);
        Self {
            rect,
            steps,
            readings,
            reads: Vec::with_capacity(2 * readings * count),
            counts: Vec::with_capacity(count),
            jumps: Vec::with_capacity(count),
        }
    }

    /// What is read from a block each way.
    #[inline(always)]
    fn reads_from(&self, x: i32, y: i32) -> [&[Vec2]; 2] {
        let block = y.div_euclid(SIDE) - self.rect.y0;
        let block =
            block as usize * self.rect.width() + (x.div_euclid(SIDE) - self.rect.x0) as usize;
        let first = 2 * self.readings * block;
        let (along, against) = self.reads[first..first + 2 * self.readings].split_at(self.readings);
        let [n, m] = self.counts[block];
        [&along[..n as usize], &against[..m as usize]]
    }

    fn follow(&mut self, lines: &FlowLines) {
        follow(self, lines);
    }
}

crate::widest! {
    fn follow(ways: &mut BlockWays, lines: &FlowLines) {
        const STEP: f32 = 1.0 / SIDE as f32;
        for y in ways.rect.y0..ways.rect.y1 {
            for x in ways.rect.x0..ways.rect.x1 {
                let start = lines.start(x, y);
                let (mut jumps, mut counts) = ([FlowJump::default(); 2], [0; 2]);
                for (i, heading) in [start.heading, -start.heading].into_iter().enumerate() {
                    let mut here = FlowPoint { heading, ..start };
                    let (first, mut is_whole) = (ways.reads.len(), heading != Vec2::ZERO);
                    for step in 0..ways.steps as usize {
                        let next = lines.reach(here, here.at + STEP * here.heading, here.heading);
                        let Some(next) = next.filter(|_| is_whole) else {
                            is_whole = false;
                            break;
                        };
                        here = next;
                        if step < ways.readings {
                            ways.reads.push(SIDE as f32 * (here.at - start.at));
                            counts[i] += 1;
                        }
                    }
                    ways.reads.resize(first + ways.readings, Vec2::ZERO);
                    if is_whole {
                        jumps[i] = FlowJump { by: here.at - start.at, heading: here.heading };
                    }
                }
                ways.counts.push(counts);
                ways.jumps.push(jumps);
            }
        }
    }

    /// Means of readings a pixel apart; the outermost count in part.
    fn mean_along(window: &FilterWindow, ways: &BlockWays, out: Rect, means: &mut Vec<[f32; 4]>) {
        let half = 0.5 * (ways.steps - 1.0);
        for y in out.y0..out.y1 {
            for x in out.x0..out.x1 {
                let center = vec2(x as f32 + 0.5, y as f32 + 0.5);
                let (mut sum, mut weight) = (window.at(x, y), 1.0);
                for reads in ways.reads_from(x, y) {
                    let mut left = half;
                    for by in reads {
                        let share = left.min(1.0);
                        let at = center + *by;
                        let reading = window.sample(at.x, at.y);
                        for k in 0..4 {
                            sum[k] += share * reading[k];
                        }
                        (left, weight) = (left - 1.0, weight + share);
                    }
                }
                means.push(sum.map(|v| v / weight));
            }
        }
    }

    /// Means of readings a jump apart; the outermost count in part.
    fn mean_of_jumps(
        lines: &FlowLines,
        first: (&FilterWindow, &BlockWays),
        out: Rect,
        count: f32,
        means: &mut Vec<[f32; 4]>
    ) {
        let (window, ways) = first;
        let corner = vec2(lines.rect.x0 as f32, lines.rect.y0 as f32);
        for y in out.y0..out.y1 {
            for x in out.x0..out.x1 {
                let block = lines.start(x.div_euclid(SIDE), y.div_euclid(SIDE));
                let at = vec2(x as f32 + 0.5, y as f32 + 0.5) / SIDE as f32 - corner;
                let (mut sum, mut weight) = (window.at(x, y), 1.0);
                if block.heading != Vec2::ZERO {
                    for heading in [block.heading, -block.heading] {
                        let mut here = FlowPoint { at, heading, ..block };
                        let mut left = 0.5 * (count - 1.0);
                        while left > 0.0 {
                            let Some(next) = lines.jump(here, &ways.jumps, ways.rect) else { break };
                            here = next;
                            let share = left.min(1.0);
                            let read = SIDE as f32 * (corner + here.at);
                            let reading = window.sample(read.x, read.y);
                            for k in 0..4 {
                                sum[k] += share * reading[k];
                            }
                            (left, weight) = (left - 1.0, weight + share);
                        }
                    }
                }
                means.push(sum.map(|v| v / weight));
            }
        }
    }
}
