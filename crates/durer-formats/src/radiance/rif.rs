//! Reads `rad` input files, which list the files and views of a scene.

use super::context::PrimitiveContext;
use super::standard::{ViewBox, standard};
use super::state::Reader;
use super::view::{DEFAULT_SIZE, View, last_view};
use super::words::{Word, Words};
use crate::shared_report::suggest;
use durer_diag::Diagnostic;
use durer_scene::math::fp;

/// Names of the variables of `rad`. The first three letters of a name are enough to identify the
/// variable.
const VARIABLES: [&str; 26] = [
    "objects",
    "scene",
    "materials",
    "illum",
    "mkillum",
    "render",
    "oconv",
    "pfilt",
    "view",
    "ZONE",
    "QUALITY",
    "OCTREE",
    "PICTURE",
    "AMBFILE",
    "OPTFILE",
    "EXPOSURE",
    "RESOLUTION",
    "UP",
    "INDIRECT",
    "DETAIL",
    "VARIABILITY",
    "PENUMBRAS",
    "RAWFILE",
    "ZFILE",
    "REPORT",
    "rpict",
];
/// Variables that have no effect on lighting.
const IGNORED_VARIABLES: [&str; 8] = ["PGMAP", "PCMAP", "mkpmap", "rvu", "rtrace", "rpiece", "EYESEP", "MATERIAL"];

/// Line of a `rad` input file, with the full name of a variable and its values.
struct Setting {
    name: &'static str,
    values: Vec<Word>,
}

