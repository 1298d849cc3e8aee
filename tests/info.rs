//! `rilievo info` as scripts meet it.

use super::maps::{Ball, encode, exr_bytes, png};
use super::program::program;
use serde_json::Value;
use std::fs;
use std::process::Output;

fn info(folder: &std::path::Path, args: &[&str]) -> Output {
    program().arg("info").args(args).current_dir(folder).output().unwrap()
}

#[test]
fn a_set_is_recognized_and_its_convention_told_as_json() {
    let (ball, folder) = (Ball::new(), tempfile::tempdir().unwrap());
    let normal =
        png(8, |x, y| ball.at(x, y).map_or([0.5, 0.5, 1.0, 1.0], |(n, _)| encode(n.x, -n.y, n.z)));
    fs::write(folder.path().join("pot_n.png"), normal).unwrap();
    fs::write(folder.path().join("pot_d.png"), ball.depth_png()).unwrap();
    fs::write(folder.path().join("pot_mask.png"), ball.mask_png()).unwrap();
    let output = info(folder.path(), &["pot_n.png", "pot_d.png", "pot_mask.png", "--json"]);
    assert!(output.status.success());
    let json: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(json["files"][1]["role"], "depth");
    let surface = &json["surfaces"][0];
    assert_eq!(surface["files"].as_array().unwrap().len(), 3);
    assert_eq!(surface["found"]["normal.flip_y"]["value"], "true");
    assert!(surface["found"]["normal.flip_y"]["confidence"].as_f64().unwrap() > 0.9);
    assert_eq!(surface["surface"]["normal"]["convention"]["flip_y"], true);
}

#[test]
fn an_exr_is_listed_by_layers_and_read_as_a_surface() {
    let (ball, folder) = (Ball::new(), tempfile::tempdir().unwrap());
    let plane = |f: &dyn Fn(glam::Vec3, f32) -> f32, outside: f32| -> Vec<f32> {
        let at = |i: usize| {
            ball.at(i % super::maps::SIDE, i / super::maps::SIDE).map_or(outside, |(n, z)| f(n, z))
        };
        (0..super::maps::SIDE * super::maps::SIDE).map(at).collect()
    };
    let channels = [
        ("N.X", plane(&|n, _| n.x, 0.0)),
        ("N.Y", plane(&|n, _| n.y, 0.0)),
        ("N.Z", plane(&|n, _| n.z, 0.0)),
        ("Z", plane(&|_, z| z, 1e10)),
    ];
    fs::write(folder.path().join("g.exr"), exr_bytes(&channels, None)).unwrap();
    let output = info(folder.path(), &["g.exr"]);
    let text = String::from_utf8(output.stdout).unwrap();
    for part in ["N.X (float)", "normal.space", "camera", "depth.near", "low"] {
        assert!(text.contains(part), "{part} is missing from {text}");
    }
}

#[test]
fn a_damaged_file_fails_but_does_not_hide_the_others() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("good.png"), Ball::new().normal_png()).unwrap();
    fs::write(folder.path().join("bad.png"), "no picture").unwrap();
    let output = info(folder.path(), &["bad.png", "good.png"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&output.stdout).contains("good.png: PNG, 96 × 96 pixels"));
    assert!(String::from_utf8_lossy(&output.stderr).contains("bad.png"));
}
