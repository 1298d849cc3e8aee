//! Names the kinds of files that are not read, by their first bytes or their name, and what to do
//! about it. Floor 5. Not here: what is read (`bitmap`).

use std::path::Path;

const AS_PICTURE: &str = "save it as PNG or JPEG";
const AS_LAYERS: &str = "save it as PSD or OpenRaster, or as PNG";
const RAW: (&str, &str) = ("a raw photo of a camera", "develop it and save it as TIFF or JPEG");

/// Kinds of files by the bytes at a place.
const SIGNATURES: [(usize, &[u8], &str, &str); 55] = [
    (4, b"ftypavif", "an AVIF picture", AS_PICTURE),
    (4, b"ftypavis", "an AVIF picture", AS_PICTURE),
    (4, b"ftyphei", "a HEIC picture", AS_PICTURE),
    (4, b"ftyphev", "a HEIC picture", AS_PICTURE),
    (4, b"ftypmif1", "a HEIC picture", AS_PICTURE),
    (4, b"ftypmsf1", "a HEIC picture", AS_PICTURE),
    (4, b"ftypcrx", RAW.0, RAW.1),
    (4, b"ftyp", "a film", "save one of its pictures as PNG or JPEG"),
    (0, b"\x1aE\xdf\xa3", "a film", "save one of its pictures as PNG or JPEG"),
    (4, b"JXL \r\n\x87\n", "a JPEG XL picture", AS_PICTURE),
    (0, b"\xff\x0a", "a JPEG XL picture", AS_PICTURE),
    (4, b"jP  \r\n\x87\n", "a JPEG 2000 picture", AS_PICTURE),
    (0, b"\xff\x4f\xff\x51", "a JPEG 2000 picture", AS_PICTURE),
    (0, b"II\xbc", "a JPEG XR picture", AS_PICTURE),
    (8, b"CR\x02", RAW.0, RAW.1),
    (0, b"IIRO", RAW.0, RAW.1),
    (0, b"IIRS", RAW.0, RAW.1),
    (0, b"MMOR", RAW.0, RAW.1),
    (0, b"IIU\0", RAW.0, RAW.1),
    (0, b"FUJIFILMCCD-RAW", RAW.0, RAW.1),
    (0, b"FOVb", RAW.0, RAW.1),
    (0, b"\0MRM", RAW.0, RAW.1),
    (0, b"gimp xcf", "a GIMP drawing", "save it as PSD or OpenRaster in GIMP"),
    (0, b"\0\xffKA", "a drawing of Affinity", "export it as PSD or PNG"),
    (0, b"CSFCHUNK", "a Clip Studio drawing", "open it, or save it as PSD or PNG"),
    (4, b"\xe0\xa5", "an Aseprite drawing", "open it, or save it as PNG"),
    (0, b"SAI-CANVAS", "a drawing of SAI", "save it as PSD in SAI"),
    (0, b"mdipack", "a drawing of MediBang or FireAlpaca", "save it as PSD or PNG"),
    (0, b"PDN3", "a drawing of Paint.NET", AS_LAYERS),
    (0, b"Paint Shop Pro Image File", "a drawing of PaintShop Pro", AS_LAYERS),
    (0, b"8BGR", "a gradient of Photoshop", "open pictures, PSD or OpenRaster files"),
    (0, b"%PDF", "a PDF document", AS_PICTURE),
    (0, b"%!PS", "a PostScript drawing", AS_PICTURE),
    (0, b"\xc5\xd0\xd3\xc6", "a PostScript drawing", AS_PICTURE),
    (0, b"<svg", "an SVG drawing", AS_PICTURE),
    (0, b"BLENDER", "a Blender scene", "render it and save its normals and its picture as EXR"),
    (0, b"glTF", "a glTF scene", "render it and save its normals and its picture as EXR"),
    (0, b"\0\0\x01\0", "an icon", AS_PICTURE),
    (0, b"\0\0\x02\0", "a mouse pointer", AS_PICTURE),
    (0, b"icns", "an icon", AS_PICTURE),
    (0, b"DDS ", "a DDS texture", AS_PICTURE),
    (0, b"\xabKTX", "a KTX texture", AS_PICTURE),
    (0, b"DXT1", "a compressed texture", AS_PICTURE),
    (0, b"\x0a\x05\x01", "a PCX picture", AS_PICTURE),
    (0, b"\x01\xda", "an SGI picture", AS_PICTURE),
    (0, b"SIMPLE  =", "a FITS picture", AS_PICTURE),
    (0, b"farbfeld", "a farbfeld picture", AS_PICTURE),
    (0, b"BPG\xfb", "a BPG picture", AS_PICTURE),
    (0, b"SDPX", "a DPX picture", AS_PICTURE),
    (0, b"XPDS", "a DPX picture", AS_PICTURE),
    (0, b"\xd7\xcd\xc6\x9a", "a Windows metafile", AS_PICTURE),
    (40, b" EMF", "a Windows metafile", AS_PICTURE),
    (0, b"\x1f\x8b", "packed with gzip", "unpack it first"),
    (0, b"7z\xbc\xaf\x27", "a 7z archive", "unpack it first"),
    (0, b"Rar!", "a RAR archive", "unpack it first"),
];

