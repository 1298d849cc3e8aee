//! The picture on the graphics card: blocks below any driver's texture limit; only changed parts
//! are uploaded. Floor 7.

use crate::io::proof::ProofTable;
use crate::math::{Affine2, ColorProfile, Rect, Size, srgb, vec2};
use crate::raster::{TILE, TileAt, TileGrid};
use crate::session::CanvasView;
use eframe::egui::{
    self, Color32, ColorImage, Mesh, Painter, Pos2, Shape, TextureFilter, TextureHandle, TextureId,
    TextureOptions, TextureWrapMode, pos2,
};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Side of a block, px: eight tiles. A driver's limit is at least 2048; a smaller block is cheaper
/// to shrink again.
pub const BLOCK: i32 = 512;

/// How pixels of the picture become pixels of the screen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Magnification {
    /// Reduced: from smaller copies of the picture, made again with every change.
    Reduced,
    #[default]
    Smooth,
    /// As squares; at their own size one pixel of the screen for each.
    Squares,
}

/// Pixels of the screen per pixel of a picture that is seen at its own size, or larger: slightly below
/// 1 means 1, rounded.
pub const OWN_SIZE: f32 = 0.999;

impl Magnification {
    /// * `scale`: pixels of the screen per pixel of the picture.
    pub fn of(scale: f32, is_upright: bool) -> Self {
        let is_own_size = is_upright && (scale - 1.0).abs() < 1e-5;
        match scale {
            _ if scale >= 2.0 || is_own_size => Self::Squares,
            _ if scale > OWN_SIZE => Self::Smooth,
            _ => Self::Reduced,
        }
    }
}

/// The blocks of one picture.
#[derive(Default)]
pub struct TextureBlocks {
    size: Option<Size>,
    textures: BTreeMap<(i32, i32), TextureBlock>,
    magnification: Magnification,
    colors: ShownColors,
}

struct TextureBlock {
    texture: TextureHandle,
    /// Whether nothing is seen through it.
    is_opaque: bool,
}

/// In which colors a picture is seen.
#[derive(Clone, Debug, Default)]
pub struct ShownColors {
    /// What its numbers mean; the window is sRGB.
    pub profile: ColorProfile,
    pub look: ShownLook,
}

/// What is done to colors before they are seen.
#[derive(Clone, Debug, Default)]
pub enum ShownLook {
    /// Nothing.
    #[default]
    Own,
    /// The grays of its luminance.
    Values,
    /// As a press or another screen shows it; what that cannot show is gray, if it is marked.
    Proof { table: Arc<ProofTable>, is_marked: bool },
}

/// What marks colors that a proof cannot show.
const MARK: [u8; 3] = [128; 3];

impl ShownColors {
    fn is_same(&self, other: &Self) -> bool {
        self.profile == other.profile && self.look.is_same(&other.look)
    }

    /// Premultiplied texels of a row as they are seen.
    fn show(&self, texels: &[[u8; 4]], row: &mut [Color32]) {
        let Some(conversion) = self.profile.conversion_to(ColorProfile::Srgb) else {
            return self.look.show(texels, row);
        };
        let mut seen = [[0; 4]; TILE];
        for (texels, row) in texels.chunks(TILE).zip(row.chunks_mut(TILE)) {
            let seen = &mut seen[..texels.len()];
            conversion.show(texels, seen);
            self.look.show(seen, row);
        }
    }
}

impl ShownLook {
    fn is_same(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Own, Self::Own) | (Self::Values, Self::Values) => true,
            (Self::Proof { table: a, is_marked: b }, Self::Proof { table, is_marked }) => {
                Arc::ptr_eq(a, table) && b == is_marked
            }
            _ => false,
        }
    }

    /// Premultiplied texels of sRGB as they are seen.
    fn show(&self, texels: &[[u8; 4]], row: &mut [Color32]) {
        for (pixel, &texel) in row.iter_mut().zip(texels) {
            let [r, g, b, a] = self.of(texel);
            *pixel = Color32::from_rgba_premultiplied(r, g, b, a);
        }
    }

    fn of(&self, texel: [u8; 4]) -> [u8; 4] {
        match self {
            Self::Own => texel,
            Self::Values => value_of(texel),
            Self::Proof { table, is_marked } => table.show(texel, is_marked.then_some(MARK)),
        }
    }
}