impl Reader<'_> {
    /// Reads a `rad` input file that is the main file of the scene.
    pub fn rif(&mut self) {
        let (bytes, file) = (self.input.bytes.clone(), self.input.file);
        let settings = self.settings(&bytes, file);
        let place = PrimitiveContext::default();
        for name in ["materials", "illum", "scene"] {
            for value in settings.iter().filter(|setting| setting.name == name).flat_map(|setting| &setting.values) {
                match value.text.starts_with('!') {
                    true => {
                        let range = value.at.start as usize + 1..value.at.end as usize;
                        self.command(Words::new(&bytes, file, range), &place);
                    }
                    false => self.file(value, &place, false),
                }
            }
        }
        if !settings.iter().any(|setting| matches!(setting.name, "scene" | "illum")) {
            let at = durer_diag::Span { file, start: 0, end: bytes.len().min(1) as u32 };
            let help = "octrees are not supported: name the source file of the octree with `scene = FILE.rad`";
            self.report.error_with_help(at, "this file names no scene", Some(help.into()));
        }
        let options = settings.iter().filter(|setting| setting.name == "render").flat_map(|setting| &setting.values);
        for option in options.filter(|option| option.text == "-bv-") {
            let what = "back-face culling (-bv-) has no counterpart: surfaces are visible from both sides";
            self.report.unsupported_once(option.at, what);
        }
        let last = |name: &str| settings.iter().rfind(|setting| setting.name == name).and_then(|s| s.values.first());
        let larger = last("RESOLUTION").and_then(|word| word.text.parse().ok()).filter(|r| (1..=1 << 16).contains(r));
        let exposure = last("EXPOSURE").cloned();
        let views: Vec<&Setting> = settings.iter().filter(|setting| setting.name == "view").collect();
        let of = |name: &str| settings.iter().rfind(|setting| setting.name == name).map(|s| s.values.as_slice());
        let zone = ViewBox::of(of("ZONE"), of("UP"), self);
        self.view(&views, &zone, larger.unwrap_or(DEFAULT_SIZE));
        self.exposure(exposure);
    }

    /// Selects a view by its name or number. The default is the first view.
    fn view(&mut self, views: &[&Setting], zone: &ViewBox, larger: u32) {
        let name = |i: usize| views[i].values.first().filter(|word| !word.text.starts_with('-'));
        let named = |i| name(i).map_or(String::new(), |word| word.text.clone());
        self.scene.camera_names = (0..views.len()).map(named).collect();
        let wanted = match &self.input.scene_defaults.camera {
            None => (!views.is_empty()).then_some(0),
            Some(wanted) => {
                let named = (0..views.len()).find(|&i| name(i).is_some_and(|word| word.text == *wanted));
                let found = named.or_else(|| wanted.parse().ok().filter(|i| *i < views.len()));
                if let (None, Some(seen)) = (found, standard(wanted)) {
                    return zone.view(seen, Default::default()).apply(&mut self.scene, larger, self.report);
                }
                if found.is_none() {
                    let known: Vec<&str> =
                        (0..views.len()).filter_map(|i| name(i).map(|word| word.text.as_str())).collect();
                    let help = match suggest(wanted, known.iter().copied()) {
                        Some(suggestion) => suggestion,
                        None if known.is_empty() => "the file names no views".into(),
                        None => format!("known views are {}", known.join(", ")),
                    };
                    let error = Diagnostic::error(format!("unknown view `{wanted}`")).code("no-camera");
                    self.report.push(Diagnostic { help: Some(help), ..error });
                }
                found
            }
        };
        let Some(number) = wanted else { return };
        let skip = usize::from(name(number).is_some());
        let values = &views[number].values;
        let words = &values[skip..];
        let at = values.first().map_or(Default::default(), |word| word.at);
        let seen = name(number).and_then(|word| standard(&word.text));
        let mut view = seen.map_or_else(|| View::new(at), |seen| zone.view(seen, at));
        if let Some(i) = words.iter().position(|word| word.text == "-vf") {
            let Some(path) = words.get(i + 1) else {
                return self.report.error(words[i].at, "`-vf` needs a file");
            };
            let Some((bytes, file)) = self.open(path) else { return };
            let Some(found) = last_view(&bytes, file, self.report) else { return };
            view = found;
        }
        let own: Vec<Word> = words
            .iter()
            .enumerate()
            .filter(|(i, word)| word.text != "-vf" && (*i == 0 || words[i - 1].text != "-vf"))
            .map(|(_, word)| word.clone())
            .collect();
        view.options(&own, false, self.report);
        view.apply(&mut self.scene, larger, self.report);
    }

    /// Adds a note about the exposure, which is a number of stops if it has a sign, and a factor
    /// otherwise.
    fn exposure(&self, word: Option<Word>) {
        let Some((word, value)) = word.and_then(|word| word.number(self.report).map(|value| (word, value as f32)))
        else {
            return;
        };
        let stops = match word.text.starts_with(['+', '-']) {
            true => value,
            false => fp::ln(value.max(1e-9)) / std::f32::consts::LN_2,
        };
        if stops != 0.0 {
            let note = Diagnostic::note(format!("the file sets an exposure: use `--exposure {stops:.2}`"));
            self.report.push(note.code("exposure").at(word.at));
        }
    }

    fn settings(&self, bytes: &[u8], file: u32) -> Vec<Setting> {
        let mut settings = Vec::new();
        let mut start = 0;
        while start < bytes.len() {
            let mut end = start;
            // A backslash at the end of a line continues the line.
            loop {
                end += bytes[end..].iter().take_while(|byte| **byte != b'\n').count();
                let line = &bytes[start..end];
                if end >= bytes.len() || !(line.ends_with(b"\\") || line.ends_with(b"\\\r")) {
                    break;
                }
                end += 1;
            }
            let line = start..end;
            start = (end + 1).min(bytes.len());
            if bytes[line.clone()].trim_ascii_start().first().is_none_or(|byte| *byte == b'#') {
                continue;
            }
            let all = Words::new(bytes, file, line.clone());
            let Some(equals) = bytes[line.clone()].iter().position(|byte| *byte == b'=') else {
                self.report.error(all.span(line.start, line.end), "a line must have the form `VARIABLE = values`");
                continue;
            };
            let mut words = Words::new(bytes, file, line.start..line.start + equals);
            let Some(name) = words.next() else {
                self.report
                    .error(all.span(line.start, line.start + equals + 1), "a variable is missing before this `=`");
                continue;
            };
            let mut words = Words::new(bytes, file, line.start + equals + 1..line.end);
            let values = std::iter::from_fn(|| words.next()).collect();
            let short = name.text.to_lowercase();
            let is = |full: &&&str| {
                let full = full.to_lowercase();
                full == short || (short.len() >= 3 && (full.starts_with(&short) || short.starts_with(&full)))
            };
            match VARIABLES.iter().chain(&IGNORED_VARIABLES).find(is) {
                Some(full) => settings.push(Setting { name: full, values }),
                None => {
                    let help = suggest(&name.text, VARIABLES);
                    self.report.error_with_help(name.at, format!("`rad` has no variable {}", name.quoted()), help);
                }
            }
        }
        settings
    }
}
