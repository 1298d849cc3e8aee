//! A shading layer's material: its model, its terms, and its lights (MATH 5). Floor 3. There is one
//! file per model; `render` makes the tiles.

mod ashikhmin;
mod ashikhmin_environment;
mod beneath;
mod hemisphere;
mod lit_sphere;
mod lobes;
mod mirror;
mod painter;
mod phong;
mod render;
mod second_look;
mod toon;

use super::{
    ball_strokes::BallStrokes,
    environment::Environment,
    features::Features,
    light::{Light, LightKind, RowLight},
    painter::Painter,
    pixel::PixelShading,
    scaling::{Reference, Scaling},
    shadow::Shadows,
    solid_glass::SolidGlass,
    sphere::LitSphere,
};
use crate::math::{Range, Size, UNIT, srgb::Color, vec3};
use crate::surface::Surface;

crate::named! {
    /// How a material reflects light.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
    pub enum Model {
        #[default]
        Phong = "phong" => ("Soft plastic", "Matt and glossy under lights (Phong)"),
        /// Phong in flat tones.
        Toon = "toon" => ("Toon", "The same in flat bands of light"),
        /// (n·ℓ)^ζ: flatter than matt, like the moon.
        SubLambertian = "sub-lambertian" => ("Velvet", "Flatter than matt, like the moon (sub-Lambertian)"),
        /// Anisotropic Phong of Ashikhmin and Shirley (2000), under lights or an environment.
        Ashikhmin = "ashikhmin" => (
            "Brushed metal",
            "A highlight that is longer in one direction (Ashikhmin)",
        ),
        /// Matt under an environment, with ambient occlusion.
        DiffuseEnvironment = "diffuse-environment" => (
            "Lit by an environment",
            "Matt, lit from all around",
        ),
        AmbientOcclusion = "ambient-occlusion" => (
            "Ambient occlusion",
            "Darker where little of the sky is visible",
        ),
        /// A painted sphere, or a convex and a concave one.
        LitSphere = "lit-sphere" => (
            "Painted ball",
            "A painted ball gives the color of every direction (lit sphere, matcap)",
        ),
        Mirror = "mirror" => ("Mirror", "An environment mirrored in the surface"),
        Refraction = "refraction" => ("Glass", "An environment seen through the surface"),
        /// As a painter would light it: key, fill, bounce, turning edge, rim, shine.
        Painter = "painter" => (
            "Painter's light",
            "Key, fill, bounce, rim and cast shadows on the picture beneath",
        ),
    }
}

impl Model {
    /// Whether it is lit by an environment alone: lights have no effect.
    pub fn is_lit_by_environment(self) -> bool {
        matches!(self, Model::DiffuseEnvironment | Model::Mirror | Model::Refraction)
    }

    /// Whether lights have an effect on it.
    pub fn has_lamps(self) -> bool {
        !self.is_lit_by_environment() && !matches!(self, Model::LitSphere | Model::AmbientOcclusion)
    }

    /// Whether its rays can meet the surface itself before they reach the environment.
    pub fn is_bouncing(self) -> bool {
        matches!(self, Model::Mirror | Model::Refraction | Model::Ashikhmin)
    }
}

/// One term of a material: weight × color × ρ × light, scaled by its own σ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Term {
    /// Its color; alpha is ignored.
    pub color: Color,
    /// `≥ 0`; 0 leaves the term out.
    pub weight: f32,
    /// How the relief scales it.
    pub scaling: Scaling,
}

impl Term {
    /// What a weight may be.
    pub const WEIGHT: Range = 0.0..=100.0;

    /// Not scaled.
    pub const fn plain(color: Color, weight: f32) -> Self {
        Self { color, weight, scaling: Scaling::NONE }
    }

    /// Whether its σ is not 1 everywhere.
    pub fn is_scaled(&self) -> bool {
        !self.scaling.is_none()
    }

    /// Weight × color in linear light.
    pub fn linear(&self) -> [f32; 3] {
        self.color.linear().map(|c| c * self.weight)
    }
    /// Contributes nothing.
    pub const NONE: Term = Term::plain(Color::WHITE, 0.0);
}

