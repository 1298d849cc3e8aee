//! A document in a recovery log: small JSON after every edit, and each large part once, by key.
//! Floor 5. The schema is that of recipes; tiles, strokes and files are replaced by keys of blobs.

use super::DrawingVersion;
use super::log::{self, RecordKind};
use crate::document::{Content, Document, Layer, Live, PixelLayer, SelectionList, StrokeList};
use crate::math::{ColorProfile, Size};
use crate::paint::Stroke;
use crate::pixels;
use crate::project::assets::{AssetList, MadeFiles, StoredPixels};
use crate::raster::{Asset, TILE, Tile, TileAt, TileGrid};
use crate::recipe::{self, RecipeSource, TileGrids};
use crate::{Budget, Files, picture};
use crate::{Error, Result};
use serde_json::{Map, Value, json};
use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// What a log already holds, by address in memory; kept alive, so that no address is reused.
#[derive(Default)]
pub struct LoggedParts {
    keys: HashMap<usize, (u64, LoggedPart)>,
    next: u64,
    made: MadeFiles,
}

#[derive(Clone)]
enum LoggedPart {
    Tile { _tile: Arc<Tile> },
    Stroke { _stroke: Arc<Stroke> },
    Asset { _asset: Asset },
}

/// Appends what a document needs and the log does not hold yet, then the document itself.
///
/// It also fails when the log was given up; after a failure neither `known` nor the appended bytes
/// are usable.
pub fn write(
    file: &Path,
    version: &DrawingVersion,
    known: &mut LoggedParts,
    out: &mut Vec<u8>,
    given_up: &AtomicBool,
) -> Result<()> {
    let DrawingVersion { document, aside } = version;
    let (pixels, shared) = (BTreeMap::new(), BTreeMap::new());
    let mut assets = AssetList::continue_from(std::mem::take(&mut known.made));
    let renamed =
        assets.rename(file, document, &StoredPixels { pixels: &pixels, shared: &shared })?;
    let bare = Document {
        layers: renamed.layers.iter().map(without_large_parts).collect(),
        ..renamed.clone()
    };
    let list = SelectionList::of(document);
    let mut writer = StateWriter { file, list: &list, known, used: HashMap::new(), out, given_up };
    let mut value = recipe::write_naming(&bare, &list);
    writer.layers(&renamed.layers, &mut value)?;
    let mut files = Map::new();
    for (name, asset) in assets.files() {
        let held = LoggedPart::Asset { _asset: asset.clone() };
        let key = writer.key(asset.address(), held, || Ok(asset.bytes().to_vec()))?;
        files.insert(name.clone(), key.into());
    }
    let used = std::mem::take(&mut writer.used);
    let state = json!({ "document": value, "files": files, "aside": aside }).to_string();
    if !log::push(out, RecordKind::State, &[state.as_bytes()]) {
        return Err(Error::too_large(file, "the document's description has more than 4 GiB"));
    }
    // Parts that the document no longer has may be freed; if one comes back, it is written again.
    (known.keys, known.made) = (used, assets.into_made());
    Ok(())
}

/// A layer without what stands in blobs.
fn without_large_parts(layer: &Arc<Layer>) -> Arc<Layer> {
    let mut next = Layer::clone(layer);
    match &mut next.content {
        Content::Strokes(live) => *live = Live::new(StrokeList::default()),
        Content::Pixels(pixels) => *pixels = PixelLayer { file: String::new(), ..pixels.clone() },
        Content::Group(group) => {
            group.layers = group.layers.iter().map(without_large_parts).collect()
        }
        _ => {}
    }
    Arc::new(next)
}

struct StateWriter<'a> {
    file: &'a Path,
    list: &'a SelectionList,
    known: &'a mut LoggedParts,
    used: HashMap<usize, (u64, LoggedPart)>,
    out: &'a mut Vec<u8>,
    given_up: &'a AtomicBool,
}

