//! Filters of pictures: a pixel depends on those around it, or on its place. Floor 3. Premultiplied
//! encoded pixels in and out, so that color under transparent pixels does not spread. Not here: the
//! layers that hold them, and composing what lies beneath (`document`).
//!
//! A picture is filtered in blocks, whose places do not depend on what changed, so that a part that
//! is filtered again gets the same bytes.
//!
//! | file | |
//! |---|---|
//! | `window` | what a filter reads |
//! | `blur`, `radial` | blurs: everywhere alike, around a point |
//! | `sharpen`, `glow` | those that compare a picture with its blur |
//! | `surface`, `flow`, `lens` | blurs over the surface, along its lines, and by its depth |
//! | `noise` | noise and grain |
//! | `cells` | median, squares, edges, shift |
//! | `halftone` | dots and lines of ink |
//! | `draft` | filters at half the size, while the user drags |

mod blur;
mod cells;
mod draft;
mod flow;
mod glow;
mod halftone;
mod lens;
mod noise;
mod radial;
mod sharpen;
mod surface;
mod window;

pub use blur::{BoxBlur, GaussianBlur, MotionBlur};
pub use cells::{EdgeFilter, MedianFilter, Pixelate, WrappedOffset};
pub use flow::FlowBlur;
pub use glow::BrightGlow;
pub use halftone::Halftone;
pub use lens::LensBlur;
pub use noise::{FilmGrain, PixelNoise};
pub use radial::{BlurCenter, SpinBlur, ZoomBlur};
pub use sharpen::{HighPass, Sharpen, UnsharpMask};
pub use surface::SurfaceBlur;
pub use window::{FilterSource, FilterWindow};

use self::draft::SoftKernel;
use crate::math::Rect;
use crate::paint::adjustment::ParameterVisitor;
use crate::paint::adjustment::parameters::{Holder, LengthScaler, Parameters, parameter_kinds};
use crate::surface::Scene;
use std::sync::Arc;

parameter_kinds! {
    /// A filter with its parameters.
    pub enum PictureFilter, fn kernel -> FilterKernel;
    GaussianBlur = "gaussian-blur" => ("Gaussian blur", "Soft everywhere alike"),
    BoxBlur = "box-blur" => ("Box blur", "The mean of a square"),
    MotionBlur = "motion-blur" => ("Motion blur", "As if the camera had moved along a line"),
    SpinBlur = "spin-blur" => ("Spin blur", "As if the picture turned about a point"),
    ZoomBlur = "zoom-blur" => ("Zoom blur", "As if the camera came nearer"),
    LensBlur = "lens-blur" => ("Lens blur", "Out of focus, by the depth of the surface"),
    SurfaceBlur = "surface-blur"
        => ("Blur over the surface", "Soft by the distance on the surface, up to its contours"),
    FlowBlur = "flow-blur"
        => ("Blur along the form", "Smeared along the lines in which the surface bends least"),
    Sharpen = "sharpen" => ("Sharpen", "Crisper edges, by the nearest pixels"),
    UnsharpMask = "unsharp-mask"
        => ("Unsharp mask", "Crisper edges, by their width and from a threshold on"),
    HighPass = "high-pass" => ("High pass", "Only details, around mid-gray: for Overlay"),
    PixelNoise = "noise" => ("Noise", "Random steps of each pixel"),
    FilmGrain = "grain" => ("Grain", "Of film or paper, on the canvas or on the surface"),
    MedianFilter = "median" => ("Median", "Removes specks and keeps edges"),
    BrightGlow = "glow" => ("Glow", "What is bright shines beyond its edge"),
    Pixelate = "pixelate" => ("Pixelate", "Squares of one color"),
    Halftone = "halftone" => ("Halftone", "Tone as dots or lines of ink, as in print"),
    EdgeFilter = "edges" => ("Edges", "Light lines where colors differ, or dark ones"),
    WrappedOffset = "offset"
        => ("Offset", "Shifted; what leaves on one side enters on the other"),
}

/// What a filter does to pixels.
pub(super) trait FilterKernel: Send + Sync {
    /// How far from the pixels of a rectangle it reads, px.
    fn reach(&self, near: Rect, bounds: Rect) -> f32;

    /// What it reads for the pixels of a rectangle.
    fn reads(&self, out: Rect, bounds: Rect) -> Vec<Rect> {
        vec![out.grown(self.reach(out, bounds).ceil() as i32)]
    }

    /// Computes now what many blocks would otherwise compute at the same time.
    fn warm(&self, _scene: &Scene) {}

    /// The filtered pixels of a rectangle, row by row.
    fn apply(&self, place: &FilterPlace, source: &dyn FilterSource) -> Vec<[f32; 4]>;

    /// What a draft of it needs, if it is costly and its picture is so soft that half the size will
    /// do.
    fn as_soft(&self) -> Option<&dyn SoftKernel> {
        None
    }
}

/// Which pixels are filtered.
#[derive(Clone, Copy)]
pub struct FilterPlace<'a> {
    /// What they lie on.
    scene: &'a Scene,
    /// Which they are.
    out: Rect,
    /// The straight encoded color above which light is clipped; 1 is white.
    brightest: f32,
    /// The side of a pixel, in pixels of the scene: more than one in drafts.
    canvas_px: i32,
}

