use super::*;
use crate::raster::picture::Texels;

const DISC: &str = r##"<?xml version="1.0"?>
<!-- a disc -->
<svg xmlns="http://www.w3.org/2000/svg" width="40" height="20">
  <circle cx="20" cy="10" r="8" fill="#204060"/>
</svg>"##;

fn decode_text(text: &str) -> Result<Picture> {
    decode(Path::new("a.svg"), text.as_bytes(), &Budget::default())
}

#[test]
fn an_svg_is_known_by_its_first_element() {
    assert!(is_svg(DISC.as_bytes()));
    assert!(is_svg(b"<svg xmlns='http://www.w3.org/2000/svg'/>"));
    let typed =
        "<?xml version='1.0'?><!DOCTYPE svg PUBLIC '-//W3C//DTD SVG 1.1//EN' 'svg11.dtd'>\n<svg/>";
    assert!(is_svg(typed.as_bytes()));
    for other in ["<html><svg/></html>", "<image w='1'/>", "{\"svg\": 1}", "<!-- <svg> --><p/>", ""]
    {
        assert!(!is_svg(other.as_bytes()), "{other}");
    }
}

#[test]
fn a_drawing_is_paint_at_its_own_size() {
    let painted =
        decode_paint(Path::new("a.svg"), DISC.as_bytes(), 0, 0, &Budget::default()).unwrap();
    assert_eq!(painted.size, Size::new(40, 20));
    let rgba = painted.tiles.to_straight_rgba(painted.size.rect());
    let at = |x: usize, y: usize| &rgba[(y * 40 + x) * 4..][..4];
    assert_eq!(at(20, 10), [0x20, 0x40, 0x60, 255]);
    assert_eq!(at(2, 2)[3], 0);
}

#[test]
fn an_image_layer_gets_more_pixels_than_a_small_drawing_says() {
    let picture = decode_text(DISC).unwrap();
    assert_eq!(picture.size, Size::new(2048, 1024));
    assert_eq!(picture.encoded.unwrap().bytes(), DISC.as_bytes());
}

#[test]
fn text_becomes_outlines_that_show_the_same_without_fonts() {
    let text = r#"<svg xmlns="http://www.w3.org/2000/svg" width="200" height="60">
        <text x="10" y="40" font-size="32">Rilievo</text></svg>"#;
    let picture = decode_text(text).unwrap();
    let Texels::Srgb8(texels) = &picture.texels else { panic!("no bytes") };
    let black = texels.iter().filter(|&&texel| texel == [0, 0, 0, 255]).count();
    assert!(black > 10_000, "only {black} texels are written on");
    let outlined = picture.encoded.clone().unwrap();
    assert!(!String::from_utf8_lossy(outlined.bytes()).contains("<text"), "text is left");
    let again = decode(Path::new("b.svg"), outlined.bytes(), &Budget::default()).unwrap();
    assert!(again == picture, "the outlines show another picture");
    assert_eq!(again.encoded.unwrap().bytes(), outlined.bytes());
}

#[test]
fn bands_that_are_painted_side_by_side_are_the_drawing() {
    let line = |y: usize| {
        format!(
            r#"<text x="7.3" y="{y}" font-size="23">Quick brown foxes {y}</text>
            <path d="M 5 {} q 90 9 180 0" stroke="url(#ramp)" stroke-width="2" fill="none"/>"#,
            y + 6
        )
    };
    let text = format!(
        r##"<svg xmlns="http://www.w3.org/2000/svg" width="240" height="400"><defs>
        <linearGradient id="ramp"><stop stop-color="#a04020"/><stop offset="1" stop-color="#2040a0"/>
        </linearGradient></defs>{}</svg>"##,
        (0..9).map(|i| line(40 + 40 * i)).collect::<String>()
    );
    let file = Path::new("a.svg");
    let drawing = Drawing::parse(file, text.as_bytes(), &Budget::default()).unwrap();
    for scale in [1.0, 2.7] {
        let size = Size::new((240.0 * scale) as u32, (400.0 * scale) as u32);
        assert!(drawing.band_ends(size, scale).len() > 2, "no bands at {scale}");
        let mut whole = vec![[0u8; 4]; size.area()];
        drawing.paint_band(0, scale, size, &mut whole).unwrap();
        let painted = drawing.paint(size, scale).unwrap();
        let off = painted.iter().flatten().zip(whole.iter().flatten());
        let off = off.map(|(a, b)| a.abs_diff(*b)).max();
        assert!(off <= Some(1), "{off:?} of 255 at {scale}");
    }
    // A path from top to bottom leaves no row where the drawing may be cut.
    let bar = text.replace("</svg>", r##"<path d="M 200 0 v 400" stroke="#000"/></svg>"##);
    let drawing = Drawing::parse(file, bar.as_bytes(), &Budget::default()).unwrap();
    assert_eq!(drawing.band_ends(Size::new(240, 400), 1.0), [400]);
}

#[test]
fn nothing_outside_of_the_file_is_read() {
    let folder = tempfile::tempdir().unwrap();
    let red = image::RgbaImage::from_pixel(4, 4, image::Rgba([255, 0, 0, 255]));
    red.save(folder.path().join("red.png")).unwrap();
    let named = folder.path().join("red.png");
    let text = format!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" width="8" height="8">
        <image href="{0}" width="8" height="8"/>
        <image href="file://{0}" width="8" height="8"/></svg>"#,
        named.display()
    );
    let file = folder.path().join("a.svg");
    let painted = decode_paint(&file, text.as_bytes(), 0, 0, &Budget::default()).unwrap();
    assert!(painted.tiles.to_straight_rgba(painted.size.rect()).iter().all(|&v| v == 0));
}

#[test]
fn what_is_wrong_is_said() {
    let said = |text: &str| decode_text(text).unwrap_err().to_string();
    let none = said("<svg xmlns='http://www.w3.org/2000/svg' width='0' height='4'/>");
    assert!(none.contains("has no size"), "{none}");
    let cut = said(&DISC[..DISC.len() - 20]);
    assert!(cut.contains("a.svg: cannot be read: the SVG cannot be parsed"), "{cut}");
    let wide = b"<svg xmlns='http://www.w3.org/2000/svg' width='1e9' height='3'/>";
    let huge = decode_paint(Path::new("a.svg"), wide, 0, 0, &Budget::default());
    assert!(huge.err().unwrap().to_string().contains("a.svg"));
    let small = Budget { memory_bytes: 1 << 20, ..Budget::default() };
    let refused = decode(Path::new("a.svg"), DISC.as_bytes(), &small).unwrap_err().to_string();
    assert!(refused.contains("an SVG of 2048 × 1024 pixels"), "{refused}");
}
