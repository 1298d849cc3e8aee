//! Which cells are searched for lines that part pixels. Floor 2.

use super::super::tests::{cube, surface, torus};
use super::*;
use crate::math::Size;
use crate::surface::Maps;

/// Whether something may part the pixels of a cell, asked pixel by pixel.
fn is_parted(surface: &Surface, shares: &Plane<u8>, (x, y): (usize, usize)) -> bool {
    let corners = [(x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1)];
    let sides = [
        ((x, y), links::RIGHT),
        ((x, y + 1), links::RIGHT),
        ((x, y), links::DOWN),
        ((x + 1, y), links::DOWN),
    ];
    let is_linked =
        |links: &Plane<u8>| sides.iter().all(|((x, y), bit)| links.at(*x, *y) & bit != 0);
    let is_one_part = surface.parts_plane().is_none_or(|parts| {
        let part = |(x, y): (usize, usize)| parts.at(x, y);
        corners.into_iter().all(|corner| part(corner) == part((x, y)))
    });
    let is_on = corners.into_iter().all(|(x, y)| shares.at(x, y) >= 128);
    !(is_on
        && is_linked(surface.links_plane())
        && is_linked(surface.smooth_links_plane())
        && is_one_part)
}

#[test]
fn cells_that_something_parts_are_those_that_single_pixels_find() {
    let size = Size::new(131, 131);
    let torus = surface(size, torus(131.0, 40.0, 14.0, 35.0));
    let cube = surface(size, cube(131.0, 33.0));
    // Parts that touch without a step: one piece, and the border between them.
    let parts = Plane::from_fn(size, |x, y| 1 + u32::from(x + y / 2 > 90));
    let maps = Maps {
        normals: Plane::from_fn(size, |x, y| torus.normal(x, y)),
        depth: torus.depth_plane().clone(),
        coverage: torus.coverage_plane().clone(),
    };
    let parted = Surface::with_parts(maps, parts, &[0, 1, 1], &mut Default::default()).unwrap();
    for (name, surface) in [("torus", &torus), ("cube", &cube), ("parts", &parted)] {
        let shares = surface.shares();
        let found = parted_cells(surface, &shares);
        assert_eq!(found.len(), 130, "{name}");
        for (y, row) in found.iter().enumerate() {
            let expected: Vec<(usize, usize)> = (0..130)
                .map(|x| (x, y))
                .filter(|cell| is_parted(surface, &shares, *cell))
                .collect();
            assert_eq!(*row, expected, "{name}: row {y}");
        }
        // Lines are traced in these cells alone: none that parts two pixels may be missing.
        let partings = Partings { surface, shares, own: Plane::full(size, 1.0), cells: Vec::new() };
        for (x, y) in (0..130).flat_map(|y| (0..130).map(move |x| (x, y))) {
            let is_crossed = partings.parting((x, y), (x + 1, y)).is_some()
                || partings.parting((x, y), (x, y + 1)).is_some();
            assert!(!is_crossed || found[y].contains(&(x, y)), "{name}: {x}, {y} is left out");
        }
    }
}
