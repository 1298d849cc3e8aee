//! SVG drawings as pictures. Floor 5. Not here: SVG files that are written.
//!
//! What an SVG shows depends on the fonts of the machine until its text has become outlines, so
//! that is what a picture keeps as its file. Nothing outside of the file is read, and no script
//! runs.

#![warn(missing_docs)]

mod plain_paths;
mod shapes;

pub(crate) use plain_paths::{PaintedPaths, PlainPath, plain_paths};
pub use shapes::{MOST_SHAPES, SvgShape, SvgShapes, read_shapes};

use super::{Budget, pixels::Painted};
use crate::math::srgb::Color;
use crate::math::{Size, Vec2, vec2};
use crate::raster::{self, Asset, Picture, TileGrid};
use crate::{Error, Result};
use image::ImageReader;
use rayon::prelude::*;
use resvg::usvg::fontdb::{Database, Family, Query};
use resvg::usvg::{ImageHrefResolver, Node, Options, Paint, Transform, Tree, WriteOptions};
use resvg::{tiny_skia::Pixmap, usvg};
use std::any::Any;
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

/// How much larger than its own size an SVG is drawn whose pixels are to be enough for most uses.
pub fn layer_scale(own: Vec2) -> f32 {
    let longer = own.max_element();
    longer.max(LAYER_PX.min(MOST_ENLARGED * longer)) / longer
}

/// Decodes an SVG for an image layer, at a resolution of at least 2048 pixels along its longer
/// side. The picture's file is the same SVG with its text as outlines.
pub fn decode(file: &Path, bytes: &[u8], budget: &Budget) -> Result<Picture> {
    let drawing = Drawing::parse(file, bytes, budget)?;
    let (scale, size) = layer_size(file, raster::VectorDrawing::size(&drawing), budget)?;
    let texels = drawing.paint(size, scale);
    let texels = texels.ok_or_else(|| Error::decode(file, "the SVG cannot be painted"))?;
    let picture = Picture::of_bytes(size, texels);
    let picture = picture.ok_or_else(|| Error::decode(file, "the drawing has no pixels"))?;
    let encoded = Some(drawing.outline_text(bytes));
    let drawing = Some(Arc::new(drawing) as Arc<dyn raster::VectorDrawing>);
    Ok(Picture { encoded, drawing, ..picture })
}

/// How much a drawing is enlarged for an image layer, and the size of its picture.
pub(crate) fn layer_size(file: &Path, own: Vec2, budget: &Budget) -> Result<(f32, Size)> {
    let most = budget.side_px.min(8192) as f32;
    let scale = layer_scale(own).min(most / own.max_element());
    Ok((scale, picture_size(file, own, scale, budget)?))
}

/// The size of the picture of a drawing at a scale, if there is room for it.
fn picture_size(file: &Path, own: Vec2, scale: f32, budget: &Budget) -> Result<Size> {
    // A length that was scaled to whole pixels may be a little above.
    let side = |length: f32| (length * scale - 1e-3).ceil().max(1.0) as u64;
    let size = budget.size(file, side(own.x), side(own.y))?;
    // The pixels twice, and layers of groups with opacity, masks or filters.
    budget.room(file, &format!("an SVG of {size} pixels"), 24 * size.area() as u64)?;
    Ok(size)
}

/// Decodes an SVG as paint at its own size, its corner at a canvas pixel.
pub fn decode_paint(file: &Path, bytes: &[u8], x: i32, y: i32, budget: &Budget) -> Result<Painted> {
    let drawing = Drawing::parse(file, bytes, budget)?;
    let size = picture_size(file, raster::VectorDrawing::size(&drawing), 1.0, budget)?;
    let texels = drawing.paint(size, 1.0);
    let texels = texels.ok_or_else(|| Error::decode(file, "the SVG cannot be painted"))?;
    let (w, h) = (size.width as usize, size.height as usize);
    let tiles = TileGrid::from_straight_rgba(texels.as_flattened(), w, h, x, y);
    Ok(Painted { size, tiles, warning: drawing.warning() })
}

