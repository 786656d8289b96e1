//! `cargo xtask course`: compares our pictures with the official pictures of the course.

mod regressions;

use anyhow::{Context, Result, bail};
use durer::image::{Image8, read8};
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Stdio};

/// Maximum difference in a channel that counts as rounding.
const ROUNDING: u8 = 2;
/// Number of renders with different seeds, which show the variation of pictures with random
/// samples.
const SEEDS: u64 = 8;

/// A row of the list of official pictures: how the picture was rendered and how to compare it.
#[derive(Clone, Debug)]
pub struct Row {
    picture: String,
    /// Year of the scene, which is also the name of its folder.
    pub dialect: String,
    shows: String,
    compare: String,
    /// Official program that rendered the picture.
    pub program: String,
    /// Arguments of the program; empty if unknown.
    pub arguments: String,
}

/// Result of comparing one of our pictures with the official one.
struct RowResult {
    /// Percentage of pixels that differ by more than rounding, or another measure.
    share: f64,
    largest: u8,
    verdict: Verdict,
    remark: String,
}

/// Result of a comparison: passed, failed, or to be judged by eye.
#[derive(PartialEq)]
enum Verdict {
    Pass,
    Fail,
    ByEye,
}

/// An official picture that differs from ours for a known reason.
struct KnownDifference {
    picture: &'static str,
    /// Percentage of differing pixels that this reason explains. A larger percentage has another
    /// cause.
    most: f64,
    words: &'static str,
}

const fn reason(picture: &'static str, most: f64, words: &'static str) -> KnownDifference {
    KnownDifference { picture, most, words }
}

/// Pictures with known differences. They do not count as passed.
const REASONS: &[KnownDifference] = &[reason(
    "output7_02e.png",
    0.17,
    "at the horizon, fields are far smaller than a pixel, so rounding of the old program decides",
)];

/// Pictures that were rendered from an edited scene, with the old and the new text of each edit.
const EDITED_SCENES: &[(&str, &[(&str, &str)])] = &[
    // Recovered from the picture: 5 of its 40,000 pixels differ.
    (
        "output5_03.png",
        &[
            ("center 0 3 10", "center 2.0375281 5.9800980 9.3264785"),
            ("direction 0 0 -1", "direction -0.2045029 -0.2860005 -0.9361529"),
            ("size 5", "size 5.00053"),
        ],
    ),
    // The two materials of the board are exchanged here, but not in output7_04a, which uses the
    // same scene.
    ("output6_18a.png", &[("materialIndex 3\n\tmaterialIndex 6", "materialIndex 6\n\tmaterialIndex 3")]),
];

