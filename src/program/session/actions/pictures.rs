//! Pictures that layers are made of, chosen from the user's own files: read on any thread, then put where they belong.
//! Floor 6. Reading files is `io`'s.

use super::files::{free_file, read_picture};
use crate::Result;
use crate::document::source::NormalConvention;
use crate::document::{Content, DetailSource, Document, LayerId, LayerMask, Live, MaskKind, NormalLayer};
use crate::io::{Budget, files::read_file, maps::detail, picture};
use crate::math::{Size, Vec2};
use crate::paint::{Adjust, PictureSource};
use crate::raster::{Picture, Plane};
use crate::session::Tab;
use crate::session::replay::names;
use crate::shading::{Environment, LitSphere};
use crate::surface::DetailMap;
use std::path::Path;
use std::sync::Arc;

/// What of a layer is a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// What a placed image shows.
    Image,
    Mask,
    Environment,
    /// The lit sphere; where there is a concave one, of convex features.
    Sphere,
    ConcaveSphere,
    /// The normals of a normal layer.
    Detail,
}

names!(Part, [
    Part::Image => "image", Part::Mask => "mask", Part::Environment => "environment", Part::Sphere => "sphere",
    Part::ConcaveSphere => "concave sphere", Part::Detail => "detail",
]);

impl Part {
    /// What a dialog that asks for it is called.
    pub fn title(self) -> &'static str {
        match self {
            Part::Image => "Picture of the layer",
            Part::Mask => "Mask of the layer",
            Part::Environment => "Environment",
            Part::Sphere => "Lit sphere",
            Part::ConcaveSphere => "Lit sphere of hollows",
            Part::Detail => "Detail normals",
        }
    }
    fn step(self) -> &'static str {
        match self {
            Part::Image => "Replace picture",
            Part::Mask => "Layer mask",
            Part::Environment => "Environment",
            Part::Sphere | Part::ConcaveSphere => "Lit sphere",
            Part::Detail => "Detail normals",
        }
    }
}

/// A part as it was read.
pub struct Read {
    part: Part,
    /// Of the file, without its folder.
    name: String,
    what: What,
}

enum What {
    Picture(Picture),
    Mask(Plane<u8>),
    Detail(Picture, Arc<DetailMap>),
}

/// Reads a part from a file of the user's.
pub fn read(part: Part, file: &Path) -> Result<Read> {
    let bytes = || read_file(file, Budget::default().file_bytes);
    let (name, what) = match part {
        Part::Mask => {
            let mask = picture::decode_coverage(file, &bytes()?, &Budget::default())?;
            let name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
            (name, What::Mask(mask))
        }
        Part::Detail => {
            let normals = detail::read(file, &bytes()?, &NormalConvention::default(), &Budget::default())?;
            let (name, picture) = read_picture(file)?;
            (name, What::Detail(picture, Arc::new(DetailMap::new(normals))))
        }
        _ => {
            let (name, picture) = read_picture(file)?;
            (name, What::Picture(picture))
        }
    };
    Ok(Read { part, name, what })
}

/// Puts what was read into a layer, as a step. A layer that has no such part stays as it is.
pub fn put(tab: &mut Tab, layer: LayerId, read: Read) {
    let Read { part, name, what } = read;
    let document = tab.document();
    let (file, canvas) = (free_file(document, &name), document.size);
    let next = match what {
        What::Mask(mask) => with_mask(document, layer, file, fitted(&mask, canvas)),
        What::Detail(picture, map) => {
            with_detail(document, layer, PictureSource::new(file, picture, Adjust::default()), map)
        }
        What::Picture(picture) => with_picture(document, layer, part, file, picture),
    };
    if let Some(next) = next {
        tab.commit(part.step(), next);
    }
}

fn with_mask(document: &Document, layer: LayerId, file: String, coverage: Plane<u8>) -> Option<Document> {
    document.with_layer(layer, |layer| {
        layer.mask = Some(LayerMask::new(MaskKind::File { file, coverage: Arc::new(coverage) }));
    })
}

fn with_detail(document: &Document, layer: LayerId, picture: PictureSource, map: Arc<DetailMap>) -> Option<Document> {
    let Content::Normals(normals) = &document.layer(layer)?.content else { return None };
    let source = DetailSource::Map { picture, convention: NormalConvention::default(), map };
    let normals = NormalLayer { source, ..normals.clone() };
    document.with_layer(layer, |layer| layer.content = Content::Normals(normals))
}

fn with_picture(document: &Document, layer: LayerId, part: Part, file: String, picture: Picture) -> Option<Document> {
    let content = match &document.layer(layer)?.content {
        Content::Image(live) if part == Part::Image => {
            let mut image = live.params().clone();
            image.source = PictureSource::new(file, picture, image.source.adjust);
            Content::Image(Live::new(image))
        }
        Content::Shading(live) => {
            let mut shading = live.params().clone();
            match part {
                Part::Environment => {
                    let known = shading.environment.as_ref().map(|e| (e.projection, e.rotation, e.exposure));
                    let mut environment = Environment::new(file, picture);
                    if let Some(known) = known {
                        (environment.projection, environment.rotation, environment.exposure) = known;
                    }
                    shading.environment = Some(environment);
                }
                Part::Sphere => shading.sphere = Some(LitSphere::new(file, picture)),
                Part::ConcaveSphere => shading.sphere_concave = Some(LitSphere::new(file, picture)),
                Part::Image | Part::Mask | Part::Detail => return None,
            }
            Content::Shading(Live::new(shading))
        }
        _ => return None,
    };
    document.with_layer(layer, |layer| layer.content = content)
}

/// A mask stretched over the canvas: the nearest of its pixels.
fn fitted(mask: &Plane<u8>, canvas: Size) -> Plane<u8> {
    if mask.size() == canvas {
        return mask.clone();
    }
    let scale = Vec2::new(mask.width() as f32 / canvas.width as f32, mask.height() as f32 / canvas.height as f32);
    let along = |v: usize, scale: f32| ((v as f32 + 0.5) * scale) as i32;
    Plane::from_fn(canvas, |x, y| mask.clamped(along(x, scale.x), along(y, scale.y)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mask_of_another_size_covers_the_canvas() {
        let mask = Plane::from_values(Size::new(2, 1), vec![10, 200]).unwrap();
        let fitted = fitted(&mask, Size::new(6, 3));
        assert_eq!((fitted.at(0, 0), fitted.at(2, 2), fitted.at(3, 1), fitted.at(5, 2)), (10, 10, 200, 200));
    }
}
