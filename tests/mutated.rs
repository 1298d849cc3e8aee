//! Files of every format, damaged at random and in their structure: never a panic, never an abort,
//! never more memory than is allowed, and every refusal a sentence that names the file. The same
//! mutations on every run.

use super::{readers, seeds, watch};
use rilievo_engine::math::hash::mix;
use std::io::{Cursor, Read, Write};
use std::path::Path;

/// The most that reading any of them may take.
const MOST_BYTES: usize = 512 << 20;

/// The same numbers on every run.
struct Dice(u32);

impl Dice {
    fn roll(&mut self, below: usize) -> usize {
        self.0 = mix(self.0.wrapping_add(0x9e37));
        self.0 as usize % below.max(1)
    }
}

/// Flips, overwrites, inserts, removes or repeats a few parts.
fn damaged(bytes: &[u8], dice: &mut Dice) -> Vec<u8> {
    let mut out = bytes.to_vec();
    for _ in 0..1 + dice.roll(4) {
        // Headers are in front.
        let reach = if dice.roll(2) == 0 { out.len() } else { out.len().min(400) };
        let (at, length) = (dice.roll(reach), 1 + dice.roll(16));
        let end = (at + length).min(out.len());
        match dice.roll(8) {
            0 | 1 => out[at] ^= 1 << dice.roll(8),
            2 => out[at] = [0, 0xff, 0x7f, 0x80][dice.roll(4)],
            3 => out[at..end].fill(0xff),
            4 => drop(out.drain(at..end)),
            5 => {
                let again = out[at..end].to_vec();
                out.splice(at..at, again);
            }
            6 => {
                let extreme =
                    [0u32, 1, 0x7fff_ffff, 0xffff_ffff, 60_000, 0x0100_0000][dice.roll(6)];
                let figure =
                    if dice.roll(2) == 0 { extreme.to_le_bytes() } else { extreme.to_be_bytes() };
                out.iter_mut().skip(at).zip(figure).for_each(|(byte, digit)| *byte = digit);
            }
            _ => out.truncate(at.max(8)),
        }
        if out.is_empty() {
            out.push(0);
        }
    }
    out
}

/// Damage that checksums and tables of contents do not reveal: inside the entries of a zip, inside
/// the chunks of a PNG.
fn mutated(bytes: &[u8], dice: &mut Dice) -> Vec<u8> {
    let deep = dice.roll(2) == 0;
    if deep && bytes.starts_with(b"PK") {
        return entries_changed(bytes, dice);
    }
    let mut out = damaged(bytes, dice);
    if deep && out.starts_with(b"\x89PNG") {
        mend_checksums(&mut out);
    }
    out
}

fn entries_changed(bytes: &[u8], dice: &mut Dice) -> Vec<u8> {
    let mut zip = zip::ZipArchive::new(Cursor::new(bytes)).unwrap();
    let mut entries: Vec<(String, Vec<u8>)> = Vec::new();
    for i in 0..zip.len() {
        let mut entry = zip.by_index(i).unwrap();
        let (name, mut bytes) = (entry.name().unwrap().into_owned(), Vec::new());
        entry.read_to_end(&mut bytes).unwrap();
        entries.push((name, bytes));
    }
    let at = dice.roll(entries.len());
    let other = dice.roll(entries.len());
    match dice.roll(8) {
        0 => drop(entries.remove(at)),
        1 => entries.swap(at, other),
        2 => {
            entries[at].0 =
                ["../a", "/etc/passwd", "a\\b", "C:x", "data/é.png", ""][dice.roll(6)].into()
        }
        3 => entries[at].0 = entries[other].0.clone() + " ",
        4 => entries[at].1 = entries[other].1.clone(),
        _ => {
            let mut changed = damaged(&entries[at].1, dice);
            if changed.starts_with(b"\x89PNG") {
                mend_checksums(&mut changed);
            }
            entries[at].1 = changed;
        }
    }
    let mut out = zip::ZipWriter::new(Cursor::new(Vec::new()));
    let stored =
        zip::write::SimpleFileOptions::default().compression_method(zip::CompressionMethod::Stored);
    for (name, bytes) in entries {
        // A name that the writer refuses is left out.
        if out.start_file(name, stored).is_ok() {
            out.write_all(&bytes).unwrap();
        }
    }
    out.finish().unwrap().into_inner()
}

