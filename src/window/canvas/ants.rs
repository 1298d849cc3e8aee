//! The outline of the selection: dashes that march, one screen point wide at any zoom. Floor 7. The
//! outline is found tile by tile (`raster::coverage::contour`) and cached; only tiles in view are
//! drawn.

use super::unwrapped::OnSheet;
use crate::math::{Affine2, Rect, Vec2, vec2};
use crate::raster::coverage::contour::{self, Run, RunsKey};
use crate::raster::{CoverageGrid, TileAt};
use crate::session::Session;
use eframe::egui::{
    self, Color32, ColorImage, Mesh, Painter, Shape, TextureHandle, TextureOptions,
    TextureWrapMode, pos2,
};
use std::collections::HashMap;
use std::sync::Arc;
use std::time::Duration;

/// A dash and the gap after it, screen points.
const DASHES_PT: f32 = 8.0;
/// How fast they march, screen points a second.
const PACE_PT: f32 = 16.0;
/// The time between two of their frames.
const FRAME: Duration = Duration::from_millis(60);
/// The approximate number of pieces drawn in a frame.
const MOST_PIECES: usize = 24_000;
/// The number of tiles whose outlines are kept.
const KEPT: usize = 20_000;

/// The outlines of the tiles of the selection that is shown.
#[derive(Default)]
pub struct Ants {
    /// Kept, so that no other tile gets the address of one of its own.
    grid: CoverageGrid,
    runs: HashMap<RunsKey, Arc<Vec<Run>>>,
    dashes: Option<TextureHandle>,
    /// What is selected, canvas px.
    covered: Option<Rect>,
    /// How many levels coarser a ragged outline is drawn, so that a frame takes no longer.
    coarser: u32,
    /// The last level that the zoom needed.
    finest: u32,
}

impl Ants {
    /// The smallest rectangle that holds all that is selected, as last drawn.
    pub fn bounds(&self) -> Option<Rect> {
        self.covered
    }

    /// Draws the outline of the selection as shown. `visible`: the canvas pixels in view.
    pub fn draw(
        &mut self,
        painter: &Painter,
        session: &Session,
        screen_from_canvas: Affine2,
        visible: Rect,
    ) {
        let scale = screen_from_canvas.matrix2.x_axis.length();
        self.draw_runs(painter, session, scale, visible, |mesh, run, phase| {
            let ends = ends(run).map(|p| screen_from_canvas.transform_point2(p));
            line(mesh, ends, phase);
        });
    }

    /// The same on the unwrapped sheet.
    pub fn draw_unwrapped(
        &mut self,
        painter: &Painter,
        session: &Session,
        on_sheet: OnSheet,
        screen_from_sheet: Affine2,
    ) {
        let scale = screen_from_sheet.matrix2.x_axis.length();
        self.draw_runs(
            painter,
            session,
            scale,
            on_sheet.surface.size().rect(),
            |mesh, run, phase| {
                let [from, to] = ends(run);
                for piece in on_sheet.line(from, to) {
                    line(mesh, piece.map(|p| screen_from_sheet.transform_point2(p)), phase);
                }
            },
        );
    }

    /// `scale`: screen points per canvas pixel.
    fn draw_runs(
        &mut self,
        painter: &Painter,
        session: &Session,
        scale: f32,
        visible: Rect,
        draw: impl Fn(&mut Mesh, &Run, f32),
    ) {
        let selected = session.shown_document().and_then(|document| document.active_coverage());
        self.follow(selected);
        let Some(grid) = selected else { return };
        if session.hides_selection || session.active().is_some_and(|open| open.quick_mask) {
            return;
        }
        // Blocks of at least a screen point.
        let finest = (1.0 / scale.max(1e-6)).log2().floor().max(0.0) as u32;
        if finest != self.finest {
            (self.finest, self.coarser) = (finest, 0);
        }
        let level = finest + self.coarser;
        let bounds = grid.bounds();
        let reach = Rect { x1: bounds.x1 + 1, y1: bounds.y1 + 1, ..bounds }.intersect(visible);
        let time_secs = painter.ctx().input(|input| input.time) as f32;
        let mut mesh = Mesh::with_texture(self.dashes(painter.ctx()));
        let phase = (time_secs * PACE_PT / DASHES_PT).fract();
        for at in TileAt::covering(reach) {
            for run in self.runs_of(grid, at, level).iter() {
                draw(&mut mesh, run, phase);
            }
        }
        // Four corners a piece.
        if mesh.vertices.len() > 4 * MOST_PIECES && level < contour::COARSEST {
            self.coarser += 1;
        }
        painter.add(Shape::mesh(mesh));
        painter.ctx().request_repaint_after(FRAME);
    }

    /// Switches to another selection, and drops what is not part of it. The old one lives until
    /// then, so that tiles of both have different addresses.
    fn follow(&mut self, selected: Option<&CoverageGrid>) {
        let Some(grid) = selected else {
            return *self = Self { dashes: self.dashes.take(), ..Self::default() };
        };
        if self.covered.is_some() && grid.ptr_eq(&self.grid) {
            return;
        }
        self.runs.retain(|key, _| key.is_of(grid));
        (self.grid, self.covered, self.coarser) = (grid.clone(), Some(grid.covered_rect()), 0);
    }

    fn runs_of(&mut self, grid: &CoverageGrid, at: TileAt, level: u32) -> Arc<Vec<Run>> {
        if self.runs.len() > KEPT {
            self.runs.clear();
        }
        let key = contour::key(grid, at, level);
        self.runs.entry(key).or_insert_with(|| Arc::new(contour::runs(grid, at, level))).clone()
    }

    fn dashes(&mut self, ctx: &egui::Context) -> egui::TextureId {
        let texture = self.dashes.get_or_insert_with(|| {
            let pixel = |i: usize| if i < 4 { Color32::WHITE } else { Color32::BLACK };
            let image = ColorImage::new([8, 1], (0..8).map(pixel).collect());
            let options =
                TextureOptions { wrap_mode: TextureWrapMode::Repeat, ..TextureOptions::NEAREST };
            ctx.load_texture("dashes", image, options)
        });
        texture.id()
    }
}

/// Where a piece of the outline begins and ends, canvas px.
fn ends(run: &Run) -> [Vec2; 2] {
    let from = vec2(run.x as f32, run.y as f32);
    let along =
        if run.is_vertical { vec2(0.0, run.length as f32) } else { vec2(run.length as f32, 0.0) };
    [from, from + along]
}

/// A piece of the outline as a band of one screen point. Its dashes follow its place on the screen,
/// so that they continue from piece to piece.
fn line(mesh: &mut Mesh, [a, b]: [Vec2; 2], phase: f32) {
    let way = (b - a).normalize_or_zero();
    // Half a point longer at both ends, so that corners are closed.
    let (a, b, aside) = (a - 0.5 * way, b + 0.5 * way, 0.5 * vec2(-way.y, way.x));
    let first = mesh.vertices.len() as u32;
    for p in [a - aside, a + aside, b + aside, b - aside] {
        mesh.vertices.push(vertex(p, phase));
    }
    mesh.add_triangle(first, first + 1, first + 2);
    mesh.add_triangle(first, first + 2, first + 3);
}

fn vertex(p: Vec2, phase: f32) -> egui::epaint::Vertex {
    let uv = pos2((p.x + p.y) / DASHES_PT - phase, 0.5);
    egui::epaint::Vertex { pos: pos2(p.x, p.y), uv, color: Color32::WHITE }
}
