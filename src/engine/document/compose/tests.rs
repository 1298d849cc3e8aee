use crate::document::{Document, Group, Layer, Progress, diff, flatten};
use crate::math::srgb::Color;
use crate::math::{Rect, Size};
use crate::paint::effect::{EffectSettings, StrokePosition};
use crate::paint::{EffectKind, LayerEffect};
use crate::raster::{BlendMode, TileAt, TileGrid};
use std::sync::Arc;

const SIZE: Size = Size::new(200, 150);
const GRAY: Color = Color { r: 128, g: 128, b: 128, a: 255 };

fn paint_rect(rect: Rect) -> TileGrid {
    let rgba = [200, 40, 40, 255].repeat(rect.width() * rect.height());
    TileGrid::from_straight_rgba(&rgba, rect.width(), rect.height(), rect.x0, rect.y0)
}

fn of(kind: EffectKind, change: impl FnOnce(&mut EffectSettings)) -> LayerEffect {
    let mut effect = LayerEffect::new(kind);
    change(&mut effect.settings);
    effect
}

fn with(effects: Vec<LayerEffect>, change: impl FnOnce(&mut Layer)) -> Document {
    let mut layer = Layer::new("square", paint_rect(Rect::new(60, 60, 100, 90)));
    layer.effects = Arc::new(effects);
    change(&mut layer);
    Document::empty(SIZE).with_top(Layer::new("ground", GRAY)).with_top(layer)
}

fn render(document: &Document) -> TileGrid {
    flatten(document, &Progress::default()).unwrap()
}

fn pixel(document: &Document, x: i32, y: i32) -> [u8; 4] {
    render(document).pixel(x, y)
}

fn shadow() -> LayerEffect {
    of(EffectKind::DropShadow, |s| {
        (s.document_light, s.angle, s.distance, s.size, s.opacity) = (false, 90.0, 20.0, 6.0, 0.5);
    })
}

#[test]
fn a_shadow_darkens_what_is_beneath_and_not_the_layer() {
    let document = with(vec![shadow()], |_| {});
    assert_eq!(pixel(&document, 80, 75), [200, 40, 40, 255]);
    assert_eq!(pixel(&document, 80, 100), [64, 64, 64, 255]);
    assert_eq!(pixel(&document, 80, 130), [128, 128, 128, 255]);
    let hidden = with(vec![LayerEffect { on: false, ..shadow() }], |_| {});
    assert_eq!(pixel(&hidden, 80, 100), [128, 128, 128, 255]);
}

#[test]
fn the_opacity_of_the_layer_fades_its_effects_and_that_of_its_fill_does_not() {
    let faded = with(vec![shadow()], |layer| layer.opacity = 0.5);
    assert_eq!(pixel(&faded, 80, 100), [96, 96, 96, 255]);
    assert_eq!(pixel(&faded, 80, 75), [164, 84, 84, 255]);
    let bare = with(vec![shadow()], |layer| layer.fill_opacity = 0.0);
    assert_eq!(pixel(&bare, 80, 100), [64, 64, 64, 255]);
    // The layer hides its shadow even where it is not seen itself.
    assert_eq!(pixel(&bare, 80, 85), [128, 128, 128, 255]);
    let through = LayerEffect {
        settings: EffectSettings { knockout: false, ..shadow().settings },
        ..shadow()
    };
    let seen = with(vec![through], |layer| layer.fill_opacity = 0.0);
    assert_eq!(pixel(&seen, 80, 87), [64, 64, 64, 255]);
    let half = with(vec![], |layer| layer.fill_opacity = 0.5);
    assert_eq!(pixel(&half, 80, 75), [164, 84, 84, 255]);
}

#[test]
fn inner_effects_lie_on_the_layer_in_their_order() {
    let multiply = |s: &mut EffectSettings| {
        (s.blend, s.color) = (BlendMode::Multiply, Color { r: 128, g: 255, b: 255, a: 255 });
    };
    let effects = vec![
        of(EffectKind::InnerGlow, |s| {
            (s.size, s.blend, s.opacity, s.color) = (0.0, BlendMode::Normal, 1.0, Color::WHITE);
        }),
        of(EffectKind::ColorOverlay, multiply),
        of(EffectKind::GradientOverlay, |s| (s.angle, s.opacity) = (0.0, 1.0)),
    ];
    let document = with(effects, |_| {});
    let [dark, light] = [61, 98].map(|x| pixel(&document, x, 75));
    assert!(dark[0] < 10 && light[1] > 240 && light[0].abs_diff(124) < 6, "{dark:?} {light:?}");
}

