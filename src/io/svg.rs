//! SVG drawings as pictures. Floor 5. Not here: SVG files that are written.
//!
//! What an SVG shows depends on the fonts of the machine until its text has become outlines, so
//! that is what a picture keeps as its file. Nothing outside of the file is read, and no script
//! runs.

#![warn(missing_docs)]

use super::{Budget, pixels::Painted};
use crate::math::{Size, Vec2, vec2};
use crate::raster::{self, Asset, Picture, TileGrid};
use crate::{Error, Result};
use image::ImageReader;
use resvg::usvg::fontdb::{Database, Family, Query};
use resvg::usvg::{ImageHrefResolver, Options, Transform, Tree, WriteOptions};
use resvg::{tiny_skia::Pixmap, usvg};
use std::io::Cursor;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::{Arc, OnceLock};

/// The least longer side of an SVG that is an image layer, px: it has no pixels of its own, and is
/// seen from near.
const LAYER_PX: f32 = 2048.0;

/// How much larger than its own size it is at most for that.
const MOST_ENLARGED: f32 = 64.0;

/// Whether a file is an SVG drawing, by its first element.
pub fn is_svg(bytes: &[u8]) -> bool {
    let start = &bytes[..bytes.len().min(4096)];
    let text = String::from_utf8_lossy(start.strip_prefix(b"\xef\xbb\xbf").unwrap_or(start));
    let mut rest = text.trim_start();
    // Before the first element stand a declaration, comments and a document type.
    while rest.starts_with("<?") || rest.starts_with("<!") {
        let end = if rest.starts_with("<!--") { "-->" } else { ">" };
        match rest.find(end) {
            Some(at) => {
                rest = rest[at + end.len()..].trim_start_matches(['\n', '\r', ' ', ']', '>', '\t'])
            }
            None => return text.contains("<svg"),
        }
    }
    rest.starts_with("<svg") || rest.starts_with("<svg:svg")
}

/// Decodes an SVG for an image layer, at a resolution of at least 2048 pixels along its longer
/// side. The picture's file is the same SVG with its text as outlines.
pub fn decode(file: &Path, bytes: &[u8], budget: &Budget) -> Result<Picture> {
    let drawing = Drawing::parse(file, bytes, budget)?;
    let longer = drawing.tree.size().width().max(drawing.tree.size().height());
    let most = budget.side_px.min(8192) as f32;
    let scale = longer.max(LAYER_PX.min(MOST_ENLARGED * longer)).min(most) / longer;
    let (size, texels) = drawing.render(file, scale, budget)?;
    let texels = texels.as_chunks().0.to_vec();
    let picture = Picture::srgb8(size, texels);
    let picture = picture.ok_or_else(|| Error::decode(file, "the drawing has no pixels"))?;
    let encoded = Some(drawing.outline_text(bytes));
    let drawing = Some(Arc::new(drawing) as Arc<dyn raster::VectorDrawing>);
    Ok(Picture { encoded, drawing, ..picture })
}

/// Decodes an SVG as paint at its own size, its corner at a canvas pixel.
pub fn decode_paint(file: &Path, bytes: &[u8], x: i32, y: i32, budget: &Budget) -> Result<Painted> {
    let drawing = Drawing::parse(file, bytes, budget)?;
    let (size, texels) = drawing.render(file, 1.0, budget)?;
    let (w, h) = (size.width as usize, size.height as usize);
    let tiles = TileGrid::from_straight_rgba(&texels, w, h, x, y);
    Ok(Painted { size, tiles, warning: drawing.warning() })
}

/// An SVG that was parsed.
#[derive(Debug)]
struct Drawing {
    tree: Tree,
    has_text: bool,
}

impl raster::VectorDrawing for Drawing {
    fn size(&self) -> Vec2 {
        vec2(self.tree.size().width(), self.tree.size().height())
    }

    fn draw(&self, size: Size) -> Option<Vec<[u8; 4]>> {
        let scale = size.width as f32 / self.tree.size().width();
        let texels = self.paint(size, scale)?;
        Some(texels.as_chunks().0.to_vec())
    }
}

/// What an SVG holds, its text in the fonts of this machine.
pub(super) fn tree(file: &Path, bytes: &[u8], budget: &Budget) -> Result<Tree> {
    let options = Options {
        fontdb: if has_text(bytes) { fonts() } else { Arc::default() },
        font_family: "sans-serif".into(),
        image_href_resolver: resolve_embedded_only(*budget),
        ..Options::default()
    };
    // The parser and the renderer are third-party code: a panic counts as a damaged file.
    let parsed = catch_unwind(AssertUnwindSafe(|| Tree::from_data(bytes, &options)));
    match parsed {
        Ok(Ok(tree)) => Ok(tree),
        Ok(Err(usvg::Error::InvalidSize)) => Err(Error::decode(
            file,
            "the SVG has no size: “width”, “height” and “viewBox” are missing or 0",
        )),
        Ok(Err(e)) => Err(Error::decode(file, format!("the SVG cannot be parsed ({e})"))),
        Err(_) => Err(Error::decode(file, "the SVG is damaged")),
    }
}

