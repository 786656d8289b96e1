//! `durer farm`: a job for an engine that is there already, over `--shard` and `durer merge`.

use crate::args::FarmArgs;
use crate::embed::Asked;
use crate::output::say;
use crate::{Failure, bad};

const SLURM: &str = include_str!("farm/slurm.sh");
const KUBERNETES: &str = include_str!("farm/k8s.yaml");
const OPENJD: &str = include_str!("farm/openjd.yaml");
const DASK: &str = include_str!("farm/dask.py");

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