/// The parameters of a shading layer.
#[derive(Clone, PartialEq)]
pub struct Shading {
    /// How it reflects light.
    pub model: Model,
    /// What it is lit by.
    pub lights: Vec<Light>,
    /// Light from everywhere; the occlusion of [`Model::AmbientOcclusion`]. For
    /// [`Model::DiffuseEnvironment`] only its scaling counts, which scales the occlusion.
    pub ambient: Term,
    /// The matt term.
    pub diffuse: Term,
    /// The glossy term; lit spheres, mirrors and refraction are this term too.
    pub specular: Term,
    /// η of the Phong highlight, `≥ 0`.
    pub shininess: f32,
    /// The curvature that scales its terms.
    pub features: Features,
    /// What counts as full reflectance where light comes from a picture (environment, lit sphere).
    pub reference: Reference,
    /// Tones of a toon term, `≥ 2`.
    pub bands: u32,
    /// ζ of the sub-Lambertian term, in `[0, 1]`.
    pub exponent: f32,
    /// Ashikhmin: exponents along the picture's x and y.
    pub nu: f32,
    /// As `nu`, along the picture's y.
    pub nv: f32,
    /// Light from all directions; absent: none.
    pub environment: Option<Environment>,
    /// Lit sphere; if there is a concave one too, this one is for convex features. `None`: gray
    /// clay.
    pub sphere: Option<LitSphere>,
    /// The lit sphere of concave features.
    pub sphere_concave: Option<LitSphere>,
    /// How the brush marks of spheres lie on the figure.
    pub strokes: BallStrokes,
    /// Refractive index, `> 0`.
    pub index: f32,
    /// How refracted light goes through the body behind the surface.
    pub solid: SolidGlass,
    /// The distance up to which occluders count, px; 0 turns occlusion off.
    pub occlusion_radius_px: f32,
    /// How often a ray that meets the surface itself is sent on before it looks at the environment:
    /// inter-reflection. 0: never, each ray looks at the environment at once.
    pub bounces: u32,
    /// Shadows that the lights cast.
    pub shadows: Shadows,
    /// The painter's light.
    pub painter: Painter,
    /// How it is divided into tones where it lights the picture beneath.
    pub pixel: PixelShading,
}

impl Shading {
    /// The lights of one layer.
    pub const MOST_LIGHTS: usize = 256;
    /// For the Phong highlight and both Ashikhmin exponents.
    pub const SHININESS: Range = 0.0..=100_000.0;
    /// What `bands` may be.
    pub const BANDS: std::ops::RangeInclusive<u32> = 2..=256;
    /// What `exponent` may be.
    pub const EXPONENT: Range = UNIT;
    /// What `index` may be.
    pub const INDEX: Range = 0.1..=10.0;
    /// What `occlusion_radius_px` may be.
    pub const OCCLUSION_RADIUS_PX: Range = 0.0..=crate::surface::Surface::WIDEST_OCCLUSION_PX;

    /// What `bounces` may be.
    pub const BOUNCES: std::ops::RangeInclusive<u32> = 0..=8;

    /// How many bounces its rays make; 0 without an environment, which they look for.
    fn bounces_made(&self) -> u32 {
        if self.has_bounces() && self.environment.is_some() { self.bounces } else { 0 }
    }

    /// Whether `bounces` has an effect: the rays of solid glass end when they have left it.
    pub fn has_bounces(&self) -> bool {
        self.model.is_bouncing() && !self.is_solid_glass()
    }

    /// Whether light goes through the body behind the surface and leaves it again.
    pub fn is_solid_glass(&self) -> bool {
        self.model == Model::Refraction && self.solid.on
    }

    /// Whether its model needs an environment but has none: it paints black.
    pub fn is_without_environment(&self) -> bool {
        self.model.is_lit_by_environment() && self.environment.is_none()
    }

    /// The model with its default material: no environment, no sphere, and one light if it needs
    /// one.
    pub fn new(model: Model) -> Self {
        let clay = Term::plain(Color { r: 0xc0, g: 0x80, b: 0x60, a: 255 }, 0.7);
        let gloss = Term::plain(Color::WHITE, 0.3);
        let (ambient, diffuse, specular) = match model {
            Model::Phong | Model::Toon => (Term::plain(Color::WHITE, 0.1), clay, gloss),
            // These models have no ambient term of their own, the sub-Lambertian one no highlight
            // either.
            Model::SubLambertian => (Term::NONE, clay, Term::NONE),
            Model::Ashikhmin => (Term::NONE, clay, gloss),
            Model::DiffuseEnvironment => (Term::NONE, Term::plain(Color::WHITE, 1.0), Term::NONE),
            Model::AmbientOcclusion => (Term::plain(Color::WHITE, 1.0), Term::NONE, Term::NONE),
            Model::LitSphere | Model::Mirror | Model::Refraction => {
                (Term::NONE, Term::NONE, Term::plain(Color::WHITE, 1.0))
            }
            Model::Painter => (
                Term::plain(Color::WHITE, 1.0),
                Term { weight: 1.0, ..clay },
                Term::plain(Color::WHITE, 0.1),
            ),
        };
        let is_painter = model == Model::Painter;
        let lamp = match is_painter {
            // Of the mood “studio”.
            true => Light {
                kind: LightKind::Directional { direction: vec3(-0.52, 0.62, 0.59) },
                ..Light::default()
            },
            false => Light::default(),
        };
        Self {
            model,
            lights: vec![lamp],
            ambient,
            diffuse,
            specular,
            shininess: if is_painter { 28.0 } else { 40.0 },
            features: Features::default(),
            reference: Reference::Auto,
            bands: 4,
            exponent: 0.5,
            nu: 100.0,
            nv: 100.0,
            environment: None,
            sphere: None,
            sphere_concave: None,
            strokes: BallStrokes::DEFAULT,
            index: 1.5,
            solid: SolidGlass::DEFAULT,
            occlusion_radius_px: 48.0,
            bounces: 0,
            shadows: Shadows { on: is_painter, ..Shadows::DEFAULT },
            painter: Painter::DEFAULT,
            pixel: PixelShading::default(),
        }
    }

