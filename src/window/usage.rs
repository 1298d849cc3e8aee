//! Memory, for the status bar: what the program takes, as the system reports, and what the open
//! documents take of it. Floor 7. The limit of what they keep for speed is enforced here, too:
//! counting and freeing are one walk (`session::memory`), on a thread of its own.

use crate::io::machine;
use crate::io::platform::Instant;
use crate::jobs::spawn;
use crate::math::Range;
use crate::session::Session;
use crate::session::memory::DocumentMemory;
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::time::Duration;

/// The share of the machine's memory that documents may keep for speed.
pub const KEPT_SHARE: Range = 0.05..=0.75;
/// Its default.
pub const USUAL_KEPT_SHARE: f32 = 0.25;

/// The time between two measurements.
const PAUSE: Duration = Duration::from_secs(1);
/// The time between two counts of documents, which may be long walks.
const COUNT_PAUSE: Duration = Duration::from_secs(3);

pub struct MemoryMeter {
    sampled: Option<(Instant, Option<u64>)>,
    machine_bytes: u64,
    counted: DocumentMemory,
    since: Option<Instant>,
    counting: Option<Receiver<DocumentMemory>>,
}

impl Default for MemoryMeter {
    fn default() -> Self {
        let machine_bytes = machine::whole_bytes();
        Self {
            sampled: None,
            machine_bytes,
            counted: DocumentMemory::default(),
            since: None,
            counting: None,
        }
    }
}

impl MemoryMeter {
    /// Bytes held at the last measurement.
    pub fn bytes(&mut self) -> Option<u64> {
        match self.sampled {
            Some((since, bytes)) if since.elapsed() < PAUSE => bytes,
            _ => {
                let bytes = machine::resident_bytes();
                self.sampled = Some((Instant::now(), bytes));
                bytes
            }
        }
    }

    /// The bytes of memory that the machine has.
    pub fn machine_bytes(&self) -> u64 {
        self.machine_bytes
    }

    /// Bytes that may be kept for speed.
    pub fn limit(&self, share: f32) -> u64 {
        (f64::from(share) * self.machine_bytes as f64) as u64
    }

    /// What documents took at the last count. If that was some time ago, another one begins, which
    /// also enforces the limit. `is_idle`: nothing is painted now.
    pub fn documents(&mut self, session: &Session, share: f32, is_idle: bool) -> DocumentMemory {
        match self.counting.as_ref().map(Receiver::try_recv) {
            Some(Ok(counted)) => (self.counted, self.counting) = (counted, None),
            Some(Err(TryRecvError::Disconnected)) => self.counting = None,
            Some(Err(TryRecvError::Empty)) | None => {}
        }
        let is_due = self.since.is_none_or(|since| since.elapsed() >= COUNT_PAUSE);
        if is_idle
            && is_due
            && self.counting.is_none()
            && let Some(held) = session.held_documents()
        {
            let (limit, (sender, receiver)) = (self.limit(share), channel());
            self.since = Some(Instant::now());
            let begun = spawn("counting memory", move || {
                // The window may be gone by then.
                let _ = sender.send(held.count(limit));
            });
            // Without a thread the last figures stay.
            self.counting = begun.is_ok().then_some(receiver);
        }
        self.counted
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_limit_is_a_share_of_the_machine() {
        let meter = MemoryMeter { machine_bytes: 8_000_000_000, ..MemoryMeter::default() };
        assert_eq!(meter.limit(USUAL_KEPT_SHARE), 2_000_000_000);
    }
}
