//! How the axes of stored vectors lie. Floor 5. Not here: detecting it (`orientation`).

use crate::math::{Vec3, vec3};

/// A way to turn stored vectors into camera space: component k is `sign[k]` · stored\[`order[k]`\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisMapping {
    pub order: [usize; 3],
    /// Whether each component is negated.
    pub flip: [bool; 3],
}

impl AxisMapping {
    pub const PLAIN: AxisMapping = AxisMapping { order: [0, 1, 2], flip: [false; 3] };

    pub fn apply(&self, v: Vec3) -> Vec3 {
        let sign = |k: usize| if self.flip[k] { -1.0 } else { 1.0 };
        vec3(sign(0) * v[self.order[0]], sign(1) * v[self.order[1]], sign(2) * v[self.order[2]])
    }
}
