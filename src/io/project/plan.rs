//! Plans what other programs see of a document: nested stacks of pictures, as far as the format can
//! express them. Floor 5. It only lists the pictures; `layer_preview` renders them and `stack` writes the
//! XML.
//!
//! OpenRaster has no masks, no clipping, no adjustments, and not every blend mode; Photoshop's
//! format has more. What the format cannot express is composed:
//!
//! * a mask, and clipping to the surface, go into the layer's own picture;
//! * layers clipped to one beneath become a stack with one composed picture, the layers themselves
//!   hidden next to it: also in Photoshop's format, whose clipping Krita does not read and others
//!   do not apply at the edge; there the hidden layers are clipped as here;
//! * an isolated group with a mask becomes one too;
//! * the inside of a frame is the mask of a group around what lies beneath it, if the format has
//!   masks; else the group of the frame becomes one with a composed picture;
//! * where several layers keep to the surface and the format has masks, its edge is the mask of a
//!   group around them, so that it cuts them once;
//! * a layer that changes or reads what is beneath in a way that cannot be expressed (radiance
//!   scaling, exclusion, plus, blending in linear light, a pass-through group with a mask or
//!   opacity) is composed with all that lies beneath it in its scope.

use crate::document::{
    Content, Document, Group, Layer, LayerId, LayerLabel, LayerLock, LayerMask, MaskKind, Role,
};
use crate::math::srgb::Color;
use crate::paint::effect::EffectFill;
use crate::paint::{EffectKind, EffectPlace, LayerEffect};
use crate::raster::{BlendMode, Plane};
use crate::surface::Surface;
use std::sync::Arc;

/// A picture or a stack of pictures, and how it blends with what lies beneath.
pub struct PlanItem {
    pub name: String,
    pub visible: bool,
    pub opacity: f32,
    pub blend: BlendMode,
    pub lock: LayerLock,
    pub label: LayerLabel,
    /// Whether it is clipped to the item beneath, if the format has clipping.
    pub clipped: bool,
    /// A mask that is not part of the pixels, if the format has masks.
    pub mask: Option<LayerMask>,
    /// Effects that are not part of the pixels, if the format has words for them.
    pub effects: Arc<Vec<LayerEffect>>,
    /// The opacity of the fill, where that is not part of the pixels.
    pub fill_opacity: f32,
    /// Its picture covers the surface's rim wholly: a mask around it is the surface's edge.
    pub whole_rim: bool,
    pub shows: ItemContent,
}

/// What a format can express.
#[derive(Clone, Copy)]
pub struct FormatSupport {
    /// Layers clipped to one beneath.
    pub clipping: bool,
    /// Masks that are pictures.
    pub masks: bool,
    /// Whether it has a name for a blend mode that other programs read as we do.
    pub says: fn(BlendMode) -> bool,
    /// Whether it has a word for an adjustment of what lies beneath.
    pub adjusts: fn(&Content) -> bool,
    /// Whether it has words for an effect.
    pub has_effect: fn(&LayerEffect) -> bool,
}

impl FormatSupport {
    pub const OPENRASTER: FormatSupport = FormatSupport {
        clipping: false,
        masks: false,
        says: BlendMode::is_said_by_openraster,
        adjusts: |_| false,
        has_effect: |_| false,
    };
    pub const PHOTOSHOP: FormatSupport = FormatSupport {
        clipping: true,
        masks: true,
        says: BlendMode::is_said_by_photoshop,
        adjusts: |content| matches!(content, Content::Adjustment(live) if live.params().is_said_by_photoshop()),
        has_effect: LayerEffect::is_said_by_photoshop,
    };
}

pub enum ItemContent {
    /// Nothing: the layer has no pixels of its own.
    Nothing(Arc<Layer>),
    /// A layer alone, wholly opaque, its mask in its pixels.
    Layer(Arc<Layer>),
    /// Some layers composed on transparency, in a document where the first layer's opacity and
    /// blend mode are reset.
    Composed { document: Document, layers: Vec<LayerId> },
    /// Bottom first.
    Stack { isolated: bool, items: Vec<PlanItem> },
}

