//! The operators: how far a point of the image moves where the surface is nearer (D_p), turns (D_n) or mirrors (D_r)
//! relative to an anchor. Floor 2. Pure functions; each is an equation of the papers (docs/EQUATIONS.md). Not here:
//! reading maps (`maps`), anchors and weights (`anchor`), pixels (`raster`).

pub mod first_order;
pub mod reflection;
pub mod second_order;

use crate::math::{Mat2, Range, Vec2, range::held};

/// Which surface flow an image follows, and how strongly.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub enum Operator {
    /// The identity: plain 2D painting.
    #[default]
    None,
    /// First order, by depth, texture-like (SF eq. 13). `gamma ≥ 0`: rate.
    Depth { gamma: f32 },
    /// Second order, by normals, reflection-like for `alpha > 0`, refraction-like for `alpha < 0` (SF eq. 15).
    /// `alpha` in canvas lengths *L*; `beta ≥ 0`: rate; `detail ≥ 0`: μ of SF fig. 10.
    Normal { alpha: f32, beta: f32, detail: f32 },
    /// By the reflected view direction on an angular map (beyond the paper). `alpha` in canvas lengths.
    Reflection { alpha: f32, detail: f32 },
}

/// What the maps hold at one pixel.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct MapValues {
    /// z, 0 near … 1 far.
    pub depth: f32,
    /// n̄, image axes (y down).
    pub nbar: Vec2,
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

/// Magnitudes beyond this are pulled in, so that no product of distances leaves f32.
const MAX_ALPHA: f32 = 1e5;

impl Operator {
    /// e^20 is half a thousand million: a stronger bend only loses digits.
    pub const GAMMA: Range = 0.0..=20.0;
    pub const ALPHA: Range = -100.0..=100.0;
    pub const BETA: Range = 0.0..=50.0;
    pub const DETAIL: Range = 0.0..=100.0;

    /// With the nearest numbers that a document may hold.
    pub fn held(self) -> Self {
        match self {
            Operator::None => Operator::None,
            Operator::Depth { gamma } => Operator::Depth { gamma: held(gamma, &Self::GAMMA) },
            Operator::Normal { alpha, beta, detail } => Operator::Normal {
                alpha: held(alpha, &Self::ALPHA),
                beta: held(beta, &Self::BETA),
                detail: held(detail, &Self::DETAIL),
            },
            Operator::Reflection { alpha, detail } => {
                Operator::Reflection { alpha: held(alpha, &Self::ALPHA), detail: held(detail, &Self::DETAIL) }
            }
        }
    }
    /// The operator with parameters that are finite and not absurd: what is not a number counts as 0.
    pub fn finite(self) -> Self {
        let number = |v: f32| if v.is_finite() { v.clamp(-MAX_ALPHA, MAX_ALPHA) } else { 0.0 };
        match self {
            Operator::None => Operator::None,
            Operator::Depth { gamma } => Operator::Depth { gamma: number(gamma) },
            Operator::Normal { alpha, beta, detail } => {
                Operator::Normal { alpha: number(alpha), beta: number(beta), detail: number(detail) }
            }
            Operator::Reflection { alpha, detail } => {
                Operator::Reflection { alpha: number(alpha), detail: number(detail) }
            }
        }
    }
    /// Whether it moves nothing on any surface: γ = 0 or α = 0.
    pub fn is_identity(self) -> bool {
        match self {
            Operator::None => true,
            Operator::Depth { gamma } => gamma == 0.0,
            Operator::Normal { alpha, .. } | Operator::Reflection { alpha, .. } => alpha == 0.0,
        }
    }
    /// μ: how strongly curvature scales the magnitude (SF fig. 10); 0 for operators without it.
    pub fn detail(self) -> f32 {
        match self {
            Operator::None | Operator::Depth { .. } => 0.0,
            Operator::Normal { detail, .. } | Operator::Reflection { detail, .. } => detail,
        }
    }
    /// offsetᵢ(q) of MATH 2, without detail enhancement: how far one anchor moves a point, canvas px.
    ///
    /// * `from_anchor`: q − qᵢ, px.
    /// * `here`, `anchor`: the maps at q and at qᵢ.
    /// * `unit_px`: *L*, the longer side of the canvas, px.
    pub fn offset(self, from_anchor: Vec2, here: MapValues, anchor: MapValues, unit_px: f32) -> Vec2 {
        match self {
            Operator::None => Vec2::ZERO,
            Operator::Depth { gamma } => first_order::offset(from_anchor, here.depth - anchor.depth, gamma),
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
            Operator::None => Mat2::ZERO,
            Operator::Depth { gamma } => {
                first_order::offset_jacobian(from_anchor, here.depth - anchor.depth, slopes.depth, gamma)
            }
            Operator::Normal { alpha, beta, .. } => {
                second_order::offset_jacobian(here.nbar - anchor.nbar, slopes.nbar, alpha, beta) * unit_px
            }
            Operator::Reflection { alpha, .. } => {
                reflection::mirrored_jacobian(here.nbar, here.nz, slopes.nbar, slopes.nz) * (alpha * unit_px)
            }
        }
    }
}

/// a bᵀ.
pub(in crate::surface) fn outer(a: Vec2, b: Vec2) -> Mat2 {
    Mat2::from_cols(a * b.x, a * b.y)
}
