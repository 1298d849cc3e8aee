//! Bends a color ramp over a surface that is computed here: a knobbly ball becomes metal.
//!
//! `cargo run --example bend_gradient -- [PICTURE]`; without an argument, to the folder for
//! temporary files.

use rilievo::math::{Vec3, vec2, vec3};
use rilievo::paint::Gradient;
use rilievo::raster::Plane;
use rilievo::{Color, Document, Layer, Maps, Operator, Overwrite, Size, Surface, write_picture};
use std::path::{Path, PathBuf};

type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

fn main() -> Result<()> {
    let temporary = || std::env::temp_dir().join("rilievo_bend_gradient.png");
    let picture = std::env::args_os().nth(1).map_or_else(temporary, PathBuf::from);
    bend(&picture)?;
    println!("{}", picture.display());
    Ok(())
}

/// The normal of the ball at a pixel: camera space, x right, y up, z to the viewer. Zero beside it:
/// no surface.
fn normal(x: usize, y: usize) -> Vec3 {
    let p = (vec2(x as f32 + 0.5, y as f32 + 0.5) - 256.0) / 220.0;
    if p.length() >= 1.0 {
        return Vec3::ZERO;
    }
    let knobs = 0.12 * vec2((9.0 * p.x + 5.0 * p.y).sin(), (7.0 * p.y - 6.0 * p.x).sin());
    vec3(p.x + knobs.x, -p.y - knobs.y, (1.0 - p.length_squared()).sqrt()).normalize()
}

/// Writes the picture.
pub fn bend(picture: &Path) -> Result<()> {
    // Depth is derived from the normals; with a depth map of your own, fill in all fields of
    // `Maps`.
    let surface = Surface::new(Maps::from_normals(Plane::from_fn(Size::new(512, 512), normal)))?;

    // A ramp between two points of the canvas. Both are anchors: there the colors stay where they
    // are, and elsewhere the operator moves them as far as the surface turns away from its
    // direction at the anchors.
    let sky = [
        Color::rgb(250, 250, 240),
        Color::rgb(120, 150, 190),
        Color::rgb(30, 30, 44),
        Color::rgb(150, 110, 70),
    ];
    let ramp = Gradient::new(vec2(200.0, 120.0), vec2(310.0, 400.0), &sky);
    // `alpha`: how far, in lengths of the canvas; above 0 like a mirror, below like glass.
    let metal = ramp.with_operator(Operator::Normal { alpha: 0.4, beta: 1.0, detail: 0.0 });

    // Layers, bottom first; they paint on the surface only, unless `clip_to_surface` is off.
    let ground =
        Layer { clip_to_surface: false, ..Layer::new("Ground", Color::rgb(236, 232, 224)) };
    let document = Document::over(surface).with_top(ground).with_top(Layer::new("Metal", metal));
    write_picture(&document, picture, Overwrite::Anything)?;
    Ok(())
}
