//! The depth of pictures through the whole program: what a file of more than 8 bits holds comes out
//! of it again.

use super::program::program;
use std::path::Path;
use std::process::Output;

fn rilievo(folder: &Path, args: &[&str]) -> Output {
    program().current_dir(folder).args(args).output().unwrap()
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

const STEPS: u32 = 4096;

/// The color of a step of a ramp; bytes cannot tell 16 of them apart.
fn step(x: u32) -> [u16; 4] {
    let v = (x * 65535 / (STEPS - 1)) as u16;
    [v, 65535 - v, 9, 65535]
}

/// Renders with 16 bits; what the program said, and the picture.
fn rendered(
    folder: &Path,
    more: &[&str],
) -> (String, image::ImageBuffer<image::Rgba<u16>, Vec<u16>>) {
    let args = [&["render", "--bits", "16", "--force", "-o", "out.png"], more].concat();
    let output = rilievo(folder, &args);
    assert!(output.status.success(), "{}", said(&output));
    (said(&output), image::open(folder.join("out.png")).unwrap().to_rgba16())
}

#[test]
fn a_ramp_of_16_bits_that_is_paint_in_a_recipe_or_a_project_is_rendered_as_it_was() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let recipe = r#"{ "canvas": { "width": 4096, "height": 2 },
        "layers": [{ "kind": "pixels", "file": "ramp.png" }] }"#;
    std::fs::write(folder.join("r.json"), recipe).unwrap();
    let ramp = image::ImageBuffer::from_fn(STEPS, 2, |x, _| image::Rgba(step(x)));
    image::DynamicImage::ImageRgba16(ramp).save(folder.join("ramp.png")).unwrap();
    let converted = rilievo(folder, &["convert", "r.json", "a.ora"]);
    assert!(converted.status.success() && said(&converted).is_empty(), "{}", said(&converted));
    for document in ["r.json", "a.ora", "ramp.png"] {
        let (said, picture) = rendered(folder, &[document]);
        assert_eq!(said, "", "{document}");
        let apart = picture.enumerate_pixels().flat_map(|(x, _, p)| step(x).into_iter().zip(p.0));
        assert!(apart.map(|(a, b)| a.abs_diff(b)).max() <= Some(1), "{document}");
        // The 64 tiles of 16 bits take 3.1 MB, and those of 8 bits 1.0 MB.
        let (said, picture) = rendered(folder, &[document, "--max-memory", "3M"]);
        assert!(said.contains("its paint was read with 8 bits"), "{document}: {said}");
        assert_eq!(said.lines().count(), 1, "{document}: {said}");
        let apart = picture.enumerate_pixels().flat_map(|(x, _, p)| step(x).into_iter().zip(p.0));
        assert!(apart.map(|(a, b)| a.abs_diff(b)).max() <= Some(128), "{document}");
        assert!(picture.pixels().all(|p| p.0.iter().all(|v| v.is_multiple_of(257))), "{document}");
    }
}
