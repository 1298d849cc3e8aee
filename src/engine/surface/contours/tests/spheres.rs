//! Nine spheres before each other and before nothing, drawn exactly: what contours are judged by.
//! The tests of the whole program read this file too, so it names nothing of the engine.

use glam::{Vec3, vec2, vec3};

/// Width and height of the canvas, px.
pub const CANVAS: [u32; 2] = [260, 200];

/// Center, height and radius, px; the first is in front.
const SPHERES: [(f32, f32, f32, f32); 9] = [
    (61.3, 58.7, 180.0, 34.2),
    (97.9, 71.2, 150.0, 40.6),
    (140.1, 50.4, 120.0, 30.9),
    (168.6, 83.3, 90.0, 44.4),
    (110.4, 121.8, 60.0, 47.7),
    (60.2, 130.9, 40.0, 39.1),
    (187.7, 130.6, 20.0, 36.3),
    (215.4, 76.9, 0.0, 33.8),
    (150.3, 150.2, -20.0, 38.5),
];

/// Which sphere a point shows, its normal (y up) and its height.
pub fn hit_at(x: f32, y: f32) -> Option<(usize, Vec3, f32)> {
    let hits = SPHERES.iter().enumerate().filter_map(|(i, &(cx, cy, z, r))| {
        let p = vec2(x - cx, y - cy) / r;
        let up = 1.0 - p.length_squared();
        (up > 0.0).then(|| (i, vec3(p.x, -p.y, up.sqrt()), z + r * up.sqrt()))
    });
    hits.max_by(|a, b| a.2.total_cmp(&b.2))
}
