//! One part of a color that covers several areas becomes a part for each area.
//! Floor 6. Not here: where the areas are (`shape::flats::color_areas`).

use super::{PartRefusal, free_id};
use crate::document::Document;
use crate::document::parts::from_flats::MOST_COLORS;
use crate::document::parts::{Part, PartKind};
use crate::shape::flats::color_areas::SplitAreas;
use std::sync::Arc;

/// The document with a part split. The largest area keeps the part's id and name, and the paint
/// that lies on it; touches and strokes of sculpting go to the area that they are at, and lines
/// and reliefs to all areas.
pub fn split_by_area(document: &Document, part: &Part) -> Result<Document, PartRefusal> {
    let refused = "Only a part that follows a color of a layer everywhere can be split by area.";
    let areas = document.areas_of(part).ok_or(refused)?;
    let points = areas.points();
    match points.len() {
        0 | 1 => return Err("The color of this part is in one area only."),
        n if n > MOST_COLORS => {
            return Err("The color of this part is in too many areas: more than 64.");
        }
        _ => {}
    }
    let upon: Vec<&Arc<Part>> =
        document.parts.list.iter().filter(|other| other.on() == Some(part.id.as_str())).collect();
    let mut made: Vec<Arc<Part>> = Vec::new();
    for (index, point) in points.into_iter().enumerate() {
        let mut own = part.clone();
        own.set_area_point(point);
        if index > 0 {
            own.id = free_id(document, &made);
            own.name = format!("{} {}", part.name, index + 1);
        }
        let id = own.id.clone();
        made.push(Arc::new(own));
        for other in &upon {
            let Some(mut other) = at_area(other, &areas, index) else { continue };
            if index > 0 {
                other.id = free_id(document, &made);
                other.lie_on(&id);
            }
            made.push(Arc::new(other));
        }
    }
    let goes = |other: &Arc<Part>| other.id == part.id || other.on() == Some(part.id.as_str());
    let at = document.parts.list.iter().position(|other| other.id == part.id).unwrap_or(0);
    let mut list: Vec<Arc<Part>> =
        document.parts.list[..at].iter().filter(|other| !goes(other)).cloned().collect();
    list.extend(made);
    list.extend(document.parts.list[at..].iter().filter(|other| !goes(other)).cloned());
    Ok(document.with_parts(list))
}

/// What of a part that lies on the split one is at an area; `None` if nothing is.
fn at_area(part: &Part, areas: &SplitAreas, index: usize) -> Option<Part> {
    let mut own = part.clone();
    let is_left = match &mut own.kind {
        PartKind::Touches { touches, .. } => {
            touches.retain(|touch| areas.nearest(touch.at) == index);
            !touches.is_empty()
        }
        PartKind::Sculpt { strokes, .. } => {
            strokes.retain(|stroke| {
                stroke.samples.first().is_some_and(|(at, _)| areas.nearest(*at) == index)
            });
            !strokes.is_empty()
        }
        _ => true,
    };
    is_left.then_some(own)
}
