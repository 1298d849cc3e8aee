//! The path tool: clicks set corners, drags smooth nodes; what is there is dragged. Floor 5. Not
//! here: edits of a path (`paint::path`).

use super::{HeldPath, SelectedNode};
use crate::document::Document;
use crate::math::Vec2;
use crate::paint::path::{NodeHandle, PathPlace};
use crate::paint::{LivePath, PathNode, Subpath};
use crate::tools::snap::{SnapLines, SnapTargets};
use crate::tools::{Gesture, GestureStart, Outcome, PenSample, ToolContext};

/// A pen that moves less than this, screen points, clicks.
const SLOP_PT: f32 = 3.0;

/// What a drag does.
#[derive(Clone, Copy, Debug, PartialEq)]
enum NodeDrag {
    /// Pulls the handles out of a node that was just set.
    Pull,
    /// Pulls the handle that arrives at the node that closes a line.
    PullEnd,
    /// Moves a node or a handle.
    Move(NodeHandle, bool),
}

/// What a click does, of a pen that does not move.
#[derive(Clone, Copy, Debug, PartialEq)]
enum NodeClick {
    /// Keeps what the press did.
    Keep,
    /// Selects the node.
    Select,
    /// Goes on with the line that ends here.
    Continue,
    /// A corner becomes smooth, a smooth node a corner.
    Turn,
}

/// The pen comes down with the tool.
pub fn press(context: &ToolContext, pen: PenSample) -> GestureStart {
    let held = match HeldPath::of_selected(context) {
        Ok(held) => held,
        Err(why) => return (None, Outcome::Refused(why.into())),
    };
    match held {
        None => begin_path(context, pen),
        Some(held) => {
            let selected = context.tools.path_node.within(held.id(), &held.path);
            press_on(context, pen, held, selected)
        }
    }
}

/// The pen comes down while a path is selected.
fn press_on(
    context: &ToolContext,
    pen: PenSample,
    held: HeldPath,
    selected: SelectedNode,
) -> GestureStart {
    let (at, keys) = (held.to_path(pen.place()), pen.keys);
    let within = held.reach(pen.place(), context.px_per_pt);
    let found = held.path.handle_at(at, within, selected.node);
    if let (Some((place, NodeHandle::Node)), true) = (found, keys.alt) {
        return delete(held, place);
    }
    if let (Some(line), Some((place, NodeHandle::Node))) = (selected.line, found)
        && place == (PathPlace { line, node: 0 })
        && held.path.subpaths()[line].nodes.len() > 1
    {
        let path = held.path.with_nodes(|lines| lines[line].closed = true);
        let selected = SelectedNode { line: None, node: Some(place), ..selected };
        return begin(context, held, path, selected, (NodeDrag::PullEnd, NodeClick::Keep), pen);
    }
    if let Some((place, handle)) = found {
        let drag = NodeDrag::Move(handle, keys.ctrl);
        let click = match handle {
            NodeHandle::Node if keys.ctrl => NodeClick::Turn,
            NodeHandle::Node if is_end(&held.path, place) => NodeClick::Continue,
            _ => NodeClick::Select,
        };
        let (path, selected) = (held.path.clone(), SelectedNode { node: Some(place), ..selected });
        return begin(context, held, path, selected, (drag, click), pen);
    }
    let point = held.to_path(context.snap.point(pen.place()).at);
    if let Some(line) = selected.line {
        let mut node = 0;
        let path = held.path.with_nodes(|lines| {
            lines[line].nodes.push(PathNode::corner(point));
            node = lines[line].nodes.len() - 1;
        });
        let selected = SelectedNode { node: Some(PathPlace { line, node }), ..selected };
        return begin(context, held, path, selected, (NodeDrag::Pull, NodeClick::Keep), pen);
    }
    if let Some((after, t)) = held.path.curve_at(at, within).filter(|_| !keys.shift) {
        let path = held.path.with_added_node(after, t);
        let place = PathPlace { node: after.node + 1, ..after };
        let selected = SelectedNode { node: Some(place), ..selected };
        let drag = NodeDrag::Move(NodeHandle::Node, false);
        return begin(context, held, path, selected, (drag, NodeClick::Keep), pen);
    }
    if keys.shift {
        let path = held.path.with_nodes(|lines| {
            lines.push(Subpath { nodes: vec![PathNode::corner(point)], closed: false });
        });
        let line = path.subpaths().len() - 1;
        let node = Some(PathPlace { line, node: 0 });
        let selected = SelectedNode { line: Some(line), node, ..selected };
        return begin(context, held, path, selected, (NodeDrag::Pull, NodeClick::Keep), pen);
    }
    begin_path(context, pen)
}

