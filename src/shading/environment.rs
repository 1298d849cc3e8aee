//! An environment: the light that arrives from every direction, as a picture fixed to the camera.
//! Floor 3.

use crate::raster::Picture;

/// A picture of the surroundings.
#[derive(Clone)]
pub struct Environment {
    /// The name it goes by in the document.
    pub file: String,
    pub picture: Picture,
    pub projection: Projection,
    /// About the vertical axis, degrees: direction d is looked up at R_y(rotation) d.
    pub rotation: f32,
    /// Stops: light is multiplied by 2^exposure.
    pub exposure: f32,
}

impl Environment {
    pub fn new(file: String, picture: Picture) -> Self {
        Self { file, picture, projection: Projection::default(), rotation: 0.0, exposure: 0.0 }
    }
}

/// How directions lie in the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum Projection {
    /// u = atan2(e_x, −e_z) / 2π, v = acos(e_y) / π from the top.
    #[default]
    LatLong,
    /// The centre is toward the viewer, the radius proportional to the angle from it, the rim straight away.
    Angular,
    /// A photographed mirror ball: the picture is the ball, seen orthographically.
    MirrorBall,
}

impl Projection {
    /// Every projection with its name in documents.
    pub const ALL: [(Projection, &'static str); 3] =
        [(Projection::LatLong, "lat-long"), (Projection::Angular, "angular"), (Projection::MirrorBall, "mirror-ball")];
    pub fn name(self) -> &'static str {
        Self::ALL.iter().find(|(p, _)| *p == self).map_or("lat-long", |(_, name)| name)
    }
}
