//! Selections that a file can hold. Floor 4.

use super::Fit;
use crate::document::{Document, NamedSelection, SelectionList};
use crate::math::range::{at_most, check_range};
use crate::math::{COORDINATE, Size};
use crate::paint::Selection;
use crate::raster::Picture;
use crate::surface::region::SurfaceRegion;
use std::collections::HashSet;
use std::sync::Arc;

/// The most values that a selection takes in a description.
pub const A_SELECTION: usize = 40;

/// The selections of a document that another does not hold, and their number.
pub fn fit(document: &Document, before: Option<&Document>) -> Fit {
    let list = SelectionList::of(document);
    if list.is_empty() {
        return Ok(());
    }
    at_most("Selections", list.all().len(), Document::MOST_SELECTIONS)
        .map_err(|why| format!("{why}."))?;
    let regions = list.all().filter(|selection| selection.made.is_some()).count();
    let most = Document::MOST_REGION_PX / document.size.area().max(1) as u64;
    at_most(
        "Selections that follow the surface",
        regions,
        usize::try_from(most).unwrap_or(usize::MAX).max(1),
    )
    .map_err(|why| format!("{why}."))?;
    let mut known = HashSet::new();
    if let Some(before) = before {
        known.extend(SelectionList::of(before).all().map(Arc::as_ptr));
    }
    let mut names = HashSet::new();
    for (name, selection) in list.iter_with_names() {
        if let Some(name) = name {
            let letters = at_most(
                "letters of a selection's name",
                name.chars().count(),
                NamedSelection::LONGEST_NAME,
            );
            letters.map_err(|why| format!("{why}."))?;
            if name.is_empty() || !names.insert(name) {
                return Err(format!(
                    "Two selections would be called “{name}”, or one would have no name."
                ));
            }
        }
        if !known.contains(&Arc::as_ptr(selection)) {
            check_selection(selection, document.size)
                .map_err(|why| format!("The selection: {why}."))?;
        }
    }
    Ok(())
}

fn check_selection(selection: &Selection, canvas: Size) -> Fit {
    if let Some(from_region) = &selection.made {
        return region(from_region);
    }
    let rect = selection.coverage.covered_rect();
    [rect.x0, rect.y0, rect.x1, rect.y1]
        .iter()
        .try_for_each(|v| check_range("its place", *v as f32, &COORDINATE))?;
    let side = Picture::LONGEST_SIDE_PX.max(canvas.width).max(canvas.height) as usize;
    let (width, height) = (rect.width(), rect.height());
    if width.max(height) > side || width * height > Picture::MOST_PX.max(canvas.area()) {
        return Err(format!("it has {width} × {height} px, more than a picture can hold"));
    }
    Ok(())
}

pub fn region(region: &SurfaceRegion) -> Fit {
    check_range("the point of a region", region.at.x, &COORDINATE)?;
    check_range("the point of a region", region.at.y, &COORDINATE)?;
    check_range("the tolerance of a region", region.tolerance, &region.kind.tolerances())?;
    check_range("the softness of a region", region.softness, &SurfaceRegion::SOFTNESS)
}
