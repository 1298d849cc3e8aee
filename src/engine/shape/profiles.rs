//! Lighting profiles: normals from one drawing shaded several times by hand, each with the light
//! elsewhere. Floor 3. Photometric stereo (Woodham 1980): I_k = ρ n·ℓ_k.

use super::lines::filled;
use super::touches::{unproject_normal, with_normals};
use super::{Form, Outline};
use crate::math::{Mat3, Size, Vec3, vec2, vec3};
use crate::raster::Plane;

/// One shading of the drawing.
pub struct ShadedDrawing {
    /// Linear light, `[0, 1]`.
    pub gray: Plane<f32>,
    /// Unit, toward the light, camera space (y up).
    pub light: Vec3,
}

/// What shadings give.
pub struct ProfileNormals {
    /// Unit, camera space; zero where fewer than three shadings give a value.
    pub normals: Plane<Vec3>,
    /// ρ.
    pub albedo: Plane<f32>,
    /// How far the shadings contradict each other, r.m.s. of the residual of I, linear light.
    pub residual: Plane<f32>,
}

/// How many shadings there may be.
pub const MOST_PROFILES: usize = 5;
/// A shading darker or lighter than this is clipped and gives nothing: half a step of 8 bits, and
/// as much below white.
const CLIPPED: (f32, f32) = (0.0016, 0.9984);

/// ρn = (Σ w ℓℓᵀ)⁻¹ Σ w I ℓ at every pixel, w = 0 where a shading is clipped.
///
/// With two shadings, n is the one nearest to the viewer's direction that both allow (the third
/// equation is n·z ≥ 0, held faintly). `None` where the planes differ in size or there are fewer
/// than two or more than five.
pub fn normals_from_profiles(profiles: &[ShadedDrawing]) -> Option<ProfileNormals> {
    let size = profiles.first()?.gray.size();
    let fits = (2..=MOST_PROFILES).contains(&profiles.len())
        && profiles.iter().all(|p| p.gray.size() == size);
    if !fits {
        return None;
    }
    let all = Plane::from_fn(size, |x, y| solve(profiles, x, y));
    Some(ProfileNormals {
        normals: all.map(|v| v.0.normalize_or(Vec3::ZERO)),
        albedo: all.map(|v| v.0.length()),
        residual: all.map(|v| v.1),
    })
}

/// ρn and the residual at a pixel; zero where they are unknown.
fn solve(profiles: &[ShadedDrawing], x: usize, y: usize) -> (Vec3, f32) {
    let is_exposed = |p: &&ShadedDrawing| {
        let gray = p.gray.at(x, y);
        gray > CLIPPED.0 && gray < CLIPPED.1
    };
    let used: Vec<&ShadedDrawing> = profiles.iter().filter(is_exposed).collect();
    if used.len() < profiles.len().min(3) {
        return (Vec3::ZERO, 0.0);
    }
    let outer = |l: Vec3| Mat3::from_cols(l * l.x, l * l.y, l * l.z);
    let mut normal = used.iter().fold(Mat3::ZERO, |m, p| m + outer(p.light));
    let mut right = used.iter().fold(Vec3::ZERO, |v, p| v + p.light * p.gray.at(x, y));
    if used.len() < 3 {
        // Two planes meet in a line: the point of it that is nearest to the viewer's direction.
        const FAINT: f32 = 1e-3;
        let mean = used.iter().map(|p| p.gray.at(x, y)).sum::<f32>() / used.len() as f32;
        normal += FAINT * outer(Vec3::Z);
        right += FAINT * mean * Vec3::Z;
    }
    if normal.determinant().abs() < 1e-9 {
        return (Vec3::ZERO, 0.0);
    }
    let found = normal.inverse() * right;
    if !found.is_finite() || found.length() < 1e-6 {
        return (Vec3::ZERO, 0.0);
    }
    let left = used.iter().map(|p| (p.gray.at(x, y) - found.dot(p.light)).powi(2)).sum::<f32>();
    (found, (left / used.len() as f32).sqrt())
}

