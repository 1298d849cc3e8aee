//! New parts of the shape, a menu within Layer. Floor 7. Not here: what each is made from
//! (`session::actions::parts::new`).

use super::row::{MenuCommand, has_document, row};
use crate::requests::WindowRequest;
use crate::session::Action;
use crate::session::actions::{NewPart, PartAction};

/// A command for each kind, in the order of its table.
macro_rules! commands {
    ($($index:literal),+; $other:expr) => { &[$({
        const KIND: NewPart = NewPart::ALL[$index].0;
        row(KIND.label(), &[], KIND.hint(), has_document, |_, requests| {
            requests.act(Action::Part(PartAction::Add { kind: KIND }));
        })
    }),+, $other] };
}

const MAPS: MenuCommand =
    row("Maps…", &[], "Normals and depth from files, as a part", has_document, |_, requests| {
        requests.request(WindowRequest::PartMapsDialog);
    });

pub const COMMANDS: &[MenuCommand] =
    commands!(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16; MAPS);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_of_part_has_a_command() {
        let named = |(_, label): &(NewPart, &str)| COMMANDS.iter().any(|row| row.name == *label);
        assert!(NewPart::LABELS.iter().all(named) && COMMANDS.len() == NewPart::ALL.len() + 1);
    }
}