/// Kinds of files by the end of their name, where other readable files begin alike.
const ENDINGS: [(&[&str], &str, &str); 8] = [
    (&["dng", "nef", "nrw", "arw", "sr2", "srf", "pef", "srw", "3fr", "iiq", "erf"], RAW.0, RAW.1),
    (&["rw2", "orf", "raf", "cr2", "cr3", "crw", "x3f", "mrw", "kdc", "dcr"], RAW.0, RAW.1),
    (&["ai"], "a drawing of Illustrator", AS_PICTURE),
    (&["svgz"], "an SVG drawing", AS_PICTURE),
    (&["sai"], "a drawing of SAI", "save it as PSD in SAI"),
    (&["afphoto", "afdesign", "af"], "a drawing of Affinity", "export it as PSD or PNG"),
    (&["pcd"], "a Photo CD picture", AS_PICTURE),
    (&["pict", "pct"], "a PICT picture", AS_PICTURE),
];

/// What a file is that is not read, and what to do about it: “a HEIC picture; save it as PNG or
/// JPEG”. `None` where it is not known.
pub fn reason(file: &Path, bytes: &[u8]) -> Option<String> {
    let said = |(what, advice): (&str, &str)| Some(format!("{what}; {advice}"));
    let ending = file.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    let by_name = ENDINGS.iter().find(|(endings, ..)| endings.contains(&&*ending));
    // A picture under a wrong name is read.
    if let Some((_, what, advice)) = by_name
        && !has_a_plain_signature(bytes)
    {
        return said((*what, *advice));
    }
    // Files of the HEIF family list what they are compatible with.
    let brands = bytes.get(4..64.min(bytes.len())).filter(|b| b.starts_with(b"ftyp"));
    if brands.is_some_and(|brands| brands.windows(4).any(|brand| brand == b"avif")) {
        return said(("an AVIF picture", AS_PICTURE));
    }
    let is_here =
        |at: usize, signature: &[u8]| bytes.get(at..).is_some_and(|b| b.starts_with(signature));
    if let Some((.., what, advice)) = SIGNATURES.iter().find(|row| is_here(row.0, row.1)) {
        return said((*what, *advice));
    }
    let text = &bytes[..bytes.len().min(2048)];
    let text = text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(text).trim_ascii_start();
    if text.starts_with(b"<") {
        let has = |word: &[u8]| text.windows(word.len()).any(|part| part == word);
        return match has(b"<svg") {
            true => said(("an SVG drawing", AS_PICTURE)),
            false if has(b"<html") || has(b"<!DOCTYPE html") || has(b"<!doctype html") => {
                said(("a web page, not a picture", "save the picture that it shows"))
            }
            false => said(("a text file, not a picture", "open pictures, PSD or OpenRaster files")),
        };
    }
    None
}

/// Whether a file begins like one of the common formats that no raw photo begins like.
fn has_a_plain_signature(bytes: &[u8]) -> bool {
    let common: [&[u8]; 5] = [b"\x89PNG", b"\xff\xd8\xff", b"RIFF", b"BM", b"GIF8"];
    common.iter().any(|signature| bytes.starts_with(signature))
}

#[cfg(test)]
mod tests {
    use crate::{Budget, bitmap};
    use std::path::Path;

    #[test]
    fn what_is_not_read_is_named() {
        let cases: [(&str, &[u8], &str); 12] = [
            ("a.heic", b"\0\0\0\x18ftypheic\0\0\0\0mif1heic", "a HEIC picture; save it as PNG"),
            ("a.avif", b"\0\0\0\x18ftypmif1\0\0\0\0mif1avif", "an AVIF picture; save it as PNG"),
            ("a.jxl", b"\xff\x0a\x01\x02\x03\x04\x05\x06\x07\x08", "a JPEG XL picture"),
            ("a.svg", b"<?xml version=\"1.0\"?>\n<svg width=\"3\">", "an SVG drawing"),
            ("a.pdf", b"%PDF-1.7 and so on", "a PDF document"),
            ("a.ai", b"%PDF-1.5 and so on", "a drawing of Illustrator"),
            ("a.xcf", b"gimp xcf v011\0\0\0\0", "a GIMP drawing; save it as PSD or OpenRaster"),
            ("a.cr2", b"II*\0\x10\0\0\0CR\x02\0\0\0\0\0", "a raw photo of a camera; develop it"),
            ("a.nef", b"MM\0*\0\0\0\x08\0\0\0\0\0\0\0\0", "a raw photo of a camera"),
            ("a.afphoto", b"\0\xffKA\x0a\0\0\0nsrP", "a drawing of Affinity; export it as PSD"),
            ("a.sai2", b"SAI-CANVAS-TYPE0", "a drawing of SAI"),
            ("a.png", b"<!DOCTYPE html><html><head>", "a web page, not a picture"),
        ];
        for (name, bytes, part) in cases {
            let said = bitmap::decode(Path::new(name), bytes, &Budget::default()).err();
            let said = said.map(|error| error.to_string()).unwrap_or_default();
            let wanted = format!("{name}: not supported: {part}");
            assert!(said.starts_with(&wanted), "{said}");
        }
    }

    #[test]
    fn a_picture_under_another_name_is_still_read() {
        let mut png = std::io::Cursor::new(Vec::new());
        image::RgbImage::new(3, 2).write_to(&mut png, image::ImageFormat::Png).unwrap();
        let read = bitmap::decode(Path::new("a.dng"), &png.into_inner(), &Budget::default());
        assert_eq!(read.ok().map(|bitmap| bitmap.format), Some("PNG"));
    }
}
