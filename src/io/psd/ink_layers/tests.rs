use super::*;
use crate::paint::ColorAdjustment;
use crate::paint::adjustment::{Invert, Posterize, Threshold};
use crate::psd::RecordMask;

const SIZE: Size = Size::new(4, 2);

fn to_stored(byte: u8) -> u16 {
    u16::from(byte) * 257
}

/// A layer of one ink, as an ideal press shows it.
fn layer(light: [u8; 4], alpha: u8) -> LayerRecord {
    let [c, m, y, k] = light.map(u32::from);
    let seen = [c, m, y].map(|v| ((v * k + 127) / 255) as u8);
    let pixel = [seen[0], seen[1], seen[2], alpha];
    LayerRecord {
        rect: SIZE.rect(),
        rgba: pixel.repeat(SIZE.area()),
        inks: vec![light.map(to_stored); SIZE.area()],
        ..LayerRecord::default()
    }
}

fn adjusting(adjustment: ColorAdjustment) -> LayerRecord {
    LayerRecord { adjustment: Some(adjustment), ..LayerRecord::default() }
}

fn fit(records: &mut [LayerRecord]) -> bool {
    try_fit(records, SIZE, &InkView::Inks(None), false)
}

/// The first pixel of the layers, each blended normally.
fn show(records: &[LayerRecord]) -> [f32; 3] {
    records.iter().fold([1.0; 3], |below, record| {
        let pixel = record.rgba.as_chunks::<4>().0[0].map(|v| f32::from(v) / 255.0);
        [0, 1, 2].map(|c| pixel[3] * pixel[c] + (1.0 - pixel[3]) * below[c])
    })
}

#[test]
fn inks_are_mixed_and_not_what_they_look_like() {
    // Half of black over cyan: 0.75 of the light, and not 0.5 of its color.
    let mut records = vec![layer([0, 255, 255, 255], 255), layer([255, 255, 255, 0], 128)];
    assert!(fit(&mut records));
    let [r, g, b] = show(&records);
    // Cyan 0.5, black 0.5: the product shows.
    assert!(
        (r - 0.252).abs() < 0.01 && (g - 0.5).abs() < 0.01 && (b - 0.5).abs() < 0.01,
        "{r} {g} {b}"
    );
    assert_eq!(records[1].converted, [NOTE]);
    assert!(records[0].converted.is_empty(), "what lies on nothing stays");
}

#[test]
fn modes_and_adjustments_act_on_each_ink() {
    let difference = LayerRecord { blend: *b"diff", ..layer([255, 255, 255, 255], 255) };
    let mut records = vec![layer([200, 100, 50, 255], 255), difference];
    assert!(fit(&mut records));
    assert_eq!(show(&records), [0.0; 3], "no light of black is left");
    let half = RecordMask {
        rect: Rect::new(0, 0, 2, 2),
        outside: 0,
        values: vec![255; 4],
        disabled: false,
    };
    let invert = LayerRecord { mask: Some(half), ..adjusting(ColorAdjustment::Invert(Invert)) };
    let mut records = vec![layer([200, 100, 50, 0], 255), invert];
    assert!(fit(&mut records));
    assert_eq!(records[1].rect, Rect::new(0, 0, 2, 2));
    let [r, g, b] = show(&records).map(|v| (255.0 * v).round());
    assert_eq!([r, g, b], [55.0, 155.0, 205.0]);
    let posterize = Posterize { levels: 2.0, ..Posterize::default() };
    let mut records =
        vec![layer([200, 100, 127, 128], 255), adjusting(ColorAdjustment::Posterize(posterize))];
    assert!(fit(&mut records));
    assert_eq!(show(&records), [1.0, 0.0, 0.0], "128 of black is the upper of two tones");
    assert_eq!(records[1].converted, [ADJUSTED]);
}

