//! The pictures that layers are made of. Floor 6. Not here: reading them (`actions::pictures`).

use super::replay::names;

rilievo_engine::named! {
    /// The part of a layer that is a picture. The label is the title of a file dialog for it.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum PicturePart {
        /// What a placed image shows.
        Image = "image" => "Picture of the layer",
        Mask = "mask" => "Mask of the layer",
        Environment = "environment" => "Environment",
        /// The lit sphere; for convex features if there is a concave one.
        Sphere = "sphere" => "Painted ball",
        ConcaveSphere = "concave sphere" => "Painted ball for hollows",
        /// The normals of a normal layer.
        Detail = "detail" => "Detail normals",
    }
}

names!(PicturePart);

impl PicturePart {
    /// The name of the step that puts one there.
    pub fn step(self) -> &'static str {
        match self {
            PicturePart::Image => "Replace picture",
            PicturePart::Mask => "Layer mask",
            PicturePart::Environment => "Environment",
            PicturePart::Sphere | PicturePart::ConcaveSphere => "Painted ball",
            PicturePart::Detail => "Detail normals",
        }
    }
}
