//! Strokes of hatching: where tone asks for a line, and how wide it is there. Floor 3. Lines that
//! stay do not move when the light does: tone decides width alone.

use super::brush_coverage::BrushCoverage;
use super::{FormDrawing, TonePicture};
use crate::math::{Size, Vec2, Vec3, parallel, vec3};
use crate::paint::brush::Brush;
use crate::paint::dynamics::{Curve, Input, Property};
use crate::paint::stroke::Stroke;
use crate::raster::Plane;
use crate::surface::Surface;
use crate::surface::form_lines::{LinePoint, SmoothNormals};
use crate::surface::hatching::{HatchLine, HatchPoint, HatchSettings, HatchTone};
use crate::surface::shadow::{ShadowLamp, ShareMap};
use std::f32::consts::PI;
use std::sync::Arc;

/// Thinner lines are not drawn, px.
const LEAST_PX: f32 = 0.15;
/// The shortest stroke, points.
const SHORTEST: usize = 5;
/// Widths are the mean over so many points on both sides.
const MEAN: usize = 3;
/// Steps of darkness whose coverage is known; between them it goes straight.
const DARK_STEPS: usize = 512;
/// How far light reaches around a form, of n·ℓ.
const WRAP: f32 = 0.1;
/// The share of light that comes from everywhere.
const AROUND: f32 = 0.18;
/// Shadows that are kept.
const KEPT: usize = 3;
/// How far what makes hollows dark may be, in longer sides.
const HOLLOW: f32 = 0.04;

/// How dark hatching is to be: under its light, or as a picture is.
pub(super) struct FormTone<'s> {
    settings: &'s HatchSettings,
    of: ToneOf<'s>,
    /// What lines of each level cover, by how dark it is: [`HatchSettings::coverages`] in steps.
    shares: Vec<Vec<f32>>,
}

enum ToneOf<'s> {
    /// How light each pixel is, `[0, 1]`: lines read it in no order, so that it is made first.
    Light(Plane<f32>),
    Picture(&'s TonePicture, Size),
}

/// A surface under the light of a hatching.
struct LitForm<'s> {
    settings: &'s HatchSettings,
    normals: Arc<SmoothNormals>,
    shadow: Option<Arc<ShareMap>>,
    open: Option<Arc<Plane<f32>>>,
    /// Toward the light, image axes.
    toward: Vec3,
}

impl<'s> FormTone<'s> {
    pub fn of(
        surface: &Surface,
        settings: &'s HatchSettings,
        picture: Option<&'s TonePicture>,
    ) -> Self {
        let of = match picture.filter(|_| settings.tone != HatchTone::Light) {
            Some(picture) => ToneOf::Picture(picture, surface.size()),
            None => {
                let form = LitForm::of(surface, settings);
                ToneOf::Light(Plane::from_fn(surface.size(), |x, y| form.tone(x, y)))
            }
        };
        let levels = settings.levels().len();
        let mut shares = vec![Vec::with_capacity(DARK_STEPS + 2); levels];
        for step in 0..DARK_STEPS + 2 {
            let all = settings.coverages(step as f32 / DARK_STEPS as f32);
            shares.iter_mut().zip(all).for_each(|(level, share)| level.push(share));
        }
        Self { settings, of, shares }
    }

    /// What lines of a level cover where the tone is so dark, `[0, 1]`.
    fn share(&self, dark: f32, level: u8) -> f32 {
        let Some(shares) = self.shares.get(usize::from(level)) else { return 0.0 };
        let along = dark.max(0.0).min(1.0) * DARK_STEPS as f32;
        let step = along as usize;
        shares[step] + (along - step as f32) * (shares[step + 1] - shares[step])
    }

    /// How dark the drawing is to be at a place, `[0, 1]`.
    pub fn dark(&self, at: Vec2) -> f32 {
        let tone = match &self.of {
            ToneOf::Light(light) => {
                let pixel = |v: f32, n: usize| (v.max(0.0) as usize).min(n.saturating_sub(1));
                light.at(pixel(at.x, light.width()), pixel(at.y, light.height()))
            }
            ToneOf::Picture(picture, canvas) => picture.at(at, *canvas),
        };
        let paper = self.settings.paper.max(1e-3);
        self.settings.darkness * ((paper - tone) / paper).clamp(0.0, 1.0)
    }
}

