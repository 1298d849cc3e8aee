//! CIE L*a*b* of the connection space (D50), as profiles, Photoshop and swatches mean it.
//! Floor 0. Not here: OKLab, in which this program computes (`oklab`).

/// The connection space's white.
const WHITE: [f32; 3] = [0.9642, 1.0, 0.8249];
/// XYZ of D50 to linear sRGB, adapted by Bradford's matrix.
const TO_SRGB: [[f32; 3]; 3] = [
    [3.133_856, -1.616_867, -0.490_615],
    [-0.978_768, 1.916_142, 0.033_454],
    [0.071_945, -0.228_991, 1.405_243],
];

/// Linear sRGB of a color with L in `[0, 100]`; what sRGB lacks lies outside `[0, 1]`.
pub fn to_linear([l, a, b]: [f32; 3]) -> [f32; 3] {
    let y = (l + 16.0) / 116.0;
    let (x, z) = (y + a / 500.0, y - b / 200.0);
    let linear = |t: f32| {
        if t > 6.0 / 29.0 { t * t * t } else { 3.0 * (6.0f32 / 29.0).powi(2) * (t - 4.0 / 29.0) }
    };
    let xyz = [linear(x) * WHITE[0], linear(y) * WHITE[1], linear(z) * WHITE[2]];
    TO_SRGB.map(|row| row[0] * xyz[0] + row[1] * xyz[1] + row[2] * xyz[2])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::srgb::{encode, quantize};

    #[test]
    fn white_black_and_a_red_are_where_profiles_have_them() {
        let bytes = |lab| to_linear(lab).map(|v| quantize(encode(v)));
        assert_eq!((bytes([100.0, 0.0, 0.0]), bytes([0.0; 3])), ([255; 3], [0; 3]));
        // sRGB's red, as profiles give it in D50.
        let [r, g, b] = bytes([54.29, 80.81, 69.89]);
        assert!(r == 255 && g <= 1 && b <= 1, "{r} {g} {b}");
        assert!(to_linear([50.0, -100.0, 0.0])[0] < 0.0, "beyond sRGB");
    }
}