/// The items of a document, bottom first.
pub fn plan(document: &Document, words: FormatSupport) -> Vec<PlanItem> {
    let edge = document.surface.as_deref().filter(|_| words.masks).map(Surface::shares);
    let is_soft = |edge: &Plane<u8>| edge.values().iter().any(|share| (1..255).contains(share));
    let mask =
        |edge| LayerMask::new(MaskKind::File { file: String::new(), coverage: Arc::new(edge) });
    Planner { document, words, edge: edge.filter(is_soft).map(mask) }.scope(&document.layers)
}

/// The name of the group whose mask is the surface's edge.
const ON_SURFACE: &str = "On the surface";

/// The name of the group whose mask is the inside of a frame.
const IN_FRAME: &str = "In the frame";

struct Planner<'a> {
    document: &'a Document,
    words: FormatSupport,
    /// The surface's edge as a mask, if it is soft, the format has masks, and no group around has
    /// it.
    edge: Option<LayerMask>,
}

impl Planner<'_> {
    /// Layers that are composed with each other.
    fn scope(&self, layers: &[Arc<Layer>]) -> Vec<PlanItem> {
        let runs = runs(layers);
        let last = runs.iter().rposition(|run| self.is_composed_with_beneath(run));
        let mut items = Vec::new();
        if let Some(last) = last {
            items.extend(self.plan_composed_with_beneath(&runs[..=last]));
        }
        let above = last.map_or(0, |last| last + 1);
        for runs in runs[above..].chunk_by(|a, b| are_on_surface(a) == are_on_surface(b)) {
            items.extend(
                self.plan_within_edge(runs)
                    .unwrap_or_else(|| runs.iter().flat_map(|run| self.run(run)).collect()),
            );
        }
        items
    }

    /// Runs of layers on the surface in a group whose mask is its edge; `None` where each layer may
    /// as well have the edge itself.
    fn plan_within_edge(&self, runs: &[&[Arc<Layer>]]) -> Option<Vec<PlanItem>> {
        let edge = self.edge.clone().filter(|_| runs.iter().all(|run| are_on_surface(run)))?;
        let bare = Planner { edge: None, ..*self };
        let items: Vec<PlanItem> =
            runs.iter().flat_map(|run| bare.run(run)).map(with_whole_rim).collect();
        // A single picture has its own edge.
        (pictures_seen(&items) > 1).then(|| {
            let shows = ItemContent::Stack { isolated: false, items };
            vec![PlanItem { mask: Some(edge), ..picture(ON_SURFACE.into(), shows) }]
        })
    }

    /// A layer that reads what lies beneath it, and all that lies beneath it, as one picture.
    fn plan_composed_with_beneath(&self, runs: &[&[Arc<Layer>]]) -> [PlanItem; 2] {
        let parts = runs.iter().flat_map(|run| self.run(run)).collect();
        let top = runs.last().and_then(|run| run.first());
        let name = top.map_or(String::new(), |layer| layer.name.clone());
        // Without a base, what is clipped paints nothing.
        let visible =
            runs.iter().filter(|run| run.first().is_some_and(|base| base.visible && is_base(base)));
        let layers = visible
            .flat_map(|run| run.iter())
            .filter(|l| l.visible)
            .map(|layer| layer.id)
            .collect();
        [
            hidden_parts(&name, parts),
            picture(name, ItemContent::Composed { document: self.document.clone(), layers }),
        ]
    }

    /// A layer and those clipped to it.
    fn run(&self, run: &[Arc<Layer>]) -> Vec<PlanItem> {
        let Some((base, rest)) = run.split_first() else { return Vec::new() };
        let is_base = is_base(base);
        let clipped = rest.iter().any(|layer| layer.clip_below && layer.visible);
        if is_base && base.visible && clipped {
            return self.clipping_stack(base, run);
        }
        if let Some(items) = self.plan_clipping(run) {
            return items;
        }
        let mut items: Vec<PlanItem> = run.iter().map(|layer| self.single(layer)).collect();
        for (item, layer) in items.iter_mut().zip(run) {
            // A layer without its clipping base paints nothing.
            item.visible &= !layer.clip_below;
        }
        items
    }

    /// A layer and those clipped to it as the format clips; `None` where it cannot.
    fn plan_clipping(&self, run: &[Arc<Layer>]) -> Option<Vec<PlanItem>> {
        let (base, rest) = run.split_first()?;
        let is_said = |layer: &Arc<Layer>| {
            !layer.clip_below || !layer.visible || self.can_express_blending(layer)
        };
        let can = self.words.clipping
            && is_base(base)
            && base.content.group().is_none()
            && rest.iter().all(is_said);
        let item =
            |layer: &Arc<Layer>| PlanItem { clipped: layer.clip_below, ..self.single(layer) };
        can.then(|| run.iter().map(item).collect())
    }

    fn clipping_stack(&self, base: &Arc<Layer>, run: &[Arc<Layer>]) -> Vec<PlanItem> {
        let single = || run.iter().map(|layer| self.single(layer)).collect();
        let parts = self.plan_clipping(run).unwrap_or_else(single);
        let layers = run.iter().filter(|layer| layer.visible).map(|layer| layer.id).collect();
        let composed = ItemContent::Composed { document: self.plain(base.id), layers };
        if self.words.clipping {
            // No group around both: some programs take a group of such a file for opaque.
            return vec![
                hidden_parts(&base.name, parts),
                PlanItem { shows: composed, ..without_effects(item(base)) },
            ];
        }
        let items = vec![hidden_parts(&base.name, parts), picture(base.name.clone(), composed)];
        let shows = ItemContent::Stack { isolated: true, items };
        vec![PlanItem { shows, ..without_effects(item(base)) }]
    }

    /// The document with one layer's opacity and blend mode reset.
    fn plain(&self, id: LayerId) -> Document {
        let plain = self.document.with_layer(id, |layer| {
            (layer.opacity, layer.blend, layer.blend_linear) = (1.0, BlendMode::Normal, false);
        });
        plain.unwrap_or_else(|| self.document.clone())
    }

    fn single(&self, layer: &Arc<Layer>) -> PlanItem {
        let shows = match layer.content.role() {
            Role::Adjusts(_) | Role::Shapes(_) => ItemContent::Nothing(layer.clone()),
            Role::Groups(group) => return self.group(layer, group),
            Role::Paints => ItemContent::Layer(layer.clone()),
        };
        let mask = layer.mask.clone().filter(|mask| self.has_word_for(mask));
        self.with_word_for_effects(layer, PlanItem { shows, mask, ..item(layer) })
    }

    /// An item with its effects in its pixels, where the format has no words for them.
    fn with_word_for_effects(&self, layer: &Layer, item: PlanItem) -> PlanItem {
        if self.has_words_for_effects(layer) { item } else { without_effects(item) }
    }

    fn has_words_for_effects(&self, layer: &Layer) -> bool {
        let all_said = layer.effects.iter().all(|effect| (self.words.has_effect)(effect));
        all_said && (self.words.clipping || (layer.effects.is_empty() && layer.fill_opacity >= 1.0))
    }

    /// Whether a layer looks the same with its effects in its pixels.
    fn can_hold_effects(&self, layer: &Layer) -> bool {
        let shown = layer.shown_effects();
        // Black that is multiplied is black that covers.
        let is_plain = |effect: &LayerEffect| {
            let s = &effect.settings;
            let is_black = s.blend == BlendMode::Multiply && s.color == Color::BLACK;
            effect.kind != EffectKind::Bevel
                && (s.blend == BlendMode::Normal
                    || (is_black && effect.fill() == EffectFill::Color))
        };
        let is_alone = |effect: &LayerEffect| {
            effect.place() == EffectPlace::Within && layer.fill_opacity >= 1.0 || is_plain(effect)
        };
        shown.iter().all(is_alone)
            && (layer.blend == BlendMode::Normal
                || layer.fill_opacity >= 1.0
                    && shown.iter().all(|effect| effect.place() == EffectPlace::Within))
    }

    fn has_word_for(&self, mask: &LayerMask) -> bool {
        self.words.masks && matches!(mask.kind, MaskKind::File { .. })
    }

    fn group(&self, layer: &Arc<Layer>, group: &Group) -> PlanItem {
        let is_said = !group.pass_through && self.can_express_frame(group);
        let parts = match group.frames().next().filter(|_| is_said) {
            Some(frame) => self.plan_framed(group, frame),
            None => self.scope(&group.layers),
        };
        if group.pass_through {
            let shows = ItemContent::Stack { isolated: false, items: parts };
            let own = self.with_word_for_effects(layer, item(layer));
            return PlanItem { opacity: 1.0, blend: BlendMode::Normal, shows, ..own };
        }
        let is_baked = !self.has_words_for_effects(layer) || !is_said;
        let mask = layer.mask.clone().filter(|mask| self.has_word_for(mask));
        let items = match &layer.mask {
            _ if mask.is_some() && !is_baked => parts,
            None if !is_baked => parts,
            _ => {
                let composed = ItemContent::Composed {
                    document: self.plain(layer.id),
                    layers: vec![layer.id],
                };
                vec![hidden_parts(&layer.name, parts), picture(layer.name.clone(), composed)]
            }
        };
        let mask = mask.filter(|_| !is_baked);
        let own = if is_baked { without_effects(item(layer)) } else { item(layer) };
        PlanItem { shows: ItemContent::Stack { isolated: true, items }, mask, ..own }
    }

    /// The layers of a group whose frame is the mask of what lies beneath it.
    fn plan_framed(&self, group: &Group, frame: usize) -> Vec<PlanItem> {
        let (beneath, above) = group.layers.split_at(frame);
        let inside = above.first().and_then(|layer| self.document.inside_of_frame(layer.id));
        let mask = inside.map(|inside| {
            let coverage = Arc::new(inside.to_plane(self.document.size.rect()));
            LayerMask::new(MaskKind::File { file: String::new(), coverage })
        });
        let shows = ItemContent::Stack { isolated: true, items: self.scope(beneath) };
        let framed = PlanItem { mask, ..picture(IN_FRAME.into(), shows) };
        [framed].into_iter().chain(self.scope(above)).collect()
    }

    /// Whether the format can express the frames of a group.
    fn can_express_frame(&self, group: &Group) -> bool {
        let mut frames = group.frames();
        let Some(frame) = frames.next() else { return true };
        let above = runs(&group.layers[frame..]);
        self.words.masks
            && frames.next().is_none()
            && !above.iter().any(|run| self.is_composed_with_beneath(run))
    }

    /// A visible run that cannot be shown without composing it with what lies beneath.
    fn is_composed_with_beneath(&self, run: &[Arc<Layer>]) -> bool {
        let Some((base, rest)) = run.split_first() else { return false };
        if !base.visible || base.clip_below {
            return false;
        }
        let clips = rest.iter().any(|layer| layer.clip_below && layer.visible);
        match base.content.role() {
            Role::Adjusts(_) => clips || !self.can_express_adjustment(base),
            Role::Shapes(_) => false,
            Role::Groups(group) if group.pass_through && !clips => {
                let is_faded =
                    base.opacity < 1.0 || base.mask.is_some() || group.frames().next().is_some();
                let is_baked = !self.has_words_for_effects(base);
                is_faded
                    || is_baked
                    || runs(&group.layers).iter().any(|run| self.is_composed_with_beneath(run))
            }
            role => {
                let is_said =
                    !matches!(role, Role::Groups(group) if !self.can_express_frame(group));
                let is_baked = clips || !is_said || !self.has_words_for_effects(base);
                !self.can_express_blending(base) || (is_baked && !self.can_hold_effects(base))
            }
        }
    }

    /// Whether the format can express an adjustment, with its mask, on all that lies beneath it.
    fn can_express_adjustment(&self, layer: &Layer) -> bool {
        let is_cut = layer.clip_to_surface && self.document.surface.is_some();
        (self.words.adjusts)(&layer.content)
            && !is_cut
            && !layer.blend_linear
            && (self.words.says)(layer.blend)
            && layer.mask.as_ref().is_none_or(|mask| self.has_word_for(mask))
    }

    fn can_express_blending(&self, layer: &Layer) -> bool {
        !layer.blend_linear
            && (self.words.says)(layer.blend)
            && (self.has_words_for_effects(layer) || self.can_hold_effects(layer))
            && (!matches!(layer.content.role(), Role::Adjusts(_))
                || self.can_express_adjustment(layer))
    }
}

