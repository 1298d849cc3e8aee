//! A shading layer's material: which model, under which light.
//! Floor 3.

/// The parameters of a shading layer.
#[derive(Clone, Debug, PartialEq)]
pub struct Shading {}
