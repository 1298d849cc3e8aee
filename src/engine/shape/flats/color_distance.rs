//! When two colors are one flat, and how far between two colors a mixed one lies. Floor 3.

/// Colors nearer than this, in any channel of 8 bits, are one flat.
pub const NEAR: i32 = 8;

/// Whether a pixel has nearly a color.
pub fn is_near(pixel: [u8; 4], color: [u8; 4]) -> bool {
    pixel.iter().zip(color).all(|(a, b)| (i32::from(*a) - i32::from(b)).abs() <= NEAR)
}

/// How far two colors are apart: the largest difference of a channel.
pub fn color_distance(a: [u8; 4], b: [u8; 4]) -> u8 {
    a.iter().zip(b).map(|(a, b)| a.abs_diff(b)).max().unwrap_or(0)
}

/// How far a pixel lies from one color toward another, 255 at the other; 0 if it is off the line
/// between them.
pub fn share_on_the_way(pixel: [u8; 4], from: [u8; 4], to: [u8; 4]) -> u8 {
    let way: [f32; 4] = std::array::from_fn(|c| f32::from(to[c]) - f32::from(from[c]));
    let gone: [f32; 4] = std::array::from_fn(|c| f32::from(pixel[c]) - f32::from(from[c]));
    let dot = |a: &[f32; 4], b: &[f32; 4]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f32>();
    let length = dot(&way, &way);
    if length < 1.0 {
        return 0;
    }
    let t = (dot(&gone, &way) / length).max(0.0).min(1.0);
    let off: [f32; 4] = std::array::from_fn(|c| gone[c] - t * way[c]);
    if dot(&off, &off) > (4 * NEAR * NEAR) as f32 { 0 } else { (t * 255.0).round() as u8 }
}

/// A channel of what is added may be off by this much from what it must add to what lies behind,
/// of 255.
const ROUNDING: i32 = 1;

/// What has to lie with some alpha over an opaque color, so that a given one is seen. `None` if
/// nothing can.
pub fn uncomposite(seen: [u8; 4], alpha: u8, over: [u8; 4]) -> Option<[u8; 4]> {
    let left = |c: usize| (i32::from(over[c]) * (255 - i32::from(alpha)) + 127) / 255;
    let own = |c: usize| i32::from(seen[c]) - left(c);
    let alpha_range = -ROUNDING..=i32::from(alpha) + ROUNDING;
    (0..3).all(|c| alpha_range.contains(&own(c))).then(|| {
        let channel =
            |c: usize| if c == 3 { alpha } else { own(c).clamp(0, i32::from(alpha)) as u8 };
        std::array::from_fn(channel)
    })
}