#[test]
fn a_line_is_around_the_layer_on_transparency_too() {
    let line = of(EffectKind::Stroke, |s| (s.size, s.color) = (4.0, Color::WHITE));
    let mut document = with(vec![line.clone()], |_| {});
    document.layers.remove(0);
    assert_eq!(pixel(&document, 57, 75), [255, 255, 255, 255]);
    assert_eq!(pixel(&document, 55, 75), [0, 0, 0, 0]);
    let inside = LayerEffect {
        settings: EffectSettings { position: StrokePosition::Inside, ..line.settings },
        ..line
    };
    let document = with(vec![inside], |_| {});
    assert_eq!(pixel(&document, 62, 75), [255, 255, 255, 255]);
    assert_eq!(pixel(&document, 66, 75), [200, 40, 40, 255]);
    assert_eq!(pixel(&document, 57, 75), [128, 128, 128, 255]);
}

/// As in pictures of Photoshop.
#[test]
fn a_line_lies_on_what_is_beneath_the_layer_and_hides_that_and_its_shadow() {
    let line = |position| {
        of(EffectKind::Stroke, |s| {
            (s.size, s.color, s.opacity, s.position) = (4.0, Color::WHITE, 0.5, position);
        })
    };
    let near = |found: [u8; 4], to: [u8; 3]| {
        let far = found.iter().zip(to).map(|(a, b)| a.abs_diff(b)).max();
        assert!(far <= Some(1), "{found:?} {to:?}");
    };
    let around = with(vec![line(StrokePosition::Outside), shadow()], |_| {});
    near(pixel(&around, 80, 92), [191; 3]);
    near(pixel(&around, 80, 98), [64; 3]);
    let within = with(vec![line(StrokePosition::Inside)], |_| {});
    near(pixel(&within, 62, 75), [191; 3]);
    near(pixel(&within, 66, 75), [200, 40, 40]);
    let both = with(vec![line(StrokePosition::Center)], |_| {});
    for (x, shown) in [(57, [128; 3]), (58, [191; 3]), (61, [191; 3]), (62, [200, 40, 40])] {
        near(pixel(&both, x, 75), shown);
    }
}

/// As in a picture of Photoshop: 249 and 15 % of 251 are more than white.
#[test]
fn the_opacity_of_an_effect_thins_what_it_adds_or_burns() {
    let overlay = |blend, opacity, v: u8| {
        of(EffectKind::ColorOverlay, |s| {
            (s.blend, s.opacity, s.color) = (blend, opacity, Color { r: v, g: v, b: v, a: 255 });
        })
    };
    let shown = |effect: LayerEffect| pixel(&with(vec![effect], |_| {}), 80, 75);
    assert_eq!(shown(overlay(BlendMode::LinearDodge, 0.3, 200)), [255, 100, 100, 255]);
    assert_eq!(shown(overlay(BlendMode::LinearBurn, 0.7, 15)), [32, 0, 0, 255]);
    let mut alone = with(vec![], |layer| layer.effects = Arc::default());
    alone.layers.remove(0);
    let glow = of(EffectKind::OuterGlow, |s| {
        (s.blend, s.opacity, s.size, s.range) = (BlendMode::LinearDodge, 0.5, 0.0, 0.5);
    });
    alone = alone.with_layer(alone.layers[0].id, |l| l.effects = Arc::new(vec![glow])).unwrap();
    assert_eq!(pixel(&alone, 80, 75), [200, 40, 40, 255]);
}

#[test]
fn a_line_lies_beneath_what_the_layer_covers_in_part() {
    let rgba = [200, 40, 40, 102].repeat(40 * 30);
    let faint = TileGrid::from_straight_rgba(&rgba, 40, 30, 60, 60);
    let line = of(EffectKind::Stroke, |s| (s.size, s.color) = (2.0, Color::WHITE));
    let document = with(vec![line], |layer| layer.content = faint.into());
    for x in [60, 75] {
        // Two fifths of the layer and three of the line.
        let found = pixel(&document, x, 75);
        let far = found.iter().zip([233u8, 169, 169, 255]).map(|(a, b)| a.abs_diff(b)).max();
        assert!(far <= Some(1), "{found:?}");
    }
}

