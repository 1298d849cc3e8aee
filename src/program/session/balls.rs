//! *Paint the ball*: the ball of a lit-sphere layer as a document of its own, whose every step
//! repaints the layer. Floor 6. Not here: how the ball lies on the figure (`shading`).

use super::actions::file_names::free_file;
use super::{OpenDocument, Session, is_same};
use crate::document::{Content, Document, Layer, LayerId, Live, PixelLayer, Progress, flatten};
use crate::io::recipe::{RecipeSource, read_value};
use crate::io::{Budget, UserFiles};
use crate::math::{Size, Vec2, srgb, vec2};
use crate::raster::{Picture, TileGrid};
use crate::shading::{LitSphere, Model};
use serde_json::json;
use std::path::Path;

/// The name of the step, and of the ball's document.
const STEP: &str = "Paint the ball";
/// The sides of a ball's canvas, px.
const SIDES: (u32, u32) = (384, 1024);

/// A ball that is painted, and the layer that shows it.
pub struct BallLink {
    /// The keys of the open documents.
    ball: usize,
    figure: usize,
    layer: LayerId,
    hollows: bool,
    /// The ball as the layer shows it.
    shown: Document,
    /// The figure after the last step that was made from here.
    made: Option<Document>,
}

/// The ball's document: its paint on a ball that fills the canvas.
fn ball_document(sphere: &LitSphere) -> Option<Document> {
    let side = sphere.picture.size.width.max(sphere.picture.size.height).clamp(SIDES.0, SIDES.1);
    let radius = 0.5 * side as f32;
    let recipe = json!({ "canvas": { "width": side, "height": side }, "surface": { "parts": [
        { "id": "ball", "name": "Ball", "kind": "primitive", "shape": "sphere",
          "center": [radius, radius], "radius": radius }] } });
    let source = RecipeSource {
        file: Path::new("ball"),
        files: &UserFiles::default(),
        budget: &Budget::default(),
        onto: None,
    };
    let bare = read_value(&recipe, source).ok()?;
    let mut paint = Layer::new(
        "Ball",
        Content::Pixels(PixelLayer {
            tiles: paint_ball_tiles(sphere, bare.size),
            ..PixelLayer::default()
        }),
    );
    paint.clip_to_surface = false;
    Some(bare.with_top(paint))
}

/// The paint of a sphere; around it the paint of its rim goes on.
fn paint_ball_tiles(sphere: &LitSphere, size: Size) -> TileGrid {
    let (light, side) = (sphere.light(), size.width as usize);
    let byte = |light: f32| srgb::quantize(srgb::encode(light.max(0.0)));
    let pixel = |i: usize| {
        let nbar =
            (vec2((i % side) as f32, (i / side) as f32) + 0.5) * (2.0 / side as f32) - Vec2::ONE;
        let [r, g, b] = light.at(nbar);
        [byte(r), byte(g), byte(b), 255]
    };
    let bytes: Vec<u8> = (0..size.area()).flat_map(pixel).collect();
    TileGrid::from_straight_rgba(&bytes, side, side, 0, 0)
}

/// What a ball's document shows, as a picture.
fn picture(ball: &Document) -> Option<Picture> {
    let pixels = flatten(ball, &Progress::default())?.to_straight_rgba(ball.size.rect());
    Picture::srgb8(ball.size, pixels.as_chunks::<4>().0.to_vec())
}

impl BallLink {
    /// The figure with the ball as it is now.
    fn repaint(&self, figure: &Document, ball: &Document) -> Option<Document> {
        let Content::Shading(live) = &figure.layer(self.layer)?.content else { return None };
        let own = live.params().ball(self.hollows).map(|ball| ball.file.clone());
        // A ball that came with the program, or with a file, is another one from now on.
        let file = own
            .filter(|_| self.made.is_some())
            .unwrap_or_else(|| free_file(figure, "painted-ball.png"));
        let ball = LitSphere::new(file, picture(ball)?);
        let shading = live.params().clone().with_ball(self.hollows, ball);
        let content = Content::Shading(Live::new(shading));
        figure.with_layer(self.layer, |layer| layer.content = content)
    }
}

