//! Options that determine a picture, with their defaults.
//!
//! [`RenderJob`] contains the options that are set. The options are defined in a single place,
//! [`RenderJob::OPTIONS`]. The command line, the text that reproduces a job
//! ([`RenderJob::to_arguments`]), JSON and Python use these definitions. [`RenderJob::resolve`]
//! turns the options into a [`Job`], with defaults from the scene.

mod option_form;

use durer_render::film::Filter;
use durer_render::film::aov::Aov;
use durer_render::film::course::CourseFilter;
use durer_render::film::false_color::FalseColorScale;
use durer_render::integrator::{IntegratorKind, RenderSettings};
use durer_render::render::{Backdrop, Job, PixelRect, Sampling};
use durer_scene::camera::{Projection, Raster};
use durer_scene::describe::{DescribedKind, Field, Value};
use durer_scene::dialect::{Dialect, DialectRules};
use durer_scene::sampler::Sampler;
use durer_scene::scene::{Scene, SceneDefaults};
#[cfg(feature = "options")]
pub(crate) use option_form::three_numbers;
pub(crate) use option_form::unknown_option;
pub use option_form::{JobOption, OptionForm};
use option_form::{OptionValue, one_of};

/// Maximum number of samples per pixel if there is a noise threshold.
const MAX_FOR_NOISE: u32 = 4096;
/// Minimum throughput of a ray.
const MIN_THROUGHPUT: f32 = 1.0 / 256.0;

/// Default number of scattering events after the first hit of a path.
pub const PATH_BOUNCES: u32 = 16;

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
            integrator_name: Option<String>,
            integrator_option_values: Vec<(&'static str, Value)>,
        }

        impl $name {
            /// All options except those of the integrators, which define their own options. See
            /// [`IntegratorKind`].
            pub const OPTIONS: &'static [JobOption] =
                &[$(JobOption { name: $word, doc: concat!($($fdoc, "\n"),+), form: $form },)*];

            $($(#[doc = $fdoc])+
            #[must_use]
            pub fn $field(mut self, value: impl Into<$type>) -> Self {
                self.$field = Some(value.into());
                self
            })*

            /// Sets an option by its name on the command line. `text` is the value of the option,
            /// or empty for a flag.
            ///
            /// # Errors
            ///
            /// Returns a message if the option is unknown or the text is not a valid value.
            pub fn set(&mut self, name: &str, text: &str) -> Result<(), String> {
                let option = RenderJob::OPTIONS.iter().find(|option| option.name == name);
                match option.map(|option| option.form) {
                    Some(OptionForm::Flag | OptionForm::Switch) if text.is_empty() => return self.set(name, "on"),
                    Some(form) => form.check(text)?,
                    None => {}
                }
                match name {
                    $($word => self.$field = Some(OptionValue::parse(text)?),)*
                    _ => return self.set_integrator_text(name, text),
                }
                Ok(())
            }

            /// Returns the value of an option as text, or `None` if it is not set.
            pub fn get(&self, name: &str) -> Option<String> {
                match name {
                    $($word => self.$field.as_ref().map(OptionValue::to_text),)*
                    _ => None,
                }
            }
        }
    };
}

