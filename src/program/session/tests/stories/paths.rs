//! Draws paths: figures, and lines of a few nodes.

use super::dice::{Dice, Roll};
use crate::math::vec2;
use crate::paint::{
    Figure, FigureKind, LivePath, PanelDrag, PanelSettings, PathCap, PathGeometry, PathJoin,
    PathNode, PathRule, Subpath,
};

impl Roll for Figure {
    fn roll(dice: &mut Dice) -> Self {
        let kind = dice.one_of(&FigureKind::ALL).0;
        let mut figure = Figure { kind, from: dice.place(), to: dice.place(), ..Figure::DEFAULT };
        for setting in Figure::SETTINGS {
            if dice.is(60) {
                continue;
            }
            let (least, most) = (*setting.range.start(), *setting.range.end());
            let useful = least.max(-180.0)..=most.min(40.0);
            (setting.set)(&mut figure, dice.in_range(useful, setting.range.clone()));
        }
        figure
    }
}

impl Roll for PathNode {
    fn roll(dice: &mut Dice) -> Self {
        let node = PathNode::corner(dice.place());
        let mut handle = || vec2(dice.within(-20.0, 20.0), dice.within(-20.0, 20.0));
        let (before, after) = (handle(), handle());
        match dice.below(4) {
            0 => node,
            1 => PathNode::smooth(node.at, after),
            2 => PathNode { before, after, width: dice.in_range(0.0..=3.0, 0.0..=20.0), ..node },
            _ => PathNode { after, ..node },
        }
    }
}

impl Roll for Subpath {
    fn roll(dice: &mut Dice) -> Self {
        let nodes = (0..dice.below(5)).map(|_| PathNode::roll(dice)).collect();
        Subpath { nodes, closed: dice.is(50) }
    }
}

impl Roll for LivePath {
    fn roll(dice: &mut Dice) -> Self {
        let geometry: PathGeometry = match dice.is(50) {
            true => Figure::roll(dice).into(),
            false => (0..dice.below(3)).map(|_| Subpath::roll(dice)).collect::<Vec<_>>().into(),
        };
        LivePath {
            fill: if dice.is(60) { Some(dice.value(dice.word, "color")) } else { None },
            rule: dice.one_of(&PathRule::ALL).0,
            outline: if dice.is(50) { dice.in_range(0.0..=9.0, 0.0..=60.0) } else { 0.0 },
            outline_color: dice.value(dice.word, "color"),
            cap: dice.one_of(&PathCap::ALL).0,
            join: dice.one_of(&PathJoin::ALL).0,
            dashes: (0..dice.below(4)).map(|_| dice.within(0.0, 12.0)).collect(),
            frames: dice.is(25),
            ..LivePath::new(geometry)
        }
    }
}

impl Roll for PanelSettings {
    fn roll(dice: &mut Dice) -> Self {
        let mut settings = PanelSettings {
            border_color: dice.value("PanelSettings", "color"),
            paper: dice.is(70),
            paper_color: dice.value("PanelSettings", "color"),
            right_to_left: dice.is(30),
            drag: dice.one_of(&PanelDrag::ALL).0,
            ..PanelSettings::DEFAULT
        };
        for setting in PanelSettings::SETTINGS {
            let all = setting.range.clone();
            let to = match setting.is_length {
                true => dice.in_range(*all.start()..=12.0, all),
                false => dice.within(1.0, 3.0),
            };
            (setting.set)(&mut settings, to);
        }
        settings
    }
}
