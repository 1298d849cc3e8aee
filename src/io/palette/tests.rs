use super::*;
use crate::math::hash::mix;
use crate::math::srgb::Color;
use crate::paint::NamedColor;
use crate::project::packer::ZipPacker;

fn read_bytes(bytes: &[u8]) -> Result<ImportedPalette> {
    read(Path::new("sky.xyz"), bytes, &Budget::default())
}

/// The colors with their names, `#rrggbb name`.
fn color_texts(palette: &ColorPalette) -> Vec<String> {
    let one = |named: &NamedColor| format!("{} {}", named.color, named.name).trim().to_owned();
    palette.colors.iter().map(one).collect()
}

fn words(words: &[u16]) -> Vec<u8> {
    words.iter().flat_map(|word| word.to_be_bytes()).collect()
}

/// Names with signs that XML, text and UTF-16 treat differently.
fn sky() -> ColorPalette {
    let named = |hex, name| NamedColor::new(Color::parse(hex).unwrap(), name);
    ColorPalette {
        name: "Sky & sea <1>".into(),
        columns: 2,
        colors: vec![
            named("#102a43", "night"),
            named("#e8c39e", "Dünen “𝄞” & sand"),
            named("#ffffff", ""),
        ],
    }
}

#[test]
fn every_format_gives_back_what_it_can_hold_and_is_known_by_its_content() {
    let palette = sky();
    for (format, name) in PaletteFormat::ALL {
        let bytes = write(Path::new("sky.out"), &palette, format).unwrap();
        assert_eq!(PaletteFormat::of_content(&bytes), Some(format), "{name}");
        let ImportedPalette { palette: read, notes } = read_bytes(&bytes).unwrap();
        assert_eq!(notes, [""; 0], "{name}");
        let colors: Vec<Color> = read.colors.iter().map(|named| named.color).collect();
        assert_eq!(colors, [0x102a43, 0xe8c39e, 0xffffff].map(of_hex), "{name}");
        let has_names = !matches!(
            format,
            PaletteFormat::ColorTable | PaletteFormat::PaintShop | PaletteFormat::Windows
        );
        assert_eq!(read.colors == palette.colors, has_names, "{name}");
        let has_columns = matches!(format, PaletteFormat::Gimp | PaletteFormat::KritaPalette);
        assert_eq!(read == palette, has_columns, "{name}");
    }
}

fn of_hex(hex: u32) -> Color {
    let [_, r, g, b] = hex.to_be_bytes();
    Color::rgb(r, g, b)
}

#[test]
fn the_ending_says_how_a_palette_is_written() {
    let format = |name: &str| PaletteFormat::of_extension(Path::new(name)).map(|f| f.name());
    assert_eq!(format("a/b.KPL"), Some("kpl"));
    assert_eq!(format("b.pal"), Some("jasc"));
    assert_eq!((format("b"), format("b.png")), (None, None));
    for (format, _) in PaletteFormat::ALL {
        assert!(PaletteFormat::EXTENSIONS.contains(&format.extension()));
    }
}

#[test]
fn a_gimp_palette_may_lack_names_and_columns_and_has_comments() {
    let text = b"GIMP Palette\r\n#Palette Name: Old\r\n# 3 4 5\r\n\r\n255   0\t9 Red, deep \r\n0 0 7\tUntitled\n1 2 3";
    let ImportedPalette { palette, .. } = read_bytes(text).unwrap();
    assert_eq!((palette.name.as_str(), palette.columns), ("Old", 0));
    assert_eq!(color_texts(&palette), ["#ff0009 Red, deep", "#000007", "#010203"]);
    let text = b"GIMP Palette\nChannels: RGBA\nColumns: 9999\n1 2 3 255 a\n";
    let ImportedPalette { palette, .. } = read_bytes(text).unwrap();
    assert_eq!((palette.name.as_str(), palette.columns), ("sky", 0), "named as the file");
    let said = read_bytes(b"GIMP Palette\n1 2\n").unwrap_err().to_string();
    assert_eq!(said, "sky.xyz: cannot be read: line 2: is not three numbers up to 255");
    let latin = b"GIMP Palette\nName: \xe9t\xe9\n1 2 3\n";
    assert_eq!(read_bytes(latin).unwrap().palette.name, "été");
}