/// An SVG with each of its colors replaced, its text as outlines. Pictures within it stay.
pub fn recolor(
    file: &Path,
    bytes: &[u8],
    budget: &Budget,
    replace: impl Fn(Color) -> Color,
) -> Result<Vec<u8>> {
    /// Attributes of colors, as the writer of `usvg` has them: `#rrggbb`.
    const COLORS: [&str; 5] =
        ["fill=\"", "stroke=\"", "stop-color=\"", "flood-color=\"", "lighting-color=\""];
    let text = tree(file, bytes, budget)?.to_string(&WriteOptions::default());
    let (mut out, mut rest) = (String::with_capacity(text.len()), text.as_str());
    while let Some(at) = rest.find("=\"#") {
        let (before, after) = rest.split_at(at + 2);
        out.push_str(before);
        let color = after.split('"').next().unwrap_or_default();
        let replaced =
            Color::parse(color).filter(|_| COLORS.iter().any(|name| before.ends_with(name)));
        match replaced {
            Some(known) => out.push_str(&replace(known).to_string()),
            None => out.push_str(color),
        }
        rest = &after[color.len()..];
    }
    out.push_str(rest);
    Ok(out.into_bytes())
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
        Some(self.paint(size, scale)?.to_vec())
    }

    fn as_any(&self) -> &dyn Any {
        self
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

    /// Straight bytes of a picture of a size, the drawing enlarged; `None` where it panics, or the
    /// picture cannot be had.
    fn paint(&self, size: Size, scale: f32) -> Option<Arc<[[u8; 4]]>> {
        if let Some(paths) = plain_paths(self.tree.root()) {
            return Some(PaintedPaths::paint(&paths, size, scale)?.texels);
        }
        let mut texels = vec![[0u8; 4]; size.area()];
        let (mut bands, mut rest) = (Vec::new(), texels.as_mut_slice());
        let mut top = 0;
        for end in self.band_ends(size, scale) {
            let (band, after) = rest.split_at_mut((end - top) * size.width as usize);
            bands.push((top, band));
            (top, rest) = (end, after);
        }
        let painted =
            bands.into_par_iter().map(|(top, band)| self.paint_band(top, scale, size, band));
        painted.collect::<Option<()>>()?;
        Some(texels.into())
    }

    /// Paints the rows of a picture from one on.
    fn paint_band(&self, top: usize, scale: f32, size: Size, band: &mut [[u8; 4]]) -> Option<()> {
        let height = (band.len() / size.width.max(1) as usize) as u32;
        let mut pixmap = Pixmap::new(size.width, height)?;
        let at = Transform::from_row(scale, 0.0, 0.0, scale, 0.0, -(top as f32));
        catch_unwind(AssertUnwindSafe(|| {
            resvg::render(&self.tree, at, &mut pixmap.as_mut());
        }))
        .ok()?;
        for (texel, painted) in band.iter_mut().zip(pixmap.data().as_chunks().0) {
            *texel = straight(*painted);
        }
        Some(())
    }

    /// The rows at which bands of a picture end that are painted side by side: between lines of text,
    /// where no path is cut. Always the same ones, so that the picture does not depend on threads.
    fn band_ends(&self, size: Size, scale: f32) -> Vec<usize> {
        /// So many at most.
        const BANDS: usize = 4;
        let height = size.height as usize;
        let mut is_free = vec![true; height + 1];
        let mut take = |top: f32, bottom: f32| {
            let row = |y: f32, by: f32| ((y * scale + by).max(0.0) as usize).min(height);
            is_free[row(top, -1.0)..=row(bottom, 2.0)].fill(false);
        };
        let mut ends = Vec::new();
        if are_plain(self.tree.root(), &mut take) {
            for k in 1..BANDS {
                let (wanted, reach) = (height * k / BANDS, height / (3 * BANDS));
                let near = (0..reach).flat_map(|by| [wanted - by, wanted + by]);
                ends.extend(near.into_iter().find(|row| is_free[*row]));
            }
        }
        ends.push(height);
        ends.dedup();
        ends
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

/// Whether only paths are painted one over the other, each pixel by itself.
///
/// * `take`: is told the upper and the lower end of each path.
fn are_plain(group: &usvg::Group, take: &mut impl FnMut(f32, f32)) -> bool {
    let is_bare = group.filters().is_empty()
        && group.mask().is_none()
        && group.clip_path().is_none()
        && !group.should_isolate();
    is_bare
        && group.children().iter().all(|node| match node {
            Node::Group(group) => are_plain(group, take),
            Node::Path(path) => {
                let bounds = path.abs_stroke_bounding_box();
                take(bounds.top(), bounds.bottom());
                let paints =
                    [path.fill().map(usvg::Fill::paint), path.stroke().map(usvg::Stroke::paint)];
                !paints.into_iter().flatten().any(|paint| matches!(paint, Paint::Pattern(_)))
            }
            Node::Text(text) => are_plain(text.flattened(), take),
            Node::Image(_) => false,
        })
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
