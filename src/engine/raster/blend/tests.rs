//! Blend modes against the specification, hand-computed values and an independent rasterizer.

use super::spec::BlendFunction;
use super::*;
use crate::raster::tile::{TILE, TileF32, sixteen_bit};

/// Straight component values worth trying: ends, edges of the piecewise formulas, and between.
const VALUES: [f32; 9] = [0.0, 0.1, 0.25, 0.3, 0.5, 0.6, 0.75, 0.9, 1.0];
const ALPHAS: [f32; 4] = [0.0, 0.3, 0.8, 1.0];

fn separable(mode: BlendMode) -> fn(f32, f32) -> f32 {
    match mode.function() {
        BlendFunction::Separable(b) => b,
        _ => panic!("{} is not separable", mode.name()),
    }
}

fn close(a: &[f32], b: &[f32], tolerance: f32) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() <= tolerance)
}

fn one_pixel(p: [f32; 4]) -> Box<TileF32> {
    vec![p; TILE_AREA].into_boxed_slice().try_into().unwrap()
}

/// The fast path's result for one pixel.
fn fast(mix: Mix, backdrop: [f32; 4], source: [f32; 4]) -> [f32; 4] {
    let mut tile = PlanarTile::from_pixels(&one_pixel(backdrop));
    tile.blend(mix, TilePaint::Solid(source), &TileCoverage::FULL);
    tile.rows()[17].pixel(23)
}

#[test]
fn separable_modes_give_the_values_computed_by_hand() {
    // (mode, cb, cs, B)
    let table = [
        (BlendMode::Normal, 0.2, 0.7, 0.7),
        (BlendMode::Multiply, 0.4, 0.5, 0.2),
        (BlendMode::Screen, 0.4, 0.5, 0.7),
        (BlendMode::Overlay, 0.4, 0.6, 0.48),
        (BlendMode::Overlay, 0.7, 0.6, 0.76),
        (BlendMode::Darken, 0.4, 0.5, 0.4),
        (BlendMode::Lighten, 0.4, 0.5, 0.5),
        (BlendMode::ColorDodge, 0.0, 1.0, 0.0),
        (BlendMode::ColorDodge, 0.1, 1.0, 1.0),
        (BlendMode::ColorDodge, 0.2, 0.5, 0.4),
        (BlendMode::ColorDodge, 0.8, 0.5, 1.0),
        (BlendMode::ColorBurn, 1.0, 0.0, 1.0),
        (BlendMode::ColorBurn, 0.9, 0.0, 0.0),
        (BlendMode::ColorBurn, 0.8, 0.5, 0.6),
        (BlendMode::ColorBurn, 0.2, 0.5, 0.0),
        (BlendMode::HardLight, 0.4, 0.3, 0.24),
        (BlendMode::HardLight, 0.4, 0.7, 0.64),
        (BlendMode::SoftLight, 0.4, 0.25, 0.28),
        (BlendMode::SoftLight, 0.2, 0.75, 0.324),
        (BlendMode::SoftLight, 0.64, 0.75, 0.72),
        (BlendMode::Difference, 0.4, 0.7, 0.3),
        (BlendMode::Exclusion, 0.4, 0.5, 0.5),
        (BlendMode::LinearDodge, 0.4, 0.5, 0.9),
        (BlendMode::LinearDodge, 0.8, 0.5, 1.0),
        (BlendMode::LinearBurn, 0.8, 0.5, 0.3),
        (BlendMode::LinearBurn, 0.4, 0.5, 0.0),
        (BlendMode::LinearLight, 0.5, 0.6, 0.7),
        (BlendMode::LinearLight, 0.5, 0.2, 0.0),
        (BlendMode::LinearLight, 0.5, 0.8, 1.0),
        (BlendMode::VividLight, 0.8, 0.25, 0.6),
        (BlendMode::VividLight, 0.2, 0.75, 0.4),
        (BlendMode::VividLight, 1.0, 0.0, 0.0),
        (BlendMode::VividLight, 0.0, 1.0, 1.0),
        (BlendMode::PinLight, 0.8, 0.25, 0.5),
        (BlendMode::PinLight, 0.3, 0.25, 0.3),
        (BlendMode::PinLight, 0.3, 0.75, 0.5),
        (BlendMode::HardMix, 0.4, 0.5, 0.0),
        (BlendMode::HardMix, 0.4, 0.7, 1.0),
        (BlendMode::HardMix, 0.4, 0.6, 0.0),
        (BlendMode::HardMix, 0.6, 0.4, 1.0),
        (BlendMode::Subtract, 0.6, 0.2, 0.4),
        (BlendMode::Subtract, 0.2, 0.6, 0.0),
        (BlendMode::Divide, 0.2, 0.5, 0.4),
        (BlendMode::Divide, 0.6, 0.5, 1.0),
        (BlendMode::Divide, 0.6, 0.0, 1.0),
        (BlendMode::Divide, 0.0, 0.0, 0.0),
    ];
    for (mode, cb, cs, expected) in table {
        let got = separable(mode)(cb, cs);
        assert!(
            (got - expected).abs() < 1e-6,
            "{}({cb}, {cs}) is {got}, not {expected}",
            mode.name()
        );
    }
}