#[test]
fn swatches_of_all_spaces_become_srgb_and_what_is_not_exact_is_noted() {
    // RGB, HSB, CMYK, Lab, gray, wide CMYK, and a color book's.
    let colors = [
        [0, 0xffff, 0x8080, 0, 0],
        [1, 0x5555, 0xffff, 0xffff, 0],
        [2, 0, 0xffff, 0xffff, 0x8000],
        [7, 10_000, 0, 0, 0],
        [7, 5_000, -10_000i16 as u16, 0, 0],
        [8, 5_000, 0, 0, 0],
        [9, 0, 10_000, 0, 0],
        [4, 1, 2, 3, 4],
    ];
    let bytes = [words(&[1, 8]), colors.map(|color| words(&color)).concat()].concat();
    let ImportedPalette { palette, notes } = read_bytes(&bytes).unwrap();
    assert_eq!(
        color_texts(&palette),
        ["#ff8000", "#00ff00", "#008080", "#ffffff", "#009774", "#808080", "#ff00ff"]
    );
    assert_eq!(
        notes,
        [
            "2 colors are mixes of inks (CMYK), which are approximate here: as an ideal press prints",
            "One color lies beyond sRGB, and became the nearest there",
            "One color is of an unknown kind and left out",
        ]
    );
}

#[test]
fn the_second_list_of_photoshops_swatches_has_the_names() {
    let first = words(&[1, 1, 0, 0x1111, 0x2222, 0x3333, 0]);
    let second = words(&[2, 1, 0, 0x1111, 0x2222, 0x3333, 0, 0, 3, 0xe4, 0x42, 0]);
    let named = read_bytes(&[first.clone(), second.clone()].concat()).unwrap().palette;
    assert_eq!(color_texts(&named), ["#112233 äB"]);
    assert_eq!(color_texts(&read_bytes(&second).unwrap().palette), ["#112233 äB"], "alone");
    assert_eq!(color_texts(&read_bytes(&first).unwrap().palette), ["#112233"]);
    let cut = [first, second[..second.len() - 2].to_vec()].concat();
    let said = read_bytes(&cut).unwrap_err().to_string();
    assert_eq!(said, "sky.xyz: cannot be read: the swatches are cut short");
}

#[test]
fn a_color_table_has_256_colors_or_says_how_many() {
    let mut table = vec![7; 768];
    assert_eq!(read_bytes(&table).unwrap().palette.colors.len(), 256);
    table.extend([0, 3, 0xff, 0xff]);
    assert_eq!(color_texts(&read_bytes(&table).unwrap().palette), ["#070707"; 3]);
    let many = ColorPalette::of_colors("", &[Color::BLACK; 257]);
    let said = write(Path::new("a.act"), &many, PaletteFormat::ColorTable).unwrap_err();
    let expected = "a.act: not supported: a color table holds 256 colors, and the palette has 257";
    assert_eq!(said.to_string(), expected);
}

/// A block of Adobe's swatch exchange.
fn exchange_color(name: &str, space: &[u8; 4], values: &[f32]) -> Vec<u8> {
    let units: Vec<u16> = name.encode_utf16().chain([0]).collect();
    let mut content = words(&[units.len() as u16]);
    content.extend(words(&units));
    content.extend(space);
    content.extend(values.iter().flat_map(|value| value.to_be_bytes()));
    content.extend([0, 2]);
    let length = (content.len() as u32).to_be_bytes();
    [words(&[1]), length.to_vec(), content].concat()
}