impl<'s> LitForm<'s> {
    fn of(surface: &Surface, settings: &'s HatchSettings) -> Self {
        let side = surface.size().longer_side();
        let light = settings.light.normalize_or(Vec3::Z);
        let lamp = ShadowLamp::of_drawing(light, surface.size());
        Self {
            settings,
            normals: surface.smooth_normals(settings.smooth),
            shadow: (settings.shadow > 0.0).then(|| surface.shadow(&lamp, KEPT)),
            open: (settings.hollows > 0.0).then(|| surface.occlusion(HOLLOW * side)),
            toward: vec3(light.x, -light.y, light.z),
        }
    }

    /// How light a pixel is, `[0, 1]`.
    #[inline(always)]
    fn tone(&self, x: usize, y: usize) -> f32 {
        let n = self.normals.nbar(x, y).extend(self.normals.nz(x, y));
        let lit = ((n.dot(self.toward) + WRAP) / (1.0 + WRAP)).clamp(0.0, 1.0);
        let seen = self.shadow.as_ref().map_or(1.0, |shadow| shadow.at(x, y));
        let open = self.open.as_ref().map_or(1.0, |open| open.at(x, y));
        let cast = 1.0 - self.settings.shadow * (1.0 - seen);
        let hollow = 1.0 - self.settings.hollows * (1.0 - open);
        (lit * cast * (1.0 - AROUND) + AROUND) * hollow
    }
}

/// The strokes of a hatching on a surface, level by level.
pub(super) fn strokes(
    drawing: &FormDrawing,
    surface: &Surface,
    settings: &HatchSettings,
) -> Vec<Arc<Stroke>> {
    let tone = FormTone::of(surface, settings, drawing.found.tone.as_deref());
    let lines = surface.hatch_lines(settings, &drawing.found.guides);
    let covered = BrushCoverage::of(&drawing.brush);
    let of_line = |line: &HatchLine| of_line(drawing, line, &tone, covered);
    parallel::map(&lines.lines, of_line).into_iter().flatten().collect()
}

fn of_line(
    drawing: &FormDrawing,
    line: &HatchLine,
    tone: &FormTone,
    covered: BrushCoverage,
) -> Vec<Arc<Stroke>> {
    if let [point] = line.points[..] {
        return of_point(drawing, point, line.level, tone, covered).into_iter().collect();
    }
    let width = |point: &HatchPoint| tone.share(tone.dark(point.at), line.level) * point.room_px;
    let widths: Vec<f32> = line.points.iter().map(width).collect();
    let mean = |i: usize| {
        let near = &widths[i.saturating_sub(MEAN)..(i + MEAN + 1).min(widths.len())];
        near.iter().sum::<f32>() / near.len() as f32
    };
    let smooth: Vec<f32> = (0..widths.len()).map(mean).collect();
    let mut strokes = Vec::new();
    let mut from = 0;
    while from < smooth.len() {
        let is_drawn = smooth[from] >= LEAST_PX;
        let run = smooth[from..].iter().take_while(|w| (**w >= LEAST_PX) == is_drawn).count();
        if is_drawn && run >= SHORTEST {
            let point = |i: usize| LinePoint {
                at: line.points[i].at,
                strength: pressure_of(&drawing.brush, smooth[i] / covered.width),
            };
            let points: Vec<LinePoint> = (from..from + run).map(point).collect();
            let room_px = [from, from + run - 1].map(|i| line.points[i].room_px);
            strokes.push(drawing.hand.draw_part(drawing, &points, from, room_px));
        }
        from += run;
    }
    strokes
}

/// A dab for a point of stippling, as large as its area asks; `None` where it is too small.
fn of_point(
    drawing: &FormDrawing,
    point: HatchPoint,
    level: u8,
    tone: &FormTone,
    covered: BrushCoverage,
) -> Option<Arc<Stroke>> {
    let area = tone.settings.stipple_area(tone.dark(point.at), usize::from(level));
    let width_px = (area * 4.0 / PI).sqrt() * point.room_px;
    (width_px >= LEAST_PX).then(|| {
        let strength = pressure_of(&drawing.brush, width_px / covered.area.sqrt());
        let dot = [LinePoint { at: point.at, strength }];
        drawing.hand.draw_part(drawing, &dot, 0, [point.room_px; 2])
    })
}

/// The pressure at which a brush draws so wide: the inverse of how pressure drives its size.
fn pressure_of(brush: &Brush, width_px: f32) -> f32 {
    let share = match brush.dynamics.curve(Property::Size, Input::Pressure) {
        Some(Curve::Share(share)) if *share > 0.05 => *share,
        _ => 1.0,
    };
    let ratio = width_px / brush.size.max(0.1);
    ((ratio - (1.0 - share)) / share).clamp(0.0, 1.0)
}
