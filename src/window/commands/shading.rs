//! New shading layers, one for each model.
//! Floor 7.

use super::row::{MenuCommand, has_document, row};
use crate::requests::UiRequests;
use crate::session::Action;
use crate::session::actions::LayerAction;
use crate::shading::Model;

fn add(requests: &mut UiRequests, model: Model) {
    requests.act(Action::Layer(LayerAction::AddShading { model }));
}

pub const COMMANDS: &[MenuCommand] = &[
    row("New painter's light layer", &[], Model::Painter.hint(), has_document, |_, requests| {
        add(requests, Model::Painter)
    }),
    row("New soft plastic layer", &[], Model::Phong.hint(), has_document, |_, requests| {
        add(requests, Model::Phong)
    }),
    row("New toon layer", &[], Model::Toon.hint(), has_document, |_, requests| {
        add(requests, Model::Toon)
    }),
    row("New velvet layer", &[], Model::SubLambertian.hint(), has_document, |_, requests| {
        add(requests, Model::SubLambertian)
    }),
    row("New brushed metal layer", &[], Model::Ashikhmin.hint(), has_document, |_, requests| {
        add(requests, Model::Ashikhmin)
    }),
    row("New painted ball layer", &[], Model::LitSphere.hint(), has_document, |_, requests| {
        add(requests, Model::LitSphere)
    }),
    row("New mirror layer", &[], Model::Mirror.hint(), has_document, |_, requests| {
        add(requests, Model::Mirror)
    }),
    row("New glass layer", &[], Model::Refraction.hint(), has_document, |_, requests| {
        add(requests, Model::Refraction)
    }),
    row(
        "New layer lit by an environment",
        &[],
        Model::DiffuseEnvironment.hint(),
        has_document,
        |_, requests| add(requests, Model::DiffuseEnvironment),
    ),
    row(
        "New ambient occlusion layer",
        &[],
        Model::AmbientOcclusion.hint(),
        has_document,
        |_, requests| add(requests, Model::AmbientOcclusion),
    ),
];
