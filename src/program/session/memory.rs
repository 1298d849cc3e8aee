//! The memory that the open documents take, and its limit. Floor 6. Not here: the counting
//! (`document::memory_use`).

use super::Session;
use crate::document::{Document, MemoryCount, MemoryUse};

/// The open documents with their histories, to be counted on a thread of their own.
pub struct HeldDocuments {
    /// The one in front, its history with the nearest steps first, and then the others in the same
    /// way.
    presents: Vec<Document>,
    pasts: Vec<Vec<Document>>,
}

/// What was counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DocumentMemory {
    /// The document in front with its history.
    pub front: MemoryUse,
    /// All that are open.
    pub all: MemoryUse,
}

impl Session {
    /// What there is to count; nothing if no document is open.
    pub fn held_documents(&self) -> Option<HeldDocuments> {
        let front = self.active()?;
        let others = self.open_documents.iter().filter(|open| open.key != front.key);
        let in_order: Vec<_> = std::iter::once(front).chain(others).collect();
        Some(HeldDocuments {
            presents: in_order.iter().map(|open| open.shown_document().clone()).collect(),
            pasts: in_order
                .iter()
                .map(|open| {
                    let steps = std::iter::once(open.document()).chain(open.history.others());
                    // The history may have dropped what the file holds.
                    steps.chain([open.saved_document()]).cloned().collect()
                })
                .collect(),
        })
    }
}

impl HeldDocuments {
    /// Counts them. Once they keep more than `limit` bytes for speed, steps of the history free
    /// what they keep: the farthest first, and those of the document in front last.
    pub fn count(&self, limit: u64) -> DocumentMemory {
        let mut count = MemoryCount::default();
        let Some((front, others)) = self.presents.split_first() else {
            return DocumentMemory::default();
        };
        let mut add = |document: &Document, is_shown: bool| {
            let before = count.sum_up();
            let keeps = is_shown || before.kept < limit;
            count.add(document, keeps);
            count.sum_up().minus(before)
        };
        let mut of_front = add(front, true);
        for document in others {
            add(document, true);
        }
        for (i, past) in self.pasts.iter().enumerate() {
            for document in past {
                let more = add(document, false);
                if i == 0 {
                    of_front = of_front.plus(more);
                }
            }
        }
        DocumentMemory { front: of_front, all: count.sum_up() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::{Content, History, Layer, Live, Progress, flatten};
    use crate::math::{Size, srgb::Color, vec2};
    use crate::paint::{Gradient, GradientStop, ImageFilter};
    use crate::session::OpenDocument;
    use crate::surface::Operator;
    use std::sync::Arc;

    /// A gradient over the canvas that begins here.
    fn gradient(x: f32) -> Content {
        let stop = |t: f32, color| GradientStop { t, color };
        Content::Gradient(Live::new(Gradient {
            from: vec2(x, 0.0),
            to: vec2(200.0, 100.0),
            stops: vec![stop(0.0, Color::BLACK), stop(1.0, Color::WHITE)],
            operator: Operator::None,
            filter: ImageFilter::Antialias,
            frame: Default::default(),
            style: Default::default(),
            pieces: Vec::new(),
        }))
    }

    /// A session whose gradient was dragged so often, each time rendered whole.
    fn dragged(times: usize) -> Session {
        let mut session = Session::default();
        let size = Size::new(256, 128);
        let layer = Layer::new("ramp", gradient(0.0));
        let id = layer.id;
        let document = Document { layers: vec![Arc::new(layer)], ..Document::empty(size) };
        flatten(&document, &Progress::default()).unwrap();
        let mut open = OpenDocument::new("ramp", document, None);
        for i in 1..=times {
            let next =
                open.document().with_layer(id, |layer| layer.content = gradient(i as f32)).unwrap();
            flatten(&next, &Progress::default()).unwrap();
            open.commit("Drag", next);
        }
        session.open_documents.push(open);
        session.current = session.open_documents.len() - 1;
        session
    }
    /// Eight tiles of 64 × 64 pixels of four bytes.
    const RENDERED: u64 = 8 * 64 * 64 * 4;

    #[test]
    fn every_step_is_counted_once_with_what_it_was_rendered_to() {
        let session = dragged(5);
        let held = session.held_documents().unwrap();
        let used = held.count(u64::MAX);
        assert_eq!(used.front.kept, 6 * RENDERED, "the present, and five before it");
        assert_eq!(used.front, used.all);
        assert_eq!(held.count(u64::MAX), used);
    }

    #[test]
    fn what_the_file_holds_is_counted_after_the_history_has_dropped_it() {
        let mut session = dragged(5);
        let open = &mut session.open_documents[session.current];
        let last = open.document().clone();
        open.history = History::new(last, 10);
        assert_eq!(session.held_documents().unwrap().count(u64::MAX).all.kept, 2 * RENDERED);
    }

    #[test]
    fn beyond_the_limit_the_farthest_steps_let_go_and_the_picture_stays() {
        let mut session = dragged(5);
        let before = flatten(session.active().unwrap().document(), &Progress::default()).unwrap();
        let used = session.held_documents().unwrap().count(3 * RENDERED);
        assert_eq!(used.all.kept, 3 * RENDERED);
        assert_eq!(
            session.held_documents().unwrap().count(u64::MAX),
            used,
            "what was let go of is gone"
        );
        assert_eq!(
            session.held_documents().unwrap().count(0).all.kept,
            RENDERED,
            "what is shown is kept"
        );
        // It is rendered again to the same picture.
        let open = &mut session.open_documents[session.current];
        open.history.undo();
        open.history.redo();
        let again = flatten(open.document(), &Progress::default()).unwrap();
        assert!(before.changed_tiles(&again).iter().all(|at| {
            let bytes =
                |grid: &crate::raster::TileGrid| grid.tile(*at).map(|tile| tile.bytes().to_vec());
            bytes(&before) == bytes(&again)
        }));
    }
}
