//! Tests of the `durer` command, which run the program.
//! They are one program, so that they are linked once.

mod book;
mod cameras;
mod causes;
mod check;
mod check_models;
mod common;
mod compare;
mod corpus;
mod course;
mod daylight;
mod device;
mod explain;
#[cfg(target_os = "linux")]
mod growth;
#[cfg(unix)]
mod interrupts;
mod lecture;
mod lesson;
mod light;
mod models;
#[cfg(unix)]
mod names;
mod parts;
mod paths;
mod photo;
mod pictures;
mod refusals;
mod samples;
mod sound;
mod teacher;
mod terminal;
#[cfg(unix)]
mod trust;
#[cfg(unix)]
mod watch;
mod words;
