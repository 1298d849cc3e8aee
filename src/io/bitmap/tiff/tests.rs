use super::*;

/// An uncompressed TIFF. Tags have a number and 16-bit values; those of a single strip come by themselves.
fn file(is_big_endian: bool, size: [u16; 2], tags: &[(u16, &[u16])], data: &[u8]) -> Vec<u8> {
    let short = |v: u16| if is_big_endian { v.to_be_bytes() } else { v.to_le_bytes() };
    let long = |v: u32| if is_big_endian { v.to_be_bytes() } else { v.to_le_bytes() };
    let (width, height, start, length) = ([size[0]], [size[1]], [8], [data.len() as u16]);
    let mut all = vec![(256, &width[..]), (257, &height), (259, &[1]), (273, &start), (278, &height), (279, &length)];
    all.retain(|(tag, _)| tags.iter().all(|(other, _)| other != tag));
    all.extend(tags);
    all.sort();
    let mut spare = data.to_vec();
    spare.resize(spare.len().next_multiple_of(2), 0);
    let mut directory = short(all.len() as u16).to_vec();
    for (tag, values) in all {
        directory.extend([short(tag), short(3)].concat());
        directory.extend(long(values.len() as u32));
        let mut bytes: Vec<u8> = values.iter().flat_map(|v| short(*v)).collect();
        if bytes.len() > 4 {
            let at = 8 + spare.len() as u32;
            spare.extend(bytes);
            bytes = long(at).to_vec();
        }
        bytes.resize(4, 0);
        directory.extend(bytes);
    }
    let begin = if is_big_endian { b"MM\0*" } else { b"II*\0" };
    [&begin[..], &long(8 + spare.len() as u32), &spare, &directory, &[0; 4]].concat()
}
fn decoded(bytes: &[u8]) -> DynamicImage {
    decode(Path::new("a.tif"), bytes, &Budget::default()).unwrap_or_else(|e| panic!("{e}")).image
}
const PHOTOMETRIC: u16 = 262;
const BITS: u16 = 258;
const SAMPLES: u16 = 277;
const EXTRA: u16 = 338;
const FORMAT: u16 = 339;
const FLOATS: &[u16] = &[3];