impl TextureBlocks {
    /// Starts another picture and drops the last one.
    pub fn begin(&mut self, size: Size) {
        if self.size != Some(size) {
            self.size = Some(size);
        }
        self.textures.clear();
    }

    /// Uploads tiles that changed.
    pub fn update(
        &mut self,
        ctx: &egui::Context,
        grid: &TileGrid,
        tiles: impl Iterator<Item = TileAt>,
    ) {
        let Some(size) = self.size else { return };
        let mut changed: BTreeMap<(i32, i32), Rect> = BTreeMap::new();
        for at in tiles {
            let block = (at.rect().x0.div_euclid(BLOCK), at.rect().y0.div_euclid(BLOCK));
            let area = changed.entry(block).or_insert(Rect::EMPTY);
            // One pixel more, where the canvas ends within the block: see `image`.
            let Rect { x0, y0, x1, y1 } = at.rect();
            let reached = Rect::new(x0, y0, x1 + 1, y1 + 1).intersect(block_rect(block));
            *area = area.union(if x1 < size.width as i32 && y1 < size.height as i32 {
                at.rect()
            } else {
                reached
            });
        }
        for (block, area) in changed {
            let options = self.options();
            let whole = block_rect(block);
            let shown = whole.intersect(size.rect());
            match self.textures.get_mut(&block) {
                Some(TextureBlock { texture, is_opaque }) => {
                    let at = [(area.x0 - whole.x0) as usize, (area.y0 - whole.y0) as usize];
                    let image = image(grid, area, size, &self.colors);
                    let is_whole = area.intersect(shown) == shown;
                    *is_opaque = (*is_opaque || is_whole) && is_covered(&image, area, shown);
                    texture.set_partial(at, image, options);
                }
                None if !shown.is_empty() => {
                    let image = image(grid, whole, size, &self.colors);
                    let is_opaque = is_covered(&image, whole, shown);
                    let texture = ctx.load_texture(format!("canvas {block:?}"), image, options);
                    self.textures.insert(block, TextureBlock { texture, is_opaque });
                }
                None => {}
            }
        }
    }

    /// The filter belongs to the texture, so one pixel of each is sent again.
    pub fn magnify(&mut self, magnification: Magnification, grid: &TileGrid) {
        let Some(size) = self.size.filter(|_| self.magnification != magnification) else { return };
        self.magnification = magnification;
        let options = self.options();
        for (&block, TextureBlock { texture, .. }) in &mut self.textures {
            let whole = block_rect(block);
            let tile = Rect::new(whole.x0, whole.y0, whole.x0 + 1, whole.y0 + 1);
            texture.set_partial([0, 0], image(grid, tile, size, &self.colors), options);
        }
    }

    /// Shows it in other colors. What is on the graphics card is sent again.
    pub fn show_in(&mut self, colors: &ShownColors, grid: &TileGrid) {
        if self.colors.is_same(colors) {
            return;
        }
        self.colors = colors.clone();
        let (Some(size), options) = (self.size, self.options()) else { return };
        for (&block, TextureBlock { texture, .. }) in &mut self.textures {
            texture.set(image(grid, block_rect(block), size, colors), options);
        }
    }

    fn options(&self) -> TextureOptions {
        let is_in_squares = self.magnification == Magnification::Squares;
        TextureOptions {
            magnification: if is_in_squares {
                TextureFilter::Nearest
            } else {
                TextureFilter::Linear
            },
            minification: TextureFilter::Linear,
            wrap_mode: TextureWrapMode::ClampToEdge,
            mipmap_mode: (self.magnification == Magnification::Reduced)
                .then_some(TextureFilter::Linear),
        }
    }

