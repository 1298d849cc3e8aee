//! Makes the program's own sample surfaces and pictures, all of them procedural:
//! `cargo run --release --example make_samples -- OUT_DIR [NAME]`.
//! The same bytes on every run and with any number of threads.

mod cloth;
mod decals;
mod fossil;
mod landscape;
mod medal;
mod muse;
mod noise;
mod output;
mod painting;
mod patterns;
mod photometry;
mod pictures;
mod render;
mod sdf;
mod shapes;
mod sheet;
mod snail;
mod textures;
mod tube;

use std::error::Error;
use std::path::PathBuf;
use std::time::Instant;

use pictures::{PICTURES, Picture};
use shapes::Sample;

/// Every sample surface, by the function that builds it.
const SURFACES: [fn() -> Sample; 11] = [
    shapes::ball,
    shapes::apple,
    shapes::teapot,
    muse::muse,
    shapes::lettering,
    medal::medal,
    cloth::drapery,
    shapes::still_life,
    shapes::knot,
    snail::snail,
    shapes::moon,
];

/// The studio as light.
const LIGHT: &str = "studio_light.hdr";

/// The surface that is measured from photographs.
const FOSSIL: &str = "fossil";

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let out = PathBuf::from(arguments.next().ok_or("usage: make_samples OUT_DIR [NAME]")?);
    let only = arguments.next();
    for build in SURFACES {
        let start = Instant::now();
        let sample = build();
        if only.as_deref().is_some_and(|name| name != sample.name) {
            continue;
        }
        let maps = render::render(sample.surface.as_ref(), &sample.view);
        output::write_maps(&out.join(sample.name), &maps)?;
        println!("{:<12} {:>6.1} s", sample.name, start.elapsed().as_secs_f64());
    }
    let landscapes: [Picture; 2] =
        [("panorama.jpg", landscape::panorama), ("backplate.jpg", landscape::backplate)];
    for (name, make) in PICTURES.into_iter().chain(landscapes) {
        if only.as_deref().is_some_and(|wanted| wanted != name) {
            continue;
        }
        let start = Instant::now();
        output::write_picture(&out.join("pictures").join(name), &make())?;
        println!("{name:<14} {:>4.1} s", start.elapsed().as_secs_f64());
    }
    if only.as_deref().is_none_or(|wanted| wanted == FOSSIL) {
        let captured = photometry::capture();
        output::write_captured(&out.join(FOSSIL), &captured)?;
        println!("{FOSSIL}: the solved normals are {:.1}° off in the mean", captured.error);
    }
    if only.as_deref().is_none_or(|wanted| wanted == LIGHT) {
        let (width, height, light) = pictures::studio_lat_long();
        output::write_light(&out.join("pictures").join(LIGHT), width, height, &light)?;
    }
    Ok(())
}