#[test]
fn an_upper_line_replaces_a_lower_one_and_is_blended_with_the_ground() {
    let line = |size: f32, blend, color| {
        of(EffectKind::Stroke, |s| (s.size, s.blend, s.color) = (size, blend, color))
    };
    let yellow = Color { r: 255, g: 255, b: 0, a: 255 };
    let blue = Color { r: 0, g: 0, b: 255, a: 255 };
    let effects = vec![line(3.0, BlendMode::Multiply, yellow), line(8.0, BlendMode::Normal, blue)];
    let document = with(effects, |_| {});
    assert_eq!(pixel(&document, 58, 75), [128, 128, 0, 255]);
    assert_eq!(pixel(&document, 54, 75), [0, 0, 255, 255]);
    assert_eq!(pixel(&document, 50, 75), [128, 128, 128, 255]);
}

#[test]
fn a_group_has_effects_of_all_that_is_in_it() {
    for pass_through in [false, true] {
        let layers = [Rect::new(60, 60, 80, 90), Rect::new(80, 60, 100, 90)]
            .map(|rect| Arc::new(Layer::new("half", paint_rect(rect))));
        let mut group = Layer::new("group", Group { layers: layers.to_vec(), pass_through });
        group.effects = Arc::new(vec![shadow()]);
        let document = Document::empty(SIZE).with_top(Layer::new("ground", GRAY)).with_top(group);
        assert_eq!(render(&document).pixel(80, 100), [64, 64, 64, 255], "{pass_through}");
        assert_eq!(render(&document).pixel(80, 70), [200, 40, 40, 255], "{pass_through}");
    }
}

#[test]
fn what_changes_with_a_layer_is_drawn_again_as_far_as_its_effects_reach() {
    let kinds = EffectKind::ALL.map(|(kind, _)| kind);
    for kind in kinds {
        let effect = of(kind, |s| (s.size, s.distance) = (40.0, 30.0));
        let before = with(vec![effect], |_| {});
        let id = before.layers[1].id;
        let after = before
            .with_layer(id, |layer| layer.content = paint_rect(Rect::new(60, 60, 90, 90)).into())
            .unwrap();
        let (was, is) = (render(&before), render(&after));
        let drawn = diff(&before, &after);
        for at in TileAt::covering(SIZE.rect()).filter(|at| !drawn.contains(at)) {
            let tiles = [&was, &is].map(|grid| grid.tile(at).map(|tile| tile.bytes().to_vec()));
            assert!(tiles[0] == tiles[1], "{kind:?} {at:?}");
        }
        // What is kept of the layer before gives what a new one does.
        let fresh = after.with_layer(id, |layer| layer.cache = Default::default()).unwrap();
        let fresh = render(&fresh);
        for at in TileAt::covering(SIZE.rect()) {
            let tiles = [&is, &fresh].map(|grid| grid.tile(at).map(|tile| tile.bytes().to_vec()));
            assert!(tiles[0] == tiles[1], "{kind:?} {at:?}");
        }
    }
}

#[test]
fn effects_keep_their_look_on_a_larger_canvas() {
    let document = with(vec![shadow()], |_| {});
    let large = document.scaled(2.0).unwrap();
    assert_eq!(render(&large).pixel(160, 200), [64, 64, 64, 255]);
    assert_eq!(render(&large).pixel(160, 246), [128, 128, 128, 255]);
}

/// One pixel of three layers, as Photoshop shows it.
#[test]
fn a_thinned_fill_covers_by_its_opacity_where_nothing_is() {
    let fill = |rgb: [u8; 3], blend, opacity, fill_opacity| Layer {
        blend,
        opacity,
        fill_opacity,
        ..Layer::new("fill", Color { r: rgb[0], g: rgb[1], b: rgb[2], a: 255 })
    };
    let document = Document::empty(SIZE)
        .with_top(fill([0, 0, 255], BlendMode::Normal, 0.6, 1.0))
        .with_top(fill([0, 255, 0], BlendMode::LinearLight, 0.4, 1.0))
        .with_top(fill([255, 0, 0], BlendMode::LinearLight, 1.0, 0.2));
    let [r, g, b, a] = pixel(&document, 5, 5);
    // Straight 63, 78, 66.
    let near = |v: u8, to: f32| (f32::from(v) - to * 206.0 / 255.0).abs() < 1.5;
    assert!(near(r, 63.0) && near(g, 78.0) && near(b, 66.0) && a == 206, "{:?}", [r, g, b, a]);
}
