//! The program's memory use, for the status bar. Floor 7. The system reports it; nothing is shown if it does not.

use std::time::{Duration, Instant};

/// The time between two measurements.
const PAUSE: Duration = Duration::from_secs(1);

#[derive(Default)]
pub struct MemoryMeter {
    sampled: Option<(Instant, Option<u64>)>,
}

impl MemoryMeter {
    /// Bytes held at the last measurement.
    pub fn bytes(&mut self) -> Option<u64> {
        match self.sampled {
            Some((since, bytes)) if since.elapsed() < PAUSE => bytes,
            _ => {
                let bytes = std::fs::read_to_string("/proc/self/status").ok().and_then(|text| resident(&text));
                self.sampled = Some((Instant::now(), bytes));
                bytes
            }
        }
    }
}

/// The resident set in a Linux status file.
fn resident(status: &str) -> Option<u64> {
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    let kib: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    kib.checked_mul(1024)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn memory_is_read() {
        assert_eq!(resident("Name:\tx\nVmRSS:\t    2048 kB\n"), Some(2 << 20));
        assert_eq!(resident("VmRSS: many kB"), None);
    }
}
