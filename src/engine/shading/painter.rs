//! The settings of the painter's light. Floor 3. Not here: its equations (`material::painter`), its
//! ready-made moods (`mood`).

use crate::math::number_settings::number_settings;
use crate::math::srgb::Color;

number_settings! {
    /// How a painter would light a figure: each term that is not among those of other models.
    pub struct Painter {
        /// w: how far the key reaches beyond the terminator.
        wrap: "Soft edge", "How far the lamp's light reaches around the form", 0.0..=1.0, 0.12;
        /// Of the key: 1 is lamplight, 0 the lamp's own color, negative cool.
        warmth: "Key warmth", "1 is warm lamplight, 0 the lamp's own color, −1 cool", -4.0..=4.0, 1.0;
        /// Cool light from above.
        fill: "Fill", "Cool light from above", 0.0..=10.0, 1.0;
        /// Warm light from below.
        bounce: "Bounce", "Warm light from below, bounced by the ground", 0.0..=10.0, 1.0;
        /// Light from everywhere.
        around: "Around", "Light from everywhere", 0.0..=10.0, 1.0;
        /// Saturation where the form turns from the light.
        edge: "Turning edge", "Richer color where the form turns from light to shade", 0.0..=3.0, 1.0;
        /// Light from behind, along the figure's edge.
        rim: "Rim", "Light from behind that separates the figure from the background", 0.0..=20.0, 1.0;
        /// Shade where the surroundings stand higher.
        contact: "Contact shade", "Shade where parts touch", 0.0..=5.0, 1.0;
        /// The size of the largest surroundings that shade, px.
        contact_size: "Contact size", "How far contact shade reaches, px", 4.0..=1000.0, 45.0, px;
        /// What contact shade leaves of the light at least.
        contact_floor: "Contact floor", "The least light that contact shade leaves", 0.0..=1.0, 0.35;
        /// Factor of all light.
        exposure: "Exposure", "Factor of all light", 0.0..=8.0, 1.0;
        and
        /// Whether the picture beneath is lit, not a color of its own.
        beneath: bool = false;
        /// Of the fill.
        fill_color: Color = Color::rgb(0xd8, 0xe4, 0xff);
        /// Of the bounce.
        bounce_color: Color = Color::rgb(0xff, 0xdf, 0xc1);
        /// Of the rim.
        rim_color: Color = Color::rgb(0xcc, 0xe1, 0xff);
    }
}

impl Painter {
    /// The strongest channel of the fill, the bounce, the light from everywhere and the rim, at 1.
    pub const FILL: f32 = 0.44;
    /// As [`Painter::FILL`].
    pub const BOUNCE: f32 = 0.30;
    /// As [`Painter::FILL`].
    pub const AROUND: f32 = 0.10;
    /// As [`Painter::FILL`].
    pub const RIM: f32 = 0.55;
    /// Contact shade for each unit of what stands higher, at 1.
    pub const CONTACT: f32 = 0.4;
    /// The color's share that the turning edge replaces, at 1.
    pub const EDGE: f32 = 0.25;
    /// What warmth adds to each channel of a lamp, at 1.
    pub const WARM: [f32; 3] = [0.06, 0.0, -0.1];

    /// The same on a canvas `factor` times as large.
    pub fn scaled(&self, factor: f32) -> Self {
        let mut next = *self;
        Self::lengths().for_each(|setting| setting.scale(&mut next, factor));
        next
    }

    /// A lamp's light, warmed.
    pub fn warmed(&self, light: [f32; 3]) -> [f32; 3] {
        std::array::from_fn(|c| light[c] * (1.0 + self.warmth * Self::WARM[c]).max(0.0))
    }
}