impl Session {
    /// Opens the ball of a layer of the document in front as a document of its own, in front, or
    /// brings the one to the front that is open already.
    pub(super) fn paint_ball(&mut self, layer: LayerId, hollows: bool) {
        let Some(figure) = self.active() else { return };
        let (key, document) = (figure.key, figure.document());
        let Some(Content::Shading(live)) = document.layer(layer).map(|layer| &layer.content) else {
            return;
        };
        if live.params().model != Model::LitSphere {
            return;
        }
        let is_known =
            |link: &&BallLink| link.figure == key && link.layer == layer && link.hollows == hollows;
        let known = self.balls.iter().find(is_known).map(|link| link.ball);
        if let Some(at) = self.open_documents.iter().position(|open| Some(open.key) == known) {
            self.current = at;
            return;
        }
        let ball = live.params().ball(hollows).unwrap_or(LitSphere::clay());
        let Some(document) = ball_document(ball) else { return };
        let open = OpenDocument::new("Ball", document, None);
        self.balls.push(BallLink {
            ball: open.key,
            figure: key,
            layer,
            hollows,
            shown: open.document().clone(),
            made: None,
        });
        self.add_document(open);
    }

    /// Repaints the figures whose balls have changed. All strokes on a ball are one step of the
    /// figure, until something else is done there.
    pub(super) fn follow_balls(&mut self) {
        let mut links = std::mem::take(&mut self.balls);
        links.retain_mut(|link| self.follow_ball(link).is_some());
        self.balls.extend(links);
    }

