//! `rilievo thumbnail`: the small picture of a file that file managers show.
//! Floor 7. Not here: where it comes from (`io::thumbnail`).

use super::LimitArgs;
use super::force::Force;
use crate::Result;
use crate::document::Progress;
use crate::io::fs::Disk;
use crate::io::pixels;
use crate::io::replace::{check, replace};
use crate::io::thumbnail::{SIDES_PX, thumbnail};
use std::path::PathBuf;

/// Write a small picture of a file, as file managers show it
///
/// A project contains one, so nothing is painted unless SIDE is larger than 256.
#[derive(clap::Args)]
pub struct ThumbnailArgs {
    /// What to show: .ora, .psd, .json, or a picture
    #[arg(value_name = "FROM")]
    from: PathBuf,
    /// The PNG to write
    #[arg(value_name = "TO")]
    to: PathBuf,
    /// Longer side of the picture, in pixels
    #[arg(short, long, value_name = "SIDE", default_value_t = 256,
          value_parser = clap::value_parser!(u32).range(i64::from(*SIDES_PX.start())..=i64::from(*SIDES_PX.end())))]
    size: u32,
    #[command(flatten)]
    force: Force,
    #[command(flatten)]
    limits: LimitArgs,
}

pub fn run(args: &ThumbnailArgs) -> Result<()> {
    args.limits.install(|| {
        let terms = args.force.export(vec![args.from.clone()]);
        check(&Disk, &args.to, &terms)?;
        let small = thumbnail(&args.from, args.size, &args.limits.budget())?;
        let png = pixels::encode_texels(&args.to, small.rgba.as_chunks().0, small.size)?;
        replace(&Disk, &args.to, png.bytes(), &terms, &Progress::default()).map(drop)
    })
}