/// The form that shadings give within an outline: their normals, and heights with these slopes.
/// Where they give nothing (all but two are clipped) the form continues from its neighborhood.
/// `None` as for [`normals_from_profiles`].
///
/// The planes of the shadings are those of the outline.
pub fn solve_form(profiles: &[ShadedDrawing], outline: &Outline) -> Option<Form> {
    let (found, inside) = (normals_from_profiles(profiles)?, outline.inside_pixels());
    if found.normals.size() != inside.size() {
        return None;
    }
    let is_exposed = Plane::from_fn(inside.size(), |x, y| {
        inside.at(x, y) && found.normals.at(x, y) != Vec3::ZERO
    });
    let unknown = Plane::from_fn(inside.size(), |x, y| inside.at(x, y) && !is_exposed.at(x, y));
    let bar = Plane::from_fn(inside.size(), |x, y| {
        let n = found.normals.at(x, y);
        // What turns away from the viewer is not seen.
        let n = if n.z < 0.0 { vec3(n.x, n.y, 0.0).normalize_or(Vec3::Z) } else { n };
        vec2(n.x, -n.y)
    });
    let bar = filled(bar, &unknown, inside);
    let normals = Plane::from_fn(inside.size(), |x, y| {
        if inside.at(x, y) { unproject_normal(bar.at(x, y)) } else { Vec3::Z }
    });
    let flat = Form {
        corner: outline.corner(),
        height: Plane::full(inside.size(), 0.0).into(),
        normals: normals.clone().into(),
        coverage: outline.coverage().clone(),
    };
    let form = with_normals(&flat, outline, normals);
    // Its lowest point is at 0.
    let covered =
        || form.height.values().iter().zip(inside.values()).filter(|(_, i)| **i).map(|(z, _)| *z);
    let low = covered().fold(f32::MAX, f32::min);
    Some(if low < f32::MAX { form.raised(-low) } else { form })
}

/// The size of all shadings; `None` if there are none.
pub fn size_of(profiles: &[ShadedDrawing]) -> Option<Size> {
    profiles.first().map(|p| p.gray.size())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::primitive::{Body, Primitive};

    fn lights() -> Vec<Vec3> {
        let around = |i: usize| {
            let turn = crate::math::Vec2::from_angle(std::f32::consts::TAU * i as f32 / 4.0 + 0.3);
            vec3(turn.x * 0.6, turn.y * 0.6, 0.8)
        };
        (0..4).map(around).chain([Vec3::Z]).collect()
    }

    #[test]
    fn five_shadings_of_a_ball_give_its_normals_back_and_shadows_hardly_harm_them() {
        let ball = Primitive::new(Body::Sphere, vec2(60.0, 60.0), 55.0).form(1 << 16).unwrap();
        let shaded = |light: Vec3| ShadedDrawing {
            gray: ball.normals.map(|n| (0.8 * n.dot(light)).max(0.0).min(1.0)),
            light,
        };
        let profiles: Vec<ShadedDrawing> = lights().into_iter().map(shaded).collect();
        let found = normals_from_profiles(&profiles).unwrap();
        let (mut clear, mut shadowed) = (Vec::new(), Vec::new());
        for (i, n) in ball.normals.values().iter().enumerate() {
            if ball.coverage.values()[i] == 255 {
                let got = found.normals.values()[i];
                let off = got.cross(*n).length().atan2(got.dot(*n)).to_degrees();
                let lit = profiles.iter().all(|p| n.dot(p.light) > 0.01);
                if lit { clear.push(off) } else { shadowed.push(off) }
            }
        }
        let mean = |v: &[f32]| v.iter().sum::<f32>() / v.len() as f32;
        assert!(
            mean(&clear) < 0.5 && mean(&shadowed) < 3.0,
            "{}°, {}°",
            mean(&clear),
            mean(&shadowed)
        );
        assert!(shadowed.len() > 100);
        assert!(found.residual.values().iter().all(|r| *r < 1e-3));
    }

    #[test]
    fn a_shading_that_contradicts_the_others_shows_in_the_residual() {
        let size = Size::new(4, 4);
        let n = vec3(0.3, 0.2, 0.9).normalize();
        let mut profiles: Vec<ShadedDrawing> = lights()
            .into_iter()
            .map(|light| ShadedDrawing { gray: Plane::full(size, 0.7 * n.dot(light)), light })
            .collect();
        profiles[0].gray.set(2, 2, 0.9);
        let found = normals_from_profiles(&profiles).unwrap();
        assert!(found.residual.at(2, 2) > 0.05 && found.residual.at(0, 0) < 1e-4);
        assert!(normals_from_profiles(&profiles[..1]).is_none());
    }
}
