//! A blur along the lines of the surface, which stops at contours. Floor 3. On premultiplied encoded
//! pixels.
//!
//! Two means of few readings make one of many: of readings a pixel apart, then of these, as far
//! apart as the first mean is long. The second one jumps: where the line through a pixel leads is
//! found once, together with the first mean.

mod blocks;
mod lines;

use super::draft::{SoftKernel, detail_of_mean};
use super::window::{FilterSource, FilterWindow};
use super::{FilterKernel, FilterPlace};
use crate::math::{Rect, Vec2, vec2};
use crate::paint::adjustment::parameters::{
    NumberParameter, ParameterVisitor, Parameters, parameter_name,
};
use crate::surface::{Curvature, Scene, Surface};
use lines::{FlowJump, FlowLines, FlowPoint, is_one_piece};
use std::sync::Arc;

/// Smeared along the lines in which the surface bends least, or across them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlowBlur {
    /// Of the way, px.
    pub length: f32,
    /// How smooth the lines are: the standard deviation of a blur of the normals, px.
    pub smooth: f32,
    /// Along the lines in which it bends most.
    pub across: bool,
}

impl Default for FlowBlur {
    fn default() -> Self {
        Self { length: 24.0, smooth: 4.0, across: false }
    }
}

impl Parameters for FlowBlur {
    fn visit(&mut self, v: &mut dyn ParameterVisitor) {
        let length = parameter_name("length", "Length", "How far paint is smeared");
        let length = NumberParameter::whole(length, 0.0, 200.0, 24.0).decimals(1).px();
        v.number(length, &mut self.length);
        let smooth =
            parameter_name("smooth", "Smoothness", "How much small bumps are left out of the flow");
        let smooth = NumberParameter::whole(smooth, 0.0, 100.0, 4.0).decimals(1).px();
        v.number(smooth, &mut self.smooth);
        let across = parameter_name("across", "Across", "Around the form and not along it");
        v.flag(across, false, &mut self.across);
    }
}

impl FilterKernel for FlowBlur {
    fn reach(&self, _: Rect, _: Rect) -> f32 {
        self.length.max(0.0) * 0.5 + 4.0
    }

    fn warm(&self, scene: &Scene) {
        let _ = scene.surface.as_deref().map(|surface| surface.curvature(self.smooth));
    }

    fn apply(&self, place: &FilterPlace, source: &dyn FilterSource) -> Vec<[f32; 4]> {
        let out = place.out;
        let Some((surface, curvature)) = self.surface_of(place) else {
            return source.window(out).cropped(out);
        };
        let passes = self.passes(out, source.bounds());
        let window = source.window(passes.reads);
        let lines =
            FlowLines::of(surface, &curvature, self.across, (window.rect(), place.canvas_px));
        let around = passes.around.intersect(window.rect());
        let (mut means, mut ways) = (Vec::new(), Vec::new());
        // Jumps begin no farther out than this.
        let jumping = out.grown((0.5 * self.length - passes.steps).max(0.0).ceil() as i32 + 2);
        mean_along(&lines, &window, (around, jumping), passes.steps, (&mut means, &mut ways));
        let first = FilterWindow::new(around, means);
        let mut all = Vec::new();
        mean_of_jumps(&lines, (&first, &ways), out, passes.jumps, &mut all);
        all
    }

    fn as_soft(&self) -> Option<&dyn SoftKernel> {
        Some(self)
    }
}

/// How the blur of a rectangle is found.
struct FlowPasses {
    /// Steps of a pixel in a jump.
    steps: f32,
    jumps: f32,
    /// Where the first means are read.
    around: Rect,
    /// What they read.
    reads: Rect,
}

impl FlowBlur {
    fn passes(&self, out: Rect, bounds: Rect) -> FlowPasses {
        let steps = self.length.sqrt().ceil().max(1.0);
        let jumps = (self.length / steps).ceil().max(1.0);
        let around = out.grown((0.5 * self.length).ceil() as i32 + 2).intersect(bounds);
        let reads = around.grown((0.5 * steps).ceil() as i32 + 2).intersect(bounds);
        let reads = reads.intersect(out.grown(self.reach(out, out).ceil() as i32)).union(out);
        FlowPasses { steps, jumps, around, reads }
    }