    /// Draws the blocks, and behind those that are not opaque squares; `screen_from_canvas` in the
    /// window's points.
    pub fn draw(&self, painter: &Painter, checker: TextureId, screen_from_canvas: Affine2) {
        let Some(size) = self.size else { return };
        let end = |px: u32| (px as i32 + BLOCK - 1).div_euclid(BLOCK);
        let all = (0..end(size.height)).flat_map(|y| (0..end(size.width)).map(move |x| (x, y)));
        for block in all {
            let whole = block_rect(block);
            let shown = whole.intersect(size.rect());
            let uv = |x: i32, y: i32| {
                pos2((x - whole.x0) as f32 / BLOCK as f32, (y - whole.y0) as f32 / BLOCK as f32)
            };
            let at = corners(shown).map(|(x, y)| on_screen(screen_from_canvas, x, y));
            let known = self.textures.get(&block);
            if known.is_none_or(|known| !known.is_opaque) {
                painter.add(checker_shape(checker, at));
            }
            if let Some(TextureBlock { texture, .. }) = known {
                let uv = corners(shown).map(|(x, y)| uv(x, y));
                let corners = [0, 1, 2, 3].map(|i| (at[i], uv[i]));
                painter.add(quad(texture.id(), corners, Color32::WHITE));
            }
        }
    }
}

/// Squares of the same size at any zoom, in a quadrilateral; two that are side by side fit.
pub fn checker_shape(texture: TextureId, corners: [Pos2; 4]) -> Shape {
    const SQUARES_PT: f32 = 16.0;
    let uv = corners.map(|p| (p, pos2(p.x / SQUARES_PT, p.y / SQUARES_PT)));
    quad(texture, uv, Color32::WHITE)
}

/// A textured quadrilateral, its corners in order around it.
pub fn quad(texture: egui::TextureId, corners: [(Pos2, Pos2); 4], tint: Color32) -> Shape {
    let mut mesh = Mesh::with_texture(texture);
    for (pos, uv) in corners {
        mesh.vertices.push(egui::epaint::Vertex { pos, uv, color: tint });
    }
    mesh.indices = vec![0, 1, 2, 0, 2, 3];
    Shape::mesh(mesh)
}

pub fn corners(rect: Rect) -> [(i32, i32); 4] {
    [(rect.x0, rect.y0), (rect.x1, rect.y0), (rect.x1, rect.y1), (rect.x0, rect.y1)]
}

pub fn on_screen(screen_from_canvas: Affine2, x: i32, y: i32) -> Pos2 {
    let p = screen_from_canvas.transform_point2(vec2(x as f32, y as f32));
    pos2(p.x, p.y)
}

/// The middle of an area of the window, moved by less than a pixel of the screen so that a canvas which
/// is not turned lies on whole ones: its own pixels would be mixed between them. Points.
///
/// * `per_point`: pixels of the screen per point.
pub fn middle_on_pixels(area: egui::Rect, view: &CanvasView, per_point: f32) -> Pos2 {
    let middle = area.center();
    if view.turn_rad != 0.0 || view.zoom * per_point < OWN_SIZE {
        return middle;
    }
    let corner = view.screen_from_canvas().translation + vec2(middle.x, middle.y);
    let corner_px = corner * per_point;
    let by = (corner_px.round() - corner_px) / per_point;
    middle + egui::vec2(by.x, by.y)
}

fn block_rect((col, row): (i32, i32)) -> Rect {
    Rect::new(col * BLOCK, row * BLOCK, (col + 1) * BLOCK, (row + 1) * BLOCK)
}

/// Premultiplied pixels of a rectangle, as the graphics card takes them. Beyond the canvas's right
/// and lower edge its last pixels are repeated once, so that interpolation mixes nothing else into
/// the rim.
fn image(grid: &TileGrid, rect: Rect, canvas: Size, colors: &ShownColors) -> ColorImage {
    let (width, height) = (rect.width(), rect.height());
    let mut pixels = vec![Color32::TRANSPARENT; width * height];
    for at in TileAt::covering(rect) {
        let Some(tile) = grid.tile(at) else { continue };
        let area = at.rect().intersect(rect);
        for y in area.y0..area.y1 {
            let from = ((y - at.rect().y0) as usize * TILE + (area.x0 - at.rect().x0) as usize) * 4;
            let to = (y - rect.y0) as usize * width + (area.x0 - rect.x0) as usize;
            let texels = tile.bytes()[from..from + area.width() * 4].as_chunks::<4>().0;
            colors.show(texels, &mut pixels[to..to + area.width()]);
        }
    }
    let within = |end: i32, begin: i32, n: usize| {
        usize::try_from(end - begin).ok().filter(|&at| at > 0 && at < n)
    };
    if let Some(x) = within(canvas.width as i32, rect.x0, width) {
        (0..height).for_each(|y| pixels[y * width + x] = pixels[y * width + x - 1]);
    }
    if let Some(y) = within(canvas.height as i32, rect.y0, height) {
        pixels.copy_within((y - 1) * width..y * width, y * width);
    }
    ColorImage::new([width, height], pixels)
}

