//! What a picture is: one statement of its options, and what decides where none is given.
//!
//! [`RenderJob`] holds the options that are given. The command line, the text that repeats a job
//! ([`RenderJob::spelled`]), JSON and Python's arguments walk [`RenderJob::OPTIONS`].
//! [`RenderJob::resolve`] makes a [`Job`] of them, with defaults from the scene.

use durer_diag::did_you_mean;
use durer_render::film::Filter;
use durer_render::film::aov::Aov;
use durer_render::film::course::CourseFilter;
use durer_render::film::false_color::LightScale;
use durer_render::integrator::{Method, Settings};
use durer_render::render::{Crop, Job, Sampling};
use durer_scene::camera::{Projection, Raster};
use durer_scene::describe::{DescribedList, Field, Value};
use durer_scene::dialect::{Dialect, Rules};
use durer_scene::sampler::Sampler;
use durer_scene::scene::Scene;

/// Samples a pixel at most where a noise threshold decides.
const MAX_FOR_NOISE: u32 = 4096;
/// Least throughput of a ray that is followed.
const MIN_THROUGHPUT: f32 = 1.0 / 256.0;

/// How often a path is scattered after its first hit, unless the scene or an option says otherwise.
pub const PATH_BOUNCES: u32 = 16;

/// What stands after an option.
#[derive(Clone, Copy, Debug)]
pub enum OptionForm {
    /// Nothing.
    Flag,
    /// `on`, `off`, or nothing for `on`.
    Switch,
    /// A whole number in a range, both ends included.
    Whole(u32, u32),
    /// A number, or several joined by a letter; the name of the value.
    Value(&'static str),
    /// A number of which the test is true; the name of the value, the test, and what to say else.
    Number(&'static str, fn(f32) -> bool, &'static str),
    /// Two numbers, parted by a blank; their names.
    Two(&'static str, &'static str),
    /// One of some words.
    Words(fn() -> Vec<&'static str>),
}

/// An option of a picture.
#[derive(Clone, Copy, Debug)]
pub struct JobOption {
    /// Name on the command line, without dashes.
    pub name: &'static str,
    /// Meaning, unit and default.
    pub doc: &'static str,
    /// What stands after it.
    pub form: OptionForm,
}

/// A type that an option can have, as text.
trait OptionValue: Sized {
    fn parse(text: &str) -> Result<Self, String>;
    fn shown(&self) -> String;
}

impl OptionValue for bool {
    fn parse(text: &str) -> Result<Self, String> {
        match text {
            "on" => Ok(true),
            "off" => Ok(false),
            _ => Err("say `on` or `off`".into()),
        }
    }
    fn shown(&self) -> String {
        if *self { "on".into() } else { "off".into() }
    }
}

macro_rules! numbers {
    ($($type:ty: $what:literal),+) => {
        $(impl OptionValue for $type {
            fn parse(text: &str) -> Result<Self, String> {
                text.parse().map_err(|_| concat!("say ", $what).into())
            }
            fn shown(&self) -> String {
                self.to_string()
            }
        })+
    };
}

numbers!(u32: "a whole number", u64: "a whole number", f32: "a number", String: "a word");

/// Columns and rows.
impl OptionValue for (u32, u32) {
    fn parse(text: &str) -> Result<Self, String> {
        let parsed = text.split_once(['x', 'X']).and_then(|(w, h)| Some((w.parse().ok()?, h.parse().ok()?)));
        match parsed.ok_or("say it as 640x480")? {
            (0, _) | (_, 0) => Err("a picture has at least one pixel".into()),
            size => Ok(size),
        }
    }
    fn shown(&self) -> String {
        format!("{}x{}", self.0, self.1)
    }
}

/// Two numbers.
impl OptionValue for [f32; 2] {
    fn parse(text: &str) -> Result<Self, String> {
        let numbers: Option<Vec<f32>> = text.split_whitespace().map(|word| word.parse().ok()).collect();
        numbers.and_then(|numbers| numbers.try_into().ok()).ok_or_else(|| "say two numbers".into())
    }
    fn shown(&self) -> String {
        format!("{} {}", self[0], self[1])
    }
}

macro_rules! options {
    (
        $(#[doc = $doc:literal])+
        $name:ident {
            $( $(#[doc = $fdoc:literal])+ $field:ident: $type:ty = $word:literal, $form:expr; )*
        }
    ) => {
        $(#[doc = $doc])+
        #[derive(Clone, Debug, Default, PartialEq)]
        pub struct $name {
            $($field: Option<$type>,)*
            method: Option<String>,
            method_options: Vec<(&'static str, Value)>,
        }

        impl $name {
            /// All options but those of integrators, which state their own: see [`Method`].
            pub const OPTIONS: &'static [JobOption] =
                &[$(JobOption { name: $word, doc: concat!($($fdoc, "\n"),+), form: $form },)*];

            $($(#[doc = $fdoc])+
            #[must_use]
            pub fn $field(mut self, value: impl Into<$type>) -> Self {
                self.$field = Some(value.into());
                self
            })*

            /// Sets an option by its name on the command line, from the text after it: nothing for a
            /// flag.
            ///
            /// # Errors
            ///
            /// A sentence, if there is no such option, or the text is no value of it.
            pub fn set(&mut self, name: &str, text: &str) -> Result<(), String> {
                let option = RenderJob::OPTIONS.iter().find(|option| option.name == name);
                match option.map(|option| option.form) {
                    Some(OptionForm::Flag | OptionForm::Switch) if text.is_empty() => return self.set(name, "on"),
                    Some(OptionForm::Whole(least, most)) => {
                        let value: u32 = text.parse().map_err(|_| "say a whole number".to_string())?;
                        if !(least..=most).contains(&value) {
                            return Err(format!("{value} is not in {least}..={most}"));
                        }
                    }
                    Some(OptionForm::Number(_, test, otherwise)) if !text.parse().is_ok_and(test) => {
                        return Err(otherwise.into());
                    }
                    Some(OptionForm::Words(words)) if !words().contains(&text) => {
                        return Err(format!("it is one of {}", words().join(", ")));
                    }
                    _ => {}
                }
                match name {
                    $($word => self.$field = Some(OptionValue::parse(text)?),)*
                    _ => return self.set_of_method(name, text),
                }
                Ok(())
            }

            /// The text after an option; `None` where it is not given.
            pub fn get(&self, name: &str) -> Option<String> {
                match name {
                    $($word => self.$field.as_ref().map(OptionValue::shown),)*
                    _ => None,
                }
            }
        }
    };
}

options! {
    /// Options of a picture. What is not given follows from the scene: see [`RenderJob::resolve`].
    ///
    /// ```
    /// use durer::job::RenderJob;
    ///
    /// let mut job = RenderJob::default().size((640, 480)).samples(64_u32);
    /// job.set("filter", "mitchell").unwrap();
    /// assert_eq!(job.get("size").as_deref(), Some("640x480"));
    /// assert!(job.set("samples", "0").is_err());
    /// ```
    RenderJob {
        /// Size in pixels [default: 512x512; with --dialect, that year's]
        size: (u32, u32) = "size", OptionForm::Value("WIDTHxHEIGHT");
        /// Depths shown as the two ends of grey [default: those in the picture]
        depth_range: [f32; 2] = "depth-range", OptionForm::Two("MIN", "MAX");
        /// Luminance or illuminance shown as the first and the last false colour [default: 0 and what
        /// 98 % of the picture stay below]
        light_range: [f32; 2] = "light-range", OptionForm::Two("LOW", "HIGH");
        /// False colours of light by equal ratios; --light-range begins above 0
        light_log: bool = "light-log", OptionForm::Flag;
        /// Levels of mirrored and transmitted rays; of paths, how often light is scattered after the
        /// first time [default: 8, of paths 16; with --dialect, that year's]
        bounces: u32 = "bounces", OptionForm::Whole(0, Settings::MAX_BOUNCES);
        /// Whether things cast shadows [default: on; with --dialect, off]
        shadows: bool = "shadows", OptionForm::Switch;
        /// Whether surfaces are shaded from behind too [default: on; with --dialect, off]
        shade_back: bool = "shade-back", OptionForm::Switch;
        /// Let transparent things cast coloured shadows
        transparent_shadows: bool = "transparent-shadows", OptionForm::Flag;
        /// Leave mirrored rays out
        no_reflection: bool = "no-reflection", OptionForm::Flag;
        /// Leave transmitted rays out
        no_refraction: bool = "no-refraction", OptionForm::Flag;
        /// Leave out rays that count for less than this [default: 1/256; with --dialect, 0]
        min_throughput: f32 = "min-throughput",
            OptionForm::Number("SHARE", |x| x.is_finite() && x >= 0.0, "say a number, 0 or more");
        /// Samples a pixel; 1 is the pixel's centre [default: 16, or 64 through a lens or a hole; with
        /// --dialect, 1; with --time-limit, no end; with --noise-threshold, 4096]
        samples: u32 = "samples", OptionForm::Whole(1, Job::MAX_SAMPLES);
        /// Where samples lie; all but sobol are the course's, with its filters
        sampler: String = "sampler", OptionForm::Words(|| Sampler::NAMES.map(|row| row.0).to_vec());
        /// Reconstruction filter [default: blackman-harris; none for the course's samplers]
        filter: String = "filter", OptionForm::Words(|| Filter::NAMES.map(|row| row.0).to_vec());
        /// Radius of the filter in pixels; for the course's Gaussian, its standard deviation
        filter_radius: f32 = "filter-radius", OptionForm::Value("PIXELS");
        /// Three by three jittered sub-pixels, as in 2012
        jitter: bool = "jitter", OptionForm::Flag;
        /// Blur by five taps, as in 2012
        blur: bool = "blur", OptionForm::Flag;
        /// Stop where the estimated error of what is seen is below this; 0.01 is a hundredth of the way
        /// from black to white
        noise_threshold: f32 = "noise-threshold",
            OptionForm::Number("ERROR", |x| x.is_finite() && x > 0.0, "say a number more than 0");
        /// Take --samples a pixel on average: more where the picture is noisier, as a quarter of them
        /// tells
        adaptive: bool = "adaptive", OptionForm::Flag;
        /// Seed of the random numbers
        seed: u64 = "seed", OptionForm::Value("SEED");
    }
}

/// The integrator that a scene needs: paths for layered materials, environments, fog and surfaces
/// that shine, else Whitted's.
pub fn usual_method(scene: &Scene) -> Method {
    if scene.is_physical() { Method::PATH } else { Method::WHITTED }
}

/// Name of an integrator's option on the command line.
pub fn option_name(field: &Field) -> &'static str {
    field.spelling(Dialect::Durer).unwrap_or(field.name)
}

/// Index of an integrator's option of some name.
pub fn option_index(method: &Method, option: &str) -> Option<usize> {
    method.fields().iter().position(|field| option_name(field) == option)
}

/// What a job's defaults follow from.
#[derive(Clone, Copy, Debug)]
pub struct JobContext<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// What its words mean.
    pub rules: &'a Rules,
    /// Whether an old program is followed in all: its dialect was asked for.
    pub emulates: bool,
    /// Whether a time limit decides when there are enough samples.
    pub timed: bool,
}

/// Which pictures are made.
#[derive(Clone, Debug)]
pub struct View {
    /// The part of the picture: left, top, width, height; `None`: the one that the scene asks for.
    pub crop: Option<(u32, u32, u32, u32)>,
    /// Names of pictures: `color`, and those of [`durer_render::film::aov::AOVS`].
    pub show: Vec<String>,
}

impl Default for View {
    fn default() -> Self {
        View { crop: None, show: vec!["color".into()] }
    }
}

impl RenderJob {
    /// Sets the integrator by its name.
    #[must_use]
    pub fn integrator(mut self, name: impl Into<String>) -> Self {
        self.method = Some(name.into());
        self
    }

    /// Sets an option that an integrator states.
    ///
    /// # Errors
    ///
    /// A sentence, if no integrator has it.
    pub fn set_integrator_option(&mut self, name: &str, value: Value) -> Result<(), String> {
        let kinds = Method::kinds();
        let fields = kinds.iter().flat_map(|kind| kind.fields());
        let name = fields.map(option_name).find(|word| *word == name).ok_or_else(|| self.unknown(name))?;
        self.method_options.retain(|known| known.0 != name);
        self.method_options.push((name, value));
        Ok(())
    }

    fn set_of_method(&mut self, name: &str, text: &str) -> Result<(), String> {
        if name == "integrator" {
            self.method = Some(text.into());
            return Ok(());
        }
        let kinds = Method::kinds();
        let field = kinds.iter().flat_map(|kind| kind.fields()).find(|field| option_name(field) == name);
        let kind = field.map(|field| field.kind).ok_or_else(|| self.unknown(name))?;
        use durer_scene::describe::Kind;
        let value = match kind {
            Kind::Word(_) => Value::Word(text.into()),
            Kind::Int => Value::Int(text.parse().map_err(|_| "say a whole number".to_string())?),
            _ => Value::Float(text.parse().map_err(|_| "say a number".to_string())?),
        };
        self.set_integrator_option(name, value)
    }

    fn unknown(&self, name: &str) -> String {
        match did_you_mean(name, RenderJob::OPTIONS.iter().map(|option| option.name)) {
            Some(near) => format!("there is no option `{name}`; did you mean `{near}`?"),
            None => format!("there is no option `{name}`"),
        }
    }

    /// The integrator that is asked for, with its options; without any, the usual one.
    ///
    /// # Errors
    ///
    /// A sentence, if there is no such integrator, or an option is not one of it or out of range.
    pub fn resolved_method(&self, usual: Method) -> Result<Method, String> {
        let has = |kind: &Method, (option, _): &(&str, Value)| option_index(kind, option).is_some();
        let mut methods = std::iter::once(usual).chain(Method::kinds());
        // The one that has all the options, or at least the last.
        let fitting = methods.clone().find(|kind| self.method_options.iter().all(|option| has(kind, option)));
        let last = self.method_options.last();
        let found = match &self.method {
            Some(name) => methods.find(|kind| kind.name() == name),
            None => fitting.or_else(|| methods.find(|kind| last.is_none_or(|option| has(kind, option)))),
        };
        let Some(mut method) = found else {
            let known: Vec<&str> = Method::kinds().iter().map(Method::name).collect();
            return Err(format!("there is no integrator of that name: there are {}", known.join(", ")));
        };
        for (option, value) in &self.method_options {
            let Some(at) = option_index(&method, option) else {
                return Err(format!("--{option} makes no sense with --integrator {}", method.name()));
            };
            if let Err(wrong) = method.fields()[at].rule.validate(value) {
                return Err(format!("--{option} {wrong}"));
            }
            method.set(at, value.clone());
        }
        Ok(method)
    }

    /// The size of the picture that is asked for.
    pub fn given_size(&self) -> Option<(u32, u32)> {
        self.size
    }

    /// Makes a job of what is given and, where nothing is, of what the scene and its rules have as
    /// defaults. Without a view, the whole picture in colour.
    ///
    /// # Errors
    ///
    /// A sentence, if options contradict each other or the scene.
    pub fn resolve(&self, context: &JobContext, view: Option<&View>) -> Result<Job, String> {
        let JobContext { scene, rules, emulates, .. } = *context;
        let camera = scene.camera.as_ref();
        let wishes = scene.wishes;
        let natural = || Raster::natural_size(camera.and_then(|camera| camera.proportions()), rules.size);
        let (width, height) = self.size.or(wishes.size).unwrap_or_else(natural);
        let method = self.resolved_method(usual_method(scene))?;
        // A blur needs more samples than an edge.
        let plenty = if camera.is_some_and(|camera| camera.has_aperture()) || method.is_random() { 64 } else { 16 };
        let plenty = wishes.samples.unwrap_or(plenty);
        let is = |flag: Option<bool>| flag.unwrap_or(false);
        if method.is_random() && (is(self.jitter) || is(self.blur)) {
            return Err(format!("--jitter and --blur make no sense with --integrator {}", method.name()));
        }
        self.check_combination()?;
        let depth_range = self.depth_range.map(|[min, max]| (min, max));
        if depth_range.is_some_and(|(min, max)| !(min.is_finite() && max.is_finite() && min != max)) {
            return Err("--depth-range needs two different numbers".into());
        }
        let logarithmic = is(self.light_log);
        let light_scale = match self.light_range {
            Some([low, high]) => {
                let least = if logarithmic { f32::MIN_POSITIVE } else { 0.0 };
                if !(low >= least && high > low && high.is_finite()) {
                    return Err(match logarithmic {
                        true => "--light-range needs two numbers above 0 with --light-log, the second greater".into(),
                        false => "--light-range needs two numbers from 0 on, the second greater".into(),
                    });
                }
                Some(LightScale { low, high, logarithmic })
            }
            None => None,
        };
        // The part that the scene asks for belongs to the size that it asks for.
        let wished = wishes.crop.filter(|_| wishes.size == Some((width, height)));
        let crop = view.and_then(|view| view.crop.or(wished));
        let shown = view.map_or(&[][..], |view| &view.show);
        Ok(Job {
            width,
            height,
            crop: crop.map(|(left, top, width, height)| Crop { left, top, width, height }),
            seed: self.seed.unwrap_or(0),
            sampling: self.sampling(context, plenty)?,
            noise: self.noise_threshold,
            adaptive: is(self.adaptive),
            method,
            settings: Settings {
                bounces: self.bounces.unwrap_or_else(|| usual_bounces(method, context)),
                shadows: self.shadows.unwrap_or(rules.shadows),
                shade_back: self.shade_back.unwrap_or(rules.shade_back),
                transparent_shadows: is(self.transparent_shadows) || rules.transparent_shadows,
                reflection: !is(self.no_reflection),
                refraction: !is(self.no_refraction),
                least_weight: self.min_throughput.unwrap_or(if emulates { 0.0 } else { MIN_THROUGHPUT }),
            },
            color: view.is_none() || shown.iter().any(|show| show == "color"),
            aovs: shown.iter().filter_map(|name| Aov::from_name(name)).collect(),
            depth_range,
            light_scale,
        })
    }

    /// Refuses options that contradict each other.
    fn check_combination(&self) -> Result<(), String> {
        let is = |flag: Option<bool>| flag.unwrap_or(false);
        let wrong = if (is(self.jitter) || is(self.blur))
            && (self.samples.is_some() || self.sampler.is_some() || self.filter.is_some())
        {
            "--jitter and --blur have samples of their own: leave out --samples, --sampler and --filter"
        } else if is(self.adaptive) && self.noise_threshold.is_some() {
            "--adaptive and --noise-threshold each decide the samples: leave one of them out"
        } else if is(self.adaptive) && (is(self.jitter) || is(self.blur)) {
            "--adaptive cannot divide the samples of --jitter and --blur"
        } else if is(self.light_log) && self.light_range.is_none() {
            "--light-log needs --light-range"
        } else if self.filter_radius.is_some() && self.filter.is_none() {
            "--filter-radius needs --filter"
        } else {
            return Ok(());
        };
        Err(wrong.into())
    }

    fn sampling(&self, context: &JobContext, plenty: u32) -> Result<Sampling, String> {
        let (jitter, blur) = (self.jitter.unwrap_or(false), self.blur.unwrap_or(false));
        if jitter || blur {
            return Ok(Sampling::Course2012 { jitter, blur });
        }
        if self.filter_radius.is_some_and(|r| !(r > 0.0 && r <= Job::MAX_FILTER_RADIUS)) {
            return Err("--filter-radius must be more than 0 and at most 64".into());
        }
        let noise = self.noise_threshold.is_some();
        let sampler = self.sampler.as_deref().and_then(Sampler::from_name).unwrap_or_default();
        if matches!(sampler, Sampler::Uniform | Sampler::Jittered) && (noise || context.timed) {
            return Err("--noise-threshold and --time-limit need a sampler whose first samples are spread over the \
                        pixel: sobol or random"
                .into());
        }
        if self.adaptive == Some(true) && context.timed && self.samples.is_none() {
            return Err("--adaptive divides a number of samples: with --time-limit, say how many with --samples".into());
        }
        let filter = self.filter.as_deref().and_then(Filter::from_name);
        let usual = match (context.emulates, noise, context.timed) {
            (true, ..) => 1,
            (false, true, _) => MAX_FOR_NOISE,
            (false, false, true) => Job::MAX_SAMPLES,
            (false, false, false) => plenty,
        };
        let samples = self.samples.unwrap_or(usual);
        if sampler == Sampler::Sobol {
            let filter = filter.unwrap_or_default();
            let filter = self.filter_radius.map_or(filter, |radius| filter.with_radius(radius));
            return Ok(if samples == 1 { Sampling::Center } else { Sampling::Filtered { samples, filter } });
        }
        let radius = self.filter_radius;
        let filter = match filter {
            None => None,
            Some(Filter::Box { .. }) => Some(CourseFilter::Box { radius: radius.unwrap_or(0.5) }),
            Some(Filter::Tent { .. }) => Some(CourseFilter::Tent { radius: radius.unwrap_or(1.0) }),
            Some(Filter::Gaussian { .. }) => Some(CourseFilter::Gaussian { sigma: radius.unwrap_or(0.5) }),
            Some(_) => return Err("the course's samplers take the filters box, tent and gaussian".into()),
        };
        Ok(Sampling::Course2004 { sampler, samples, filter })
    }

    /// The options that make a job of a scene, but for its size and view: those whose values are not
    /// the scene's defaults. The inverse of [`RenderJob::resolve`].
    pub fn of(job: &Job, context: &JobContext) -> RenderJob {
        let JobContext { scene, rules, emulates, .. } = *context;
        let settings = &job.settings;
        let unless = |value: bool, usual: bool| (value != usual).then_some(value);
        let usual = usual_method(scene);
        let plain = Method::kinds().into_iter().find(|kind| kind.name() == job.method.name()).unwrap_or_default();
        let fields = job.method.fields().iter().enumerate();
        let differing = fields.filter(|&(at, _)| job.method.get(at) != plain.get(at));
        let mut options = RenderJob {
            method: (job.method.name() != usual.name()).then(|| job.method.name().into()),
            method_options: differing
                .filter_map(|(at, field)| Some((option_name(field), job.method.get(at)?)))
                .collect(),
            bounces: Some(settings.bounces).filter(|&bounces| bounces != usual_bounces(job.method, context)),
            shadows: unless(settings.shadows, rules.shadows),
            shade_back: unless(settings.shade_back, rules.shade_back),
            transparent_shadows: (settings.transparent_shadows && !rules.transparent_shadows).then_some(true),
            no_reflection: unless(!settings.reflection, false),
            no_refraction: unless(!settings.refraction, false),
            min_throughput: Some(settings.least_weight)
                .filter(|&least| least != if emulates { 0.0 } else { MIN_THROUGHPUT }),
            noise_threshold: job.noise,
            adaptive: unless(job.adaptive, false),
            seed: Some(job.seed).filter(|&seed| seed != 0),
            ..RenderJob::default()
        };
        match job.sampling {
            Sampling::Center => options.samples = (!emulates).then_some(1),
            Sampling::Filtered { samples, filter } => {
                options.samples = Some(samples);
                if filter != Filter::default() {
                    let of_kind = |row: &&(&str, Filter)| row.1.with_radius(filter.radius()) == filter;
                    options.filter = Filter::NAMES.iter().find(of_kind).map(|row| row.0.into());
                    options.filter_radius = Some(filter.radius());
                }
            }
            Sampling::Course2004 { sampler, samples, filter } => {
                let name = Sampler::NAMES.iter().find(|row| row.1 == sampler).map_or("sobol", |row| row.0);
                (options.sampler, options.samples) = (Some(name.into()), Some(samples));
                let filter = filter.map(|filter| match filter {
                    CourseFilter::Box { radius } => ("box", radius),
                    CourseFilter::Tent { radius } => ("tent", radius),
                    CourseFilter::Gaussian { sigma } => ("gaussian", sigma),
                });
                options.filter = filter.map(|(name, _)| name.into());
                options.filter_radius = filter.map(|(_, radius)| radius);
            }
            Sampling::Course2012 { jitter, blur } => {
                (options.jitter, options.blur) = (unless(jitter, false), unless(blur, false));
            }
        }
        options
    }

    /// The options that are given, as words of a command line.
    pub fn spelled(&self) -> Vec<String> {
        let mut words: Vec<String> = self.method.iter().map(|name| format!("--integrator {name}")).collect();
        words.extend(self.method_options.iter().filter_map(|(name, value)| match value {
            Value::Float(number) => Some(format!("--{name} {number}")),
            Value::Int(number) => Some(format!("--{name} {number}")),
            Value::Word(word) => Some(format!("--{name} {word}")),
            Value::Vec3(_) | Value::Path(_) | Value::Rows(_) => None,
        }));
        for option in RenderJob::OPTIONS {
            let Some(text) = self.get(option.name) else { continue };
            match option.form {
                OptionForm::Flag if text == "on" => words.push(format!("--{}", option.name)),
                OptionForm::Flag => {}
                OptionForm::Switch => words.push(format!("--{}={text}", option.name)),
                _ => words.push(format!("--{} {text}", option.name)),
            }
        }
        words
    }
}

/// How often light is scattered, or reflected, after the first time, unless asked otherwise.
fn usual_bounces(method: Method, context: &JobContext) -> u32 {
    match method.transport() {
        Some(_) => context.scene.wishes.bounces.unwrap_or(PATH_BOUNCES),
        None => context.rules.bounces,
    }
}

#[cfg(test)]
mod tests;
