//! Floor 0: numbers without pictures. Vectors are `glam`'s; a position and a direction are both
//! `Vec2`, distinguished by name.

pub mod cielab;
pub mod color_profile;
pub mod conjugate_gradients;
pub mod fast;
pub mod hash;
pub mod hsv;
pub mod named;
pub mod noise;
pub(crate) mod number_settings;
pub mod oklab;
pub mod oklch;
pub mod parallel;
pub mod plane_map;
pub mod range;
pub mod rect;
pub mod simd;
pub mod srgb;
pub mod union_find;

pub use color_profile::{ColorProfile, ProfileConversion};
pub use glam::{Affine2, DVec2, Mat2, Mat3, Vec2, Vec3, Vec3A, Vec4, vec2, vec3};
pub use number_settings::NumberSetting;
pub use plane_map::PlaneMap;
pub use range::{COORDINATE, Range, TURNS, UNIT};
pub use rect::{Rect, Size};
