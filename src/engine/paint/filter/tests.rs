//! What filters do to pixels, by values and by properties.

mod drafts;

use super::*;
use crate::math::{Size, Vec2, hash, vec2};

const RECT: Rect = Rect::new(0, 0, 96, 80);

fn flat() -> Scene {
    Scene { size: Size::new(96, 80), surface: None }
}

/// Smooth and rough parts, half of it transparent in places.
fn picture() -> FilterWindow {
    let pixels = (RECT.y0..RECT.y1).flat_map(|y| (RECT.x0..RECT.x1).map(move |x| (x, y)));
    let pixel = |(x, y): (i32, i32)| {
        let a = if (x / 9 + y / 7) % 3 == 0 { 0.4 } else { 1.0 };
        let rough = hash::unit(3, x as u32, y as u32);
        [rough * a, x as f32 / 96.0 * a, if y < 40 { a } else { 0.0 }, a]
    };
    FilterWindow::new(RECT, pixels.map(pixel).collect())
}

fn apply(filter: &PictureFilter, source: &FilterWindow, out: Rect) -> FilterWindow {
    let scene = flat();
    LiveFilter::new(filter.clone()).apply(&FilterPlace::new(&scene, out, 1.0), source)
}

fn of(name: &str) -> PictureFilter {
    PictureFilter::from_name(name).unwrap()
}

