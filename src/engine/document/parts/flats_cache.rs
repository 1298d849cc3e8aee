//! What was found in the flats that parts are made of, kept while they are made: many parts ask for
//! one picture. Floor 4.

use super::Parts;
use crate::math::srgb::Color;
use crate::raster::TileGrid;
use crate::shape::flats::color_areas::ColorAreas;
use crate::shape::flats::picture::FlatReading;
use crate::shape::flats::shares::Flats;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Areas of more pixels together than this are not kept.
const MOST_KEPT_PX: usize = 1 << 25;

/// The flats of one picture.
pub struct CachedFlats {
    pub flats: Flats,
    tiles: TileGrid,
    asked: Vec<Color>,
    areas: Mutex<Vec<(Color, Arc<ColorAreas>)>>,
}

/// The last that were asked for.
#[derive(Default)]
pub struct FlatsCache {
    flats: Mutex<Option<Arc<CachedFlats>>>,
    /// The picture that was read last: ink is lifted off what parts are made of.
    reading: Mutex<Option<(TileGrid, FlatReading)>>,
}

fn lock<T>(value: &Mutex<T>) -> MutexGuard<'_, T> {
    value.lock().unwrap_or_else(PoisonError::into_inner)
}

impl CachedFlats {
    /// The areas of a color.
    pub fn areas_of(&self, color: Color) -> Arc<ColorAreas> {
        let known =
            lock(&self.areas).iter().find(|(of, _)| *of == color).map(|(_, areas)| areas.clone());
        known.unwrap_or_else(|| {
            let found = Arc::new(ColorAreas::of(&self.flats, color));
            let mut areas = lock(&self.areas);
            if areas.iter().map(|(_, areas)| areas.pixels_held()).sum::<usize>()
                + found.pixels_held()
                > MOST_KEPT_PX
            {
                areas.clear();
            }
            areas.push((color, found.clone()));
            found
        })
    }
}

impl Parts {
    /// The flats of a picture, `None` if it is empty; `asked`: colors that are looked for however
    /// small their areas are.
    pub(super) fn flats_of(&self, tiles: &TileGrid, asked: &[Color]) -> Option<Arc<CachedFlats>> {
        let last = &self.cache.flats.flats;
        let known =
            lock(last).clone().filter(|known| known.tiles.ptr_eq(tiles) && known.asked == asked);
        known.or_else(|| {
            // What is no longer needed is let go of first.
            *lock(last) = None;
            let flats = Flats::of_reading(&self.reading_of(tiles)?, asked);
            let known = CachedFlats {
                flats,
                tiles: tiles.clone(),
                asked: asked.to_vec(),
                areas: Mutex::default(),
            };
            Some(lock(last).insert(Arc::new(known)).clone())
        })
    }

    /// What is found in a picture, whatever colors are asked for; `None` if it is empty.
    pub(in crate::document) fn reading_of(&self, tiles: &TileGrid) -> Option<FlatReading> {
        let mut last = lock(&self.cache.flats.reading);
        if let Some((_, reading)) = last.as_ref().filter(|(known, _)| known.ptr_eq(tiles)) {
            return Some(reading.clone());
        }
        *last = None;
        drop(last);
        let rect = tiles.bounds();
        let reading = (!rect.is_empty()).then(|| FlatReading::of(tiles, rect))?;
        *lock(&self.cache.flats.reading) = Some((tiles.clone(), reading.clone()));
        Some(reading)
    }

    /// Drops them: they are large, and an edit of the picture needs others.
    pub(super) fn forget_flats(&self) {
        *lock(&self.cache.flats.flats) = None;
        *lock(&self.cache.flats.reading) = None;
    }
}