/// Runs `cargo xtask course`.
pub fn run(arguments: &[String]) -> Result<ExitCode> {
    let value = |name| crate::value(arguments, name);
    let guess = arguments.iter().any(|a| a == "--guess");
    let (only, keep) = (value("--only"), value("--keep").map(PathBuf::from));
    let corpus = crate::corpus();
    let course = corpus.join("course").canonicalize().context("the course is missing; set DURER_CORPUS")?;
    let durer = crate::build::build_durer()?;
    let out = keep.clone().unwrap_or_else(|| std::env::temp_dir().join(format!("durer-course-{}", std::process::id())));
    std::fs::create_dir_all(&out)?;
    let out = out.canonicalize()?;
    let rows = rows(&course)?;
    let (mut passed, mut failed, mut looked, mut explained) = (0, 0, 0, 0);
    let mut bench = Comparison { durer, course, out: out.clone(), guess, made: HashMap::new() };
    for row in rows.iter().filter(|row| only.is_none_or(|text| format!("{row:?}").contains(text.as_str()))) {
        if row.arguments.is_empty() {
            looked += 1;
            continue;
        }
        let finding = match bench.compare(row) {
            Ok(finding) => finding,
            Err(error) => {
                RowResult { share: 100.0, largest: 255, verdict: Verdict::Fail, remark: format!("{error:#}") }
            }
        };
        let known = |reason: &&KnownDifference| row.picture.ends_with(reason.picture) && finding.share <= reason.most;
        let reason = REASONS.iter().find(known).map(|reason| reason.words);
        let verdict = match (&finding.verdict, reason) {
            (Verdict::Pass, _) => "pass",
            (Verdict::ByEye, _) => "look",
            (Verdict::Fail, Some(_)) => "ODD",
            (Verdict::Fail, None) => "FAIL",
        };
        match verdict {
            "pass" => passed += 1,
            "look" => looked += 1,
            "ODD" => explained += 1,
            _ => failed += 1,
        }
        let name = row.picture.trim_start_matches("reference/");
        let remark = [finding.remark.as_str(), reason.filter(|_| verdict == "ODD").unwrap_or("")].join(" ");
        println!(
            "{verdict:<5}{:>8.3} %  {:>3}  {:<11}{name:<42} {}",
            finding.share,
            finding.largest,
            row.compare,
            remark.trim()
        );
    }
    let small = corpus.join("faults/course");
    let (durer, scenes) = (bench.durer, bench.course.join("scenes"));
    let wrong = match small.canonicalize() {
        Ok(folder) if !guess => regressions::run(&durer, &folder, &scenes, &out, only.map(String::as_str))?,
        _ => 0,
    };
    failed += wrong;
    if keep.is_none() {
        std::fs::remove_dir_all(&out)?;
    }
    println!(
        "\n{passed} passed, {failed} failed, {explained} differ for a known reason, {looked} for visual comparison only"
    );
    Ok(if failed == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// Reads the rows of the reference list.
pub fn rows(course: &Path) -> Result<Vec<Row>> {
    let mut reader = csv::Reader::from_path(course.join("reference.csv"))?;
    let mut rows = Vec::new();
    for record in reader.records() {
        let record = record?;
        let field = |i: usize| record.get(i).unwrap_or_default().to_string();
        rows.push(Row {
            picture: field(0),
            dialect: field(1),
            shows: field(2),
            compare: field(3),
            program: field(4),
            arguments: field(5),
        });
    }
    Ok(rows)
}

/// State of the comparison: paths, options, and the pictures rendered so far.
struct Comparison {
    durer: PathBuf,
    course: PathBuf,
    out: PathBuf,
    guess: bool,
    /// Folders with our pictures, by dialect, program, arguments and seed.
    made: HashMap<String, PathBuf>,
}

impl Comparison {
    fn compare(&mut self, row: &Row) -> Result<RowResult> {
        let reference = read(&self.course.join(&row.picture))?;
        let ours = self.picture(row, 0)?;
        if (ours.width, ours.height) != (reference.width, reference.height) {
            bail!("{} x {} instead of {} x {}", ours.width, ours.height, reference.width, reference.height);
        }
        let (share, largest) = difference(&ours, &reference);
        self.keep_difference(row, &ours, &reference)?;
        let limit = match row.compare.as_str() {
            "exact" => {
                if self.refracts(row) {
                    0.5
                } else {
                    0.1
                }
            }
            "exit-r0" => 0.5,
            "procedural" => 1.0,
            "random" => return self.compare_random(row, &reference, share, largest),
            "grid" => return Ok(compare_silhouettes(&ours, &reference, largest)),
            _ => return Ok(RowResult { share, largest, verdict: Verdict::ByEye, remark: String::new() }),
        };
        let verdict = if share <= limit { Verdict::Pass } else { Verdict::Fail };
        Ok(RowResult { share, largest, verdict, remark: String::new() })
    }

    /// Returns our picture for a row. Each combination of arguments and seed is rendered only once.
    fn picture(&mut self, row: &Row, seed: u64) -> Result<Image8> {
        let key = format!("{} {} {} {seed}", row.dialect, row.program, row.arguments);
        let folder = match self.made.get(&key) {
            Some(folder) => folder.clone(),
            None => {
                let folder = self.make(row, seed)?;
                self.made.insert(key, folder.clone());
                folder
            }
        };
        read(&folder.join(output_name(row)?))
    }

    fn make(&self, row: &Row, seed: u64) -> Result<PathBuf> {
        let folder = self.out.join(self.made.len().to_string());
        std::fs::create_dir_all(&folder)?;
        let mut command = Command::new(&self.durer);
        command.current_dir(self.course.join("scenes").join(&row.dialect));
        command.args(["course", "--quiet", "--seed", &seed.to_string()]);
        if !self.guess {
            command.args(["--program", &row.program]);
        } else if row.compare == "exit-r0" {
            command.args(["--compat", "exit-r0"]);
        }
        let words: Vec<&str> = row.arguments.split_whitespace().collect();
        let amended = EDITED_SCENES.iter().find(|(picture, _)| row.picture.ends_with(picture));
        for (i, word) in words.iter().enumerate() {
            if let (Some((_, edits)), Some(&"-input")) = (amended, i.checked_sub(1).map(|i| &words[i])) {
                let scene = self.course.join("scenes").join(&row.dialect).join(word);
                let text = std::fs::read_to_string(&scene)?.replace('\r', "");
                let path = folder.join(word);
                if let Some((from, _)) = edits.iter().find(|(from, _)| !text.contains(from)) {
                    bail!("{word} does not contain `{from}`");
                }
                std::fs::write(&path, edits.iter().fold(text, |text, (from, to)| text.replacen(from, to, 1)))?;
                command.arg(path).arg("--allow-outside").arg("--assets").arg(scene.parent().unwrap_or(&scene));
                continue;
            }
            let is_output = files(&words).any(|(_, at)| at == i);
            if is_output {
                command.arg(folder.join(word))
            } else {
                command.arg(word)
            };
        }
        let output = command.stdin(Stdio::null()).output()?;
        if !output.status.success() {
            bail!("{}", String::from_utf8_lossy(&output.stderr).lines().next().unwrap_or("failed"));
        }
        Ok(folder)
    }

    fn refracts(&self, row: &Row) -> bool {
        let words: Vec<&str> = row.arguments.split_whitespace().collect();
        let scene = words.iter().position(|w| *w == "-input").and_then(|i| words.get(i + 1));
        let path = scene.map(|scene| self.course.join("scenes").join(&row.dialect).join(scene));
        let text = path.and_then(|path| std::fs::read_to_string(path).ok()).unwrap_or_default();
        text.contains("transparentColor") || text.contains("refractionIndex")
    }

    /// Compares mean and spread: the official picture should look like one of our pictures with
    /// another seed.
    fn compare_random(&mut self, row: &Row, reference: &Image8, share: f64, largest: u8) -> Result<RowResult> {
        let ours: Vec<Image8> = (0..SEEDS).map(|seed| self.picture(row, seed)).collect::<Result<_>>()?;
        let n = SEEDS as f64;
        let channels = |image: &Image8| -> Vec<f64> { image.pixels.iter().flatten().map(|&c| f64::from(c)).collect() };
        let values: Vec<Vec<f64>> = ours.iter().map(channels).collect();
        let theirs = channels(reference);
        let mean_of = |v: &[f64]| v.iter().sum::<f64>() / v.len() as f64;
        // Compute the distance of each picture from the mean of the others, in the same way for our
        // pictures and the official one.
        let sums: Vec<f64> = (0..theirs.len()).map(|i| values.iter().map(|v| v[i]).sum()).collect();
        let spread = |picture: &[f64], others: &dyn Fn(usize) -> f64| {
            (picture.iter().enumerate().map(|(i, v)| square(v - others(i))).sum::<f64>() / picture.len() as f64).sqrt()
        };
        let own: Vec<f64> = values.iter().map(|v| spread(v, &|i| (sums[i] - v[i]) / (n - 1.0))).collect();
        let reference_spread = spread(&theirs, &|i| sums[i] / n);
        let means: Vec<f64> = values.iter().map(|v| mean_of(v)).collect();
        let mean = mean_of(&means);
        let deviation = (means.iter().map(|m| square(m - mean)).sum::<f64>() / (n - 1.0)).sqrt();
        let mean_difference = mean_of(&theirs) - mean;
        let own_spread = mean_of(&own);
        let spread_deviation = (own.iter().map(|s| square(s - own_spread)).sum::<f64>() / (n - 1.0)).sqrt();
        let spread_difference = reference_spread - own_spread;
        // Allow four standard deviations, plus the maximum effect of truncation to integer grey
        // levels, which is zero for most pixels.
        let chance = 4.0 * (1.0 + 1.0 / n).sqrt();
        let mean_equal = mean_difference.abs() <= chance * deviation + 0.1;
        let spread_equal = spread_difference.abs() <= chance * spread_deviation + 0.1;
        let verdict = if mean_equal && spread_equal { Verdict::Pass } else { Verdict::Fail };
        let remark = format!(
            "mean {mean_difference:+.3} (deviation {deviation:.3}), \
             spread {own_spread:.3} {spread_difference:+.3} (deviation {spread_deviation:.3})"
        );
        Ok(RowResult { share, largest, verdict, remark })
    }

    fn keep_difference(&self, row: &Row, ours: &Image8, reference: &Image8) -> Result<()> {
        use durer::image::{Image, Layer, Transfer, WriteOptions, format_for};
        let name = row.picture.trim_start_matches("reference/").replace('/', "_");
        let shown = [ours, reference].map(|image| image.pixels.iter().map(|p| p.map(f32::from)).collect::<Vec<_>>());
        let mut pixels = Vec::new();
        // Write our picture, the official one, and eight times the difference, side by side.
        let width = ours.width as usize;
        for y in 0..ours.height as usize {
            for part in 0..3 {
                let row = y * width..(y + 1) * width;
                for (a, b) in shown[0][row.clone()].iter().zip(&shown[1][row]) {
                    let color = match part {
                        0 => *a,
                        1 => *b,
                        _ => std::array::from_fn(|c| ((a[c] - b[c]).abs() * 8.0).min(255.0)),
                    };
                    pixels.push(durer::math::Vec3::from(color) / 255.0);
                }
            }
        }
        let image = Image::from_pixels(ours.width * 3, ours.height, pixels)?;
        let path = self.out.join(name);
        let mut bytes = Vec::new();
        let options = WriteOptions { display: Transfer::Linear.into(), ..WriteOptions::default() };
        format_for(&path)?.write(&[Layer::color("color", image)], &options, &mut bytes)?;
        durer::image::save(&path, &bytes)?;
        Ok(())
    }
}

fn square(x: f64) -> f64 {
    x * x
}

/// Iterates over the output files among the arguments: the option and the index of the file.
pub fn files<'a>(words: &'a [&'a str]) -> impl Iterator<Item = (&'a str, usize)> {
    const OUTPUTS: [(&str, usize); 5] =
        [("-output", 1), ("-depth", 3), ("-normals", 1), ("-render_samples", 1), ("-render_filter", 1)];
    words
        .iter()
        .enumerate()
        .filter_map(|(i, word)| OUTPUTS.iter().find(|(name, _)| name == word).map(|(name, offset)| (*name, i + offset)))
}

/// Returns the name of the output file that the row's picture is compared with.
fn output_name(row: &Row) -> Result<String> {
    let option = match row.shows.as_str() {
        "color" => "-output",
        "depth" => "-depth",
        "normals" => "-normals",
        "samples" => "-render_samples",
        "filter" => "-render_filter",
        other => bail!("unknown kind of picture: {other}"),
    };
    let words: Vec<&str> = row.arguments.split_whitespace().collect();
    let place = files(&words).find(|(name, _)| *name == option).map(|(_, place)| place);
    place.and_then(|place| words.get(place)).map(|name| name.to_string()).context("the row does not write this picture")
}

fn read(path: &Path) -> Result<Image8> {
    let bytes = std::fs::read(path).with_context(|| path.display().to_string())?;
    Ok(read8(&bytes, &path.to_string_lossy())?)
}

/// Returns the percentage of pixels that differ by more than rounding, and the largest difference.
fn difference(a: &Image8, b: &Image8) -> (f64, u8) {
    let of_pixel = |(p, q): (&[u8; 3], &[u8; 3])| (0..3).map(|c| p[c].abs_diff(q[c])).max().unwrap_or(0);
    let differences: Vec<u8> = a.pixels.iter().zip(&b.pixels).map(of_pixel).collect();
    let beyond = differences.iter().filter(|&&d| d > ROUNDING).count();
    (100.0 * beyond as f64 / differences.len().max(1) as f64, differences.into_iter().max().unwrap_or(0))
}

/// Checks that both pictures differ from the background at the same pixels. The background is the
/// most common colour on the border.
fn compare_silhouettes(ours: &Image8, reference: &Image8, largest: u8) -> RowResult {
    let background = |image: &Image8| {
        let (w, h) = (image.width as usize, image.height as usize);
        let mut counts: HashMap<[u8; 3], usize> = HashMap::new();
        for i in 0..w * h {
            if i < w || i >= w * (h - 1) || i % w == 0 || i % w == w - 1 {
                *counts.entry(image.pixels[i]).or_default() += 1;
            }
        }
        counts.into_iter().max_by_key(|(color, count)| (*count, *color)).map_or([0; 3], |c| c.0)
    };
    let (a, b) = (background(ours), background(reference));
    let differ = ours.pixels.iter().zip(&reference.pixels).filter(|(p, q)| (**p == a) != (**q == b)).count();
    let share = 100.0 * differ as f64 / ours.pixels.len() as f64;
    let verdict = if share <= 0.1 { Verdict::Pass } else { Verdict::Fail };
    RowResult { share, largest, verdict, remark: "silhouette".into() }
}
