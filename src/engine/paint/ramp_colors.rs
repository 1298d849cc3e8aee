//! Ramps that come with the program, by their names. Floor 3.

use super::ramp::GradientStop;
use crate::math::srgb::Color;

crate::named! {
    /// The colors of a new ramp.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub enum RampColors {
        /// From the first to the second color.
        #[default]
        Both = "both" => ("Both colors", "From the first to the second color"),
        /// From the first color to nothing.
        Fading = "fading" => ("Color to transparent", "From the first color to transparent"),
        /// Black to white.
        Gray = "gray" => ("Black to white", "For masks and tones"),
        /// All hues.
        Spectrum = "spectrum" => ("Spectrum", "All hues, equally light to the eye"),
        /// Evening sky.
        Sunset = "sunset" => ("Sunset", "An evening sky, from the horizon up"),
        /// Sky at noon.
        Noon = "noon" => ("Noon", "A clear sky, from the horizon up"),
        /// Night sky.
        Night = "night" => ("Night", "A night sky, from the horizon up"),
        /// Fire.
        Fire = "fire" => ("Fire", "Embers to flame"),
        /// Sea.
        Sea = "sea" => ("Sea", "Shallow to deep water"),
        /// Leaves.
        Leaves = "leaves" => ("Leaves", "Foliage in shade and sun"),
        /// Skin.
        Skin = "skin" => ("Skin", "Shade to light of a warm skin"),
        /// Gold.
        Gold = "gold" => ("Gold", "Reflections of gold"),
        /// Copper.
        Copper = "copper" => ("Copper", "Reflections of copper"),
        /// Steel.
        Steel = "steel" => ("Steel", "Reflections of brushed steel"),
        /// Chrome.
        Chrome = "chrome" => ("Chrome", "Sky and ground in a mirror, with a hard horizon"),
    }
}

impl RampColors {
    /// Positions on the ramp, and colors as `0xrrggbb`; empty for those of the user's colors.
    fn table(self) -> &'static [(f32, u32)] {
        match self {
            RampColors::Both | RampColors::Fading => &[],
            RampColors::Gray => &[(0.0, 0x000000), (1.0, 0xffffff)],
            // Hues of OKLCH at lightness 0.75 and chroma 0.12.
            RampColors::Spectrum => &[
                (0.0, 0xf08d95),
                (0.17, 0xdaa24f),
                (0.33, 0x8cbf70),
                (0.5, 0x2cc5c5),
                (0.67, 0x79b1f9),
                (0.83, 0xcb96e2),
                (1.0, 0xf08d95),
            ],
            RampColors::Sunset => &[
                (0.0, 0xfff0b8),
                (0.2, 0xffb45e),
                (0.45, 0xe8654f),
                (0.7, 0x8a3f77),
                (1.0, 0x2b2555),
            ],
            RampColors::Noon => &[(0.0, 0xeaf6fb), (0.35, 0xa3d5f2), (1.0, 0x2c77c4)],
            RampColors::Night => &[(0.0, 0x4b5a86), (0.4, 0x1f2a52), (1.0, 0x070a1d)],
            RampColors::Fire => &[
                (0.0, 0x1a0503),
                (0.3, 0x7d1408),
                (0.6, 0xe2521b),
                (0.85, 0xffb52e),
                (1.0, 0xfff7c9),
            ],
            RampColors::Sea => {
                &[(0.0, 0xd4f4e4), (0.3, 0x5cc3bd), (0.65, 0x1b7f9c), (1.0, 0x0a2f57)]
            }
            RampColors::Leaves => {
                &[(0.0, 0x12301f), (0.4, 0x2f6b33), (0.75, 0x88ad3d), (1.0, 0xe6e88e)]
            }
            RampColors::Skin => {
                &[(0.0, 0x4a2320), (0.35, 0x9c5a44), (0.7, 0xdfa283), (1.0, 0xfbe2cd)]
            }
            RampColors::Gold => &[
                (0.0, 0x3d2506),
                (0.3, 0xa8741a),
                (0.5, 0xfff0a8),
                (0.65, 0xd79c2b),
                (0.85, 0x7a4a0f),
                (1.0, 0xf6d470),
            ],
            RampColors::Copper => &[
                (0.0, 0x2e1009),
                (0.35, 0x9b4a27),
                (0.55, 0xffcfae),
                (0.75, 0xb4623a),
                (1.0, 0x5a2413),
            ],
            RampColors::Steel => &[
                (0.0, 0x2f363d),
                (0.25, 0x8a949e),
                (0.45, 0xeef2f5),
                (0.6, 0x9aa5af),
                (0.8, 0x4d565f),
                (1.0, 0xc9d1d8),
            ],
            RampColors::Chrome => &[
                (0.0, 0x24180f),
                (0.3, 0x8a6a4a),
                (0.49, 0xf4e6cf),
                (0.5, 0x1d3350),
                (0.7, 0x6fa5d6),
                (1.0, 0xffffff),
            ],
        }
    }

    /// The stops, with the user's colors where it is made of them.
    pub fn stops(self, first: Color, second: Color) -> Vec<GradientStop> {
        let ends = |from, to| {
            vec![GradientStop { t: 0.0, color: from }, GradientStop { t: 1.0, color: to }]
        };
        match self {
            RampColors::Both => ends(first, second),
            RampColors::Fading => ends(first, Color { a: 0, ..first }),
            named => named
                .table()
                .iter()
                .map(|&(t, rgb)| GradientStop { t, color: opaque(rgb) })
                .collect(),
        }
    }
}

fn opaque(rgb: u32) -> Color {
    let [_, r, g, b] = rgb.to_be_bytes();
    Color { r, g, b, a: 255 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_ramp_runs_from_0_to_1_in_order() {
        for (colors, name) in RampColors::ALL {
            let stops = colors.stops(Color::BLACK, Color::WHITE);
            assert_eq!(stops.first().map(|stop| stop.t), Some(0.0), "{name}");
            assert_eq!(stops.last().map(|stop| stop.t), Some(1.0), "{name}");
            assert!(stops.windows(2).all(|pair| pair[0].t < pair[1].t), "{name}");
        }
    }
}