#[test]
fn a_threshold_leaves_paper_or_black() {
    let threshold = |level| adjusting(ColorAdjustment::Threshold(Threshold { level }));
    // (0.3 · 200 + 0.59 · 100 + 0.11 · 50) · 0.8 = 99.6
    for (level, white) in [(100.0, 1.0), (101.0, 0.0)] {
        let mut records = vec![layer([200, 100, 50, 204], 255), threshold(level)];
        assert!(fit(&mut records));
        assert_eq!(show(&records), [white; 3]);
    }
}

#[test]
fn what_is_not_known_of_inks_stays_as_it_was() {
    let vibrance = adjusting(ColorAdjustment::Vibrance(Default::default()));
    let clipped = LayerRecord { clipped: true, ..layer([9; 4], 255) };
    let group = |section| LayerRecord { section, ..LayerRecord::default() };
    for other in [vibrance, clipped, group(RecordSection::End), group(RecordSection::Group)] {
        let mut records = vec![layer([0, 255, 255, 255], 255), other];
        let before = records.clone();
        assert!(!fit(&mut records));
        assert_eq!(records, before);
    }
}

#[test]
fn groups_are_composed_by_themselves_unless_they_pass_through() {
    let group = |section, blend: &[u8; 4], opacity| LayerRecord {
        section,
        opacity,
        blend: *blend,
        ..LayerRecord::default()
    };
    let multiply = || LayerRecord { blend: *b"mul ", ..layer([100, 255, 255, 255], 255) };
    let end = || group(RecordSection::End, b"norm", 255);
    for (blend, opacity) in [(b"pass", 255), (b"norm", 255)] {
        let head = group(RecordSection::Group, blend, opacity);
        let mut records = vec![layer([255, 50, 255, 255], 255), end(), multiply(), head];
        assert!(fit(&mut records));
        let pixel = records[2].rgba.as_chunks::<4>().0[0];
        let green = if blend == b"pass" { 50 } else { 255 };
        assert_eq!(pixel, [100, green, 255, 255]);
    }
    let faded = group(RecordSection::Group, b"pass", 90);
    assert!(!fit(&mut [layer([0; 4], 255), end(), multiply(), faded]));
}

#[test]
fn truncated_pixels_and_masks_are_no_harm() {
    let short = LayerRecord { inks: vec![[0; 4]; 3], ..layer([1, 2, 3, 4], 200) };
    let cut = LayerRecord { rgba: vec![1, 2, 3, 255], ..layer([1, 2, 3, 4], 200) };
    let far = LayerRecord { rect: Rect::new(-900_000, 1, 900_000, 2), ..layer([7; 4], 9) };
    let mask = RecordMask { rect: SIZE.rect(), outside: 9, values: vec![1], disabled: false };
    let masked = LayerRecord { mask: Some(mask), ..layer([5; 4], 77) };
    assert!(fit(&mut [short, cut, far, masked]));
}

#[test]
fn lab_and_gray_are_blended_as_their_values() {
    let of = |values: [u8; 3], rgb: [u8; 3], alpha: u8| LayerRecord {
        rgba: [rgb[0], rgb[1], rgb[2], alpha].repeat(SIZE.area()),
        inks: vec![[values[0], values[1], values[2], 0].map(to_stored); SIZE.area()],
        ..layer([0; 4], 255)
    };
    let mut records = vec![of([255, 128, 128], [255; 3], 255), of([0, 128, 128], [0; 3], 128)];
    assert!(try_fit(&mut records, SIZE, &InkView::Lab(false), false));
    // Half of L is 18.4 % of the light, 118 of 255; half of sRGB would be 127.
    let [r, g, b] = show(&records).map(|v| 255.0 * v);
    assert!([r, g, b].iter().all(|v| (v - 118.0).abs() < 1.5), "{r} {g} {b}");
    let lab = |blend: &[u8; 4]| LayerRecord { blend: *blend, ..of([9; 3], [9; 3], 9) };
    assert!(!try_fit(&mut [lab(b"mul ")], SIZE, &InkView::Lab(false), false));
    assert!(InkView::of(Mode::Rgb, None, None, false).is_none());
    assert!(InkView::of(Mode::Gray, None, None, false).is_none());
}