    /// The same, with lengths that suit a canvas.
    pub fn fitting(model: Model, canvas: Size) -> Self {
        /// The side of the canvas that the default lengths are for, px.
        const SIDE_PX: f32 = 1200.0;
        let (mut shading, ratio) = (Self::new(model), canvas.longer_side() / SIDE_PX);
        let fit = |v: f32, least: f32| (v * ratio).round().clamp(least, 1000.0);
        shading.shadows.reach = fit(Shadows::DEFAULT.reach, 8.0);
        shading.painter.contact_size = fit(Painter::DEFAULT.contact_size, 4.0);
        shading.solid.on = model == Model::Refraction;
        if model == Model::LitSphere {
            shading.strokes.size = fit(BallStrokes::DEFAULT.size, 16.0);
            shading.strokes.chunk = fit(BallStrokes::DEFAULT.chunk, 8.0);
        }
        shading
    }

    /// Whether it lights the picture beneath it in place of a color of its own.
    pub fn is_lighting_beneath(&self) -> bool {
        self.model == Model::Painter && self.painter.beneath
    }

    /// Whether it shows something off the surface: a shadow on the page.
    pub fn has_ground_shadow(&self) -> bool {
        self.model.has_lamps() && self.shadows.has_ground() && !self.lights.is_empty()
    }

    /// The same for a moment while the user drags, cheaper to render; `None` if it is the same then.
    pub fn drafted(&self) -> Option<Self> {
        let shadows = self.shadows.drafted();
        let is_other =
            self.model.has_lamps() && self.shadows.has_effect() && shadows != self.shadows;
        is_other.then(|| Self { shadows, ..self.clone() })
    }

    /// With its lengths on a canvas `factor` times as large.
    pub fn scaled(&self, factor: f32) -> Self {
        let mut next = self.clone();
        next.occlusion_radius_px *= factor;
        next.shadows = self.shadows.scaled(factor);
        next.painter = self.painter.scaled(factor);
        next.strokes = self.strokes.scaled(factor);
        next
    }

    /// Its lit sphere, or the one for hollows.
    pub fn ball(&self, hollows: bool) -> Option<&LitSphere> {
        if hollows { self.sphere_concave.as_ref() } else { self.sphere.as_ref() }
    }

    /// With another lit sphere, or another one for hollows.
    pub fn with_ball(self, hollows: bool, ball: LitSphere) -> Self {
        match hollows {
            true => Self { sphere_concave: Some(ball), ..self },
            false => Self { sphere: Some(ball), ..self },
        }
    }

    /// Whether its spheres' brush marks stay whole.
    pub fn has_strokes(&self) -> bool {
        self.model == Model::LitSphere && self.strokes.on
    }

    /// What its shadows, its ball's places and its solid glass keep of each pixel, bytes.
    pub fn kept_bytes(&self) -> u64 {
        let lamps = match self.model.has_lamps() && self.shadows.has_effect() {
            true => self.lights.len().min(Shadows::MOST_LAMPS),
            false => 0,
        };
        let contact = usize::from(self.model == Model::Painter);
        let strokes = usize::from(self.has_strokes());
        let glass = usize::from(self.is_solid_glass());
        let of_shadows = (lamps + contact) * Surface::SHADOW_BYTES;
        (of_shadows + strokes * Surface::BALL_PLACE_BYTES + glass * Surface::BODY_BYTES) as u64
    }

    /// Its lights with their shadows, as seen from the rows of a tile of a surface.
    fn row_lights(&self, surface: &Surface) -> Vec<RowLight> {
        let maps = self.shadows.maps(surface, &self.lights);
        let (mut maps, left) = (maps.into_iter(), self.shadows.remaining_light());
        let row_light = |light: &Light| match maps.next() {
            Some(map) => light.row_light().with_shadow(map, left),
            None => light.row_light(),
        };
        self.lights.iter().map(row_light).collect()
    }
}

#[cfg(test)]
mod tests;