    /// What it follows, if it smears anything. The surface has its own size, whatever that of the
    /// picture is.
    fn surface_of<'s>(&self, place: &FilterPlace<'s>) -> Option<(&'s Surface, Arc<Curvature>)> {
        let surface = place.scene.surface.as_deref().filter(|_| self.length > 1.0)?;
        Some((surface, surface.curvature(self.smooth * place.canvas_px as f32)))
    }
}

impl SoftKernel for FlowBlur {
    fn apply_as_draft(&self, place: &FilterPlace, source: &dyn FilterSource) -> Vec<[f32; 4]> {
        blocks::apply(self, place, source)
    }

    /// Where nothing is smeared, and at contours, which stay.
    fn detail_left(&self, place: &FilterPlace, _: Rect) -> Vec<f32> {
        let (out, side) = (place.out, place.canvas_px);
        let Some(surface) = place.scene.surface.as_deref() else {
            return vec![1.0; out.width() * out.height()];
        };
        let smeared = detail_of_mean(self.length * side as f32);
        let mut all = Vec::with_capacity(out.width() * out.height());
        for y in out.y0..out.y1 {
            all.extend((out.x0..out.x1).map(|x| {
                let square = Rect::new(x * side, y * side, (x + 1) * side, (y + 1) * side);
                if is_one_piece(surface, square) { smeared } else { 1.0 }
            }));
        }
        all
    }
}

crate::widest! {
    /// Means of readings a pixel apart, and where lines lead in so many steps.
    ///
    /// * `places`: of the means, and from where lines are followed that far.
    fn mean_along(
        lines: &FlowLines,
        window: &FilterWindow,
        places: (Rect, Rect),
        steps: f32,
        found: (&mut Vec<[f32; 4]>, &mut Vec<[FlowJump; 2]>)
    ) {
        let ((out, jumping), (means, ways)) = (places, found);
        let corner = vec2(lines.rect.x0 as f32, lines.rect.y0 as f32);
        let half = 0.5 * (steps - 1.0);
        for y in out.y0..out.y1 {
            for x in out.x0..out.x1 {
                let start = lines.start(x, y);
                let (mut sum, mut weight) = (window.at(x, y), 1.0);
                let mut way = [FlowJump::default(); 2];
                let count = if jumping.contains(x, y) { steps } else { half.ceil() } as i32;
                if start.heading != Vec2::ZERO {
                    for (way, heading) in way.iter_mut().zip([start.heading, -start.heading]) {
                        let mut here = FlowPoint { heading, ..start };
                        let (mut left, mut is_whole) = (half, true);
                        for _ in 0..count {
                            let Some(next) = lines.step(here) else {
                                is_whole = false;
                                break;
                            };
                            here = next;
                            if left > 0.0 {
                                let share = left.min(1.0);
                                let reading = window.sample(corner.x + here.at.x, corner.y + here.at.y);
                                for k in 0..4 {
                                    sum[k] += share * reading[k];
                                }
                                (left, weight) = (left - 1.0, weight + share);
                            }
                        }
                        if is_whole {
                            *way = FlowJump { by: here.at - start.at, heading: here.heading };
                        }
                    }
                }
                means.push(sum.map(|v| v / weight));
                ways.push(way);
            }
        }
    }

    /// Means of readings a jump apart; the outermost count in part.
    fn mean_of_jumps(
        lines: &FlowLines,
        first: (&FilterWindow, &[[FlowJump; 2]]),
        out: Rect,
        count: f32,
        means: &mut Vec<[f32; 4]>
    ) {
        let (window, ways) = first;
        let corner = vec2(lines.rect.x0 as f32, lines.rect.y0 as f32);
        for y in out.y0..out.y1 {
            for x in out.x0..out.x1 {
                let start = lines.start(x, y);
                let (mut sum, mut weight) = (window.at(x, y), 1.0);
                if start.heading != Vec2::ZERO {
                    for heading in [start.heading, -start.heading] {
                        let mut here = FlowPoint { heading, ..start };
                        let mut left = 0.5 * (count - 1.0);
                        while left > 0.0 {
                            let Some(next) = lines.jump(here, ways, window.rect()) else { break };
                            here = next;
                            let share = left.min(1.0);
                            let reading = window.sample(corner.x + here.at.x, corner.y + here.at.y);
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
