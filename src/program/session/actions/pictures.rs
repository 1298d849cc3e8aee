//! Pictures that layers use, chosen from the user's files: read on any thread, then put into the
//! layer. Floor 6. Not here: reading files (`io`).

use super::file_names::free_file;
use super::placing::{in_profile, read_picture};
use crate::Result;
use crate::document::source::NormalConvention;
use crate::document::{
    Content, DetailSource, Document, LayerId, LayerMask, Live, MaskKind, NormalLayer,
};
use crate::io::{Budget, files::read_file, maps::detail, picture};
use crate::math::{ColorProfile, Size, Vec2};
use crate::paint::{Adjust, PictureSource};
use crate::raster::{Picture, Plane};
use crate::session::{OpenDocument, PicturePart};
use crate::shading::{Environment, LitSphere};
use crate::surface::DetailMap;
use std::path::Path;
use std::sync::Arc;

/// A picture part that was read.
pub struct ReadPart {
    part: PicturePart,
    /// The name of the file, without its folder.
    name: String,
    what: PartValue,
}

enum PartValue {
    Picture(Picture),
    Mask(Plane<u8>),
    Detail(Picture, Arc<DetailMap>),
}

/// Reads a part from a file of the user's.
pub fn read(part: PicturePart, file: &Path) -> Result<ReadPart> {
    let bytes = || read_file(file, Budget::of_this_machine().file_bytes);
    let (name, what) = match part {
        PicturePart::Mask => {
            let mask = picture::decode_coverage(file, &bytes()?, &Budget::of_this_machine())?;
            let name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
            (name, PartValue::Mask(mask))
        }
        PicturePart::Detail => {
            let normals = detail::read(
                file,
                &bytes()?,
                &NormalConvention::default(),
                &Budget::of_this_machine(),
            )?;
            let (name, picture) = read_picture(file)?;
            (name, PartValue::Detail(picture, Arc::new(DetailMap::new(normals))))
        }
        _ => {
            let (name, picture) = read_picture(file)?;
            (name, PartValue::Picture(picture))
        }
    };
    Ok(ReadPart { part, name, what })
}

/// Puts a part into a layer, as a step. A layer without such a part is left as it is.
pub fn put(open: &mut OpenDocument, layer: LayerId, read: ReadPart) {
    let ReadPart { part, name, what } = read;
    let document = open.document();
    let (file, canvas) = (free_file(document, &name), document.size);
    let next = match what {
        PartValue::Mask(mask) => with_mask(document, layer, file, fit_mask(&mask, canvas)),
        PartValue::Detail(picture, map) => {
            with_detail(document, layer, PictureSource::new(file, picture, Adjust::default()), map)
        }
        PartValue::Picture(picture) => {
            let picture = in_profile(&picture, ColorProfile::Srgb, document);
            with_picture(document, layer, part, file, picture)
        }
    };
    if let Some(next) = next {
        open.commit(part.step(), next);
    }
}

fn with_mask(
    document: &Document,
    layer: LayerId,
    file: String,
    coverage: Plane<u8>,
) -> Option<Document> {
    document.with_layer(layer, |layer| {
        layer.mask = Some(LayerMask::new(MaskKind::File { file, coverage: Arc::new(coverage) }));
    })
}

fn with_detail(
    document: &Document,
    layer: LayerId,
    picture: PictureSource,
    map: Arc<DetailMap>,
) -> Option<Document> {
    let Content::Normals(normals) = &document.layer(layer)?.content else { return None };
    let source = DetailSource::Map { picture, convention: NormalConvention::default(), map };
    let normals = NormalLayer { source, ..normals.clone() };
    document.with_layer(layer, |layer| layer.content = Content::Normals(normals))
}

fn with_picture(
    document: &Document,
    layer: LayerId,
    part: PicturePart,
    file: String,
    picture: Picture,
) -> Option<Document> {
    let content = match &document.layer(layer)?.content {
        Content::Image(live) if part == PicturePart::Image => {
            let mut image = live.params().clone();
            image.source = PictureSource::new(file, picture, image.source.adjust);
            Content::Image(Live::new(image))
        }
        Content::Shading(live) => {
            let mut shading = live.params().clone();
            match part {
                PicturePart::Environment => {
                    let known = shading
                        .environment
                        .as_ref()
                        .map(|e| (e.projection, e.rotation, e.exposure));
                    let mut environment = Environment::new(file, picture);
                    if let Some(known) = known {
                        (environment.projection, environment.rotation, environment.exposure) =
                            known;
                    }
                    shading.environment = Some(environment);
                }
                PicturePart::Sphere => shading.sphere = Some(LitSphere::new(file, picture)),
                PicturePart::ConcaveSphere => {
                    shading.sphere_concave = Some(LitSphere::new(file, picture))
                }
                PicturePart::Image | PicturePart::Mask | PicturePart::Detail => return None,
            }
            Content::Shading(Live::new(shading))
        }
        _ => return None,
    };
    document.with_layer(layer, |layer| layer.content = content)
}

/// A mask stretched over the canvas, by nearest pixels.
fn fit_mask(mask: &Plane<u8>, canvas: Size) -> Plane<u8> {
    if mask.size() == canvas {
        return mask.clone();
    }
    let scale = Vec2::new(
        mask.width() as f32 / canvas.width as f32,
        mask.height() as f32 / canvas.height as f32,
    );
    let along = |v: usize, scale: f32| ((v as f32 + 0.5) * scale) as i32;
    Plane::from_fn(canvas, |x, y| mask.at_clamped(along(x, scale.x), along(y, scale.y)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mask_of_another_size_covers_the_canvas() {
        let mask = Plane::from_values(Size::new(2, 1), vec![10, 200]).unwrap();
        let fitted = fit_mask(&mask, Size::new(6, 3));
        assert_eq!(
            (fitted.at(0, 0), fitted.at(2, 2), fitted.at(3, 1), fitted.at(5, 2)),
            (10, 10, 200, 200)
        );
    }
}
