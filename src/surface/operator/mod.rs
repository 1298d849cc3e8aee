//! The operators: how far a point of the image is moved where the surface stands nearer (D_p), turns (D_n) or
//! mirrors (D_r) relative to an anchor.
//! Floor 2. Pure functions; each is an equation of the papers (docs/EQUATIONS.md).
//! Not here: reading maps (`maps`), anchors and weights (`anchor`), pixels (`raster`).

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