/// These layers show nothing beyond the surface.
fn are_on_surface(layers: &[Arc<Layer>]) -> bool {
    layers.iter().all(|layer| match layer.content.role() {
        Role::Groups(group) => are_on_surface(&group.layers),
        Role::Paints => layer.clip_to_surface && !layer.content.is_shown_off_surface(),
        Role::Adjusts(_) => layer.clip_to_surface,
        Role::Shapes(_) => true,
    })
}

fn with_whole_rim(item: PlanItem) -> PlanItem {
    let shows = match item.shows {
        ItemContent::Stack { isolated, items } => {
            ItemContent::Stack { isolated, items: items.into_iter().map(with_whole_rim).collect() }
        }
        shows => shows,
    };
    PlanItem { whole_rim: true, shows, ..item }
}

fn pictures_seen(items: &[PlanItem]) -> usize {
    let of_item = |item: &PlanItem| match &item.shows {
        ItemContent::Stack { items, .. } => pictures_seen(items),
        ItemContent::Layer(_) | ItemContent::Composed { .. } => 1,
        ItemContent::Nothing(_) => 0,
    };
    items.iter().filter(|item| item.visible).map(of_item).sum()
}

/// Whether layers above may be clipped to it; normal layers do not interrupt clipping.
fn is_base(layer: &Layer) -> bool {
    !layer.clip_below && !layer.content.is_shaping_surface()
}