#[test]
fn non_separable_modes_give_the_values_computed_by_hand() {
    let (cb, cs) = ([0.6, 0.4, 0.2], [0.2, 0.2, 0.7]);
    // Lum(cb) = 0.438, Sat(cb) = 0.4; Lum(cs) = 0.255, Sat(cs) = 0.5.
    let table = [
        // SetSat(cs, 0.4) = (0, 0, 0.4), its Lum 0.044, so every component rises by 0.394.
        (spec::hue(cb, cs), [0.394, 0.394, 0.794]),
        // SetSat(cb, 0.5) = (0.5, 0.25, 0), its Lum 0.2975, rises by 0.1405.
        (spec::saturation(cb, cs), [0.6405, 0.3905, 0.1405]),
        // cs rises by 0.183.
        (spec::color(cb, cs), [0.383, 0.383, 0.883]),
        // cb falls by 0.183.
        (spec::luminosity(cb, cs), [0.417, 0.217, 0.017]),
    ];
    for (got, expected) in table {
        assert!(close(&got, &expected, 1e-6), "{got:?}, not {expected:?}");
    }
    // The darker and the lighter of both as they are.
    assert_eq!((spec::darker(cb, cs), spec::lighter(cb, cs)), (cs, cb));
    assert_eq!((spec::darker(cs, cb), spec::lighter(cs, cb)), (cs, cb));
    // Too bright a color is drawn back toward its gray, which stays.
    let clipped = spec::clip_color([1.2, 0.6, 0.4]);
    assert!(
        (spec::lum(clipped) - spec::lum([1.2, 0.6, 0.4])).abs() < 1e-6
            && (clipped[0] - 1.0).abs() < 1e-6
    );
}

#[test]
fn half_transparent_paint_mixes_as_the_specification_says() {
    // Red at half alpha multiplied onto blue at half alpha: a quarter is both (black), a quarter is
    // each alone, a quarter is neither.
    let got = blend_pixel(BlendMode::Multiply, [0.0, 0.0, 0.5, 0.5], [0.5, 0.0, 0.0, 0.5]);
    assert!(close(&got, &[0.25, 0.0, 0.25, 0.75], 1e-6), "{got:?}");
    assert_eq!(
        blend_pixel(BlendMode::Plus, [0.7, 0.2, 0.0, 0.8], [0.5, 0.1, 0.0, 0.5]),
        [1.0, 0.3, 0.0, 1.0]
    );
}