options! {
    /// Options of a render that determine the picture, such as size, integrator and samples.
    /// Options that are not set get the scene's defaults. See [`RenderJob::resolve`].
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
        /// Size in pixels [default: 512x512, or with --dialect the size of the course's program]
        size: (u32, u32) = "size", OptionForm::Value("WIDTHxHEIGHT");
        /// Depths mapped to the two ends of the grey scale [default: the range of depths in the
        /// picture]
        depth_range: [f32; 2] = "depth-range", OptionForm::Two("MIN", "MAX");
        /// Luminance or illuminance mapped to the first and last false colours [default: 0 and the
        /// 98th percentile of the picture]
        light_range: [f32; 2] = "light-range", OptionForm::Two("LOW", "HIGH");
        /// Use a logarithmic scale for false colours; --light-range must start above 0
        light_log: bool = "light-log", OptionForm::Flag;
        /// Maximum depth of reflected and transmitted rays; with path and photons, maximum number
        /// of scattering events after the first hit [default: 8; 16 with path and photons; with
        /// --dialect, that dialect's own default]
        bounces: u32 = "bounces", OptionForm::Whole(0, RenderSettings::MAX_BOUNCES);
        /// Cast shadows [default: on; with --dialect, off]
        shadows: bool = "shadows", OptionForm::Switch;
        /// Also shade surfaces that are seen from behind [default: on; with --dialect, off]
        shade_back: bool = "shade-back", OptionForm::Switch;
        /// Let transparent objects cast coloured shadows
        transparent_shadows: bool = "transparent-shadows", OptionForm::Flag;
        /// Do not trace reflected rays
        no_reflection: bool = "no-reflection", OptionForm::Flag;
        /// Do not trace transmitted rays
        no_refraction: bool = "no-refraction", OptionForm::Flag;
        /// Minimum throughput of a ray; rays below it are not traced [default: 1/256; with
        /// --dialect, 0]
        min_throughput: f32 = "min-throughput",
            OptionForm::Number("SHARE", |x| x.is_finite() && x >= 0.0, "expected a number, 0 or more");
        /// Samples per pixel; a value of 1 samples the pixel centre [default: 16; 64 with a lens, a
        /// pinhole or a stochastic integrator; 1 with --dialect; unlimited with --time-limit; 4096
        /// with --noise-threshold]
        samples: u32 = "samples", OptionForm::Whole(1, Job::MAX_SAMPLES);
        /// Sampler; random, uniform and jittered come from the course and only support its filters:
        /// box, tent and gaussian
        sampler: String = "sampler", OptionForm::Words(|| Sampler::NAMES.map(|row| row.0).to_vec());
        /// Reconstruction filter [default: blackman-harris; none for the course's samplers]
        filter: String = "filter", OptionForm::Words(|| Filter::NAMES.map(|row| row.0).to_vec());
        /// Radius of the filter in pixels; for the course's Gaussian, the standard deviation
        filter_radius: f32 = "filter-radius", OptionForm::Value("PIXELS");
        /// Render 3x3 jittered subpixels, as the 2012 program does
        jitter: bool = "jitter", OptionForm::Flag;
        /// Apply a five-tap blur, as the 2012 program does
        blur: bool = "blur", OptionForm::Flag;
        /// Stop sampling a pixel when its estimated error in display values falls below this; 0.01
        /// is 1 % of the range from black to white
        noise_threshold: f32 = "noise-threshold",
            OptionForm::Number("ERROR", |x| x.is_finite() && x > 0.0, "expected a number above 0");
        /// Take more samples in noisy pixels and fewer in others: a quarter of --samples measures
        /// the noise, and the rest are distributed accordingly
        adaptive: bool = "adaptive", OptionForm::Flag;
        /// Show something else where the camera sees no object: `transparent`, `white`, `black`, an
        /// sRGB colour such as #ffcc00, or a colour as linear light, for example 0.5,0.5,0.5; it is
        /// part of the picture, so that exposure and tone curve change it. Lighting, reflections
        /// and refractions do not change. A model without a camera then gets no ground [default:
        /// the background of the scene]
        background: Backdrop = "background", OptionForm::Value("transparent|COLOR");
        /// Seed of the random number generator
        seed: u64 = "seed", OptionForm::Value("SEED");
    }
}

/// Returns the default integrator of a scene. This is path tracing for layered materials,
/// environments, fog and emissive surfaces, and Whitted's integrator otherwise.
pub fn default_integrator(scene: &Scene) -> IntegratorKind {
    if scene.is_physical() { IntegratorKind::PATH } else { IntegratorKind::WHITTED }
}

/// Returns the command-line name of an option of an integrator.
pub fn option_name(field: &Field) -> &'static str {
    field.keyword(Dialect::Durer).unwrap_or(field.name)
}

/// Returns the index of an option among the fields of an integrator, or `None` if the integrator
/// does not have this option.
pub fn option_index(method: &IntegratorKind, option: &str) -> Option<usize> {
    method.fields().iter().position(|field| option_name(field) == option)
}

/// Scene and rules that determine the defaults of the options of a job. See [`RenderJob::resolve`].
#[derive(Clone, Copy, Debug)]
pub struct JobContext<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// Rules of the scene's dialect.
    pub rules: &'a DialectRules,
    /// True if a dialect was requested. Its program is then emulated with all quirks.
    pub emulates: bool,
    /// True if a time limit ends the sampling.
    pub timed: bool,
}

