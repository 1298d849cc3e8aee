//! The operators: how far a point of the image moves where the surface is nearer (D_p), turns (D_n)
//! or mirrors (D_r) relative to an anchor, or where it is on the surface unwrapped (D_s). Floor 2.
//! Pure functions; each is an equation (docs/EQUATIONS.md). `kinds` is the table of their names and
//! numbers. Not here: reading maps (`Surface`), anchors and weights (`anchor`), the unwrapping
//! itself (`unwrap`), pixels (`raster`).

pub mod first_order;
pub mod kinds;
pub mod reflection;
pub mod second_order;
mod unwrapping;

use crate::math::{Mat2, Vec2};
pub use kinds::OperatorNumber;
pub use unwrapping::UnwrapSettings;

/// Which surface flow an image follows, and how strongly.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub enum Operator {
    /// The identity: plain 2D painting.
    #[default]
    None,
    /// First order, by depth, texture-like (SF eq. 13). `gamma ≥ 0`: rate.
    Depth {
        /// How strongly, `≥ 0`.
        gamma: f32,
    },
    /// Second order, by normals, reflection-like for `alpha > 0`, refraction-like for `alpha < 0`
    /// (SF eq. 15). `alpha` in canvas lengths *L*; `beta ≥ 0`: rate; `detail ≥ 0`: μ of SF fig. 10.
    Normal {
        /// How far, in canvas lengths.
        alpha: f32,
        /// How soon, `≥ 0`.
        beta: f32,
        /// How much more on curved parts.
        detail: f32,
    },
    /// By the reflected view direction on an angular map (beyond the paper). `alpha` in canvas
    /// lengths.
    Reflection {
        /// How far, in canvas lengths.
        alpha: f32,
        /// How much more on curved parts.
        detail: f32,
    },
    /// The surface unwrapped: an image lies on it, undistorted as far as can be (MATH 8, beyond the
    /// papers). `amount`: a, 0 flat … 1 its own metric; `smooth`: blur of the normals beforehand,
    /// px.
    Surface {
        /// How far between flat and the surface's own metric.
        amount: f32,
        /// Blur of the normals beforehand, px.
        smooth: f32,
    },
}

/// What the maps hold at one pixel.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct MapValues {
    /// z, 0 near … 1 far.
    pub depth: f32,
    /// n̄, image axes (y down).
    pub nbar: Vec2,
    /// The third component of the normal.
    pub nz: f32,
}

impl MapValues {
    /// Values where there is no surface, as in an empty map: facing the viewer, farthest.
    pub const BACKGROUND: MapValues = MapValues { depth: 1.0, nbar: Vec2::ZERO, nz: 1.0 };
}

/// How the maps change at one pixel, per px; differenced within one piece of surface.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct MapSlopes {
    /// ∇z.
    pub depth: Vec2,
    /// ∂n̄/∂q.
    pub nbar: Mat2,
    /// ∇n_z.
    pub nz: Vec2,
}

impl Operator {
    /// Whether it moves nothing on any surface: γ = 0, α = 0 or a = 0.
    pub fn is_identity(self) -> bool {
        match self {
            Operator::None => true,
            Operator::Depth { gamma } => gamma == 0.0,
            Operator::Normal { alpha, .. } | Operator::Reflection { alpha, .. } => alpha == 0.0,
            Operator::Surface { amount, .. } => amount == 0.0,
        }
    }

    /// μ: how strongly curvature scales the magnitude (SF fig. 10); 0 for operators without it.
    pub fn detail(self) -> f32 {
        match self {
            Operator::None | Operator::Depth { .. } | Operator::Surface { .. } => 0.0,
            Operator::Normal { detail, .. } | Operator::Reflection { detail, .. } => detail,
        }
    }

    /// What the surface must be unwrapped with; `None` for operators that only read maps at a pixel
    /// and at anchors.
    pub fn unwrapping(self) -> Option<UnwrapSettings> {
        match self {
            Operator::Surface { amount, smooth } if amount > 0.0 => {
                Some(UnwrapSettings { amount, smooth_px: smooth })
            }
            _ => None,
        }
    }

    /// The same bend on a canvas whose length *L* is another: `ratio` of the old one to the new
    /// one, lengths in px being the same.
    pub fn on_canvas_of(self, ratio: f32) -> Self {
        match self {
            Operator::Normal { alpha, beta, detail } => {
                Operator::Normal { alpha: alpha * ratio, beta, detail }.clamp_to_ranges()
            }
            Operator::Reflection { alpha, detail } => {
                Operator::Reflection { alpha: alpha * ratio, detail }.clamp_to_ranges()
            }
            of_px => of_px,
        }
    }

    /// On a canvas so many times as large: lengths in px grow with it.
    pub fn scaled(self, by: f32) -> Self {
        match self {
            Operator::Surface { amount, smooth } => {
                Operator::Surface { amount, smooth: smooth * by }.clamp_to_ranges()
            }
            unitless => unitless,
        }
    }

    /// offsetᵢ(q) of MATH 2, without detail enhancement: how far one anchor moves a point, canvas
    /// px.
    ///
    /// * `from_anchor`: q − qᵢ, px.
    /// * `here`, `anchor`: the maps at q and at qᵢ.
    /// * `unit_px`: *L*, the longer side of the canvas, px.
    ///
    /// 0 for the operator that unwraps: it is no sum over anchors (`deformation::plane`).
    pub fn offset(
        self,
        from_anchor: Vec2,
        here: MapValues,
        anchor: MapValues,
        unit_px: f32,
    ) -> Vec2 {
        match self {
            Operator::None | Operator::Surface { .. } => Vec2::ZERO,
            Operator::Depth { gamma } => {
                first_order::offset(from_anchor, here.depth - anchor.depth, gamma)
            }
            Operator::Normal { alpha, beta, .. } => {
                unit_px * second_order::offset(here.nbar - anchor.nbar, alpha, beta)
            }
            Operator::Reflection { alpha, .. } => {
                let r = |at: MapValues| reflection::mirrored(at.nbar, at.nz);
                unit_px * reflection::offset(r(here), r(anchor), alpha)
            }
        }
    }

    /// ∂/∂q of [`Operator::offset`], a plain ratio.
    pub fn offset_jacobian(
        self,
        from_anchor: Vec2,
        here: MapValues,
        slopes: MapSlopes,
        anchor: MapValues,
        unit_px: f32,
    ) -> Mat2 {
        match self {
            Operator::None | Operator::Surface { .. } => Mat2::ZERO,
            Operator::Depth { gamma } => first_order::offset_jacobian(
                from_anchor,
                here.depth - anchor.depth,
                slopes.depth,
                gamma,
            ),
            Operator::Normal { alpha, beta, .. } => {
                second_order::offset_jacobian(here.nbar - anchor.nbar, slopes.nbar, alpha, beta)
                    * unit_px
            }
            Operator::Reflection { alpha, .. } => {
                reflection::mirrored_jacobian(here.nbar, here.nz, slopes.nbar, slopes.nz)
                    * (alpha * unit_px)
            }
        }
    }
}

/// a bᵀ.
pub(in crate::surface) fn outer(a: Vec2, b: Vec2) -> Mat2 {
    Mat2::from_cols(a * b.x, a * b.y)
}
