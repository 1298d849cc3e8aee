//! Gives a drawing in flat colors a shape: each color becomes a part, which is inflated and lit.
//!
//! `cargo run --example shape_from_drawing -- [PICTURE]`; without an argument, to the folder for
//! temporary files.

use rilievo::math::vec2;
use rilievo::shading::{Model, Shading};
use rilievo::shape::{Inflation, Part, PartFor, parts_of_flats};
use rilievo::{BlendMode, Color, Document, Layer, Overwrite, Size, TileGrid, write_picture};
use std::path::{Path, PathBuf};
use std::sync::Arc;

const SIZE: Size = Size::new(480, 400);

fn main() -> rilievo::Result<()> {
    let temporary = || std::env::temp_dir().join("rilievo_shape_from_drawing.png");
    let picture = std::env::args_os().nth(1).map_or_else(temporary, PathBuf::from);
    shape(&picture)?;
    println!("{}", picture.display());
    Ok(())
}

/// A bird of four flat colors on a transparent ground, as straight RGBA.
fn drawing() -> TileGrid {
    let ellipses = [
        (vec2(230.0, 230.0), vec2(170.0, 130.0), Color::rgb(222, 126, 60)),
        (vec2(280.0, 270.0), vec2(90.0, 50.0), Color::rgb(160, 74, 40)),
        (vec2(140.0, 170.0), vec2(38.0, 38.0), Color::rgb(246, 240, 226)),
        (vec2(134.0, 172.0), vec2(16.0, 16.0), Color::rgb(40, 36, 44)),
    ];
    let pixel = |i: usize| {
        let at =
            vec2((i % SIZE.width as usize) as f32 + 0.5, (i / SIZE.width as usize) as f32 + 0.5);
        let inside =
            ellipses.iter().rev().find(|(middle, radii, _)| ((at - middle) / radii).length() < 1.0);
        inside.map_or([0; 4], |(_, _, color)| [color.r, color.g, color.b, 255])
    };
    let rgba: Vec<u8> = (0..SIZE.area()).flat_map(pixel).collect();
    TileGrid::from_straight_rgba(&rgba, SIZE.width as usize, SIZE.height as usize, 0, 0)
}

/// Writes the picture.
pub fn shape(picture: &Path) -> rilievo::Result<()> {
    let flats = drawing();
    // A part for each color, in the order in which they lie on each other. Parts stay linked to
    // the layer by its name: if it is painted on, the shape follows.
    let found = parts_of_flats(&flats, "Drawing", Inflation::default(), PartFor::Color);
    let parts = found.parts.into_iter().map(|part| Arc::new(Part { raise: 4.0, ..part }));

    // From here on, the document has a surface, as if its maps had been read from files.
    let document =
        Document::empty(SIZE).with_top(Layer::new("Drawing", flats)).with_parts(parts.collect());
    let light =
        Layer { blend: BlendMode::Multiply, ..Layer::new("Light", Shading::new(Model::Phong)) };
    write_picture(&document.with_top(light), picture, Overwrite::Anything)
}
