//! Paints a stroke on waves: its dabs follow the slopes. The layer keeps the stroke, so it can be
//! changed afterwards.
//!
//! `cargo run --example paint_stroke -- [PICTURE]`, without it to the folder for temporary files.

use rilievo::math::vec2;
use rilievo::paint::{Brush, Sample, Stroke};
use rilievo::raster::Plane;
use rilievo::shading::{Model, Shading};
use rilievo::{
    BlendMode, Color, Content, Document, Layer, Maps, Operator, Overwrite, Size, Surface,
    write_picture,
};
use std::path::{Path, PathBuf};

type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

fn main() -> Result<()> {
    let temporary = || std::env::temp_dir().join("rilievo_paint_stroke.png");
    let picture = std::env::args_os().nth(1).map_or_else(temporary, PathBuf::from);
    paint(&picture)?;
    println!("{}", picture.display());
    Ok(())
}

/// What the pen reported: a wavy line at a height, pressed harder toward its middle.
fn pen(y: f32) -> Vec<Sample> {
    let sample = |i: usize| {
        let t = i as f32 / 120.0;
        let at = vec2(50.0 + 412.0 * t, y + 60.0 * (std::f32::consts::TAU * t).sin());
        Sample { pressure: (std::f32::consts::PI * t).sin(), time_secs: t, ..Sample::at(at) }
    };
    (0..=120).map(sample).collect()
}

/// Writes the picture.
pub fn paint(picture: &Path) -> Result<()> {
    // Depth alone: 0 near … 1 far, here 60 pixels deep. Normals are derived from its slopes.
    let depth = |x: usize, y: usize| 0.5 + 0.5 * (x as f32 / 40.0).sin() * (y as f32 / 57.0).cos();
    let surface = Surface::new(Maps::from_depth(Plane::from_fn(Size::new(512, 512), depth), 60.0))?;

    // Every brush setting has a default. This operator lays the mark on the surface like a print.
    let brush = Brush { size: 64.0, hardness: 0.6, spacing: 0.1, ..Brush::default() };
    let on_surface = Operator::Surface { amount: 1.0, smooth: 2.0 };
    let red = Stroke::new(brush.clone(), on_surface, Color::rgb(190, 60, 40), pen(180.0));

    let light =
        Layer { blend: BlendMode::Multiply, ..Layer::new("Light", Shading::new(Model::Phong)) };
    let document = Document::over(surface)
        .with_top(Layer::new("Cloth", Color::rgb(226, 214, 190)))
        .with_top(Layer::new("Strokes", red.clone()))
        .with_top(light);

    // A document is a value: an edit makes another one, and shares with it what is the same.
    let id = document.layers[1].id;
    let blue = Stroke::new(brush, on_surface, Color::rgb(40, 70, 160), pen(340.0));
    let edited = document.with_layer(id, |layer| layer.content = Content::from(vec![red, blue]));
    write_picture(&edited.ok_or("it has that layer")?, picture, Overwrite::Anything)?;
    Ok(())
}