/// Gives every chunk the checksum of what is in it now.
fn mend_checksums(png: &mut [u8]) {
    let mut at = 8;
    while let Some(length) =
        png.get(at..at + 4).map(|b| u32::from_be_bytes(b.try_into().unwrap()) as usize)
    {
        let end = at.saturating_add(8).saturating_add(length);
        if png.len() < end.saturating_add(4) {
            return;
        }
        let crc = crc32fast::hash(&png[at + 4..end]);
        png[end..end + 4].copy_from_slice(&crc.to_be_bytes());
        at = end + 4;
    }
}

/// Panics unless every mutation is read or refused; how many were refused, and the most memory one
/// took.
fn mutate(count: u32) -> (u32, usize) {
    // Decoders' panics are caught at the door; their traces would bury this test's own.
    std::panic::set_hook(Box::new(|panic| {
        if panic.location().is_some_and(|place| place.file().starts_with("tests")) {
            eprintln!("{panic}");
        }
    }));
    let seeds = seeds::all();
    assert!(seeds.len() >= 50, "only {} seeds", seeds.len());
    let (mut refused, mut most) = (0, 0);
    for i in 0..count {
        let (name, bytes) = &seeds[i as usize % seeds.len()];
        let broken = mutated(bytes, &mut Dice(i));
        let before = watch::forget();
        let outcome = std::panic::catch_unwind(|| readers::any(Path::new(name), &broken));
        let outcome = outcome.unwrap_or_else(|_| panic!("mutation {i} of {name} panics"));
        let took = watch::peak().saturating_sub(before);
        assert!(took <= MOST_BYTES, "mutation {i} of {name} takes {took} bytes");
        most = most.max(took);
        if let Err(error) = outcome {
            let said = error.to_string();
            let named = [name.as_str(), "p.png", "n.png", "r.json"];
            assert!(named.iter().any(|name| said.contains(name)), "mutation {i}: {said}");
            refused += 1;
        }
    }
    (refused, most)
}

#[test]
fn every_seed_is_read_as_it_is() {
    let _turn = watch::turn();
    for (name, bytes) in seeds::all() {
        readers::any(Path::new(&name), &bytes)
            .or_else(|e| needs_files(&name, e))
            .unwrap_or_else(|e| panic!("{e}"));
    }
}

/// A recipe alone names files that are not there.
fn needs_files(name: &str, error: rilievo::Error) -> rilievo::Result<()> {
    if name.ends_with(".json") && error.to_string().contains(".png") { Ok(()) } else { Err(error) }
}

#[test]
fn damaged_files_of_every_format_are_read_or_refused_with_a_sentence() {
    let _turn = watch::turn();
    let (refused, most) = mutate(20_000);
    eprintln!("{refused} refused; the most memory: {} KiB", most >> 10);
    assert!(refused > 5_000, "the mutations do damage: {refused}");
}

/// *Long*: see docs/PROJECTS.md.
#[test]
#[ignore = "twenty minutes; run by name"]
fn long_a_million_damaged_files() {
    let _turn = watch::turn();
    let (refused, most) = mutate(1_000_000);
    eprintln!("{refused} refused; the most memory: {} KiB", most >> 10);
}

/// The fuzzer's seeds and the inputs that it kept, by the names of its targets.
#[test]
fn the_corpus_of_the_fuzzer_is_read_or_refused() {
    let _turn = watch::turn();
    let fuzz = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz");
    for (target, reader) in readers::ALL {
        let folders = ["seeds", "corpus"].map(|folder| fuzz.join(folder).join(target));
        let files = folders
            .iter()
            .flat_map(|folder| std::fs::read_dir(folder).into_iter().flatten().flatten());
        let mut read = 0;
        for entry in files {
            let bytes = std::fs::read(entry.path()).unwrap();
            let before = watch::forget();
            if let Err(error) = reader(&entry.path(), &bytes) {
                assert!(!error.to_string().is_empty());
            }
            assert!(
                watch::peak().saturating_sub(before) <= MOST_BYTES,
                "{}",
                entry.path().display()
            );
            read += 1;
        }
        assert!(read > 0, "{target} has nothing to begin with");
    }
}
