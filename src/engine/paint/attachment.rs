//! Attachments: marks have their coordinates on the canvas or on a part of the document's shape,
//! which carries them where it goes. Floor 3. Parts themselves are `document::parts`;
//! `document::layer` combines attachments with the transforms of layers.

use crate::math::{Affine2, PlaneMap};
use std::sync::Arc;

/// The part that marks lie on, and where it is.
#[derive(Clone, Debug, PartialEq)]
pub struct Attachment {
    /// The id of the part, or [`Attachment::CANVAS`].
    pub part: Arc<str>,
    /// Canvas from part at its current position: resolved again whenever the document is shaped.
    pub matrix: Affine2,
}

impl Attachment {
    /// The name of the canvas as an attachment in documents. No part has this id.
    pub const CANVAS: &'static str = "canvas";

    /// On a part whose position is not known yet.
    pub fn on(part: &str) -> Self {
        Self { part: part.into(), matrix: Affine2::IDENTITY }
    }

    /// On the canvas itself, whatever is around.
    pub fn canvas() -> Self {
        Self::on(Self::CANVAS)
    }

    /// It is the canvas itself.
    pub fn is_canvas(&self) -> bool {
        &*self.part == Self::CANVAS
    }

    /// The part's id; `None` for the canvas.
    pub fn part(&self) -> Option<&str> {
        Some(&*self.part).filter(|_| !self.is_canvas())
    }

    /// Canvas from part; a matrix without area moves nothing.
    pub fn map(&self) -> PlaneMap {
        PlaneMap::affine(self.matrix.to_cols_array().map(f64::from)).unwrap_or_default()
    }
}

/// The attachment of a stroke that differs from its layer's.
#[derive(Clone, Debug, PartialEq)]
pub struct StrokeAttachment {
    /// What carries the stroke.
    pub frame: Attachment,
    /// Where the stroke's own frame lies within its layer's: a, b, c, d, e, f as in a layer's
    /// transform.
    pub own: [f64; 6],
}

impl StrokeAttachment {
    /// The map of an attachment that has not moved.
    pub const UNMOVED: [f64; 6] = [1.0, 0.0, 0.0, 1.0, 0.0, 0.0];

    /// A stroke on something that has not moved since.
    pub fn new(frame: Attachment) -> Self {
        Self { frame, own: Self::UNMOVED }
    }

    /// The stroke's own frame within its layer's.
    pub fn own_map(&self) -> PlaneMap {
        PlaneMap::affine(self.own).unwrap_or_default()
    }
}
