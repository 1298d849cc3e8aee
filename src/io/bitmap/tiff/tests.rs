use super::*;

/// An uncompressed TIFF. Tags have a number and 16-bit values; those of a single strip come by
/// themselves.
fn file(is_big_endian: bool, size: [u16; 2], tags: &[(u16, &[u16])], data: &[u8]) -> Vec<u8> {
    let short = |v: u16| if is_big_endian { v.to_be_bytes() } else { v.to_le_bytes() };
    let long = |v: u32| if is_big_endian { v.to_be_bytes() } else { v.to_le_bytes() };
    let (width, height, start, length) = ([size[0]], [size[1]], [8], [data.len() as u16]);
    let mut all = vec![
        (256, &width[..]),
        (257, &height),
        (259, &[1]),
        (273, &start),
        (278, &height),
        (279, &length),
    ];
    // A file is in strips or in tiles.
    let in_tiles = tags.iter().any(|(tag, _)| *tag == 324);
    all.retain(|(tag, _)| !(in_tiles && [273, 278, 279].contains(tag)));
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

fn decode_bytes(bytes: &[u8]) -> DynamicImage {
    decode(Path::new("a.tif"), bytes, &Budget::default()).unwrap_or_else(|e| panic!("{e}")).image
}
const PHOTOMETRIC: u16 = 262;
const BITS: u16 = 258;
const SAMPLES: u16 = 277;
const EXTRA: u16 = 338;
const FORMAT: u16 = 339;
const FLOATS: &[u16] = &[3];

#[test]
fn a_palette_gives_its_colors() {
    let mut map = [0u16; 48];
    (map[3], map[16 + 3], map[32 + 3], map[32 + 9]) = (65535, 0x8000, 0, 0x1234);
    let tags: &[(u16, &[u16])] = &[(PHOTOMETRIC, &[3]), (BITS, &[4]), (SAMPLES, &[1]), (320, &map)];
    for is_big_endian in [false, true] {
        let image = decode_bytes(&file(is_big_endian, [3, 1], tags, &[0x39, 0x30]));
        assert_eq!(image.into_rgb8().into_raw(), [255, 128, 0, 0, 0, 0x12, 255, 128, 0]);
    }
}

#[test]
fn gray_with_alpha_and_white_zero_are_light() {
    let tags: &[(u16, &[u16])] =
        &[(PHOTOMETRIC, &[0]), (BITS, &[8, 8]), (SAMPLES, &[2]), (EXTRA, &[2])];
    let image = decode_bytes(&file(true, [2, 1], tags, &[0, 255, 200, 100]));
    assert_eq!(image.into_luma_alpha8().into_raw(), [255, 255, 55, 100]);
}

#[test]
fn inks_are_printed_and_a_big_tiff_is_known() {
    let tags: &[(u16, &[u16])] =
        &[(PHOTOMETRIC, &[5]), (BITS, &[8]), (SAMPLES, &[5]), (EXTRA, &[2])];
    let image = decode_bytes(&file(true, [1, 1], tags, &[255, 0, 51, 127, 9]));
    assert_eq!(image.into_rgba8().into_raw(), [0, 128, 102, 9]);
    let mut bytes = Cursor::new(Vec::new());
    let mut encoder = tiff::encoder::TiffEncoder::new_big(&mut bytes).unwrap();
    encoder.write_image::<tiff::encoder::colortype::Gray32Float>(2, 1, &[0.5, 3.0]).unwrap();
    let read =
        crate::bitmap::decode(Path::new("a.tif"), &bytes.into_inner(), &Budget::default()).unwrap();
    assert_eq!(read.image.into_rgb32f().into_raw(), [0.5, 0.5, 0.5, 3.0, 3.0, 3.0]);
}

#[test]
fn floats_of_any_width_are_read_and_gray_ones_become_rgb() {
    let tags: &[(u16, &[u16])] =
        &[(PHOTOMETRIC, &[1]), (BITS, &[16]), (SAMPLES, &[1]), (FORMAT, FLOATS)];
    let image = decode_bytes(&file(false, [2, 1], tags, &[0x00, 0x3c, 0x00, 0x34]));
    assert_eq!(image.into_rgb32f().into_raw(), [1.0, 1.0, 1.0, 0.25, 0.25, 0.25]);
    let wide: Vec<u8> = [2.5f64, 0.5].iter().flat_map(|v| v.to_be_bytes()).collect();
    let tags: &[(u16, &[u16])] =
        &[(PHOTOMETRIC, &[1]), (BITS, &[64]), (SAMPLES, &[1]), (FORMAT, FLOATS)];
    let image = decode_bytes(&file(true, [2, 1], tags, &wide));
    assert_eq!(image.into_rgb32f().into_raw(), [2.5, 2.5, 2.5, 0.5, 0.5, 0.5]);
}

#[test]
fn colors_multiplied_by_alpha_and_planes_come_straight_and_in_turn() {
    let rgba: &[(u16, &[u16])] =
        &[(PHOTOMETRIC, &[2]), (BITS, &[8]), (SAMPLES, &[4]), (EXTRA, &[1])];
    let image = decode_bytes(&file(false, [1, 1], rgba, &[64, 32, 0, 128]));
    assert_eq!(image.into_rgba8().into_raw(), [128, 64, 0, 128]);
    let strips: &[(u16, &[u16])] = &[(273, &[8, 10, 12]), (279, &[2, 2, 2]), (284, &[2])];
    let planes = [&[(PHOTOMETRIC, &[2][..]), (BITS, &[8]), (SAMPLES, &[3])], strips].concat();
    let image = decode_bytes(&file(false, [2, 1], &planes, &[1, 2, 3, 4, 5, 6]));
    assert_eq!(image.into_rgb8().into_raw(), [1, 3, 5, 2, 4, 6]);
}

#[test]
fn what_has_signs_or_is_cut_short_gets_a_sentence() {
    let tags: &[(u16, &[u16])] =
        &[(PHOTOMETRIC, &[1]), (BITS, &[8]), (SAMPLES, &[1]), (FORMAT, &[2])];
    let signed = file(false, [2, 1], tags, &[1, 2]);
    let said = |bytes: &[u8]| {
        decode(Path::new("a.tif"), bytes, &Budget::default()).err().unwrap().to_string()
    };
    assert!(said(&signed).contains("are signed"));
    let tags: &[(u16, &[u16])] =
        &[(PHOTOMETRIC, &[1]), (BITS, &[32]), (SAMPLES, &[1]), (FORMAT, FLOATS)];
    assert!(said(&file(false, [200, 100], tags, &[0; 8])).contains("a.tif"));
}

/// Tiles of 16 × 16 that are all the same JPEG.
fn tiles_of_jpeg(size: [u16; 2], jpeg: &[u8]) -> Vec<u8> {
    let count = usize::from(size[0] / 16) * usize::from(size[1] / 16);
    let (starts, lengths) = (vec![8u16; count], vec![jpeg.len() as u16; count]);
    let tiles: &[(u16, &[u16])] =
        &[(322, &[16]), (323, &[16]), (324, &starts), (325, &lengths), (259, &[7])];
    let colors: &[(u16, &[u16])] = &[(PHOTOMETRIC, &[6]), (BITS, &[8, 8, 8]), (SAMPLES, &[3])];
    file(false, size, &[tiles, colors].concat(), jpeg)
}

fn jpeg(side: u32) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    let gray = image::RgbImage::from_pixel(side, side, image::Rgb([90; 3]));
    gray.write_to(&mut bytes, image::ImageFormat::Jpeg).unwrap();
    bytes.into_inner()
}