/// Whether the pixels of a part are all opaque.
///
/// * `part`: what the image shows of the canvas, of which only a rectangle is seen.
fn is_covered(image: &ColorImage, part: Rect, seen: Rect) -> bool {
    let seen = seen.intersect(part);
    let (left, width) = ((seen.x0 - part.x0) as usize, seen.width());
    (seen.y0..seen.y1).all(|y| {
        let row = (y - part.y0) as usize * image.size[0] + left;
        image.pixels[row..row + width].iter().all(|pixel| pixel.a() == 255)
    })
}

/// The gray of the same luminance and opacity; both premultiplied.
fn value_of([r, g, b, a]: [u8; 4]) -> [u8; 4] {
    if a == 0 {
        return [0; 4];
    }
    let opacity = f32::from(a) / 255.0;
    let light = |channel: u8| match a {
        255 => srgb::decode_u8(channel),
        _ => srgb::decode((f32::from(channel) / f32::from(a)).min(1.0)),
    };
    let gray = srgb::encode(srgb::luminance(light(r), light(g), light(b)));
    let gray = srgb::quantize(gray * opacity);
    [gray, gray, gray, a]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_canvas_at_its_own_size_lies_on_pixels_of_the_screen() {
        let area = egui::Rect::from_min_size(pos2(40.0, 61.5), egui::vec2(1001.0, 700.0));
        for (zoom, per_point, mirrored) in [(1.0, 1.0, false), (0.8, 1.25, true), (3.0, 2.0, false)]
        {
            let center = vec2(151.3, 80.5);
            let view = CanvasView { center, zoom, turn_rad: 0.0, mirrored };
            let middle = middle_on_pixels(area, &view, per_point);
            assert!(middle.distance(area.center()) * per_point <= 0.71, "less than a pixel");
            let to_window = Affine2::from_translation(vec2(middle.x, middle.y));
            for (x, y) in [(0, 0), (7, 200)] {
                let at = on_screen(to_window * view.screen_from_canvas(), x, y);
                let px = vec2(at.x, at.y) * per_point;
                assert!((px - px.round()).abs().max_element() < 1e-3, "{zoom} {px}");
            }
            assert_eq!(Magnification::of(zoom * per_point, true), Magnification::Squares);
        }
        let turned =
            CanvasView { turn_rad: 0.3, ..CanvasView::fitting(Size::new(9, 9), vec2(1.0, 1.0)) };
        assert_eq!(middle_on_pixels(area, &turned, 1.0), area.center());
        assert_eq!(Magnification::of(1.0, false), Magnification::Smooth);
        assert_eq!(Magnification::of(0.5, true), Magnification::Reduced);
    }

    #[test]
    fn squares_are_drawn_behind_blocks_that_something_is_seen_through() {
        let ctx = egui::Context::default();
        let (width, height) = (600, 40);
        let paint = |alpha: [u8; 2]| {
            let texel = |i: usize| [9, 90, 200, alpha[usize::from(i % width >= 520)]];
            let bytes: Vec<u8> = (0..width * height).flat_map(texel).collect();
            TileGrid::from_straight_rgba(&bytes, width, height, 0, 0)
        };
        let mut blocks = TextureBlocks::default();
        let size = Size::new(width as u32, height as u32);
        blocks.begin(size);
        let all = || TileAt::covering(size.rect());
        let opaque = |blocks: &TextureBlocks| {
            blocks.textures.values().map(|block| block.is_opaque).collect::<Vec<_>>()
        };
        blocks.update(&ctx, &paint([255, 255]), all());
        assert_eq!(opaque(&blocks), [true, true]);
        // One tile of the second block is seen through; opaque again, the rest is not known.
        let last = TileAt::of_pixel(599, 0);
        blocks.update(&ctx, &paint([255, 254]), [last].into_iter());
        assert_eq!(opaque(&blocks), [true, false]);
        blocks.update(&ctx, &paint([255, 255]), [last].into_iter());
        assert_eq!(opaque(&blocks), [true, false]);
        blocks.update(&ctx, &paint([255, 255]), all());
        assert_eq!(opaque(&blocks), [true, true]);
    }

    #[test]
    fn grays_stay_and_colors_become_the_gray_of_their_luminance() {
        for v in 0..=255 {
            assert_eq!(value_of([v, v, v, 255]), [v, v, v, 255]);
        }
        assert_eq!(value_of([255, 0, 0, 255]), [127, 127, 127, 255]);
        assert_eq!(value_of([0, 255, 0, 255]), [220, 220, 220, 255]);
        assert_eq!(value_of([0, 128, 0, 128]), [110, 110, 110, 128], "half of it is seen");
        assert_eq!(value_of([0; 4]), [0; 4]);
    }

    #[test]
    fn a_document_in_display_p3_is_shown_in_srgb_and_its_proof_too() {
        let rect = Rect::new(0, 0, 600, 1);
        let canvas = Size::new(600, 1);
        // The red of sRGB in Display P3, and half of it.
        let texel = |x: usize| if x < 500 { [234, 51, 35, 255] } else { [234, 51, 35, 128] };
        let bytes: Vec<u8> = (0..600).flat_map(texel).collect();
        let grid = TileGrid::from_straight_rgba(&bytes, 600, 1, 0, 0);
        let seen = |profile, look: ShownLook| {
            let colors = ShownColors { profile, look };
            [0, 599].map(|x| image(&grid, rect, canvas, &colors).pixels[x].to_array())
        };
        // Half of a red is stored in half as many steps.
        let near = |a: [[u8; 4]; 2], b: [[u8; 4]; 2]| {
            a.as_flattened().iter().zip(b.as_flattened()).all(|(a, b)| a.abs_diff(*b) <= 2)
        };
        let shown = seen(ColorProfile::DisplayP3, ShownLook::Own);
        assert!(near(shown, [[255, 0, 0, 255], [128, 0, 0, 128]]), "{shown:?}");
        let own = seen(ColorProfile::Srgb, ShownLook::Own);
        assert_eq!(own, [[234, 51, 35, 255], [117, 26, 18, 128]], "sRGB is not converted");
        let values = seen(ColorProfile::DisplayP3, ShownLook::Values);
        assert!(near(values, [[127, 127, 127, 255], [64, 64, 64, 128]]), "{values:?}");
        let icc = crate::io::icc_profiles::icc_of(ColorProfile::Srgb);
        let table = ProofTable::read(std::path::Path::new("a.icc"), icc).unwrap();
        let proof = ShownLook::Proof { table: Arc::new(table), is_marked: true };
        let proofed = seen(ColorProfile::DisplayP3, proof);
        assert!(proofed[0][0] >= 253 && proofed[0][1] <= 2, "{proofed:?}");
    }

    #[test]
    fn the_rim_of_the_canvas_is_repeated_once_beyond_it() {
        let canvas = Size::new(3, 2);
        let bytes: Vec<u8> = (0..6u8).flat_map(|i| [i * 40, 9, 9, 255]).collect();
        let grid = TileGrid::from_straight_rgba(&bytes, 3, 2, 0, 0);
        let image = image(&grid, Rect::new(0, 0, 5, 4), canvas, &ShownColors::default());
        let reds: Vec<u8> = image.pixels.iter().map(|pixel| pixel.r()).collect();
        assert_eq!(
            reds,
            [0, 40, 80, 80, 0, 120, 160, 200, 200, 0, 120, 160, 200, 200, 0, 0, 0, 0, 0, 0]
        );
    }
}
