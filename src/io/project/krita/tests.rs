//! Krita's files, made by hand.

use super::super::packer::ZipPacker;
use super::super::read;
use super::*;
use crate::Budget;
use std::path::Path;

const MAIN: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<DOC xmlns="http://www.calligra.org/DTD/krita" editor="Krita"><IMAGE width="70" height="20" name="a: b"
 colorspacename="RGBA" profile="sRGB-elle-V2-srgbtrc.icc"><layers>
 <layer name="over" nodetype="paintlayer" filename="layer4" colorspacename="RGBA" opacity="255" visible="1"
  compositeop="normal" channelflags="1110" x="0" y="0"/>
 <layer name="curves" nodetype="adjustmentlayer" filename="layer5" visible="1"/>
 <layer name="set" nodetype="grouplayer" filename="layer2" opacity="128" visible="1" compositeop="multiply">
  <layers><layer name="deep" nodetype="paintlayer" filename="layer3" colorspacename="RGBA16" opacity="255"
   visible="0" compositeop="linear_dodge" x="3" y="1" profile="sRGB-elle-V2-srgbtrc.icc">
   <masks><mask name="m" nodetype="transparencymask" filename="mask1" visible="1"/></masks></layer></layers>
 </layer>
 <layer name="paper" nodetype="paintlayer" filename="layer1" colorspacename="RGBA" compositeop="odd"/>
</layers></IMAGE></DOC>"#;

/// Tiles of one pixel value each.
fn tiles(pixel: &[u8], places: &[(i32, i32)], is_packed: bool) -> Vec<u8> {
    let size = pixel.len();
    let mut out = format!(
        "VERSION 2\nTILEWIDTH 64\nTILEHEIGHT 64\nPIXELSIZE {size}\nDATA {}\n",
        places.len()
    )
    .into_bytes();
    let mut data = vec![u8::from(is_packed)];
    for &byte in pixel {
        match is_packed {
            // The byte, then copies of 264 bytes each from the one before.
            true => {
                data.extend([0, byte]);
                data.extend([7 << 5, 255, 0].repeat(15));
                data.extend([7 << 5, (4095 - 15 * 264 - 9) as u8, 0]);
            }
            false => data.extend([byte; 4096]),
        }
    }
    for (x, y) in places {
        out.extend(format!("{x},{y},LZF,{}\n", data.len()).into_bytes());
        out.extend(&data);
    }
    out
}

fn kra() -> Vec<u8> {
    let mut packer = ZipPacker::default();
    packer.store("mimetype", b"application/x-krita").unwrap();
    packer.deflate(MAINDOC, MAIN.as_bytes()).unwrap();
    let pixels16 = [0, 0x10, 0, 0x20, 0, 0x30, 255, 255];
    let entries = [
        ("layer1.defaultpixel", vec![30, 20, 10, 255]),
        ("layer1", tiles(&[3, 2, 1, 255], &[(64, 0)], false)),
        ("layer3", tiles(&pixels16, &[(0, 0)], true)),
        ("layer3.defaultpixel", vec![0; 8]),
        ("layer4", tiles(&[50, 100, 200, 128], &[(-64, 0), (0, 0)], true)),
        ("mask1.pixelselection", tiles(&[40], &[(0, 0)], false)),
        ("mask1.pixelselection.defaultpixel", vec![255]),
    ];
    for (name, bytes) in entries {
        packer.deflate(&format!("a: b/layers/{name}"), &bytes).unwrap();
    }
    packer.finish().unwrap()
}

