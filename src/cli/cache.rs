//! `fem cache`, and whether other commands keep anything in it.

use super::{Console, Format};
use clap::Args;
use fem_io::cache::Cache;
use miette::miette;
use serde::Serialize;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::SystemTime;

/// Variables of the environment: the folder, and most megabytes in it.
const FOLDER: &str = "FEM_CACHE";
const LIMIT: &str = "FEM_CACHE_MB";
/// Most megabytes where nothing is said.
const MEGABYTES: u64 = 2000;
const MB: u64 = 1_000_000;

/// Whether plates are kept.
#[derive(Debug, Args)]
#[command(next_help_heading = "What is kept")]
pub(super) struct Keep {
    /// Keeps the modes of plates for later runs, and takes those that are kept: in the folder FEM_CACHE, or that of the user for caches.
    #[arg(long, global = true, conflicts_with = "no_cache")]
    cache: bool,
    /// Keeps none and takes none, whatever FEM_CACHE says.
    #[arg(long, global = true)]
    no_cache: bool,
}

impl Keep {
    /// The cache, where the command line or the environment asks for one.
    pub(super) fn cache(&self) -> Option<Cache> {
        let asked = self.cache || variable(FOLDER).is_some();
        if asked && !self.no_cache { found() } else { None }
    }
}

/// A variable of the environment that says something.
fn variable(name: &str) -> Option<PathBuf> {
    std::env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from)
}

/// The cache of this user; `None` where no folder is known.
fn found() -> Option<Cache> {
    let of_user = || variable("XDG_CACHE_HOME").filter(|folder| folder.is_absolute());
    let own =
        || of_user().or_else(|| variable("HOME").map(|home| home.join(".cache"))).map(|folder| folder.join("fem"));
    let megabytes = std::env::var(LIMIT).ok().and_then(|text| text.parse().ok()).unwrap_or(MEGABYTES);
    Some(Cache::new(variable(FOLDER).or_else(own)?, megabytes.saturating_mul(MB)))
}

#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  fem run coupon/scene.toml --cache\n  fem cache\n  fem cache --clear")]
pub(super) struct Arguments {
    /// Removes all that is kept
    #[arg(long)]
    clear: bool,
    #[command(flatten)]
    format: Format,
}

/// What is in the folder, or was.
#[derive(Serialize)]
#[allow(non_snake_case)]
struct Contents {
    folder: PathBuf,
    limit_MB: f64,
    plates: usize,
    size_MB: f64,
    removed: bool,
}

pub(super) fn cache(arguments: &Arguments, console: &Console) -> miette::Result<ExitCode> {
    let Some(cache) = found() else {
        return Err(miette!(help = "set FEM_CACHE to a folder", "no folder for caches is known"));
    };
    let megabytes = |bytes: u64| bytes as f64 / MB as f64;
    let entries = cache.entries();
    let (plates, bytes) = match arguments.clear {
        true => cache.clear().map_err(|why| miette!("`{}` cannot be emptied: {why}", cache.folder().display()))?,
        false => (entries.len(), entries.iter().map(|entry| entry.bytes).sum()),
    };
    let contents = Contents {
        folder: cache.folder().to_owned(),
        limit_MB: megabytes(cache.limit()),
        plates,
        size_MB: megabytes(bytes),
        removed: arguments.clear,
    };
    console.show(arguments.format, &contents, || {
        let what = if arguments.clear { "removed  " } else { "plates   " };
        let last = entries.last().filter(|_| !arguments.clear).map(|entry| entry.used);
        let age = last.and_then(|used| SystemTime::now().duration_since(used).ok());
        let used = age.map_or(String::new(), |age| format!("; last used {:.1} h ago", age.as_secs_f64() / 3600.0));
        format!(
            "  folder    {}\n  {what} {plates}, {:.1} MB of at most {:.0}{used}\n",
            contents.folder.display(),
            contents.size_MB,
            contents.limit_MB
        )
    })?;
    Ok(ExitCode::SUCCESS)
}