/// Selection of the pictures that a render writes and of the part of the picture to render.
#[derive(Clone, Debug)]
pub struct OutputSelection {
    /// Crop of the picture (left, top, width and height), or `None` for the crop of the scene.
    pub crop: Option<(u32, u32, u32, u32)>,
    /// Names of the pictures to write, which are `color` or names from
    /// [`durer_render::film::aov::AOVS`].
    pub show: Vec<String>,
}

impl Default for OutputSelection {
    fn default() -> Self {
        OutputSelection { crop: None, show: vec!["color".into()] }
    }
}

impl RenderJob {
    /// Sets the integrator by its name.
    #[must_use]
    pub fn integrator(mut self, name: impl Into<String>) -> Self {
        self.integrator_name = Some(name.into());
        self
    }

    /// Sets an option of an integrator.
    ///
    /// # Errors
    ///
    /// Returns a message if no integrator has this option.
    pub fn set_integrator_option(&mut self, name: &str, value: Value) -> Result<(), String> {
        let kinds = IntegratorKind::kinds();
        let fields = kinds.iter().flat_map(|kind| kind.fields());
        let name = fields.map(option_name).find(|word| *word == name).ok_or_else(|| self.unknown(name))?;
        self.integrator_option_values.retain(|known| known.0 != name);
        self.integrator_option_values.push((name, value));
        Ok(())
    }

    fn set_integrator_text(&mut self, name: &str, text: &str) -> Result<(), String> {
        if name == "integrator" {
            one_of(text, &IntegratorKind::kinds().iter().map(IntegratorKind::name).collect::<Vec<_>>())?;
            self.integrator_name = Some(text.into());
            return Ok(());
        }
        let kinds = IntegratorKind::kinds();
        let field = kinds.iter().flat_map(|kind| kind.fields()).find(|field| option_name(field) == name);
        let kind = field.map(|field| field.kind).ok_or_else(|| self.unknown(name))?;
        use durer_scene::describe::FieldKind;
        let value = match kind {
            FieldKind::Word(words) => {
                one_of(text, words)?;
                Value::Word(text.into())
            }
            FieldKind::Int => Value::Int(text.parse().map_err(|_| "expected a whole number".to_string())?),
            _ => Value::Float(text.parse().map_err(|_| "expected a number".to_string())?),
        };
        self.set_integrator_option(name, value)
    }

    fn unknown(&self, name: &str) -> String {
        unknown_option(name, RenderJob::OPTIONS.iter().map(|option| option.name))
    }

    /// Returns the requested integrator with its options, or `usual` if none is requested.
    ///
    /// # Errors
    ///
    /// Returns a message if the integrator is unknown, or if an option does not apply to it or is
    /// out of range.
    pub fn resolve_integrator(&self, usual: IntegratorKind) -> Result<IntegratorKind, String> {
        let has = |kind: &IntegratorKind, (option, _): &(&str, Value)| option_index(kind, option).is_some();
        let mut methods = std::iter::once(usual).chain(IntegratorKind::kinds());
        // If no integrator is requested, find one that has all options that are set, or at least
        // the last of them.
        let fitting = methods.clone().find(|kind| self.integrator_option_values.iter().all(|option| has(kind, option)));
        let last = self.integrator_option_values.last();
        let kind = match &self.integrator_name {
            Some(name) => methods.find(|kind| kind.name() == name),
            None => fitting.or_else(|| methods.find(|kind| last.is_none_or(|option| has(kind, option)))),
        };
        let Some(mut method) = kind else {
            let known: Vec<&str> = IntegratorKind::kinds().iter().map(IntegratorKind::name).collect();
            return Err(format!("unknown integrator; expected one of {}", known.join(", ")));
        };
        for (option, value) in &self.integrator_option_values {
            let Some(at) = option_index(&method, option) else {
                return Err(format!("--{option} does not apply to --integrator {}", method.name()));
            };
            if let Err(wrong) = method.fields()[at].constraint.validate(value) {
                return Err(format!("--{option} {wrong}"));
            }
            method.set(at, value.clone());
        }
        Ok(method)
    }

