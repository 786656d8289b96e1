//! The definition of the command line and its subcommands.

use crate::check::CheckArgs;
use crate::compare::CompareArgs;
use crate::convert::ConvertArgs;
use crate::course::CourseArgs;
use crate::explain::ExplainArgs;
use crate::farm::FarmArgs;
use crate::info::InfoArgs;
use crate::lesson::LessonArgs;
use crate::live::LiveArgs;
use crate::measure::MeasureArgs;
use crate::merge::MergeArgs;
use crate::photo::PhotoArgs;
use crate::render::RenderCommand;
use crate::verify::VerifyArgs;
use crate::words::WordsArgs;
use clap::{Args, Parser, Subcommand};
use std::path::PathBuf;

/// A ray tracer: exact, explainable, deterministic.
#[derive(Parser)]
#[command(
    name = "durer",
    version,
    arg_required_else_help = true,
    after_help = "Examples:
  durer render scene.txt -o picture.png
  durer info scene.txt
  durer help render"
)]
pub struct Cli {
    #[command(subcommand)]
    pub command: Command,
}

// The subcommands of `durer`. A doc comment here would replace the program's description.
#[derive(Subcommand)]
pub enum Command {
    Render(Box<RenderCommand>),
    Explain(Box<ExplainArgs>),
    Lesson(Box<LessonArgs>),
    Live(LiveArgs),
    Check(Box<CheckArgs>),
    Farm(FarmArgs),
    Merge(MergeArgs),
    Verify(Box<VerifyArgs>),
    Course(CourseArgs),
    Info(InfoArgs),
    Measure(Box<MeasureArgs>),
    Convert(ConvertArgs),
    Compare(Box<CompareArgs>),
    Photo(PhotoArgs),
    /// List the dialects of the scene language and the quirks of the official programs
    #[command(after_help = "Example:\n  durer dialects")]
    Dialects,
    /// Look up a word of the scene language: its fields, its dialects, and an example
    #[command(
        after_help = "Examples:\n  durer words\n  durer words PhongMaterial\n  durer words falloff --dialect f16"
    )]
    Words(WordsArgs),
    /// Print shell completions to standard output
    #[command(after_help = "Example:\n  durer completions bash > ~/.local/share/bash-completion/completions/durer")]
    Completions {
        /// Shell to print completions for
        shell: clap_complete::Shell,
    },
    Man(ManArgs),
}

/// Print the manual page of the program or of a command
#[derive(Args)]
#[command(after_help = "Examples:
  durer man render | man -l -
  durer man --folder ~/.local/share/man/man1")]
pub struct ManArgs {
    /// Command whose page is printed
    pub command: Option<String>,
    /// Folder into which the pages of the program and of all commands are written: durer.1,
    /// durer-render.1 and so on
    #[arg(long, value_name = "FOLDER", conflicts_with = "command")]
    pub folder: Option<PathBuf>,
}
