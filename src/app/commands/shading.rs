//! New shading layers, one for each model.
//! Floor 7.

use super::{Command, Menu, has_document};
use crate::app::asked::Asked;
use crate::session::Action;
use crate::session::actions::LayerAction;
use crate::shading::Model;

const MENU: Menu = Menu::Shading;

fn add(asked: &mut Asked, model: Model) {
    asked.act(Action::Layer(LayerAction::AddShading { model }));
}

pub const COMMANDS: &[Command] = &[
    Command {
        name: "New Phong layer",
        menu: MENU,
        keys: &[],
        hint: "Matt and glossy under lights",
        can: has_document,
        run: |_, asked| add(asked, Model::Phong),
    },
    Command {
        name: "New toon layer",
        menu: MENU,
        keys: &[],
        hint: "The same in flat bands",
        can: has_document,
        run: |_, asked| add(asked, Model::Toon),
    },
    Command {
        name: "New sub-Lambertian layer",
        menu: MENU,
        keys: &[],
        hint: "Flatter than matt, like the moon",
        can: has_document,
        run: |_, asked| add(asked, Model::SubLambertian),
    },
    Command {
        name: "New Ashikhmin layer",
        menu: MENU,
        keys: &[],
        hint: "Brushed metal: a highlight longer one way than the other",
        can: has_document,
        run: |_, asked| add(asked, Model::Ashikhmin),
    },
    Command {
        name: "New lit-sphere layer",
        menu: MENU,
        keys: &[],
        hint: "A painted ball tells the colour of every normal",
        can: has_document,
        run: |_, asked| add(asked, Model::LitSphere),
    },
    Command {
        name: "New mirror layer",
        menu: MENU,
        keys: &[],
        hint: "An environment mirrored in the surface",
        can: has_document,
        run: |_, asked| add(asked, Model::Mirror),
    },
    Command {
        name: "New glass layer",
        menu: MENU,
        keys: &[],
        hint: "An environment seen through the surface",
        can: has_document,
        run: |_, asked| add(asked, Model::Refraction),
    },
    Command {
        name: "New layer lit by an environment",
        menu: MENU,
        keys: &[],
        hint: "Matt, lit from all around",
        can: has_document,
        run: |_, asked| add(asked, Model::DiffuseEnvironment),
    },
    Command {
        name: "New ambient occlusion layer",
        menu: MENU,
        keys: &[],
        hint: "Darker where little of the sky is seen",
        can: has_document,
        run: |_, asked| add(asked, Model::AmbientOcclusion),
    },
];
