//! `durer farm`: a job for an engine that is there already, over `--shard` and `durer merge`.

use crate::embed::Asked;
use crate::output::say;
use crate::{Failure, bad};
use clap::Args;
use std::path::PathBuf;

const SLURM: &str = include_str!("farm/slurm.sh");
const KUBERNETES: &str = include_str!("farm/k8s.yaml");
const OPENJD: &str = include_str!("farm/openjd.yaml");
const DASK: &str = include_str!("farm/dask.py");

/// Print what a farm needs to render a scene in shards, for an engine that is there already
#[derive(Args)]
#[command(after_help = "Examples:
  durer farm scene.txt --template slurm --shards 64 --samples 256 > job.sh && sbatch job.sh
  durer farm scene.txt --template k8s --shards 16 > job.yaml && kubectl apply -f job.yaml
  durer farm scene.txt --template openjd > job.yaml && openjd check job.yaml
  durer farm scene.txt --template dask > render.py && python render.py

Each shard is `durer render --shard`, and may be done again on another machine; `durer merge` gives the bytes of one run. The
options of the render stand after those of the farm; they are checked here.")]
pub struct FarmArgs {
    /// The scene file
    pub scene: PathBuf,
    /// For which engine
    #[arg(long, value_parser = ["slurm", "k8s", "openjd", "dask"])]
    pub template: String,
    /// How many parts
    #[arg(long, default_value_t = 16, value_parser = clap::value_parser!(u32).range(1..=65535))]
    pub shards: u32,
    /// The picture to write in the end [default: the scene's name with .exr]
    #[arg(short, long, value_name = "PICTURE")]
    pub output: Option<PathBuf>,
    /// Options of the render
    #[arg(trailing_var_arg = true, allow_hyphen_values = true, value_name = "OPTIONS")]
    pub options: Vec<String>,
}

/// Prints the template with all that is known filled in.
pub fn run(args: &FarmArgs) -> Result<(), Failure> {
    Asked::new(&args.options).map_err(bad)?;
    let text =
        |path: &std::path::Path| path.to_str().map(String::from).ok_or_else(|| bad(format!("{path:?} is not UTF-8")));
    let scene = text(&args.scene)?;
    let stem = args.scene.file_stem().and_then(|stem| stem.to_str()).unwrap_or("picture").to_string();
    let output = args.output.as_deref().map_or_else(|| Ok(format!("{stem}.exr")), text)?;
    let quoted =
        |word: &str| shlex::try_quote(word).map(String::from).map_err(|_| bad(format!("{word:?} cannot be quoted")));
    let options = args.options.iter().map(|word| quoted(word)).collect::<Result<Vec<_>, _>>()?.join(" ");
    // Names of jobs are letters, digits and dashes.
    let name: String = stem.to_lowercase().chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '-' }).collect();
    let name = format!("durer-{}", name.trim_matches('-'));
    let template = match args.template.as_str() {
        "slurm" => SLURM,
        "k8s" => KUBERNETES,
        "openjd" => OPENJD,
        _ => DASK,
    };
    let filled = template
        .replace("@NAME@", &name)
        .replace("@SHARDS@", &args.shards.to_string())
        .replace("@LAST@", &(args.shards - 1).to_string())
        .replace("@SCENE@", &quoted(&scene)?)
        .replace("@OUTPUT@", &quoted(&output)?)
        .replace("@OPTIONS@", &options)
        .replace("@SCENE_JSON@", &serde_json::json!(scene).to_string())
        .replace("@OUTPUT_JSON@", &serde_json::json!(output).to_string())
        .replace("@WORDS_JSON@", &serde_json::json!(args.options).to_string());
    say(filled.trim_end());
    Ok(())
}
