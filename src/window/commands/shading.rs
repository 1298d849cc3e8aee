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
    row(
        "New painter's light layer",
        &[],
        "Key, fill, bounce, rim and cast shadows on the picture beneath",
        has_document,
        |_, requests| add(requests, Model::Painter),
    ),
    row("New Phong layer", &[], "Matt and glossy under lights", has_document, |_, requests| {
        add(requests, Model::Phong)
    }),
    row("New toon layer", &[], "Phong in flat bands, multiplied", has_document, |_, requests| {
        add(requests, Model::Toon)
    }),
    row(
        "New sub-Lambertian layer",
        &[],
        "Flatter than matt, like the moon",
        has_document,
        |_, requests| add(requests, Model::SubLambertian),
    ),
    row(
        "New Ashikhmin layer",
        &[],
        "Brushed metal: a highlight that is longer in one direction",
        has_document,
        |_, requests| add(requests, Model::Ashikhmin),
    ),
    row(
        "New lit-sphere layer",
        &[],
        "A painted ball gives the color of every normal",
        has_document,
        |_, requests| add(requests, Model::LitSphere),
    ),
    row(
        "New mirror layer",
        &[],
        "An environment mirrored in the surface",
        has_document,
        |_, requests| add(requests, Model::Mirror),
    ),
    row(
        "New glass layer",
        &[],
        "An environment seen through the surface",
        has_document,
        |_, requests| add(requests, Model::Refraction),
    ),
    row(
        "New layer lit by an environment",
        &[],
        "Matt, lit from all around",
        has_document,
        |_, requests| add(requests, Model::DiffuseEnvironment),
    ),
    row(
        "New ambient occlusion layer",
        &[],
        "Darker where little of the sky is visible",
        has_document,
        |_, requests| add(requests, Model::AmbientOcclusion),
    ),
];