#[test]
fn tiles_that_are_jpegs_are_read() {
    assert_eq!(
        decode_bytes(&tiles_of_jpeg([32, 32], &jpeg(16))).into_rgb8().get_pixel(20, 20).0,
        [90; 3]
    );
}

#[test]
fn a_jpeg_within_may_be_as_large_as_its_tile_and_all_together_as_a_picture() {
    let said = |bytes: &[u8], budget: &Budget| {
        decode(Path::new("a.tif"), bytes, budget).err().unwrap().to_string()
    };
    let large = tiles_of_jpeg([512, 512], &jpeg(128));
    assert!(said(&large, &Budget::default()).contains("claims more pixels than its part"));
    // Each tile of 16 × 16 hides a picture of 64 × 64.
    let (budget, many) =
        (Budget { area_px: 512 * 512, ..Budget::default() }, tiles_of_jpeg([512, 512], &jpeg(64)));
    assert!(decode(Path::new("a.tif"), &many, &budget).is_ok(), "sixteen times the picture");
    let scan = jpeg(64);
    let at = scan.windows(2).position(|pair| pair == [0xff, 0xda]).unwrap();
    let thrice = [&scan[..at], &scan[at..scan.len() - 2].repeat(3), &[0xff, 0xd9]].concat();
    let refused = said(&tiles_of_jpeg([512, 512], &thrice), &budget);
    assert!(refused.contains("visit 12582912 pixels; 8388608 are allowed"), "{refused}");
}

