//! Projects that other programs wrote: how much of them is read at all.

use super::*;

/// A project without our entries: layers that show pictures, bottom last.
fn foreign(size: Size, layers: &[&str], pictures: &[(&str, Vec<u8>)]) -> Vec<u8> {
    let layers: String = layers.iter().map(|src| format!("<layer name=\"{src}\" src=\"data/{src}\"/>")).collect();
    let (w, h) = (size.width, size.height);
    let stack = format!("<image w=\"{w}\" h=\"{h}\"><stack>{layers}</stack></image>");
    let mut entries = vec![(MIMETYPE.into(), MIME.into()), (STACK.into(), stack.into_bytes())];
    entries.extend(pictures.iter().map(|(name, bytes)| (format!("data/{name}"), bytes.clone())));
    packed(&entries)
}
fn picture(size: Size) -> Vec<u8> {
    let texels = vec![[9, 90, 200, 255]; size.area()];
    pixels::encode_texels(Path::new("p.png"), &texels, size).unwrap().bytes().to_vec()
}

#[test]
fn pictures_are_counted_by_their_headers_before_the_first_is_decoded() {
    let size = Size::new(70, 50);
    // Whoever decodes these calls them damaged, and opens the rest.
    let begun: Vec<u8> = picture(size)[..40].into();
    let bytes = foreign(size, &["a.png", "b.png", "a.png"], &[("a.png", begun.clone()), ("b.png", begun)]);
    let of = |document_px| read(Path::new("a.ora"), &bytes, &Budget { document_px, ..Budget::default() });
    assert!(!of(3 * 3500).unwrap().is_whole);
    let said = of(3 * 3500 - 1).err().unwrap().to_string();
    assert!(said.contains("its layers hold more than 10499 pixels together"), "{said}");
}
#[test]
fn layers_that_show_one_picture_share_its_tiles() {
    let size = Size::new(70, 50);
    let bytes = foreign(size, &["a.png", "b.png", "a.png"], &[("a.png", picture(size)), ("b.png", picture(size))]);
    let back = read_back(&bytes);
    let tiles = |i: usize| match &back.document.layers[i].content {
        Content::Pixels(pixels) => pixels.tiles.iter().map(|(_, tile)| tile.clone()).collect::<Vec<_>>(),
        _ => panic!("pixels"),
    };
    let shared = |i: usize, j: usize| tiles(i).iter().zip(&tiles(j)).all(|(a, b)| Arc::ptr_eq(a, b));
    assert_eq!((tiles(0).len(), shared(0, 2), shared(0, 1)), (2, true, false));
}