#[test]
fn the_fast_rows_agree_with_the_specification_in_every_mode() {
    for (mode, name) in BlendMode::ALL {
        for ab in ALPHAS {
            for as_ in ALPHAS {
                for (i, cb) in VALUES.into_iter().enumerate() {
                    for (j, cs) in VALUES.into_iter().enumerate() {
                        let backdrop =
                            [cb * ab, VALUES[(i + 4) % 9] * ab, VALUES[(i + 7) % 9] * ab, ab];
                        let source =
                            [cs * as_, VALUES[(j + 2) % 9] * as_, VALUES[(j + 5) % 9] * as_, as_];
                        // `fast` reads this pixel of the tile.
                        let left = if mode == BlendMode::Dissolve {
                            spec::dissolve(source, [23, 17])
                        } else {
                            source
                        };
                        let expected = blend_pixel(mode, backdrop, left);
                        let got = fast(Mix { mode, ..Mix::default() }, backdrop, source);
                        assert!(
                            close(&got, &expected, 2e-6),
                            "{name}: {backdrop:?} {source:?}: {got:?} {expected:?}"
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn separable_modes_and_plus_agree_with_tiny_skia_within_two_steps() {
    for (mode, name) in BlendMode::ALL {
        // Its non-separable modes are less precise, and it does not have every mode.
        let oracle = tiny_skia_mode(mode)
            .filter(|_| !matches!(mode.function(), BlendFunction::NonSeparable(_)));
        let Some(oracle) = oracle else { continue };
        for k in 0..4000u32 {
            let byte = |i: u32| (crate::math::hash::unit(9, k, i) * 256.0) as u8;
            let color = |i: u32| {
                let a = if k % 3 == 0 { 255 } else { byte(i + 3) };
                [byte(i).min(a), byte(i + 1).min(a), byte(i + 2).min(a), a]
            };
            let (backdrop, source) = (color(0), color(4));
            let expected = tiny_skia_blend(oracle, backdrop, source);
            let unit = |p: [u8; 4]| p.map(|v| f32::from(v) / 255.0);
            let got =
                blend_pixel(mode, unit(backdrop), unit(source)).map(crate::math::srgb::quantize);
            let far = got.iter().zip(expected).map(|(a, b)| a.abs_diff(b)).max();
            assert!(
                far <= Some(2),
                "{name}: {source:?} on {backdrop:?} is {got:?}, tiny-skia says {expected:?}"
            );
        }
    }
}

#[test]
fn dissolving_leaves_as_many_pixels_as_its_alpha_says_and_the_same_ones_wherever_tiles_begin() {
    let mix = Mix { mode: BlendMode::Dissolve, ..Mix::default() };
    let laid = |corner: [i32; 2]| {
        let mut tile = PlanarTile::transparent();
        let quarter = TileCoverage::uniform(0.5).times(|_, _| 0.5);
        tile.blend(Mix { corner, ..mix }, TilePaint::Solid([1.0, 0.5, 0.0, 1.0]), &quarter);
        tile
    };
    let (here, below) = (laid([0, 0]), laid([0, -9]));
    let mut kept = 0;
    for (y, row) in here.rows().iter().enumerate() {
        for x in 0..TILE {
            let pixel = row.pixel(x);
            assert!(pixel == [0.0; 4] || close(&pixel, &[1.0, 0.5, 0.0, 1.0], 1e-6), "{pixel:?}");
            kept += usize::from(pixel[3] > 0.0);
            if let Some(same) = below.rows().get(y + 9) {
                assert_eq!(same.pixel(x), pixel, "the same place of the canvas");
            }
        }
    }
    assert!(kept.abs_diff(TILE_AREA / 4) < TILE_AREA / 50, "{kept} of {TILE_AREA}");
}

#[test]
fn every_mode_leaves_the_backdrop_alone_where_nothing_is_painted() {
    let backdrop = [0.1, 0.4, 0.3, 0.6];
    for (mode, name) in BlendMode::ALL {
        for (atop, linear) in [(false, false), (true, false), (false, true)] {
            let got = fast(Mix { mode, atop, linear, ..Mix::default() }, backdrop, [0.0; 4]);
            assert!(close(&got, &backdrop, 1e-6), "{name}: {got:?}");
        }
    }
}

#[test]
fn atop_keeps_the_alpha_of_what_it_is_painted_on() {
    for (mode, name) in BlendMode::ALL {
        let mix = Mix { mode, atop: true, ..Mix::default() };
        let got = fast(mix, [0.2, 0.1, 0.0, 0.4], [0.3, 0.6, 0.0, 0.6]);
        assert_eq!(got[3], 0.4, "{name}");
        assert!(got[..3].iter().all(|&c| (0.0..=0.4 + 1e-6).contains(&c)), "{name}: {got:?}");
        assert_eq!(fast(mix, [0.0; 4], [0.3, 0.6, 0.0, 0.6]), [0.0; 4], "{name}");
    }
    // Normal: 0.6 of the color (0.5, 1, 0) and 0.4 of the previous one.
    let got =
        fast(Mix { atop: true, ..Mix::default() }, [0.2, 0.1, 0.0, 0.4], [0.3, 0.6, 0.0, 0.6]);
    assert!(
        close(&got, &[0.3 * 0.4 + 0.2 * 0.4, 0.6 * 0.4 + 0.1 * 0.4, 0.0, 0.4], 1e-6),
        "{got:?}"
    );
}

#[test]
fn linear_light_mixes_black_and_white_to_the_gray_that_emits_half() {
    let got = fast(Mix { linear: true, ..Mix::default() }, [0.0, 0.0, 0.0, 1.0], [0.5; 4]);
    assert!((got[0] - 0.735_357).abs() < 5e-4, "{got:?}");
    let encoded = fast(Mix::default(), [0.0, 0.0, 0.0, 1.0], [0.5; 4]);
    assert!((encoded[0] - 0.5).abs() < 1e-6, "{encoded:?}");
}

#[test]
fn coverage_is_opacity_times_mask_for_every_kind_of_paint() {
    let color = [0.5, 0.25, 0.0, 0.5];
    let tile = PlanarTile::from_pixels(&one_pixel(color));
    let bytes = tile.quantize().unwrap();
    let quantized = tile.to_tile_over(None).unwrap();
    let coverage = TileCoverage::uniform(0.5).times(|x, _| if x < 32 { 1.0 } else { 0.5 });
    for paint in [
        TilePaint::Solid(color),
        TilePaint::of(&bytes),
        TilePaint::of(&quantized),
        TilePaint::Planar(&tile),
    ] {
        let mut onto = PlanarTile::transparent();
        onto.blend(Mix::default(), paint, &coverage);
        assert!(close(&onto.rows()[5].pixel(0), &[0.25, 0.125, 0.0, 0.25], 0.003));
        assert!(close(&onto.rows()[5].pixel(63), &[0.125, 0.0625, 0.0, 0.125], 0.003));
        let mut half = PlanarTile::transparent();
        half.blend(Mix::default(), paint, &TileCoverage::uniform(0.5));
        assert!(close(&half.rows()[5].pixel(63), &[0.25, 0.125, 0.0, 0.25], 0.003));
    }
    assert!(TileCoverage::uniform(f32::NAN).is_none());
    assert!(TileCoverage::uniform(1.0).times(|_, _| f32::NAN).is_none());
    assert!(TileCoverage::uniform(7.0).is_full());
}

#[test]
fn paint_of_16_bits_blends_as_the_floats_that_it_holds() {
    let value = |i: usize, c: u32| (crate::math::hash::unit(i as u32, c, 7) * 65536.0) as u16;
    let mut rows = sixteen_bit::clear_rows();
    for i in 0..TILE_AREA {
        sixteen_bit::put(&mut rows[i / TILE], i % TILE, [0, 1, 2, 3].map(|c| value(i, c)));
    }
    let tile = Tile::from_rows16(rows).unwrap();
    let mut floats = PlanarTile::transparent();
    for i in 0..TILE_AREA {
        let (x, y) = (i % TILE, i / TILE);
        floats.rows_mut()[y].set(x, tile.pixel16(x, y).map(|v| f32::from(v) / 65535.0));
    }
    let same = |a: &PlanarTile, b: &PlanarTile| {
        (0..TILE_AREA).all(|i| {
            close(&a.rows()[i / TILE].pixel(i % TILE), &b.rows()[i / TILE].pixel(i % TILE), 1e-5)
        })
    };
    assert!(same(&PlanarTile::of_tile(Some(&tile)), &floats));
    assert!(
        floats.to_tile_over(Some(&tile)).unwrap().is_same(&tile),
        "what is loaded is kept as it was"
    );
    let masked = TileCoverage::uniform(0.7).times(|x, y| (x * y) as f32 / 4096.0);
    for (mode, _) in BlendMode::ALL {
        for coverage in [&TileCoverage::FULL, &TileCoverage::uniform(0.3), &masked] {
            let mut under = PlanarTile::transparent();
            under.blend(
                Mix::default(),
                TilePaint::Solid([0.3, 0.5, 0.1, 0.8]),
                &TileCoverage::FULL,
            );
            let (mut a, mut b) = (under.clone(), under);
            let mix = Mix { mode, ..Mix::default() };
            a.blend(mix, TilePaint::of(&tile), coverage);
            b.blend(mix, TilePaint::Planar(&floats), coverage);
            assert!(same(&a, &b), "{mode:?}");
        }
    }
}

#[test]
fn nothing_out_of_range_comes_out_of_any_mode() {
    let wild = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -3.0, 0.0, 1e-30, 0.5, 1.0, 2.0];
    for (mode, name) in BlendMode::ALL {
        for k in 0..wild.len() * wild.len() {
            let pick = |i: usize| wild[(k * (i + 2) + i * i) % wild.len()];
            let (backdrop, source) = ([0, 1, 2, 3].map(pick), [4, 5, 6, 7].map(pick));
            for linear in [false, true] {
                for got in [
                    blend_pixel(mode, backdrop, source),
                    fast(Mix { mode, linear, ..Mix::default() }, backdrop, source),
                ] {
                    assert!(
                        got.iter().all(|v| (-1e-5..=1.0 + 1e-5).contains(v)),
                        "{name} {backdrop:?} {source:?} {got:?}"
                    );
                }
            }
        }
    }
}

#[test]
fn every_row_of_the_table_is_found_by_each_of_its_names() {
    for (mode, name) in BlendMode::ALL {
        assert_eq!(mode.name(), name);
        assert_eq!(BlendMode::from_name(name), Some(mode));
        assert_eq!(BlendMode::from_openraster(mode.openraster()), Some(mode), "{name}");
        assert_eq!(BlendMode::from_photoshop(mode.photoshop()), Some(mode), "{name}");
        assert!(BlendMode::LABELS.contains(&(mode, mode.label())), "{name}");
    }
    assert_eq!(BlendMode::from_photoshop(*b"????"), None);
}

#[test]
fn a_mode_without_a_twin_is_computed_from_its_formula_alike() {
    // Those that have one, both ways.
    for (mode, name) in BlendMode::ALL {
        for k in 0..500u32 {
            let unit = |i: u32| crate::math::hash::unit(5, k, i);
            let color = |i: u32| {
                let a = if k % 3 == 0 { 1.0 } else { unit(i + 3) };
                [unit(i) * a, unit(i + 1) * a, unit(i + 2) * a, a]
            };
            let (backdrop, source) = (color(0), color(4));
            let expected = blend_pixel(mode, backdrop, source);
            let got = rows::pixel_by_formula(Mix { mode, ..Mix::default() }, backdrop, source);
            assert!(
                close(&got, &expected, 2e-6),
                "{name}: {backdrop:?} {source:?}: {got:?} {expected:?}"
            );
        }
    }
}

fn tiny_skia_mode(mode: BlendMode) -> Option<tiny_skia::BlendMode> {
    use tiny_skia::BlendMode as T;
    Some(match mode {
        BlendMode::Normal => T::SourceOver,
        BlendMode::Multiply => T::Multiply,
        BlendMode::Screen => T::Screen,
        BlendMode::Overlay => T::Overlay,
        BlendMode::Darken => T::Darken,
        BlendMode::Lighten => T::Lighten,
        BlendMode::ColorDodge => T::ColorDodge,
        BlendMode::ColorBurn => T::ColorBurn,
        BlendMode::HardLight => T::HardLight,
        BlendMode::SoftLight => T::SoftLight,
        BlendMode::Difference => T::Difference,
        BlendMode::Exclusion => T::Exclusion,
        BlendMode::Plus => T::Plus,
        _ => return None,
    })
}

fn tiny_skia_blend(
    blend_mode: tiny_skia::BlendMode,
    backdrop: [u8; 4],
    source: [u8; 4],
) -> [u8; 4] {
    let pixmap = |p: [u8; 4]| {
        tiny_skia::Pixmap::from_vec(p.to_vec(), tiny_skia::IntSize::from_wh(1, 1).unwrap()).unwrap()
    };
    let mut onto = pixmap(backdrop);
    let paint = tiny_skia::PixmapPaint { blend_mode, ..Default::default() };
    onto.draw_pixmap(0, 0, pixmap(source).as_ref(), &paint, tiny_skia::Transform::identity(), None);
    onto.data().try_into().unwrap()
}
