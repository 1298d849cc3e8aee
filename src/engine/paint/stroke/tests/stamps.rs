//! Strokes of picture tips.

use super::*;

/// A leaf: a picture tip, red on the left, green on the right, opaque within an ellipse.
fn leaf() -> Tip {
    let texel = |x: i32, y: i32| {
        let is_inside = ((x - 32) as f32 / 30.0).powi(2) + ((y - 16) as f32 / 14.0).powi(2) < 1.0;
        if !is_inside {
            [0; 4]
        } else if x < 32 {
            [255, 0, 0, 255]
        } else {
            [0, 255, 0, 255]
        }
    };
    let texels = (0..32).flat_map(|y| (0..64).map(move |x| texel(x, y))).collect();
    let picture = Picture::srgb8(Size::new(64, 32), texels).unwrap();
    Tip::Picture(PictureSource::new("leaf.png".into(), picture, Adjust::default()))
}

#[test]
fn a_colored_stamp_turns_counter_clockwise_and_keeps_its_colors() {
    let brush = Brush { size: 64.0, rotation: 90.0, tip: leaf(), ..Brush::default() };
    let stroke =
        Stroke::new(brush, Operator::None, Color::BLACK, vec![Sample::at(vec2(70.0, 70.0))]);
    let grid = one(stroke, &flat());
    // The leaf's right half, green, is at the top, as large as the picture: 64 px long, 28 wide.
    assert_eq!(grid.pixel(70, 50), [0, 255, 0, 255]);
    assert_eq!(grid.pixel(70, 90), [255, 0, 0, 255]);
    assert_eq!(grid.pixel(50, 70)[3], 0);
    assert_eq!((grid.pixel(70, 41)[3], grid.pixel(70, 37)[3]), (255, 0));
}

#[test]
fn a_bent_stamp_over_tile_borders_equals_the_picture_read_at_d() {
    let operator = Operator::Normal { alpha: 0.5, beta: 1.0, detail: 0.0 };
    let at = vec2(66.0, 62.0);
    let brush = Brush { size: 50.0, tip: leaf(), ..Brush::default() };
    let grid = one(Stroke::new(brush, operator, Color::WHITE, vec![Sample::at(at)]), &ball());
    let scene = ball();
    let d = Deformation::of_dab(scene.surface.as_deref(), SIZE, operator, at);
    let (mut inside, mut outside) = (0, 0);
    for (x, y) in (0..SIZE.height as i32).flat_map(|y| (0..SIZE.width as i32).map(move |x| (x, y)))
    {
        let texel = (d.at(x, y) - at) * 64.0 / 50.0;
        let r = (texel / vec2(30.0, 14.0)).length();
        // Away from the rim and from the seam of the two colors.
        if r < 0.8 && texel.x.abs() > 8.0 {
            let color = if texel.x < 0.0 { [255, 0, 0, 255] } else { [0, 255, 0, 255] };
            assert_eq!(grid.pixel(x, y), color, "({x}, {y})");
            inside += 1;
        } else if r > 3.0 {
            assert_eq!(grid.pixel(x, y)[3], 0, "({x}, {y})");
            outside += 1;
        }
    }
    assert!(inside > 100 && outside > 5000, "{inside}, {outside}");
}

#[test]
fn a_gray_tip_is_painted_in_the_strokes_color_and_softness_spreads_it() {
    let picture = Picture::srgb8(Size::new(16, 16), vec![[255, 255, 255, 255]; 256]).unwrap();
    let tip = Tip::Picture(PictureSource::new("square.png".into(), picture, Adjust::default()));
    let painted = |softness: f32| {
        let brush = Brush { size: 32.0, softness, flow: 0.5, tip: tip.clone(), ..Brush::default() };
        one(
            Stroke::new(
                brush,
                Operator::None,
                Color::parse("#ff8000").unwrap(),
                vec![Sample::at(vec2(64.0, 64.0))],
            ),
            &flat(),
        )
    };
    assert_eq!(painted(0.0).pixel(64, 64), [128, 64, 0, 128]);
    let alpha = |softness| painted(softness).pixel(64 + 18, 64)[3];
    assert_eq!(alpha(0.0), 0);
    let spread: Vec<u8> = (0..=10).map(|i| alpha(i as f32 / 10.0)).collect();
    assert!(spread.windows(2).all(|s| s[1].abs_diff(s[0]) < 25) && spread[10] > 20, "{spread:?}");
}