impl StateWriter<'_> {
    /// Puts keys in the places of tiles and strokes; `value` holds `layers` as JSON.
    fn layers(&mut self, layers: &[Arc<Layer>], value: &mut Value) -> Result<()> {
        for (i, layer) in layers.iter().enumerate() {
            let Some(value) = value.get_mut("layers").and_then(|layers| layers.get_mut(i)) else {
                continue;
            };
            match &layer.content {
                Content::Group(group) => self.layers(&group.layers, value)?,
                Content::Pixels(pixels) => value["tiles"] = self.tiles(&pixels.tiles)?,
                Content::Strokes(live) => {
                    let strokes = live.params().strokes.iter().map(|stroke| self.stroke(stroke));
                    value["strokes"] = strokes.collect::<Result<Value>>()?;
                }
                _ => {}
            }
        }
        Ok(())
    }

    fn tiles(&mut self, tiles: &TileGrid) -> Result<Value> {
        let file = self.file;
        let one = |(at, tile): (TileAt, &Arc<Tile>)| {
            let held = LoggedPart::Tile { _tile: tile.clone() };
            let key = self.key(Arc::as_ptr(tile) as usize, held, || encode_tile(file, at, tile))?;
            Ok(json!([at.col, at.row, key]))
        };
        tiles.iter().map(one).collect()
    }

    fn stroke(&mut self, stroke: &Arc<Stroke>) -> Result<Value> {
        let held = LoggedPart::Stroke { _stroke: stroke.clone() };
        let bytes = || Ok(recipe::write_stroke(stroke).to_string().into_bytes());
        let key = self.key(Arc::as_ptr(stroke) as usize, held, bytes)?;
        // The ids of selections are those of this version of the document; the blob stays.
        let selection = recipe::write_of_stroke(stroke, self.list);
        Ok(if selection.is_empty() {
            key.into()
        } else {
            recipe::with_selection(json!({ "stroke": key }), &selection)
        })
    }

    /// The key of a part in memory; its bytes are written if the log does not have them yet.
    fn key(
        &mut self,
        address: usize,
        held: LoggedPart,
        bytes: impl FnOnce() -> Result<Vec<u8>>,
    ) -> Result<u64> {
        if let Some((key, _)) = self.used.get(&address) {
            return Ok(*key);
        }
        let key = match self.known.keys.get(&address) {
            Some((key, _)) => *key,
            None => {
                if self.given_up.load(Ordering::Relaxed) {
                    return Err(Error::unsupported_file(
                        self.file,
                        "the drawing was closed in the meantime",
                    ));
                }
                let key = self.known.next;
                self.known.next += 1;
                if !log::push(self.out, RecordKind::Blob, &[&key.to_le_bytes(), &bytes()?]) {
                    return Err(Error::too_large(
                        self.file,
                        "a part of the drawing has more than 4 GiB",
                    ));
                }
                key
            }
        };
        self.used.insert(address, (key, held));
        Ok(key)
    }
}

fn encode_tile(file: &Path, at: TileAt, tile: &Arc<Tile>) -> Result<Vec<u8>> {
    let mut alone = TileGrid::default();
    alone.set(at, Some(tile.clone()));
    Ok(pixels::encode_rect(file, &alone, at.rect(), ColorProfile::Srgb)?.bytes().to_vec())
}

/// The last document in a log; `None` where there is none.
pub struct LastState<'a> {
    /// The latest head: whose drawing it is.
    pub head: Option<Value>,
    /// The number of versions in the log, the first being the document as it was opened.
    pub states: usize,
    state: Option<&'a [u8]>,
    blobs: HashMap<u64, &'a [u8]>,
}

impl<'a> LastState<'a> {
    pub fn of(log: &'a [u8]) -> Self {
        let mut last = LastState { head: None, states: 0, state: None, blobs: HashMap::new() };
        for (kind, payload) in log::records(log) {
            match kind {
                RecordKind::Head | RecordKind::Saved => {
                    last.head = serde_json::from_slice(payload).ok().or(last.head)
                }
                RecordKind::State => (last.state, last.states) = (Some(payload), last.states + 1),
                RecordKind::Blob => {
                    if let Some((key, bytes)) = payload.split_first_chunk() {
                        last.blobs.insert(u64::from_le_bytes(*key), bytes);
                    }
                }
            }
        }
        last
    }