#[test]
fn a_palette_gives_its_colours() {
    let mut map = [0u16; 48];
    (map[3], map[16 + 3], map[32 + 3], map[32 + 9]) = (65535, 0x8000, 0, 0x1234);
    let tags: &[(u16, &[u16])] = &[(PHOTOMETRIC, &[3]), (BITS, &[4]), (SAMPLES, &[1]), (320, &map)];
    for is_big_endian in [false, true] {
        let image = decoded(&file(is_big_endian, [3, 1], tags, &[0x39, 0x30]));
        assert_eq!(image.into_rgb8().into_raw(), [255, 128, 0, 0, 0, 0x12, 255, 128, 0]);
    }
}
#[test]
fn grey_with_alpha_and_white_zero_are_light() {
    let tags: &[(u16, &[u16])] = &[(PHOTOMETRIC, &[0]), (BITS, &[8, 8]), (SAMPLES, &[2]), (EXTRA, &[2])];
    let image = decoded(&file(true, [2, 1], tags, &[0, 255, 200, 100]));
    assert_eq!(image.into_luma_alpha8().into_raw(), [255, 255, 55, 100]);
}
#[test]
fn inks_are_printed_and_a_big_tiff_is_known() {
    let tags: &[(u16, &[u16])] = &[(PHOTOMETRIC, &[5]), (BITS, &[8]), (SAMPLES, &[5]), (EXTRA, &[2])];
    let image = decoded(&file(true, [1, 1], tags, &[255, 0, 51, 127, 9]));
    assert_eq!(image.into_rgba8().into_raw(), [0, 128, 102, 9]);
    let mut bytes = Cursor::new(Vec::new());
    let mut encoder = tiff::encoder::TiffEncoder::new_big(&mut bytes).unwrap();
    encoder.write_image::<tiff::encoder::colortype::Gray32Float>(2, 1, &[0.5, 3.0]).unwrap();
    let read = crate::bitmap::decode(Path::new("a.tif"), &bytes.into_inner(), &Budget::default()).unwrap();
    assert_eq!(read.image.into_rgb32f().into_raw(), [0.5, 0.5, 0.5, 3.0, 3.0, 3.0]);
}
#[test]
fn floats_of_any_width_are_read_and_grey_ones_become_rgb() {
    let tags: &[(u16, &[u16])] = &[(PHOTOMETRIC, &[1]), (BITS, &[16]), (SAMPLES, &[1]), (FORMAT, FLOATS)];
    let image = decoded(&file(false, [2, 1], tags, &[0x00, 0x3c, 0x00, 0x34]));
    assert_eq!(image.into_rgb32f().into_raw(), [1.0, 1.0, 1.0, 0.25, 0.25, 0.25]);
    let wide: Vec<u8> = [2.5f64, 0.5].iter().flat_map(|v| v.to_be_bytes()).collect();
    let tags: &[(u16, &[u16])] = &[(PHOTOMETRIC, &[1]), (BITS, &[64]), (SAMPLES, &[1]), (FORMAT, FLOATS)];
    let image = decoded(&file(true, [2, 1], tags, &wide));
    assert_eq!(image.into_rgb32f().into_raw(), [2.5, 2.5, 2.5, 0.5, 0.5, 0.5]);
}
#[test]
fn colours_multiplied_by_alpha_and_planes_come_straight_and_in_turn() {
    let rgba: &[(u16, &[u16])] = &[(PHOTOMETRIC, &[2]), (BITS, &[8]), (SAMPLES, &[4]), (EXTRA, &[1])];
    let image = decoded(&file(false, [1, 1], rgba, &[64, 32, 0, 128]));
    assert_eq!(image.into_rgba8().into_raw(), [128, 64, 0, 128]);
    let strips: &[(u16, &[u16])] = &[(273, &[8, 10, 12]), (279, &[2, 2, 2]), (284, &[2])];
    let planes = [&[(PHOTOMETRIC, &[2][..]), (BITS, &[8]), (SAMPLES, &[3])], strips].concat();
    let image = decoded(&file(false, [2, 1], &planes, &[1, 2, 3, 4, 5, 6]));
    assert_eq!(image.into_rgb8().into_raw(), [1, 3, 5, 2, 4, 6]);
}
#[test]
fn what_has_signs_or_is_cut_short_gets_a_sentence() {
    let tags: &[(u16, &[u16])] = &[(PHOTOMETRIC, &[1]), (BITS, &[8]), (SAMPLES, &[1]), (FORMAT, &[2])];
    let signed = file(false, [2, 1], tags, &[1, 2]);
    let said = |bytes: &[u8]| decode(Path::new("a.tif"), bytes, &Budget::default()).err().unwrap().to_string();
    assert!(said(&signed).contains("have a sign"));
    let tags: &[(u16, &[u16])] = &[(PHOTOMETRIC, &[1]), (BITS, &[32]), (SAMPLES, &[1]), (FORMAT, FLOATS)];
    assert!(said(&file(false, [200, 100], tags, &[0; 8])).contains("a.tif"));
}
#[test]
fn a_jpeg_within_that_claims_more_than_the_picture_is_told_by_its_header() {
    let header = |height: u16, width: u16| {
        let [h, w] = [height.to_be_bytes(), width.to_be_bytes()];
        [&[9, 9, 0xff, 0xc0, 0, 17, 8][..], &h, &w, &[3]].concat()
    };
    let size = Size::new(64, 64);
    assert!(claims_more(&header(16_384, 16_384), size));
    assert!(!claims_more(&header(512, 512), size), "a tile");
    assert!(!claims_more(&header(4_000, 4_000), Size::new(4_000, 8_000)), "a strip");
    assert!(!claims_more(&[0xff, 0xc0, 0], size));
}
