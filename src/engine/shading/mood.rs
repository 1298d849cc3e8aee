//! Moods: lamps and settings of the painter's light that are chosen by name, in one table. Floor 3.

use super::{Light, LightKind, Painter, Shading, Shadows};
use crate::math::{srgb::Color, vec3};

crate::named! {
    /// A ready-made light.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    pub enum Mood {
        Studio = "studio" => "Studio",
        Noon = "noon" => "Noon",
        Window = "window" => "Window",
        Sunset = "sunset" => "Sunset",
        Rim = "rim" => "Rim",
        Moon = "moon" => "Moon",
    }
}

/// A lamp far away: toward it, y up.
fn lamp(toward: [f32; 3], color: Color, intensity: f32) -> Light {
    let direction = vec3(toward[0], toward[1], toward[2]);
    Light { kind: LightKind::Directional { direction }, color, intensity }
}

/// What a mood sets.
struct MoodLight {
    lights: Vec<Light>,
    painter: Painter,
    shadows: Shadows,
    shine: f32,
}

impl Mood {
    /// The table. Sizes in px, and whether the picture beneath is lit, stay as they are.
    fn light(self) -> MoodLight {
        let (painter, shadows) = (Painter::DEFAULT, Shadows { on: true, ..Shadows::DEFAULT });
        let white = Color::WHITE;
        match self {
            Mood::Studio => MoodLight {
                lights: vec![lamp([-0.52, 0.62, 0.59], white, 1.0)],
                painter,
                shadows,
                shine: 0.1,
            },
            Mood::Noon => MoodLight {
                lights: vec![lamp([-0.2, 0.85, 0.5], white, 1.15)],
                painter: Painter {
                    warmth: 0.5,
                    fill: 1.2,
                    bounce: 1.6,
                    rim: 0.5,
                    fill_color: Color::rgb(0xb4, 0xd6, 0xff),
                    ..painter
                },
                shadows: Shadows { softness: 0.05, strength: 0.84, ..shadows },
                shine: 0.12,
            },
            Mood::Window => MoodLight {
                lights: vec![lamp([-0.85, 0.3, 0.5], Color::rgb(0xf4, 0xf8, 0xff), 1.1)],
                painter: Painter {
                    warmth: 0.0,
                    wrap: 0.25,
                    fill: 0.45,
                    bounce: 0.7,
                    rim: 0.4,
                    ..painter
                },
                shadows: Shadows { softness: 0.4, strength: 0.92, ..shadows },
                shine: 0.08,
            },
            Mood::Sunset => MoodLight {
                lights: vec![lamp([-0.9, 0.16, 0.4], Color::rgb(0xff, 0xb4, 0x6e), 1.35)],
                painter: Painter {
                    fill: 0.8,
                    bounce: 0.6,
                    edge: 1.6,
                    rim: 1.6,
                    fill_color: Color::rgb(0xa8, 0xa0, 0xff),
                    bounce_color: Color::rgb(0xff, 0xa8, 0x90),
                    rim_color: Color::rgb(0xff, 0x9c, 0xb4),
                    ..painter
                },
                shadows: Shadows { softness: 0.07, strength: 0.92, ..shadows },
                shine: 0.14,
            },
            Mood::Rim => MoodLight {
                lights: vec![
                    lamp([-0.35, 0.45, 0.8], Color::rgb(0xe0, 0xe8, 0xff), 0.4),
                    lamp([0.9, 0.35, 0.06], Color::rgb(0xff, 0xe8, 0xc8), 0.9),
                ],
                painter: Painter {
                    warmth: 0.0,
                    fill: 0.35,
                    bounce: 0.3,
                    around: 0.6,
                    rim: 5.0,
                    ..painter
                },
                shadows: Shadows { softness: 0.1, strength: 0.95, ..shadows },
                shine: 0.16,
            },
            Mood::Moon => MoodLight {
                lights: vec![lamp([0.5, 0.66, 0.5], Color::rgb(0xa4, 0xc2, 0xff), 0.6)],
                painter: Painter {
                    warmth: 0.0,
                    fill: 0.4,
                    bounce: 0.15,
                    around: 0.7,
                    rim: 1.4,
                    fill_color: Color::rgb(0x80, 0xa4, 0xff),
                    bounce_color: Color::rgb(0x90, 0xa0, 0xe0),
                    rim_color: Color::rgb(0xa0, 0xc8, 0xff),
                    ..painter
                },
                shadows: Shadows { softness: 0.09, strength: 0.95, ..shadows },
                shine: 0.12,
            },
        }
    }

    /// A layer in this light.
    pub fn on(self, shading: &Shading) -> Shading {
        let MoodLight { lights, painter, shadows, shine } = self.light();
        let mut next = shading.clone();
        let Painter { beneath, contact_size, .. } = next.painter;
        next.painter = Painter { beneath, contact_size, ..painter };
        let Shadows { reach, ground, rays, .. } = next.shadows;
        next.shadows = Shadows { reach, ground, rays, ..shadows };
        next.specular.weight = shine;
        next.lights = lights;
        next
    }

    /// Whether a layer is in this light.
    pub fn is_of(self, shading: &Shading) -> bool {
        self.on(shading) == *shading
    }
}
