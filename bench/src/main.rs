//! `cargo xtask bench-rays`: traces the same rays with Dürer, Embree and other Rust crates.

mod edges;
mod embree;
mod peers;
mod rays;
mod speed;

use anyhow::{Context, Result, bail};
use std::path::PathBuf;
use std::process::ExitCode;

const USAGE: &str =
    "cargo xtask bench-rays [OPTIONS]: traces the same rays with Dürer, Embree 4, obvhs, bvh and parry3d, in alternation.

  --quick            fewer rays and rounds: takes less than a minute
  --mesh NAME        only this mesh of ../shared/meshes, or a file; can be given several times
  --case NAME        only these rays: primary, bounce, shuffled, shadow, ambient; can be given several times
  --preset NAME      build quality of Dürer's BVH: fast, balanced, best [default: best]
  --threads N        threads for tracing and building [default: 1]
  --side N           N x N primary rays; a multiple of 8 [default: 512; 256 with --quick]
  --edges N          instead of the speed, count the rays, of N, that miss a closed mesh at vertices, edges and centroids
  --arrays FOLDER    only the speed of Dürer's batches, for arrays written by crates/durer-py/bench/rays.py
  --instances N      N instances of each mesh, compared with Embree
  --rounds N         number of rounds, whose medians are printed [default: 9; 5 with --quick]
  --no-peers         compare only with Embree
  --no-embree        do not compare with Embree

Examples:
  cargo xtask bench-rays --quick
  cargo xtask bench-rays --mesh dragon --mesh kitchen --threads 2
  DURER_SIMD=avx2 cargo xtask bench-rays --mesh dragon --no-peers
  cargo xtask bench-rays --edges 10000000 --threads 2
  cargo xtask bench-rays --mesh bunny --instances 64

Meshes are read from ../shared/meshes or from the folder DURER_CORPUS; DURER_EMBREE is the path of Embree.";

/// Command-line options of `cargo xtask bench-rays`.
pub struct Options {
    pub meshes: Vec<PathBuf>,
    pub cases: Vec<String>,
    pub preset: durer::bvh::BuildQuality,
    pub threads: usize,
    pub side: u32,
    pub rounds: usize,
    pub edges: Option<u32>,
    pub instances: Option<u32>,
    pub arrays: Option<PathBuf>,
    pub peers: bool,
    pub embree: Option<PathBuf>,
}

impl Options {
    /// Returns true if this kind of rays is selected.
    pub fn wants(&self, case: &rays::RayCase) -> bool {
        self.cases.is_empty() || self.cases.iter().any(|name| name == case.name)
    }
}

fn options(arguments: &[String]) -> Result<Options> {
    let (mut names, mut cases) = (Vec::new(), Vec::new());
    let mut preset = durer::bvh::BuildQuality::Best;
    let (mut threads, mut side, mut rounds, mut quick) = (1, None, None, false);
    let (mut peers, mut use_embree, mut edges, mut instances, mut arrays) = (true, true, None, None, None);
    let mut words = arguments.iter();
    while let Some(word) = words.next() {
        let mut value = || words.next().with_context(|| format!("`{word}` needs a value"));
        match word.as_str() {
            "--quick" => quick = true,
            "--mesh" => names.push(value()?.clone()),
            "--case" => cases.push(value()?.clone()),
            "--preset" => {
                let name = value()?;
                let found = durer::bvh::BuildQuality::NAMES.iter().find(|(n, _)| n == name);
                preset = found.with_context(|| format!("no preset `{name}`"))?.1;
            }
            "--threads" => threads = value()?.parse::<usize>()?.clamp(1, 1024),
            "--side" => side = Some(value()?.parse::<u32>()?.clamp(8, 8192) / 8 * 8),
            "--rounds" => rounds = Some(value()?.parse::<usize>()?.max(1)),
            "--edges" => edges = Some(value()?.parse::<u32>()?),
            "--instances" => instances = Some(value()?.parse::<u32>()?.clamp(1, 4096)),
            "--arrays" => arrays = Some(PathBuf::from(value()?)),
            "--no-peers" => peers = false,
            "--no-embree" => use_embree = false,
            _ => bail!("unknown option `{word}`\n\n{USAGE}"),
        }
    }
    let corpus = std::env::var_os("DURER_CORPUS").map_or_else(|| PathBuf::from("../shared"), PathBuf::from);
    if names.is_empty() {
        names = ["bunny", "dragon", "armadillo", "hall", "kitchen", "hairball"].map(String::from).into();
    }
    let path = |name: &String| match name.contains(['/', '.']) {
        true => PathBuf::from(name),
        false => corpus.join("meshes").join(name).with_extension("ply"),
    };
    let embree = if use_embree && arrays.is_none() { Some(embree::find()?) } else { None };
    Ok(Options {
        meshes: names.iter().map(path).collect(),
        cases,
        preset,
        threads,
        side: side.unwrap_or(if quick { 256 } else { 512 }),
        rounds: rounds.unwrap_or(if quick { 5 } else { 9 }),
        edges,
        instances,
        arrays,
        peers,
        embree,
    })
}

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            error.chain().skip(1).for_each(|cause| eprintln!("  {cause}"));
            ExitCode::from(2)
        }
    }
}

fn run() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if arguments.iter().any(|a| a == "--help" || a == "-h") {
        println!("{USAGE}");
        return Ok(());
    }
    durer::bvh::SimdLevel::from_environment()?;
    let options = options(&arguments)?;
    rayon::ThreadPoolBuilder::new().num_threads(options.threads).build_global()?;
    match (options.edges, &options.arrays) {
        (Some(count), _) => edges::run(&options, count),
        (None, Some(folder)) => speed::arrays(folder, &options),
        (None, None) => speed::run(&options),
    }
}
