//! What the numbers of normal and depth maps mean.
//! Floor 4. Plain data with their names in JSON. Not here: which files they belong to (`source`).

crate::named! {
    /// `"encoding"` of normals: how numbers become components.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    pub enum NormalEncoding {
        /// n = 2 v − 1.
        Unsigned = "unsigned",
        /// The numbers themselves, in `[−1, 1]`.
        Signed = "signed",
        /// x and y as `unsigned`, n_z = v.
        FullZ = "full-z",
        /// x and y as `unsigned` (`signed` where they are negative), z = √(1 − x² − y²).
        TwoChannel = "two-channel",
        /// As `two-channel` with x in alpha and y in green.
        Dxt5nm = "dxt5nm",
    }
}

crate::named! {
    /// `"space"` of normals.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    pub enum NormalSpace {
        Camera = "camera",
        /// Turned by `world_to_camera`, or by a rotation found from the depth map.
        World = "world",
    }
}

crate::named! {
    /// `"near"` of depth: which stored numbers are nearer to the viewer.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    pub enum Near { Auto = "auto", Low = "low", High = "high" }
}

crate::named! {
    /// `"encoding"` of depth.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    pub enum DepthEncoding {
        /// Distance along the view axis, in any unit.
        Planar = "planar",
        /// Distance along the ray; turned into planar depth where `fov` is known.
        RayDistance = "ray-distance",
        /// 1/z: near is large, 0 is infinitely far.
        Inverse = "inverse",
        /// Of unknown scale and shift; near is large.
        Disparity = "disparity",
    }
}

/// `"convention"` of normals: the words `"auto"`, `"opengl"`, `"directx"`, or an object of the
/// fields below, each of which is detected where it is absent.
///
/// ```json
/// { "encoding": "unsigned", "channels": "rgb", "srgb": false, "flip_x": false, "flip_y": true, "flip_z": false,
///   "space": "world", "world_to_camera": [[1, 0, 0], [0, 1, 0], [0, 0, 1]], "snap_flat": true, "smooth_steps": false }
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NormalConvention {
    /// How three numbers make a normal; absent: detected.
    pub encoding: Option<NormalEncoding>,
    /// Which channels hold x, y and z: indices 0 … 3 for red, green, blue, alpha. JSON: three of
    /// the letters `rgba`.
    pub channels: Option<[u8; 3]>,
    /// The numbers went through the sRGB curve by mistake: undo it.
    pub srgb: Option<bool>,
    /// The stored x points left.
    pub flip_x: Option<bool>,
    /// The stored y points down ("DirectX").
    pub flip_y: Option<bool>,
    /// The stored z points away from the viewer.
    pub flip_z: Option<bool>,
    /// What the axes are those of; absent: detected.
    pub space: Option<NormalSpace>,
    /// Rows of the rotation n_camera = R n_world (camera: x right, y up, z to the viewer). JSON: 3
    /// × 3 or 4 × 4, row by row, for column vectors.
    pub world_to_camera: Option<[[f32; 3]; 3]>,
    /// Treat |xy| < 1.5/255 as 0 where an 8-bit map is flat.
    pub snap_flat: Option<bool>,
    /// Smooth away the steps of 8 bits, within half a step. Off unless requested.
    pub smooth_steps: Option<bool>,
}

impl NormalConvention {
    /// The words that mean a whole convention.
    pub const WORDS: [&'static str; 3] = ["auto", "opengl", "directx"];

    /// The convention that a word means.
    pub fn from_word(word: &str) -> Option<Self> {
        let fixed = |flip_y| Self {
            channels: Some([0, 1, 2]),
            srgb: Some(false),
            flip_x: Some(false),
            flip_y: Some(flip_y),
            flip_z: Some(false),
            space: Some(NormalSpace::Camera),
            ..Self::default()
        };
        match word {
            "auto" => Some(Self::default()),
            "opengl" => Some(fixed(false)),
            "directx" => Some(fixed(true)),
            _ => None,
        }
    }

    /// The word that means exactly this convention.
    pub fn word(&self) -> Option<&'static str> {
        Self::WORDS.into_iter().find(|w| Self::from_word(w).as_ref() == Some(self))
    }

    /// Reads `channels`: three different letters of `rgba`.
    pub fn channels_from_letters(letters: &str) -> Option<[u8; 3]> {
        let at: Vec<u8> =
            letters.chars().map(|c| "rgba".find(c).map(|i| i as u8)).collect::<Option<_>>()?;
        let [x, y, z] = at.try_into().ok()?;
        (x != y && y != z && x != z).then_some([x, y, z])
    }

    /// The letters of `channels`.
    pub fn letters(channels: [u8; 3]) -> String {
        channels.iter().filter_map(|&c| "rgba".chars().nth(c.into())).collect()
    }
}

/// How depth is to be read: `"near"`, `"encoding"`, `"fov"`, `"background"`, `"range_px"` and
/// `"smooth_steps"`, each detected where absent.
#[derive(Clone, Debug, PartialEq)]
pub struct DepthConvention {
    /// Which end of the range is near.
    pub near: Near,
    /// What the numbers measure; absent: detected.
    pub encoding: Option<DepthEncoding>,
    /// `"fov"`: horizontal field of view in degrees, for distances along the ray.
    pub fov_degrees: Option<f32>,
    /// `"background"`: stored values that mean "no surface", besides those that are detected.
    pub background: Vec<f32>,
    /// `"range_px"`: how many pixels deep the surface is, for normals made from depth.
    pub range_px: Option<f32>,
    /// Smooth away the steps of 8 bits.
    pub smooth_steps: Option<bool>,
}

impl Default for DepthConvention {
    fn default() -> Self {
        Self {
            near: Near::Auto,
            encoding: None,
            fov_degrees: None,
            background: Vec::new(),
            range_px: None,
            smooth_steps: None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_stand_for_conventions_and_back() {
        for word in NormalConvention::WORDS {
            assert_eq!(NormalConvention::from_word(word).unwrap().word(), Some(word));
        }
        let own = NormalConvention { flip_x: Some(true), ..NormalConvention::default() };
        assert_eq!(own.word(), None);
    }

    #[test]
    fn channel_letters_read_back_and_repeats_are_refused() {
        for letters in ["rgb", "gbr", "agb"] {
            let channels = NormalConvention::channels_from_letters(letters).unwrap();
            assert_eq!(NormalConvention::letters(channels), letters);
        }
        for wrong in ["rg", "rrb", "xyz", "rgba"] {
            assert_eq!(NormalConvention::channels_from_letters(wrong), None, "{wrong}");
        }
    }
}