#[test]
fn a_picture_in_a_million_pieces_is_refused_before_any_is_read() {
    // Tiles of a pixel each, all the same.
    let (places, lengths) = (vec![8; 160_000], vec![1; 160_000]);
    let tiles: &[(u16, &[u16])] = &[(322, &[1]), (323, &[1]), (324, &places), (325, &lengths)];
    let colors: &[(u16, &[u16])] = &[(PHOTOMETRIC, &[1]), (BITS, &[8]), (SAMPLES, &[1])];
    let bytes = file(false, [400, 400], &[tiles, colors].concat(), &[9; 64]);
    let said = decode(Path::new("a.tif"), &bytes, &Budget::default()).err().unwrap().to_string();
    assert_eq!(said, "a.tif: too large: the TIFF is in 160000 pieces; 131072 are allowed");
}

/// Bits written as text, filled up to a byte.
fn bits(text: &str) -> Vec<u8> {
    let bits: Vec<u8> = text.bytes().filter(u8::is_ascii_digit).map(|digit| digit - b'0').collect();
    bits.chunks(8)
        .map(|byte| byte.iter().enumerate().fold(0, |sum, (i, bit)| sum | bit << (7 - i)))
        .collect()
}

#[test]
fn zstd_is_unpacked_strip_by_strip() {
    // Frames of one block that is stored uncompressed.
    let frame = |data: &[u8]| {
        let block = (data.len() as u32) << 3 | 1;
        [&[0x28, 0xb5, 0x2f, 0xfd, 0x20, data.len() as u8][..], &block.to_le_bytes()[..3], data]
            .concat()
    };
    let (first, second) = (frame(&[1, 2, 3, 4]), frame(&[5, 6]));
    let starts = [8, 8 + first.len() as u16];
    let (length, lengths) = (first.len() as u16, second.len() as u16);
    for number in [50_000, 34_926] {
        let strips: &[(u16, &[u16])] =
            &[(259, &[number]), (273, &starts), (278, &[2]), (279, &[length, lengths])];
        let colors: &[(u16, &[u16])] = &[(PHOTOMETRIC, &[1]), (BITS, &[8]), (SAMPLES, &[1])];
        for is_big_endian in [false, true] {
            let bytes = file(
                is_big_endian,
                [2, 3],
                &[strips, colors].concat(),
                &[&first[..], &second].concat(),
            );
            assert_eq!(decode_bytes(&bytes).into_luma8().into_raw(), [1, 2, 3, 4, 5, 6]);
        }
    }
}

#[test]
fn a_fax_of_group_3_is_read_with_and_without_its_first_mark_and_from_either_end_of_its_bytes() {
    let tags: &[(u16, &[u16])] = &[(PHOTOMETRIC, &[0]), (BITS, &[1]), (SAMPLES, &[1]), (259, &[3])];
    // White 4, black 3, white 1; then black 2 after no white, white 6.
    let (mark, rows) = ("000000000001", ["1011 10 000111", "00110101 11 1110"]);
    let text = [mark, rows[0], mark, rows[1]].concat();
    let pixels = [255, 255, 255, 255, 0, 0, 0, 255, 0, 0, 255, 255, 255, 255, 255, 255];
    let marked = bits(&text);
    assert_eq!(decode_bytes(&file(false, [8, 2], tags, &marked)).into_luma8().into_raw(), pixels);
    let bare = bits(&text[mark.len()..]);
    assert_eq!(decode_bytes(&file(true, [8, 2], tags, &bare)).into_luma8().into_raw(), pixels);
    let mirrored: Vec<u8> = marked.iter().map(|byte| byte.reverse_bits()).collect();
    let from_the_right = [tags, &[(266, &[2][..])]].concat();
    assert_eq!(
        decode_bytes(&file(false, [8, 2], &from_the_right, &mirrored)).into_luma8().into_raw(),
        pixels
    );
    let in_two_dimensions = [tags, &[(292, &[1][..])]].concat();
    let said = decode(
        Path::new("a.tif"),
        &file(false, [8, 2], &in_two_dimensions, &marked),
        &Budget::default(),
    );
    assert!(said.err().unwrap().to_string().contains("two-dimensional group 3 fax"));
}

#[test]
fn a_damaged_zstd_strip_gets_a_sentence() {
    let tags: &[(u16, &[u16])] =
        &[(PHOTOMETRIC, &[1]), (BITS, &[8]), (SAMPLES, &[1]), (259, &[50_000])];
    let bytes = file(false, [64, 64], tags, &[0x28, 0xb5, 0x2f, 0xfd, 0, 0, 0, 0]);
    let said = decode(Path::new("a.tif"), &bytes, &Budget::default()).err().unwrap().to_string();
    assert!(said.starts_with("a.tif: cannot be read: its ZSTD data is damaged"), "{said}");
}