impl<'a> FilterPlace<'a> {
    /// * `scene`: what the pixels of a rectangle lie on.
    /// * `brightest`: the straight encoded color above which light is clipped; 1 is white.
    pub fn new(scene: &'a Scene, out: Rect, brightest: f32) -> Self {
        Self { scene, out, brightest, canvas_px: 1 }
    }
}

impl FilterPlace<'_> {
    /// The pixel of the surface that is seen at a pixel, if any.
    fn on_surface(&self, x: i32, y: i32) -> Option<(usize, usize)> {
        let surface = self.scene.surface.as_ref()?;
        surface.coverage_plane().get(x, y).filter(|coverage| *coverage > 0)?;
        Some((x as usize, y as usize))
    }
}

/// A filter as layers hold it.
#[derive(Clone, Debug)]
pub struct LiveFilter {
    params: Arc<PictureFilter>,
    /// The same for a picture of half the size, if it is shown as a draft.
    halved: Option<Arc<PictureFilter>>,
}

impl PartialEq for LiveFilter {
    fn eq(&self, other: &Self) -> bool {
        self.is_draft() == other.is_draft()
            && (Arc::ptr_eq(&self.params, &other.params) || self.params == other.params)
    }
}

impl LiveFilter {
    /// With the nearest numbers that a document may hold.
    pub fn new(filter: PictureFilter) -> Self {
        Self { params: Arc::new(filter.clamp_to_ranges()), halved: None }
    }

    /// What it was made of.
    pub fn params(&self) -> &PictureFilter {
        &self.params
    }

    /// With its lengths `factor` times as large.
    pub fn scaled(&self, factor: f32) -> Self {
        let whole = Self { params: self.scale_params(factor), halved: None };
        if self.is_draft() { whole.drafted().unwrap_or(whole) } else { whole }
    }

    /// The same for a moment while the user drags, cheaper and nearly alike; `None` if it is cheap
    /// itself, or has to be whole.
    pub fn drafted(&self) -> Option<Self> {
        if self.is_draft() {
            return None;
        }
        self.params.kernel().as_soft()?;
        Some(Self { params: self.params.clone(), halved: Some(self.scale_params(0.5)) })
    }

    fn is_draft(&self) -> bool {
        self.halved.is_some()
    }

    fn scale_params(&self, factor: f32) -> Arc<PictureFilter> {
        let mut params = PictureFilter::clone(&self.params);
        params.visit(&mut LengthScaler(factor));
        Arc::new(params)
    }

    /// What filters at half the size, if it is a draft.
    fn halved_kernel(&self) -> Option<&dyn SoftKernel> {
        self.halved.as_ref()?.kernel().as_soft()
    }

    /// The sides of the blocks in which a picture is filtered, px: whole tiles, and the larger the
    /// farther it reads, so that what is read around them is not much more than they are.
    fn block_px(&self, bounds: Rect) -> i32 {
        match self.params.kernel().reach(bounds, bounds) {
            reach if reach <= 8.0 => 128,
            reach if reach <= 96.0 => 256,
            _ => 512,
        }
    }

    /// The blocks of a picture that hold some of its pixels.
    pub fn blocks(&self, holding: Rect, bounds: Rect) -> Vec<Rect> {
        let side = self.block_px(bounds);
        let holding = holding.intersect(bounds);
        let first = |v: i32| v.div_euclid(side);
        let last = |v: i32| (v - 1).div_euclid(side) + 1;
        let block = |i: i32, j: i32| {
            Rect::new(i * side, j * side, (i + 1) * side, (j + 1) * side).intersect(bounds)
        };
        let rows = if holding.is_empty() { 0..0 } else { first(holding.y0)..last(holding.y1) };
        rows.flat_map(|j| (first(holding.x0)..last(holding.x1)).map(move |i| block(i, j)))
            .filter(|block| !block.is_empty())
            .collect()
    }

    /// What it reads of a picture for one of its blocks.
    pub fn reads(&self, block: Rect, bounds: Rect) -> Vec<Rect> {
        let reads = match self.halved_kernel() {
            Some(halved) => draft::reads(halved, block, bounds),
            None => self.params.kernel().reads(block, bounds),
        };
        reads.into_iter().map(|read| read.intersect(bounds)).collect()
    }

    /// Computes now what many blocks would otherwise wait for.
    pub fn warm(&self, scene: &Scene) {
        self.params.kernel().warm(scene);
    }

    /// The filtered pixels of one of its blocks.
    pub fn apply(&self, place: &FilterPlace, source: &dyn FilterSource) -> FilterWindow {
        let mut pixels = match self.halved_kernel() {
            Some(halved) => draft::apply(halved, place, source),
            None => self.params.kernel().apply(place, source),
        };
        limit(&mut pixels, place.brightest);
        FilterWindow::new(place.out, pixels)
    }
}

crate::widest! {
    /// Colors within their alpha, which is no more than 1.
    fn limit(pixels: &mut [[f32; 4]], brightest: f32) {
        for pixel in pixels {
            let a = pixel[3].max(0.0).min(1.0);
            let most = a * brightest;
            let [r, g, b, alpha] = pixel;
            for value in [r, g, b] {
                *value = value.max(0.0).min(most);
            }
            *alpha = a;
        }
    }
}

#[cfg(test)]
mod tests;