/// A new path of one node.
fn begin_path(context: &ToolContext, pen: PenSample) -> GestureStart {
    let at = context.snap.point(pen.place()).at;
    let lines = vec![Subpath { nodes: vec![PathNode::corner(at)], closed: false }];
    let tools = context.tools;
    let path = tools.path.clamp_to_ranges().path(lines, [tools.color, tools.second_color]);
    if path.fits().is_err() {
        return (None, Outcome::Idle);
    }
    let held = HeldPath::new(context, path.clone());
    let node = Some(PathPlace { line: 0, node: 0 });
    let selected = SelectedNode { layer: Some(held.id()), line: Some(0), node };
    begin(context, held, path, selected, (NodeDrag::Pull, NodeClick::Keep), pen)
}

fn delete(held: HeldPath, place: PathPlace) -> GestureStart {
    let path = held.path.without_node(place);
    let selected = SelectedNode { layer: Some(held.id()), ..SelectedNode::default() };
    let Some(document) = without_node(&held, &path) else { return (None, Outcome::Idle) };
    let done = Outcome::Commit { label: "Delete node".into(), document, select: None };
    (None, done.with_settings(move |tools| tools.path_node = selected))
}

/// The document after a node was taken away; with the last one goes the layer.
fn without_node(held: &HeldPath, path: &LivePath) -> Option<Document> {
    match path.count_nodes() {
        0 => held.document.without_layers(&[held.id()]),
        _ => held.with(path),
    }
}

/// The document without the node that was set last, or that is selected, and what is selected then;
/// `None` where there is none.
pub fn step_back(context: &ToolContext) -> Option<(Document, SelectedNode)> {
    let held = HeldPath::of_selected(context).ok().flatten()?;
    let selected = context.tools.path_node.within(held.id(), &held.path);
    let last = selected.line.map(|line| {
        let node = held.path.subpaths()[line].nodes.len().saturating_sub(1);
        PathPlace { line, node }
    });
    let place = last.or(selected.node)?;
    let path = held.path.without_node(place);
    let document = without_node(&held, &path)?;
    let line = selected.line.filter(|line| path.subpaths().len() > *line && place.node > 0);
    let node = line.map(|line| PathPlace { line, node: place.node.saturating_sub(1) });
    Some((document, SelectedNode { line, node, ..selected }))
}

/// Whether an open line ends at a node.
fn is_end(path: &LivePath, place: PathPlace) -> bool {
    path.subpaths()
        .get(place.line)
        .is_some_and(|line| !line.closed && (place.node == 0 || place.node + 1 == line.nodes.len()))
}

fn begin(
    context: &ToolContext,
    held: HeldPath,
    path: LivePath,
    selected: SelectedNode,
    (drag, click): (NodeDrag, NodeClick),
    pen: PenSample,
) -> GestureStart {
    let slop_px = SLOP_PT * context.px_per_pt;
    let snap = context.snap.clone();
    let gesture = NodeGesture {
        now: path.clone(),
        path,
        held,
        selected,
        drag,
        click,
        from: pen.place(),
        slop_px,
        is_dragged: false,
        snap,
        lines: SnapLines::default(),
    };
    let shown = gesture.held.with(&gesture.now).map_or(Outcome::Idle, Outcome::Preview);
    let shown = shown.with_settings(move |tools| tools.path_node = selected);
    (Some(Box::new(gesture)), shown)
}