    /// Adapts the defaults of models to these options: the camera fits the aspect ratio of the
    /// picture, and a replaced background needs no ground.
    pub fn adapt(&self, defaults: &mut SceneDefaults) {
        defaults.aspect = self.size.map(|(width, height)| width as f32 / height.max(1) as f32);
        defaults.no_ground = self.background.is_some();
    }

    /// Returns the size of the picture if it is set.
    pub fn requested_size(&self) -> Option<(u32, u32)> {
        self.size
    }

    /// Resolves the options into a job. Options that are not set get defaults from the scene and
    /// its rules. Without a view, the job renders the full picture in colour and no other pictures.
    ///
    /// # Errors
    ///
    /// Returns a message if options contradict each other or the scene.
    pub fn resolve(&self, context: &JobContext, view: Option<&OutputSelection>) -> Result<Job, String> {
        let JobContext { scene, rules, emulates, .. } = *context;
        let camera = scene.camera.as_ref();
        let render_defaults = scene.render_defaults;
        let natural = || Raster::natural_size(camera.and_then(|camera| camera.proportions()), rules.size);
        let (width, height) = self.size.or(render_defaults.size).unwrap_or_else(natural);
        let mut method = self.resolve_integrator(default_integrator(scene))?;
        let is_clamped = self.integrator_option_values.iter().any(|(option, _)| *option == "clamp");
        if let (Some(clamp), false, Some(at)) = (render_defaults.clamp, is_clamped, option_index(&method, "clamp")) {
            method.set(at, Value::Float(clamp));
        }
        // Blur caused by an aperture and integrators that use random numbers need more samples than
        // antialiasing.
        let default_samples =
            if camera.is_some_and(|camera| camera.has_aperture()) || method.is_stochastic() { 64 } else { 16 };
        let default_samples = render_defaults.samples.unwrap_or(default_samples);
        let is = |flag: Option<bool>| flag.unwrap_or(false);
        if method.is_stochastic() && (is(self.jitter) || is(self.blur)) {
            return Err(format!("--jitter and --blur do not apply to --integrator {}", method.name()));
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
                        true => "--light-range with --light-log needs two numbers above 0, the second greater".into(),
                        false => "--light-range needs two numbers, 0 or more, the second greater".into(),
                    });
                }
                Some(FalseColorScale { low, high, logarithmic })
            }
            None => None,
        };
        // The crop of the scene applies only if the picture has the size that the scene defines.
        let scene_crop = render_defaults.crop.filter(|_| render_defaults.size == Some((width, height)));
        let crop = view.and_then(|view| view.crop.or(scene_crop));
        let pictures = view.map_or(&[][..], |view| &view.show);
        Ok(Job {
            width,
            height,
            crop: crop.map(|(left, top, width, height)| PixelRect { left, top, width, height }),
            device: None,
            seed: self.seed.unwrap_or(0),
            sampling: self.sampling(context, default_samples)?,
            noise: self.noise_threshold,
            adaptive: is(self.adaptive),
            method,
            settings: RenderSettings {
                bounces: self.bounces.unwrap_or_else(|| usual_bounces(method, context)),
                shadows: self.shadows.unwrap_or(rules.shadows),
                shade_back: self.shade_back.unwrap_or(rules.shade_back),
                transparent_shadows: is(self.transparent_shadows) || rules.transparent_shadows,
                reflection: !is(self.no_reflection),
                refraction: !is(self.no_refraction),
                min_weight: self.min_throughput.unwrap_or(if emulates { 0.0 } else { MIN_THROUGHPUT }),
            },
            color: view.is_none() || pictures.iter().any(|show| show == "color"),
            aovs: pictures.iter().filter_map(|name| Aov::from_name(name)).collect(),
            depth_range,
            light_scale,
            backdrop: self.background,
        })
    }

    /// Reports options that contradict each other.
    fn check_combination(&self) -> Result<(), String> {
        let is = |flag: Option<bool>| flag.unwrap_or(false);
        let wrong = if (is(self.jitter) || is(self.blur))
            && (self.samples.is_some() || self.sampler.is_some() || self.filter.is_some())
        {
            "--jitter and --blur set the samples: remove --samples, --sampler and --filter"
        } else if is(self.adaptive) && self.noise_threshold.is_some() {
            "--adaptive and --noise-threshold both set the samples: remove one of them"
        } else if is(self.adaptive) && (is(self.jitter) || is(self.blur)) {
            "--adaptive cannot distribute the samples of --jitter and --blur"
        } else if is(self.light_log) && self.light_range.is_none() {
            "--light-log needs --light-range"
        } else if self.filter_radius.is_some() && self.filter.is_none() {
            "--filter-radius needs --filter"
        } else {
            return Ok(());
        };
        Err(wrong.into())
    }

    fn sampling(&self, context: &JobContext, default_samples: u32) -> Result<Sampling, String> {
        let (jitter, blur) = (self.jitter.unwrap_or(false), self.blur.unwrap_or(false));
        if jitter || blur {
            return Ok(Sampling::Course2012 { jitter, blur });
        }
        if self.filter_radius.is_some_and(|r| !(r > 0.0 && r <= Job::MAX_FILTER_RADIUS)) {
            return Err("--filter-radius must be above 0 and at most 64".into());
        }
        let noise = self.noise_threshold.is_some();
        let sampler = self.sampler.as_deref().and_then(Sampler::from_name).unwrap_or_default();
        if matches!(sampler, Sampler::Uniform | Sampler::Jittered) && (noise || context.timed) {
            return Err(
                "--noise-threshold and --time-limit need a sampler whose first samples cover the pixel: sobol or \
                        random"
                    .into(),
            );
        }
        if self.adaptive == Some(true) && context.timed && self.samples.is_none() {
            return Err("--adaptive with --time-limit needs a number of samples: pass --samples".into());
        }
        let filter = self.filter.as_deref().and_then(Filter::from_name);
        let usual = match (context.emulates, noise, context.timed) {
            (true, ..) => 1,
            (false, true, _) => MAX_FOR_NOISE,
            (false, false, true) => Job::MAX_SAMPLES,
            (false, false, false) => default_samples,
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
            Some(_) => return Err("the course's samplers support only the filters box, tent and gaussian".into()),
        };
        Ok(Sampling::Course2004 { sampler, samples, filter })
    }

    /// Returns the options in which a job differs from the defaults of the scene, except the size
    /// and the view. This is the inverse of [`RenderJob::resolve`].
    pub fn of(job: &Job, context: &JobContext) -> RenderJob {
        let JobContext { scene, rules, emulates, .. } = *context;
        let settings = &job.settings;
        let unless = |value: bool, usual: bool| (value != usual).then_some(value);
        let usual = default_integrator(scene);
        let plain =
            IntegratorKind::kinds().into_iter().find(|kind| kind.name() == job.method.name()).unwrap_or_default();
        let fields = job.method.fields().iter().enumerate();
        let differing = fields.filter(|&(at, _)| job.method.get(at) != plain.get(at));
        let mut options = RenderJob {
            integrator_name: (job.method.name() != usual.name()).then(|| job.method.name().into()),
            integrator_option_values: differing
                .filter_map(|(at, field)| Some((option_name(field), job.method.get(at)?)))
                .collect(),
            bounces: Some(settings.bounces).filter(|&bounces| bounces != usual_bounces(job.method, context)),
            shadows: unless(settings.shadows, rules.shadows),
            shade_back: unless(settings.shade_back, rules.shade_back),
            transparent_shadows: (settings.transparent_shadows && !rules.transparent_shadows).then_some(true),
            no_reflection: unless(!settings.reflection, false),
            no_refraction: unless(!settings.refraction, false),
            min_throughput: Some(settings.min_weight)
                .filter(|&least| least != if emulates { 0.0 } else { MIN_THROUGHPUT }),
            noise_threshold: job.noise,
            adaptive: unless(job.adaptive, false),
            background: job.backdrop,
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

    /// Returns the options that are set as command-line arguments.
    pub fn to_arguments(&self) -> Vec<String> {
        let mut words: Vec<String> = self.integrator_name.iter().map(|name| format!("--integrator {name}")).collect();
        words.extend(self.integrator_option_values.iter().filter_map(|(name, value)| match value {
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

/// Returns the default number of bounces.
fn usual_bounces(method: IntegratorKind, context: &JobContext) -> u32 {
    match method.path_options() {
        Some(_) => context.scene.render_defaults.bounces.unwrap_or(PATH_BOUNCES),
        None => context.rules.bounces,
    }
}

#[cfg(test)]
mod tests;