#[test]
fn adobes_exchange_is_read_block_by_block_whatever_else_there_is() {
    let blocks = [
        [words(&[0xc001, 0, 6, 2]), words(&[0x41, 0])].concat(),
        exchange_color("rot", b"RGB ", &[1.0, 0.5, 0.0]),
        words(&[0x7777, 0, 2, 9]),
        exchange_color("ink", b"CMYK", &[0.0, 1.0, 1.0, 0.0]),
        words(&[0xc002, 0, 0]),
        exchange_color("", b"LAB ", &[1.0, 0.0, 0.0]),
        exchange_color("mid", b"Gray", &[0.5]),
        exchange_color("?", b"HSL ", &[0.5]),
    ];
    let head = [b"ASEF".to_vec(), words(&[1, 0, 0, blocks.len() as u16])].concat();
    let bytes = [head, blocks.concat()].concat();
    let ImportedPalette { palette, notes } = read_bytes(&bytes).unwrap();
    assert_eq!(palette.name, "A");
    assert_eq!(color_texts(&palette), ["#ff8000 rot", "#ff0000 ink", "#ffffff", "#808080 mid"]);
    assert_eq!(notes.len(), 2, "{notes:?}");
    let nameless = [b"ASEF".to_vec(), words(&[1, 0, 0, 1, 0xc001, 0, 0])].concat();
    assert_eq!(read_bytes(&nameless).unwrap().palette.name, "sky");
    let newer = [b"ASEF".to_vec(), words(&[2, 0, 0, 0])].concat();
    let said = read_bytes(&newer).unwrap_err().to_string();
    assert!(said.contains("version 2"), "{said}");
}

#[test]
fn both_files_that_end_in_pal_are_read() {
    let text = b"JASC-PAL\r\n0100\r\n2\r\n1 2 3\r\n255 0 9 128\r\n4 5 6\r\n";
    assert_eq!(color_texts(&read_bytes(text).unwrap().palette), ["#010203", "#ff0009"]);
    let said = read_bytes(b"JASC-PAL\n0100\n3\n1 2 3\n").unwrap_err().to_string();
    assert_eq!(said, "sky.xyz: cannot be read: it has 1 colors; it should have 3");
    // A chunk of an odd length before the colors.
    let riff =
        b"RIFF\x22\0\0\0PAL offl\x01\0\0\0x\0data\x0c\0\0\0\0\x03\x02\0\x01\x02\x03\0\xff\0\x09\0";
    assert_eq!(color_texts(&read_bytes(riff).unwrap().palette), ["#010203", "#ff0009"]);
    let said = read_bytes(&riff[..40]).unwrap_err().to_string();
    assert_eq!(said, "sky.xyz: cannot be read: its colors are cut short");
}

/// A palette of Krita with this list.
fn krita(list: &str) -> Vec<u8> {
    let mut packer = ZipPacker::default();
    packer.store("mimetype", b"application/x-krita-palette").unwrap();
    packer.deflate("colorset.xml", list.as_bytes()).unwrap();
    packer.finish().unwrap()
}

#[test]
fn kritas_colors_stand_where_their_places_say_and_are_of_many_spaces() {
    let list = r#"<?xml version="1.0"?>
        <!DOCTYPE Colorset>
        <Colorset version="1.0" name="N" columns="2">
          <ColorSetEntry name="third" bitdepth="U8"><RGB r="0" g="0" b="1" space="sRGB-elle-V2-srgbtrc.icc"/>
            <Position row="1" column="0"/></ColorSetEntry>
          <ColorSetEntry name="first"><sRGB r="1" g="0" b="0"/><Position row="0" column="0"/></ColorSetEntry>
          <ColorSetEntry name="second"><RGB space="sRGB-elle-V2-g10.icc" r="0.2158605" g="0" b="0"/>
            <Position row="0" column="1"/></ColorSetEntry>
          <Group name="g" rows="1">
            <ColorSetEntry name="gray"><Gray space="x" g="0.5"/><Position row="0" column="1"/></ColorSetEntry>
            <ColorSetEntry name="a&amp;b"><Lab space="y" L="100" a="0" b="0"/><Position row="0" column="0"/>
            </ColorSetEntry>
            <ColorSetEntry name="z"><XYZ x="1" y="1" z="1"/><Position row="2" column="0"/></ColorSetEntry>
            <ColorSetEntry name="w"><RGB space="Wide" r="1" g="1" b="0"/><Position row="3" column="0"/></ColorSetEntry>
          </Group>
        </Colorset>"#;
    let ImportedPalette { palette, notes } = read_bytes(&krita(list)).unwrap();
    assert_eq!((palette.name.as_str(), palette.columns), ("N", 2));
    assert_eq!(
        color_texts(&palette),
        [
            "#ff0000 first",
            "#800000 second",
            "#0000ff third",
            "#ffffff a&b",
            "#808080 gray",
            "#ffff00 w"
        ]
    );
    assert_eq!(notes.len(), 2, "{notes:?}");
    let said = read_bytes(&krita("<x/>")).unwrap_err().to_string();
    assert_eq!(said, "sky.xyz: cannot be read: colorset.xml lists no colors");
    let mut other = ZipPacker::default();
    other.store("a", b"b").unwrap();
    let said = read_bytes(&other.finish().unwrap()).unwrap_err().to_string();
    assert_eq!(said, "sky.xyz: cannot be read: it is a zip, but no palette of Krita");
}