/// The layers, split before each base: a layer that is neither clipped nor a normal layer.
fn runs(layers: &[Arc<Layer>]) -> Vec<&[Arc<Layer>]> {
    let mut runs = Vec::new();
    let mut start = 0;
    for i in 1..=layers.len() {
        if i == layers.len() || is_base(&layers[i]) {
            runs.push(&layers[start..i]);
            start = i;
        }
    }
    runs
}

fn item(layer: &Layer) -> PlanItem {
    PlanItem {
        name: layer.name.clone(),
        visible: layer.visible,
        opacity: layer.opacity,
        blend: layer.blend,
        lock: layer.lock,
        label: layer.label,
        clipped: false,
        mask: None,
        effects: layer.effects.clone(),
        fill_opacity: layer.fill_opacity,
        whole_rim: false,
        shows: ItemContent::Stack { isolated: true, items: Vec::new() },
    }
}

fn picture(name: String, shows: ItemContent) -> PlanItem {
    PlanItem {
        name,
        visible: true,
        opacity: 1.0,
        blend: BlendMode::Normal,
        lock: LayerLock::None,
        label: LayerLabel::None,
        clipped: false,
        mask: None,
        effects: Arc::default(),
        fill_opacity: 1.0,
        whole_rim: false,
        shows,
    }
}

/// The same with its effects in its pixels.
fn without_effects(item: PlanItem) -> PlanItem {
    PlanItem { effects: Arc::default(), fill_opacity: 1.0, ..item }
}

/// The layers that a composed picture shows, themselves hidden.
fn hidden_parts(name: &str, items: Vec<PlanItem>) -> PlanItem {
    let shows = ItemContent::Stack { isolated: true, items };
    PlanItem { visible: false, ..picture(format!("{name} (parts)"), shows) }
}

#[cfg(test)]
mod tests;