    /// The drawing, to be reshaped: parts are made from the pixels that are put into its layers
    /// here. `None` where the log holds none.
    pub fn version(&self, file: &Path, budget: &Budget) -> Result<Option<DrawingVersion>> {
        let Some(state) = self.state else { return Ok(None) };
        let mut state = crate::json::parse(file, state, budget)?;
        let mut tiles = Vec::new();
        self.fill_in(file, budget, &mut state["document"], ("", &mut tiles))?;
        let document = state["document"].take();
        let blobs = BlobFiles { file, names: &state["files"], last: self };
        let source = RecipeSource { file, files: &blobs, budget, onto: None };
        let (mut document, _) = recipe::read_unshaped(&document, source, TileGrids::new())?;
        for (path, grid) in tiles {
            let id = document
                .walk()
                .into_iter()
                .find(|(known, _)| *known == path)
                .map(|(_, layer)| layer.id);
            let put = |layer: &mut Layer| {
                if let Content::Pixels(pixels) = &mut layer.content {
                    pixels.tiles = grid;
                }
            };
            document = id.and_then(|id| document.with_layer(id, put)).unwrap_or(document);
        }
        Ok(Some(DrawingVersion { document, aside: state["aside"].take() }))
    }

    /// Puts strokes back in the places of their keys, and takes the tiles out, by the paths of
    /// their layers.
    fn fill_in(
        &self,
        file: &Path,
        budget: &Budget,
        value: &mut Value,
        (prefix, out): (&str, &mut Vec<(String, TileGrid)>),
    ) -> Result<()> {
        for (i, layer) in value["layers"].as_array_mut().into_iter().flatten().enumerate() {
            let path = format!("{prefix}layers[{i}]");
            if layer.get("layers").is_some() {
                self.fill_in(file, budget, layer, (&format!("{path}."), &mut *out))?;
            }
            if let Some(keys) = layer.get_mut("strokes").and_then(Value::as_array_mut) {
                for key in keys {
                    let mut stored = key.take();
                    let blob =
                        stored.as_object_mut().and_then(|stored| stored.shift_remove("stroke"));
                    *key = recipe::parse(
                        file,
                        self.blob(file, blob.as_ref().unwrap_or(&stored))?,
                        budget,
                    )?;
                    if let (Value::Object(stroke), Value::Object(stored)) = (&mut *key, stored) {
                        stroke.extend(stored);
                    }
                }
            }
            let tiles = layer.as_object_mut().and_then(|layer| layer.shift_remove("tiles"));
            if let Some(Value::Array(tiles)) = tiles {
                out.push((path, self.grid(file, &tiles)?));
            }
        }
        Ok(())
    }

    fn grid(&self, file: &Path, tiles: &[Value]) -> Result<TileGrid> {
        let mut grid = TileGrid::default();
        for tile in tiles {
            let side = |i: usize| {
                tile[i].as_i64().and_then(|n| i32::try_from(n).ok()).filter(|n| n.abs() < 1 << 14)
            };
            let (Some(col), Some(row)) = (side(0), side(1)) else {
                return Err(Error::decode(file, "a tile of the drawing has no place"));
            };
            let at = TileAt::new(col, row);
            let picture = picture::decode(file, self.blob(file, &tile[2])?, &Budget::default())?;
            let is_tile = picture.size == Size::new(TILE as u32, TILE as u32);
            if is_tile {
                let one = picture::to_tiles(&picture, at.rect().x0, at.rect().y0);
                grid.set(at, one.tile(at).cloned());
            }
        }
        Ok(grid)
    }

    fn blob(&self, file: &Path, key: &Value) -> Result<&'a [u8]> {
        let found = key.as_u64().and_then(|key| self.blobs.get(&key).copied());
        found.ok_or_else(|| Error::decode(file, "a part of the drawing is missing"))
    }
}

/// The files of a document by their names in its state.
struct BlobFiles<'a> {
    file: &'a Path,
    names: &'a Value,
    last: &'a LastState<'a>,
}

impl Files for BlobFiles<'_> {
    fn read(&self, name: &str, budget: &Budget) -> Result<Vec<u8>> {
        let bytes = self.last.blob(&self.path(name), &self.names[name])?;
        if bytes.len() as u64 > budget.file_bytes {
            return Err(Error::too_large(
                self.path(name),
                format!("it has more than {} bytes", budget.file_bytes),
            ));
        }
        Ok(bytes.to_vec())
    }

    fn path(&self, name: &str) -> PathBuf {
        self.file.join(name)
    }
}