fn largest_difference(a: &[[f32; 4]], b: &[[f32; 4]]) -> f32 {
    let both = a.as_flattened().iter().zip(b.as_flattened());
    both.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

/// The sum itself, in f64.
fn direct_gaussian(source: &FilterWindow, sigma: f64) -> Vec<[f32; 4]> {
    let reach = (5.0 * sigma).ceil() as i32;
    let weight = |d: i32| (-0.5 * (f64::from(d) / sigma).powi(2)).exp();
    let sum: f64 = (-reach..=reach).map(weight).sum();
    let pass = |source: &FilterWindow, (dx, dy): (i32, i32)| {
        let mut all = Vec::new();
        for (y, x) in (RECT.y0..RECT.y1).flat_map(|y| (RECT.x0..RECT.x1).map(move |x| (y, x))) {
            let mut value = [0.0f64; 4];
            for d in -reach..=reach {
                let pixel = source.at(x + d * dx, y + d * dy);
                (0..4).for_each(|k| value[k] += weight(d) / sum * f64::from(pixel[k]));
            }
            all.push(value.map(|v| v as f32));
        }
        FilterWindow::new(RECT, all)
    };
    pass(&pass(source, (1, 0)), (0, 1)).pixels().to_vec()
}

#[test]
fn a_gaussian_of_any_width_is_the_sum_within_half_a_level() {
    for sigma in [0.6, 1.5, 4.0, 4.9, 5.0, 7.3, 10.0, 19.0] {
        let filter = PictureFilter::GaussianBlur(GaussianBlur { radius: sigma });
        let found = apply(&filter, &picture(), RECT);
        let off =
            largest_difference(found.pixels(), &direct_gaussian(&picture(), f64::from(sigma)));
        assert!(off < 0.5 / 255.0, "σ {sigma}: {} levels", off * 255.0);
    }
}

#[test]
fn blocks_fit_together_without_seams() {
    let source = picture();
    for filter in PictureFilter::all() {
        let whole = apply(&filter, &source, RECT);
        for part in [Rect::new(0, 0, 64, 64), Rect::new(64, 0, 96, 64), Rect::new(0, 64, 64, 80)] {
            let off =
                largest_difference(apply(&filter, &source, part).pixels(), &whole.cropped(part));
            // Around a point, a part is read on circles and rays of its own.
            let most = if filter.name() == "spin-blur" || filter.name() == "zoom-blur" {
                0.02
            } else {
                2e-4
            };
            assert!(off < most, "{} on {part:?}: {off}", filter.name());
        }
    }
}

#[test]
fn what_is_read_is_what_is_said_to_be_read() {
    let bounds = Rect::new(0, 0, 400, 400);
    struct Watched(Vec<Rect>);
    impl FilterSource for Watched {
        fn bounds(&self) -> Rect {
            Rect::new(0, 0, 400, 400)
        }
        fn window(&self, rect: Rect) -> FilterWindow {
            let read = rect.intersect(self.bounds());
            let is_said = self.0.iter().any(|said| read.intersect(*said) == read);
            assert!(is_said || read.is_empty(), "{read:?} is not in {:?}", self.0);
            FilterWindow::new(rect, Vec::new())
        }
    }
    let scene = Scene { size: Size::new(400, 400), surface: None };
    let whole = || PictureFilter::all().into_iter().map(LiveFilter::new);
    for live in whole().chain(whole().filter_map(|live| live.drafted())) {
        for out in live.blocks(bounds, bounds) {
            let said = Watched(live.reads(out, bounds));
            live.apply(&FilterPlace::new(&scene, out, 1.0), &said);
        }
    }
}

#[test]
fn one_color_stays_one_color_under_what_blurs_and_sharpens() {
    let color = [0.3, 0.15, 0.05, 0.6];
    let source = FilterWindow::new(RECT, vec![color; RECT.width() * RECT.height()]);
    let names = [
        "gaussian-blur",
        "box-blur",
        "motion-blur",
        "spin-blur",
        "zoom-blur",
        "sharpen",
        "unsharp-mask",
        "median",
        "pixelate",
        "offset",
        "lens-blur",
        "surface-blur",
        "flow-blur",
    ];
    for name in names {
        let found = apply(&of(name), &source, RECT);
        let off = largest_difference(found.pixels(), source.pixels());
        assert!(off < 1e-4, "{name}: {off}");
    }
}

#[test]
fn blurs_keep_the_sum_of_a_dot() {
    let mut source = FilterWindow::new(RECT, Vec::new());
    source.pixels_mut()[40 * 96 + 48] = [1.0, 0.5, 0.25, 1.0];
    for (name, most) in [("gaussian-blur", 1e-3), ("box-blur", 1e-4), ("motion-blur", 1e-3)] {
        for angle in [0.0, 30.0, 45.0, 100.0, -70.0] {
            let mut filter = of(name);
            if let PictureFilter::MotionBlur(own) = &mut filter {
                own.angle = angle;
            }
            let found = apply(&filter, &source, RECT);
            let sum: f32 = found.pixels().iter().map(|p| p[3]).sum();
            assert!((sum - 1.0).abs() < most, "{name} at {angle}: {sum}");
        }
    }
}

#[test]
fn motion_spreads_a_dot_along_its_way_alone() {
    let mut source = FilterWindow::new(RECT, Vec::new());
    source.pixels_mut()[40 * 96 + 48] = [1.0; 4];
    let filter = PictureFilter::MotionBlur(MotionBlur { angle: 90.0, length: 11.0 });
    let found = apply(&filter, &source, RECT);
    for (i, pixel) in found.pixels().iter().enumerate() {
        let (x, y) = (i as i32 % 96, i as i32 / 96);
        let expected = if x == 48 && (35..=45).contains(&y) { 1.0 / 11.0 } else { 0.0 };
        assert!((pixel[3] - expected).abs() < 1e-5, "{x}, {y}: {}", pixel[3]);
    }
    // Counter-clockwise from the right: at 45° the way rises to the right.
    let rising = PictureFilter::MotionBlur(MotionBlur { angle: 45.0, length: 12.0 });
    let found = apply(&rising, &source, RECT);
    assert!(found.at(51, 37)[3] > 0.05 && found.at(45, 37)[3] == 0.0);
}

/// The mean of readings along a way through each pixel, as the words say.
fn direct_means(source: &FilterWindow, at: impl Fn(Vec2, f32) -> Vec2) -> Vec<[f32; 4]> {
    const READINGS: usize = 240;
    let places = (RECT.y0..RECT.y1).flat_map(|y| (RECT.x0..RECT.x1).map(move |x| (x, y)));
    let mean = |(x, y): (i32, i32)| {
        let mut sum = [0.0; 4];
        for i in 0..READINGS {
            let place =
                at(vec2(x as f32 + 0.5, y as f32 + 0.5), (i as f32 + 0.5) / READINGS as f32);
            let value = source.sample(place.x, place.y);
            (0..4).for_each(|k| sum[k] += value[k] / READINGS as f32);
        }
        sum
    };
    places.map(mean).collect()
}

#[test]
fn spin_and_zoom_are_means_along_circles_and_rays() {
    // Beyond the picture its border goes on; each channel has edges or noise.
    let source = picture();
    for (x, y) in [(50.0, 50.0), (-40.0, 130.0), (20.0, 60.0)] {
        let center = BlurCenter { x, y };
        let from = vec2(0.96 * x, 0.8 * y);
        for (angle, share) in [(10.0f32, 20.0f32), (70.0, 80.0)] {
            let spin = PictureFilter::SpinBlur(SpinBlur { angle, center });
            let zoom = PictureFilter::ZoomBlur(ZoomBlur { amount: share, center });
            let turned = |at: Vec2, t: f32| {
                from + Vec2::from_angle((t - 0.5) * angle.to_radians()).rotate(at - from)
            };
            let nearer = |at: Vec2, t: f32| from + (at - from) * (1.0 + (t - 0.5) * share / 100.0);
            for (filter, wanted) in
                [(spin, direct_means(&source, turned)), (zoom, direct_means(&source, nearer))]
            {
                let found = apply(&filter, &source, RECT);
                let both = found.pixels().as_flattened().iter().zip(wanted.as_flattened());
                let off: Vec<f32> = both.map(|(a, b)| (a - b).abs() * 255.0).collect();
                let mean = off.iter().sum::<f32>() / off.len() as f32;
                // Readings of noise are between pixels twice, which shows where a way is short.
                assert!(mean < 4.0, "{filter:?}: {mean} levels in the mean");
            }
        }
    }
}

#[test]
fn transparent_edges_stay_as_bright_as_they_were() {
    // White paint on the left, nothing on the right.
    let pixels = (0..RECT.width() * RECT.height())
        .map(|i| if i % 96 < 48 { [1.0; 4] } else { [0.0; 4] })
        .collect();
    let source = FilterWindow::new(RECT, pixels);
    for name in ["gaussian-blur", "box-blur", "motion-blur", "zoom-blur", "sharpen", "unsharp-mask"]
    {
        for pixel in apply(&of(name), &source, RECT).pixels().iter().filter(|p| p[3] > 0.01) {
            assert!((pixel[0] / pixel[3] - 1.0).abs() < 1e-2, "{name}: {pixel:?}");
        }
    }
}

/// Two planes that face the viewer, the right one farther away, or one cylinder along y.
fn scene_of_two_planes(
    depth: impl Fn(usize) -> f32 + Sync,
    normal: impl Fn(usize) -> f32 + Sync,
) -> Scene {
    use crate::math::vec3;
    use crate::raster::Plane;
    let size = Size::new(96, 80);
    let maps = crate::surface::Maps {
        normals: Plane::from_fn(size, |x, _| {
            let nx = normal(x);
            vec3(nx, 0.0, (1.0 - nx * nx).sqrt())
        }),
        depth: Plane::from_fn(size, |x, _| depth(x)),
        coverage: Plane::full(size, 255),
    };
    Scene { size, surface: Some(Arc::new(crate::surface::Surface::new(maps).unwrap())) }
}

fn stepped_scene() -> Scene {
    scene_of_two_planes(|x| if x < 48 { 0.0 } else { 0.9 }, |_| 0.0)
}

fn on(scene: &Scene, filter: PictureFilter, source: &FilterWindow) -> FilterWindow {
    let live = LiveFilter::new(filter);
    live.warm(scene);
    live.apply(&FilterPlace::new(scene, RECT, 1.0), source)
}

/// Black on the left, white on the right.
fn black_and_white() -> FilterWindow {
    let pixels = (0..RECT.width() * RECT.height())
        .map(|i| if i % 96 < 48 { [0.0, 0.0, 0.0, 1.0] } else { [1.0; 4] })
        .collect();
    FilterWindow::new(RECT, pixels)
}

#[test]
fn over_the_surface_a_blur_stops_at_contours_and_follows_the_distance() {
    let blur = || PictureFilter::SurfaceBlur(SurfaceBlur { radius: 6.0 });
    let cut = on(&stepped_scene(), blur(), &black_and_white());
    assert!(largest_difference(cut.pixels(), black_and_white().pixels()) < 1e-5);
    let whole = on(&scene_of_two_planes(|_| 0.5, |_| 0.0), blur(), &black_and_white());
    // A step of which a standard deviation lies on each side.
    let at = |x: i32| whole.at(x, 40)[0];
    assert!((at(47) + at(48) - 1.0).abs() < 0.02, "{} {}", at(47), at(48));
    assert!((at(54) - 0.86).abs() < 0.04, "{}", at(54));
    let steep = scene_of_two_planes(|x| x as f32 / 96.0 * 0.9, |_| 0.9);
    let narrow = on(&steep, blur(), &black_and_white());
    assert!(narrow.at(52, 40)[0] > whole.at(52, 40)[0] + 0.03);
}

#[test]
fn sharpening_that_stops_at_contours_leaves_no_rim() {
    let mask = UnsharpMask { stop_at_contours: true, ..UnsharpMask::default() };
    let gray = |v: f32| [v, v, v, 1.0];
    let pixels = (0..96 * 80).map(|i| gray(if i % 96 < 48 { 0.3 } else { 0.7 })).collect();
    let source = FilterWindow::new(RECT, pixels);
    let found = on(&stepped_scene(), PictureFilter::UnsharpMask(mask), &source);
    assert!(largest_difference(found.pixels(), source.pixels()) < 1e-4);
    let rimmed = UnsharpMask { stop_at_contours: false, ..mask };
    let found = on(&stepped_scene(), PictureFilter::UnsharpMask(rimmed), &source);
    assert!(largest_difference(found.pixels(), source.pixels()) > 0.1);
}

#[test]
fn along_the_form_a_dot_is_smeared_along_a_cylinder() {
    let round = |x: usize| (x as f32 - 47.5) / 60.0;
    let cylinder = scene_of_two_planes(|x| 1.0 - (1.0 - round(x).powi(2)).sqrt(), round);
    let mut source = FilterWindow::new(RECT, vec![[0.0, 0.0, 0.0, 1.0]; 96 * 80]);
    source.pixels_mut()[40 * 96 + 48] = [1.0; 4];
    let blur = |across| FlowBlur { length: 16.0, smooth: 2.0, across };
    let along = on(&cylinder, PictureFilter::FlowBlur(blur(false)), &source);
    assert!(along.at(48, 44)[0] > 0.02 && along.at(48, 36)[0] > 0.02, "{:?}", along.at(48, 44));
    assert!(along.at(52, 40)[0] < 1e-3);
    let sum: f32 = along.pixels().iter().map(|p| p[0]).sum();
    assert!((sum - 1.0).abs() < 0.05, "{sum}");
    let around = on(&cylinder, PictureFilter::FlowBlur(blur(true)), &source);
    assert!(around.at(52, 40)[0] > 0.02 && around.at(48, 44)[0] < 1e-3);
}

#[test]
fn a_lens_keeps_what_is_in_focus_and_spreads_what_is_not() {
    let lens = LensBlur { radius: 8.0, ..LensBlur::default() };
    let source = picture();
    let found = on(&stepped_scene(), PictureFilter::LensBlur(lens), &source);
    for (x, y) in [(3, 5), (30, 60), (47, 20)] {
        let off = largest_difference(&[found.at(x, y)], &[source.at(x, y)]);
        assert!(off < 2e-3, "the near plane is in focus: {off} at {x}, {y}");
    }
    assert!(largest_difference(&[found.at(70, 30)], &[source.at(70, 30)]) > 0.05);
    // One color at any depth stays.
    let plain = FilterWindow::new(RECT, vec![[0.4, 0.2, 0.1, 0.8]; 96 * 80]);
    for scene in [stepped_scene(), scene_of_two_planes(|x| x as f32 / 96.0, |_| 0.3)] {
        let found = on(&scene, PictureFilter::LensBlur(lens), &plain);
        let off = largest_difference(found.pixels(), plain.pixels());
        assert!(off < 2e-3, "{off}");
    }
    // A light becomes a disk: its rim is as bright as its middle.
    let mut dot = FilterWindow::new(RECT, vec![[0.0, 0.0, 0.0, 1.0]; 96 * 80]);
    dot.pixels_mut()[40 * 96 + 48] = [1.0; 4];
    for radius in [3.0, 9.0] {
        let lens = LensBlur { radius, by_depth: false, highlights: 300.0, ..lens };
        let found = on(&flat(), PictureFilter::LensBlur(lens), &dot);
        let (middle, near) = (found.at(48, 40)[0], found.at(48 + radius as i32 - 2, 40)[0]);
        assert!(middle > 0.05 && (near / middle - 1.0).abs() < 0.25, "{middle} {near}");
        assert!(found.at(48 + radius as i32 + 3, 40)[0] < 0.3 * middle);
    }
}

#[test]
fn grain_on_the_surface_is_bent_with_it() {
    let grain =
        |on_surface| PictureFilter::FilmGrain(FilmGrain { on_surface, ..FilmGrain::default() });
    let gray = FilterWindow::new(RECT, vec![[0.5, 0.5, 0.5, 1.0]; 96 * 80]);
    let facing = scene_of_two_planes(|_| 0.5, |_| 0.0);
    let steep = scene_of_two_planes(|x| x as f32 / 96.0 * 0.9, |_| 0.8);
    // How often it crosses mid-gray along rows.
    let crossings = |scene: &Scene| {
        let found = on(scene, grain(true), &gray);
        let rows = found.pixels().chunks_exact(96);
        rows.map(|row| row.windows(2).filter(|p| (p[0][0] < 0.5) != (p[1][0] < 0.5)).count()).sum()
    };
    let (plain, bent): (usize, usize) = (crossings(&facing), crossings(&steep));
    assert!(bent * 10 > plain * 13, "{plain} on a facing plane, {bent} on a steep one");
}

#[test]
fn noise_has_no_mean_and_is_the_same_every_time() {
    let area = RECT.width() * RECT.height();
    let gray = FilterWindow::new(RECT, vec![[0.5, 0.5, 0.5, 1.0]; area]);
    let noise = |gaussian, monochrome, seed| {
        let own = PixelNoise { amount: 20.0, gaussian, monochrome, seed, ..PixelNoise::default() };
        apply(&PictureFilter::PixelNoise(own), &gray, RECT)
    };
    for (gaussian, deviation) in [(false, 0.2 / 3f32.sqrt()), (true, 0.2)] {
        let found = noise(gaussian, false, 0.0);
        let steps: Vec<f32> = found.pixels().iter().map(|p| p[1] - 0.5).collect();
        let mean = steps.iter().sum::<f32>() / area as f32;
        let spread = (steps.iter().map(|v| v * v).sum::<f32>() / area as f32).sqrt();
        assert!(mean.abs() < 0.005, "mean {mean}");
        assert!((spread - deviation).abs() < 0.01, "{spread} and not {deviation}");
    }
    assert_eq!(noise(true, true, 3.0), noise(true, true, 3.0));
    assert_ne!(noise(true, true, 3.0), noise(true, true, 4.0));
    assert!(noise(false, true, 0.0).pixels().iter().all(|p| p[0] == p[1] && p[1] == p[2]));
    let grain = apply(&of("grain"), &gray, RECT);
    let mean = grain.pixels().iter().map(|p| p[0] - 0.5).sum::<f32>() / area as f32;
    assert!(mean.abs() < 0.01, "grain {mean}");
}

#[test]
fn an_unsharp_mask_adds_what_its_blur_takes_away() {
    let source = picture();
    let mask = UnsharpMask { amount: 80.0, radius: 1.5, ..UnsharpMask::default() };
    let found = apply(&PictureFilter::UnsharpMask(mask), &source, RECT);
    let blurred = direct_gaussian(&source, 1.5);
    for ((own, mean), found) in source.pixels().iter().zip(&blurred).zip(found.pixels()) {
        let x = own[1] / own[3];
        let expected = (x + 0.8 * (x - mean[1] / mean[3])).clamp(0.0, 1.0) * own[3];
        assert!((found[1] - expected).abs() < 2e-3, "{} and not {expected}", found[1]);
        assert_eq!(found[3], own[3]);
    }
    let none = UnsharpMask { threshold: 255.0, ..mask };
    assert!(
        largest_difference(
            apply(&PictureFilter::UnsharpMask(none), &source, RECT).pixels(),
            source.pixels()
        ) < 1e-6
    );
}

#[test]
fn a_median_is_the_middle_of_all_sorted() {
    let source = picture();
    let found = apply(&of("median"), &source, RECT);
    for (x, y) in [(3, 4), (50, 39), (95, 79), (20, 60)] {
        let around = (-2..=2).flat_map(|dy| (-2..=2).map(move |dx| (x + dx, y + dy)));
        let mut reds: Vec<f32> = around.map(|(x, y)| source.at(x, y)[0]).collect();
        reds.sort_by(f32::total_cmp);
        let off = (found.at(x, y)[0] - reds[12]).abs();
        assert!(off <= 0.5 / 255.0 + 1e-6, "at {x}, {y}: {off}");
    }
}

#[test]
fn shifted_twice_by_half_a_picture_is_the_picture() {
    let source = picture();
    let once = apply(&of("offset"), &source, RECT);
    assert_eq!(once.at(0, 0), source.at(48, 40));
    assert_eq!(apply(&of("offset"), &once, RECT), source);
}

#[test]
fn squares_have_the_mean_of_their_pixels_and_edges_lie_where_colors_differ() {
    let source = picture();
    let squares = apply(&of("pixelate"), &source, RECT);
    let mean = (0..64).map(|i| source.at(16 + i % 8, 8 + i / 8)[0]).sum::<f32>() / 64.0;
    assert!((squares.at(20, 12)[0] - mean).abs() < 1e-5);
    assert_eq!(squares.at(16, 8), squares.at(23, 15));
    let edges = apply(&of("edges"), &source, RECT);
    let on = edges.at(50, 40);
    assert!(on[2] / on[3] > 0.99, "a step from black to white is white: {on:?}");
    assert!(edges.at(50, 60)[2] < 1e-5);
}

#[test]
fn numbers_that_are_no_numbers_are_held_and_lengths_scale() {
    struct Spoil(f32);
    impl ParameterVisitor for Spoil {
        fn number(&mut self, _: crate::paint::adjustment::NumberParameter, value: &mut f32) {
            *value = self.0;
        }
        fn flag(&mut self, _: crate::paint::adjustment::ParameterName, _: bool, _: &mut bool) {}
        fn color(
            &mut self,
            _: crate::paint::adjustment::ParameterName,
            _: crate::math::srgb::Color,
            _: &mut crate::math::srgb::Color,
        ) {
        }
        fn curve(
            &mut self,
            _: crate::paint::adjustment::ParameterName,
            _: &mut crate::paint::adjustment::ToneCurve,
        ) {
        }
        fn stops(
            &mut self,
            _: crate::paint::adjustment::ParameterName,
            _: &mut Vec<crate::paint::GradientStop>,
        ) {
        }
        fn table(
            &mut self,
            _: crate::paint::adjustment::ParameterName,
            _: &mut Option<crate::paint::adjustment::ColorTable>,
        ) {
        }
        fn group(
            &mut self,
            _: crate::paint::adjustment::ParameterName,
            inside: &mut dyn FnMut(&mut dyn ParameterVisitor),
        ) {
            inside(self);
        }
    }
    let source = picture();
    for value in [f32::NAN, f32::INFINITY, -1e30, 1e30, 0.0] {
        for mut filter in PictureFilter::all() {
            filter.visit(&mut Spoil(value));
            let found = apply(&filter, &source, Rect::new(30, 30, 40, 40));
            assert!(found.pixels().as_flattened().iter().all(|v| v.is_finite()), "{filter:?}");
        }
    }
    let live = LiveFilter::new(of("unsharp-mask")).scaled(3.0);
    let PictureFilter::UnsharpMask(own) = live.params() else { panic!("another filter") };
    assert_eq!((own.radius, own.amount), (6.0, 100.0));
}