struct NodeGesture {
    held: HeldPath,
    /// After the press.
    path: LivePath,
    now: LivePath,
    selected: SelectedNode,
    drag: NodeDrag,
    click: NodeClick,
    /// Where the pen came down, canvas px.
    from: Vec2,
    slop_px: f32,
    is_dragged: bool,
    snap: SnapTargets,
    lines: SnapLines,
}

impl NodeGesture {
    fn label(&self) -> &'static str {
        match (self.drag, self.click) {
            (NodeDrag::PullEnd, _) => "Close path",
            (_, NodeClick::Turn) if !self.is_dragged => "Turn node",
            (NodeDrag::Pull, _) if self.now.count_nodes() == 1 => "Path",
            (NodeDrag::Pull, _) => "Add node",
            (_, NodeClick::Keep) => "Add node",
            _ => "Move node",
        }
    }

    fn path_at(&self, at: Vec2) -> LivePath {
        let Some(place) = self.selected.node else { return self.path.clone() };
        let Some(node) = self.path.node(place) else { return self.path.clone() };
        let with = |node: PathNode| {
            self.path.with_nodes(|lines| lines[place.line].nodes[place.node] = node)
        };
        match self.drag {
            NodeDrag::Pull => with(PathNode::smooth(node.at, at - node.at)),
            NodeDrag::PullEnd => with(PathNode { before: node.at - at, ..node }),
            NodeDrag::Move(handle, breaks) => self.path.with_handle(place, handle, at, breaks),
        }
    }

    /// The line that ends at the selected node, so that it ends there, as clicks go on from its end.
    fn continue_from(&self, place: PathPlace) -> LivePath {
        if place.node > 0 {
            return self.path.clone();
        }
        self.path.with_nodes(|lines| {
            let nodes = &mut lines[place.line].nodes;
            nodes.reverse();
            nodes.iter_mut().for_each(|node| std::mem::swap(&mut node.before, &mut node.after));
        })
    }

    /// The pen was lifted where it came down.
    fn finish_click(&mut self) -> Outcome {
        let selected = self.selected;
        let (path, selected) = match (self.click, selected.node) {
            (NodeClick::Keep, _) => (self.path.clone(), selected),
            (NodeClick::Turn, Some(place)) => (self.path.with_turned_node(place), selected),
            (NodeClick::Continue, Some(place)) => {
                let path = self.continue_from(place);
                let node = path.subpaths()[place.line].nodes.len() - 1;
                let node = Some(PathPlace { node, ..place });
                (path, SelectedNode { line: Some(place.line), node, ..selected })
            }
            _ => return Outcome::Cancel,
        };
        self.now = path;
        self.selected = selected;
        self.commit()
    }

    fn commit(&self) -> Outcome {
        let selected = self.selected;
        let is_same =
            self.now == self.held.path && matches!(self.held.layer, super::PathTarget::Old(..));
        let done = match self.held.with(&self.now).filter(|_| !is_same) {
            Some(document) => Outcome::Commit {
                label: self.label().into(),
                document,
                select: Some(self.held.id()),
            },
            None => Outcome::Cancel,
        };
        done.with_settings(move |tools| tools.path_node = selected)
    }
}

impl Gesture for NodeGesture {
    fn drag(&mut self, pens: &[PenSample]) -> Outcome {
        let Some(pen) = pens.last().filter(|pen| pen.place().is_finite()) else {
            return Outcome::Idle;
        };
        self.is_dragged |= pen.place().distance(self.from) > self.slop_px;
        if !self.is_dragged {
            return Outcome::Idle;
        }
        let snaps = matches!(self.drag, NodeDrag::Move(NodeHandle::Node, _));
        let found = if snaps { self.snap.point(pen.place()) } else { Default::default() };
        let at = if snaps { found.at } else { pen.place() };
        self.lines = found.lines;
        let next = self.path_at(self.held.to_path(at));
        match self.held.with(&next) {
            Some(document) => {
                self.now = next;
                Outcome::Preview(document)
            }
            None => Outcome::Idle,
        }
    }

    fn release(&mut self) -> Outcome {
        if self.is_dragged { self.commit() } else { self.finish_click() }
    }

    fn snap_lines(&self) -> SnapLines {
        self.lines
    }
}
