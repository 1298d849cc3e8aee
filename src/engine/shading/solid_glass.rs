//! Glass with a back: what is set of it. Floor 3. Not here: how light goes through it
//! (`material::mirror`), where its back is (`surface::ray::body`).

use crate::math::number_settings::number_settings;

number_settings! {
    /// Glass that light leaves again, at a back that is made up behind the surface.
    pub struct SolidGlass {
        /// How far the back bulges, as a share of the front: 0 is flat, 1 the front mirrored, without
        /// its detail.
        back: "Back", "How far the back bulges: 0 is flat, 1 is as round as the front", 0.0..=1.0, 0.25;
        and
        /// Whether light leaves the glass again, and the front mirrors its share of it; else each
        /// ray is refracted once.
        on: bool = false;
    }
}