#[test]
fn layers_groups_masks_and_modes_come_back_and_what_is_lost_is_named() {
    let read = read(Path::new("a.kra"), &kra(), &Budget::default()).unwrap();
    assert_eq!((read.document.size, read.is_whole), (Size::new(70, 20), false));
    let notes = read.notes.join("\n");
    assert!(
        notes.contains("“curves” is a filter layer") && notes.contains("“paper” is blended by")
    );
    let [base, over] = &read.document.layers[..] else {
        panic!("a base and what is clipped to it")
    };
    assert!(over.clip_below && over.name == "over");
    let Content::Group(base) = &base.content else { panic!("what lies beneath, as one") };
    let [paper, set] = &base.layers[..] else { panic!("two layers") };
    let pixel = |layer: &Layer, x: i32, y: i32| -> [u8; 4] {
        let Content::Pixels(pixels) = &layer.content else { panic!("pixels") };
        let straight = pixels.tiles.to_straight_rgba(crate::math::Rect::new(x, y, x + 1, y + 1));
        straight[..].try_into().unwrap()
    };
    assert_eq!([pixel(paper, 0, 0), pixel(paper, 66, 5)], [[10, 20, 30, 255], [1, 2, 3, 255]]);
    assert_eq!(pixel(over, 3, 3), [199, 100, 50, 128]);
    assert_eq!((set.blend, (set.opacity * 255.0).round()), (BlendMode::Multiply, 128.0));
    let Content::Group(set) = &set.content else { panic!("a group") };
    let pixels16 = &set.layers[0];
    assert!(!pixels16.visible && pixels16.blend == BlendMode::LinearDodge);
    assert_eq!([pixel(pixels16, 2, 1), pixel(pixels16, 3, 1)], [[0; 4], [48, 32, 16, 255]]);
    let Some(LayerMask { kind: MaskKind::File { coverage, .. }, .. }) = &pixels16.mask else {
        panic!("a mask")
    };
    assert_eq!([coverage.at(0, 0), coverage.at(66, 3)], [40, 255]);
}

#[test]
fn an_image_in_display_p3_keeps_its_numbers_and_converts_layers_of_other_profiles() {
    use crate::icc_profiles::icc_of;
    use crate::math::ColorProfile;
    let node = |name: &str, profile: &str| {
        format!(
            r#"<layer name="{name}" nodetype="paintlayer" filename="{name}" colorspacename="RGBA"
                profile="{profile}"/>"#
        )
    };
    let main = format!(
        r#"<DOC><IMAGE width="64" height="64"><layers>{}{}{}</layers></IMAGE></DOC>"#,
        node("other", "Wide"),
        node("srgb", "sRGB-elle-V2-srgbtrc.icc"),
        node("own", "Display P3")
    );
    let p3 = icc_of(ColorProfile::DisplayP3);
    let wide = moxcms::ColorProfile::new_adobe_rgb().encode().unwrap();
    let red = tiles(&[0, 0, 255, 255], &[(0, 0)], false);
    let mut packer = ZipPacker::default();
    packer.store("mimetype", b"application/x-krita").unwrap();
    packer.deflate(MAINDOC, main.as_bytes()).unwrap();
    let entries =
        [("own.icc", p3), ("srgb.icc", icc_of(ColorProfile::Srgb)), ("other.icc", &wide[..])];
    for (name, bytes) in entries {
        packer.deflate(&format!("a/layers/{name}"), bytes).unwrap();
        packer.deflate(&format!("a/layers/{}", name.replace(".icc", "")), &red).unwrap();
    }
    packer.deflate("a/annotations/icc", p3).unwrap();
    let read = read(Path::new("a.kra"), &packer.finish().unwrap(), &Budget::default()).unwrap();
    assert_eq!((read.document.profile, read.is_whole), (ColorProfile::DisplayP3, true));
    let pixel = |layer: &Arc<Layer>| {
        let Content::Pixels(pixels) = &layer.content else { panic!("pixels") };
        pixels.tiles.pixel(5, 5)
    };
    let [own, srgb, other] = &read.document.layers[..] else { panic!("three layers") };
    assert_eq!([pixel(own), pixel(srgb)], [[255, 0, 0, 255], [234, 51, 35, 255]]);
    // Through sRGB, whose own red is the nearest to that of Adobe RGB.
    assert_eq!(pixel(other), pixel(srgb));
}

#[test]
fn a_cut_file_is_read_or_gets_a_sentence() {
    let bytes = kra();
    for length in (100..bytes.len()).step_by(61) {
        let _ = read(Path::new("a.kra"), &bytes[..length], &Budget::default());
    }
}

#[test]
fn a_procreate_drawing_shows_the_picture_it_holds_of_itself() {
    let mut png = std::io::Cursor::new(Vec::new());
    image::RgbImage::new(3, 2).write_to(&mut png, image::ImageFormat::Png).unwrap();
    let mut packer = ZipPacker::default();
    packer.store("Document.archive", b"bplist00").unwrap();
    packer.store("QuickLook/Thumbnail.png", &png.into_inner()).unwrap();
    let read = read(Path::new("a.procreate"), &packer.finish().unwrap(), &Budget::default());
    let read = read.unwrap();
    assert_eq!((read.document.size, read.is_whole), (Size::new(3, 2), false));
    assert!(read.notes[0].contains("a Procreate drawing"), "{:?}", read.notes);
}
