//! Flats: drawings in flat colors, which areas they have, and whose pixels are whose. Floor 3. Not
//! here: how parts are made of them (`document::parts::from_flats`).
//!
//! `shares` says what each pixel is of: `picture` reads areas and mixed pixels, `palette` finds the
//! colors, `ink` takes lines out, and `complete` gives what is left to the areas beside it.
//! `lifted_ink` takes the lines off the picture, `area_names` gives areas names. `color_areas` tells the
//! areas of one color apart, `beneath` continues them under nearer ones;
//! `areas` has walks over pixels, and `color_distance` says which colors are one.

pub mod area_names;
pub mod areas;
pub mod beneath;
pub mod color_areas;
pub mod color_distance;
mod complete;
pub mod ink;
pub mod lifted_ink;
pub mod palette;
pub mod picture;
pub mod shares;
mod thin_ink;