    /// `None` when the ball or its layer is gone.
    fn follow_ball(&mut self, link: &mut BallLink) -> Option<()> {
        let place = |key: usize| self.open_documents.iter().position(|open| open.key == key);
        let (ball, figure) = (place(link.ball)?, place(link.figure)?);
        let painted = self.open_documents[ball].document().clone();
        self.open_documents[figure].document().layer(link.layer)?;
        if is_same(&painted, &link.shown) {
            return Some(());
        }
        let figure = &mut self.open_documents[figure];
        let is_ours = link.made.as_ref().is_some_and(|made| is_same(made, figure.document()));
        if is_ours {
            figure.history.undo();
        }
        let next = link.repaint(figure.document(), &painted)?;
        figure.commit(STEP, next);
        link.made = Some(figure.document().clone());
        link.shown = painted;
        // Its paint is kept in the figure.
        self.open_documents[ball].mark_kept();
        Some(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::session::Action;
    use crate::session::actions::{EditAction, FileAction, LayerAction, NewLayer};
    use crate::session::replay::ReplayValue;
    use crate::session::{LayerPath, actions};
    use crate::shading::Shading;

    /// A session with a canvas that has a lit-sphere layer, and the ball of it in front.
    fn painting() -> Session {
        let mut session = Session::default();
        let size = Size::new(64, 48);
        let lit = Shading::new(Model::LitSphere);
        let layer = Layer::new("Lit", Content::Shading(Live::new(lit)));
        session.add_document(OpenDocument::new(
            "Figure",
            Document::empty(size).with_top(layer),
            None,
        ));
        let path = LayerPath::of(session.open_documents[0].document(), lit_id(&session)).unwrap();
        act(&mut session, LayerAction::PaintBall { layer: path, hollows: false });
        session
    }

    fn lit_id(session: &Session) -> LayerId {
        session.open_documents[0].document().layers[0].id
    }

    fn act(session: &mut Session, action: LayerAction) {
        Action::Layer(action).apply(session).unwrap();
    }

    /// The middle of the ball that the figure shows, if it has one of its own.
    fn shown(session: &Session) -> Option<[u8; 3]> {
        let document = session.open_documents[0].document();
        let Content::Shading(live) = &document.layers[0].content else { return None };
        let light = live.params().sphere.as_ref()?.light().at(Vec2::ZERO);
        Some(light.map(|light| srgb::quantize(srgb::encode(light))))
    }

    fn fill(session: &mut Session, color: srgb::Color) {
        session.tools.color = color;
        act(session, LayerAction::Add { kind: NewLayer::Fill });
    }

    #[test]
    fn what_is_painted_on_the_ball_is_seen_on_the_figure_as_one_step() {
        let mut session = painting();
        assert_eq!((session.current, session.open_documents.len()), (1, 2));
        let ball = session.active().unwrap().document();
        assert!(ball.surface.is_some() && ball.layers.len() == 1);
        assert_eq!(shown(&session), None, "nothing is painted yet");
        fill(&mut session, srgb::Color::rgb(200, 20, 20));
        assert_eq!(shown(&session), Some([200, 20, 20]));
        fill(&mut session, srgb::Color::rgb(20, 200, 20));
        assert_eq!(shown(&session), Some([20, 200, 20]));
        assert_eq!(session.open_documents[0].history.past_names().len(), 1);
        assert!(!session.active().unwrap().is_dirty(), "the figure keeps the paint");
        // A stroke less on the ball is a stroke less on the figure.
        Action::Edit(EditAction::Undo {}).apply(&mut session).unwrap();
        assert_eq!(shown(&session), Some([200, 20, 20]));
        // Undone on the figure, its old ball is back.
        session.current = 0;
        Action::Edit(EditAction::Undo {}).apply(&mut session).unwrap();
        assert_eq!(shown(&session), None);
        // The same ball comes to the front again, and paints again.
        let path = LayerPath::of(session.open_documents[0].document(), lit_id(&session)).unwrap();
        act(&mut session, LayerAction::PaintBall { layer: path, hollows: false });
        assert_eq!((session.current, session.open_documents.len()), (1, 2));
        fill(&mut session, srgb::Color::rgb(20, 20, 200));
        assert_eq!(shown(&session), Some([20, 20, 200]));
    }

    #[test]
    fn a_ball_whose_figure_or_layer_is_gone_is_a_drawing_like_any_other() {
        for closes in [true, false] {
            let mut session = painting();
            if closes {
                Action::File(FileAction::Close { index: 0 }).apply(&mut session).unwrap();
            } else {
                session.current = 0;
                let document = session.open_documents[0].document();
                let path = actions::layers::LayerAction::select_layers(
                    document,
                    &[lit_id(&session)],
                    None,
                );
                act(&mut session, path.unwrap());
                let layer = session.layer_paths();
                act(&mut session, LayerAction::Delete { layer });
                session.current = 1;
            }
            fill(&mut session, srgb::Color::rgb(9, 9, 9));
            assert!(session.balls.is_empty() && session.active().unwrap().is_dirty());
        }
    }

    #[test]
    fn a_ball_or_a_look_that_cannot_be_had_says_why() {
        let mut session = painting();
        let says = |session: &mut Session, action: LayerAction| {
            session.said.clear();
            act(session, action);
            session.said.concat()
        };
        let layer = || LayerPath::read(&json!("0")).unwrap();
        let bare = LayerAction::PaintBall { layer: layer(), hollows: false };
        assert!(says(&mut session, bare).contains("painted ball"), "the ball's own layer is paint");
        session.current = 0;
        let (name, hollows) = ("billiard".to_owned(), false);
        let unknown = LayerAction::PaintedBall { layer: layer(), name, hollows };
        assert!(says(&mut session, unknown).contains("No painted ball"));
        let flat = says(&mut session, LayerAction::Look { name: "oil-sketch".into() });
        assert!(flat.contains("needs a shape"), "{flat}");
        session.current = 1;
        let unknown = says(&mut session, LayerAction::Look { name: "cubism".into() });
        assert!(unknown.contains("No look"), "{unknown}");
    }
}