fn has_text(bytes: &[u8]) -> bool {
    bytes.windows(5).any(|word| word == b"<text" || word == b":text")
}

impl Drawing {
    fn parse(file: &Path, bytes: &[u8], budget: &Budget) -> Result<Self> {
        Ok(Self { tree: tree(file, bytes, budget)?, has_text: has_text(bytes) })
    }

    /// Straight bytes at a scale.
    fn render(&self, file: &Path, scale: f32, budget: &Budget) -> Result<(Size, Vec<u8>)> {
        // A length that was scaled to whole pixels may be a little above.
        let side = |length: f32| (length * scale - 1e-3).ceil().max(1.0) as u64;
        let [width, height] = [self.tree.size().width(), self.tree.size().height()].map(side);
        let size = budget.size(file, width, height)?;
        // The pixels twice, and layers of groups with opacity, masks or filters.
        budget.room(file, &format!("an SVG of {size} pixels"), 24 * size.area() as u64)?;
        let texels = self.paint(size, scale);
        let texels = texels.ok_or_else(|| Error::decode(file, "the SVG cannot be painted"))?;
        Ok((size, texels))
    }

    /// Straight bytes of a picture of a size, the drawing enlarged; `None` where it panics, or the
    /// picture cannot be had.
    fn paint(&self, size: Size, scale: f32) -> Option<Vec<u8>> {
        let mut pixmap = Pixmap::new(size.width, size.height)?;
        catch_unwind(AssertUnwindSafe(|| {
            resvg::render(&self.tree, Transform::from_scale(scale, scale), &mut pixmap.as_mut());
        }))
        .ok()?;
        let mut rgba = pixmap.take();
        for texel in rgba.as_chunks_mut().0 {
            *texel = straight(*texel);
        }
        Some(rgba)
    }

    /// The file with its text as outlines: the same on every machine.
    fn outline_text(&self, bytes: &[u8]) -> Asset {
        if self.has_text {
            Asset::from(self.tree.to_string(&WriteOptions::default()).into_bytes())
        } else {
            Asset::from(bytes.to_vec())
        }
    }

    fn warning(&self) -> Option<&'static str> {
        let is_lost = self.has_text && !self.tree.has_text_nodes();
        is_lost.then_some("its text is left out: its fonts are not installed")
    }
}

/// A premultiplied texel as straight color.
fn straight([r, g, b, a]: [u8; 4]) -> [u8; 4] {
    if a == 0 {
        return [0; 4];
    }
    let of = |v: u8| ((u32::from(v) * 255 + u32::from(a) / 2) / u32::from(a)).min(255) as u8;
    [of(r), of(g), of(b), a]
}

/// The font that stands in where the machine has none.
const EMBEDDED: &str = "Ubuntu";

/// The fonts of this machine, and two of the program's own; read once, and only for a drawing with
/// text.
pub(super) fn fonts() -> Arc<Database> {
    static FONTS: OnceLock<Arc<Database>> = OnceLock::new();
    let load = || {
        let mut fonts = Database::new();
        fonts.load_system_fonts();
        fonts.load_font_data(epaint_default_fonts::UBUNTU_LIGHT.to_vec());
        fonts.load_font_data(epaint_default_fonts::HACK_REGULAR.to_vec());
        let has =
            |family| fonts.query(&Query { families: &[family], ..Query::default() }).is_some();
        let (has_sans, has_serif) = (has(Family::SansSerif), has(Family::Serif));
        let has_mono = has(Family::Monospace);
        if !has_sans {
            fonts.set_sans_serif_family(EMBEDDED);
        }
        if !has_serif {
            fonts.set_serif_family(EMBEDDED);
        }
        if !has_mono {
            fonts.set_monospace_family("Hack");
        }
        Arc::new(fonts)
    };
    FONTS.get_or_init(load).clone()
}

/// Pictures within the file, if the budget allows them; never other files.
fn resolve_embedded_only(budget: Budget) -> ImageHrefResolver<'static> {
    let decode = ImageHrefResolver::default_data_resolver();
    ImageHrefResolver {
        resolve_data: Box::new(move |mime, data, options| {
            let reader =
                ImageReader::new(Cursor::new(data.as_slice())).with_guessed_format().ok()?;
            if reader.format().is_some() {
                let (width, height) = reader.into_dimensions().ok()?;
                budget.size(Path::new("image"), width.into(), height.into()).ok()?;
            }
            decode(mime, data, options)
        }),
        resolve_string: Box::new(|_, _| None),
    }
}

#[cfg(test)]
mod tests;