#[test]
fn what_is_no_palette_is_refused_and_so_are_too_many_colors() {
    for bytes in [&b""[..], b"\x89PNG\r\n", &[0, 1, 0, 9, 0]] {
        let said = read_bytes(bytes).unwrap_err().to_string();
        assert!(said.contains("no palette of GIMP"), "{said}");
    }
    let many = format!("GIMP Palette\n{}", "1 2 3\n".repeat(ColorPalette::MOST + 1));
    let said = read_bytes(many.as_bytes()).unwrap_err().to_string();
    assert_eq!(said, "sky.xyz: too large: a palette may have 10000 colors");
}

/// Flips, cuts, repeats and overwrites parts of every format: no panic, and every refusal names
/// the file.
#[test]
fn damaged_palettes_are_refused_in_a_sentence_or_read() {
    let mut seed = 0u32;
    let mut roll = |below: usize| {
        seed = mix(seed.wrapping_add(0x9e37));
        seed as usize % below.max(1)
    };
    let mut refused = 0;
    for (format, _) in PaletteFormat::ALL {
        let whole = write(Path::new("sky.out"), &sky(), format).unwrap();
        for _ in 0..2000 {
            let mut bytes = whole.clone();
            for _ in 0..1 + roll(3) {
                let at = roll(bytes.len());
                let end = (at + 1 + roll(8)).min(bytes.len());
                match roll(6) {
                    0 => bytes[at] ^= 1 << roll(8),
                    1 => bytes[at] = [0, 0xff, 0x7f, 0x80][roll(4)],
                    2 => bytes[at..end].fill(0xff),
                    3 => drop(bytes.drain(at..end)),
                    4 => {
                        let again = bytes[at..end].to_vec();
                        bytes.splice(at..at, again);
                    }
                    _ => bytes.truncate(at.max(1)),
                }
                if bytes.is_empty() {
                    bytes.push(0);
                }
            }
            match read_bytes(&bytes) {
                Ok(read) => assert_eq!(read.palette.fits(), Ok(())),
                Err(error) => {
                    refused += 1;
                    assert!(error.to_string().starts_with("sky.xyz"), "{error}");
                }
            }
        }
    }
    assert!(refused > 2000, "{refused}");
}

/// Palettes that other programs wrote, in the folder that `PALETTES` names.
#[test]
#[ignore = "needs files of others"]
fn files_of_others_are_read() {
    let Some(folder) = std::env::var_os("PALETTES") else { return };
    let mut files: Vec<_> =
        std::fs::read_dir(folder).unwrap().flatten().map(|f| f.path()).collect();
    files.sort();
    for file in files {
        match read(&file, &std::fs::read(&file).unwrap(), &Budget::default()) {
            Ok(ImportedPalette { palette, notes }) => {
                let texts = color_texts(&palette);
                let (count, some) = (texts.len(), &texts[..texts.len().min(4)]);
                println!("{}: “{}” {count} {some:?} {notes:?}", file.display(), palette.name);
            }
            Err(error) => println!("{error}"),
        }
    }
}
