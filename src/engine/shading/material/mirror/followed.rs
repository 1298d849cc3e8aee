//! What the rays of a tile see where they are followed over the surface (MATH 5). Floor 3.
//!
//! Where a ray meets bumps, a pixel can see a lamp by chance that none of its neighbors sees. It is
//! made no brighter than the brightest of them.

use super::{rays::RayRow, refractive_index};
use crate::math::{Rect, Vec3, srgb, vec3};
use crate::raster::TILE;
use crate::shading::features::FeatureMap;
use crate::shading::surface_row::{Light3, SurfaceRow};
use crate::shading::{Model, Shading};
use crate::surface::{Surface, links};

/// What the rays of a tile and of the pixels around it see.
pub struct FollowedTile {
    /// The pixels that are known: the tile's, and those around it.
    rect: Rect,
    /// Row by row: linear light.
    light: Vec<Vec3>,
    /// Whether the pixel's rays meet the surface.
    is_met: Vec<bool>,
}

impl FollowedTile {
    /// Follows the rays of a tile and around it; `None` where no ray is followed, or on a far side,
    /// whose pixels are no neighbors.
    pub fn of(
        shading: &Shading,
        surface: &Surface,
        features: &FeatureMap,
        area: Rect,
    ) -> Option<Self> {
        let is_followed = matches!(shading.model, Model::Mirror | Model::Refraction);
        let surface = surface.on_canvas().filter(|_| is_followed && shading.bounces_made() > 0)?;
        let environment_light = shading.environment.as_ref()?.environment_light();
        let rect = area.grown(1).intersect(surface.size().rect());
        let pixels = rect.width() * rect.height();
        let mut tile = Self { rect, light: vec![Vec3::ZERO; pixels], is_met: vec![false; pixels] };
        for y in rect.y0..rect.y1 {
            for (from, to) in [(rect.x0, area.x0), (area.x0, area.x1), (area.x1, rect.x1)] {
                if from == to {
                    continue;
                }
                let (x0, y, width) = (from as usize, y as usize, (to - from) as usize);
                let row = SurfaceRow::new(surface, features, x0, y, width);
                let mut light = [[0.0; TILE]; 3];
                let rays = RayRow::new(&row, refractive_index(shading));
                let met = rays.see(shading, &row, &environment_light, &mut light);
                let place = tile.place(from, y as i32);
                let [red, green, blue] = &light;
                for (x, texel) in tile.light[place..place + width].iter_mut().enumerate() {
                    *texel = vec3(red[x], green[x], blue[x]);
                    tile.is_met[place + x] = met >> x & 1 == 1;
                }
            }
        }
        Some(tile)
    }

    fn place(&self, x: i32, y: i32) -> usize {
        (y - self.rect.y0) as usize * self.rect.width() + (x - self.rect.x0) as usize
    }

    /// The light of a row of the tile.
    pub fn read(&self, surface_row: &SurfaceRow, light: &mut Light3) {
        let [red, green, blue] = light;
        let texels = red.iter_mut().zip(green).zip(blue).take(surface_row.width);
        for (x, ((red, green), blue)) in texels.enumerate() {
            let at = (surface_row.x0 + x, surface_row.y);
            (*red, *green, *blue) = self.at(surface_row.surface, at).into();
        }
    }

    /// The light of a pixel: where its rays meet the surface, no brighter than the brightest of the
    /// pixels around it on the same piece.
    fn at(&self, surface: &Surface, (x, y): (usize, usize)) -> Vec3 {
        let place = self.place(x as i32, y as i32);
        let own = self.light[place];
        if !self.is_met[place] {
            return own;
        }
        let luminance = |light: Vec3| srgb::luminance(light.x, light.y, light.z);
        let joined = links::joined_neighbors(surface.smooth_links_plane(), (x, y));
        let around = joined.into_iter().enumerate().filter(|&(i, joined)| joined && i != 4);
        let brightest = around
            .map(|(i, _)| {
                let (dx, dy) = (i as i32 % 3 - 1, i as i32 / 3 - 1);
                luminance(self.light[self.place(x as i32 + dx, y as i32 + dy)])
            })
            .reduce(f32::max);
        let own_luminance = luminance(own);
        match brightest {
            Some(brightest) if brightest < own_luminance => own * (brightest / own_luminance),
            _ => own,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Size, srgb::Color};
    use crate::raster::Picture;
    use crate::shading::Environment;
    use crate::shading::material::second_look::tests::{PAIR, scene};
    use crate::shading::material::tests::{ball, term};

    /// Nine pixels of the ball's surface, dark but for the one in the middle.
    fn around_a_bright_one(is_met: bool) -> (FollowedTile, (usize, usize)) {
        let mut light = vec![vec3(0.1, 0.1, 0.1); 9];
        (light[2], light[4]) = (vec3(0.2, 0.2, 0.2), vec3(8.0, 4.0, 4.0));
        let rect = Rect::new(59, 65, 62, 68);
        (FollowedTile { rect, light, is_met: vec![is_met; 9] }, (60, 66))
    }

    #[test]
    fn a_single_bright_pixel_that_meets_the_surface_is_as_bright_as_its_brightest_neighbor() {
        let surface = ball().surface.unwrap();
        let (tile, at) = around_a_bright_one(true);
        let seen = tile.at(&surface, at);
        assert!((srgb::luminance(seen.x, seen.y, seen.z) - 0.2).abs() < 1e-4, "{seen}");
        assert!((seen.x - 2.0 * seen.y).abs() < 1e-5, "its color stays: {seen}");
        let (tile, at) = around_a_bright_one(false);
        assert_eq!(tile.at(&surface, at), vec3(8.0, 4.0, 4.0), "it sees a lamp itself");
    }

    #[test]
    fn tiles_know_what_the_pixels_beside_them_see() {
        let texel = |i: u32| {
            let light = 0.1 + (i % 64) as f32 / 64.0;
            [light, 0.5 * light, 1.0 - 0.5 * light, 1.0]
        };
        let picture = Picture::linear(Size::new(64, 32), (0..64 * 32).map(texel).collect());
        let shading = Shading {
            environment: Some(Environment::new("sky.hdr".into(), picture.unwrap())),
            specular: term(Color::WHITE, 0.9, 0.4, 0.0),
            bounces: 2,
            ..Shading::new(Model::Mirror)
        };
        let scene = scene(&PAIR);
        let surface = scene.surface.as_deref().unwrap();
        let features = shading.features.on(surface);
        // The edge lies where the left ball sees the right one.
        let [left, right] = [Rect::new(0, 0, 54, 64), Rect::new(54, 0, 118, 64)]
            .map(|area| FollowedTile::of(&shading, surface, &features, area).unwrap());
        let mut met = 0;
        for (x, y) in (53..55).flat_map(|x| (0..64).map(move |y| (x, y))) {
            let [a, b] = [&left, &right].map(|tile| (tile, tile.place(x, y)));
            // Of a contour pixel in another row the rays' differences read the maps as they are.
            let off = a.0.light[a.1].distance(b.0.light[b.1]);
            assert!(off < 1.0 / 255.0, "{x} {y}: {off}");
            assert_eq!(a.0.is_met[a.1], b.0.is_met[b.1], "{x} {y}");
            met += usize::from(a.0.is_met[a.1]);
        }
        assert!(met > 0, "rays meet the surface at the edge of the tiles");
    }
}
