//! A scene whose pictures can leave out parts of the light or include a common mistake.

use super::topics::{Glass, PathSettings, Shot, ShotOptions, Topic};
use crate::mistakes::{SceneVariant, mistake_by_name};
use durer_diag::{Diagnostics, Files};
use durer_formats::Decoder;
use durer_formats::course::{self, ReadOptions};
use durer_image::{Image, Layer, can_allocate};
use durer_render::compile::{AccelKind, Resources, compile};
use durer_render::film::aov::Aov;
use durer_render::film::{Filter, luminance_of};
use durer_render::integrator::{IntegratorKind, PathOptions, PhotonParameters, RenderSettings};
use durer_render::render::explain::SceneNames;
use durer_render::render::{Control, Job, RenderError, Sampling, center_ray, raster, render};
use durer_render::world::{Material, World};
use durer_scene::camera::Raster;
use durer_scene::dialect::{Dialect, DialectRules, Highlight, SecondaryRays};
use durer_scene::light::Light;
use durer_scene::math::{Color, Vec3};
use durer_scene::scene::Scene;
use durer_scene::source::MemorySource;
use std::sync::Arc;

/// Text of the built-in scene, in which every step has a visible effect.
pub const OWN_SCENE: &str = include_str!("scene.txt");
/// File name of the built-in scene in messages.
pub const OWN_SCENE_NAME: &str = "our-scene.txt";

/// Number of samples per pixel if the job has only one.
const SAMPLES: u32 = 16;

/// Number of pictures cached for later steps.
const MAX_CACHED: usize = 4;

/// A picture rendered for the lesson, with the values before tone mapping and an estimate of the
/// noise.
#[derive(Clone, Debug)]
pub(super) struct LessonPicture {
    pub(super) layer: Layer,
    pub(super) values: Image,
    /// Standard error of the pixels relative to the luminance, for Monte Carlo pictures.
    pub(super) noise: Option<f64>,
}

/// A scene of the lesson that has been compiled and can be rendered with parts of its light
/// switched off.
#[derive(Debug)]
pub struct LessonScene {
    scene: Scene,
    files: Files,
    pub(super) world: World,
    pub(super) job: Job,
    /// Lights, materials and rules of the unmodified world.
    lights: Vec<Light>,
    ambient: Color,
    materials: Vec<Material>,
    rules: DialectRules,
    /// Recent pictures. They are kept because a step often starts with the last picture of the
    /// previous one.
    cache: Vec<(Shot, LessonPicture)>,
}

impl LessonScene {
    /// Creates a stage for a compiled scene. The crop and the AOVs of the job are ignored.
    pub fn new(scene: Scene, files: Files, world: World, job: Job) -> Self {
        let (lights, ambient) = (world.lights().to_vec(), world.ambient());
        let (materials, rules) = (world.materials().to_vec(), world.rules().clone());
        let job = Job { crop: None, color: true, aovs: Vec::new(), ..job };
        LessonScene { scene, files, world, job, lights, ambient, materials, rules, cache: Vec::new() }
    }

    /// Loads the built-in scene in order to render it at a given size.
    pub(super) fn built_in((width, height): (u32, u32)) -> Self {
        let (mut files, mut diagnostics) = (Files::default(), Diagnostics::default());
        let file = files.add(OWN_SCENE_NAME, OWN_SCENE.as_bytes().into());
        let options = ReadOptions { dialect: Dialect::Durer, strict: false, compat: 0 };
        let source = MemorySource::default();
        let scene = course::read(OWN_SCENE.as_bytes(), file, options, &mut diagnostics).unwrap_or_default();
        let resources = Resources::new(&source, &Decoder, &mut files);
        let world = compile(&scene, Dialect::Durer.rules(), AccelKind::Bvh, resources, &mut diagnostics);
        let world = world.expect("the lesson's own scene is valid");
        LessonScene::new(scene, files, world, Job { width, height, ..Job::default() })
    }

    /// Returns the reason why the scene's dialect does not support the effect of a topic, if there
    /// is one.
    pub(super) fn unsupported_by_dialect(&self, topic: &str) -> Option<&'static str> {
        let (highlights, secondary) = (self.rules.highlight, self.rules.secondary);
        match topic {
            "specular" if highlights == Highlight::None => Some("this year's program has no highlights"),
            "reflection" | "refraction" | "fresnel" if secondary == SecondaryRays::None => {
                Some("this year's program traces no reflected or transmitted rays")
            }
            "refraction" | "fresnel" if secondary == SecondaryRays::Specular => {
                Some("this year's program has mirrors, but no glass")
            }
            "fresnel" if secondary == SecondaryRays::Colors => Some("this year's program does not apply Fresnel's law"),
            _ => None,
        }
    }

    /// Returns the width and height of the pictures.
    pub(super) fn size(&self) -> (u32, u32) {
        (self.job.width, self.job.height)
    }

    /// Returns the raster of the pictures.
    pub(super) fn raster(&self) -> Raster {
        raster(&self.world, self.job.width, self.job.height)
    }

    /// Renders the picture of a shot.
    pub(super) fn render(&mut self, shot: &Shot, control: &Control) -> Result<LessonPicture, RenderError> {
        let same = |cached: &&(Shot, LessonPicture)| (cached.0.aov, cached.0.options) == (shot.aov, shot.options);
        if let Some((_, picture)) = self.cache.iter().find(same) {
            return Ok(picture.clone());
        }
        let picture = match shot.aov {
            Some("rays") => self.directions(control)?,
            value => {
                let options = self.with_method(shot.options);
                self.apply(&options);
                let color = value.is_none();
                let noise = options.paths.map(|_| "variance");
                let aovs: Vec<_> = value.into_iter().chain(noise).filter_map(Aov::from_name).collect();
                let settings = self.settings(&options);
                let sampling = self.sampling(&options);
                let method = self.method(&options);
                let mut job = Job { color, aovs, settings, sampling, method, ..self.job.clone() };
                let mut rendered = render(&self.world, &job, control)?;
                if value == Some("depth") && job.depth_range.is_none() {
                    job.depth_range = depth_range(self.distances());
                    rendered = render(&self.world, &job, control)?;
                }
                let noise = noise.and_then(|_| noise_of(&rendered.layers[0].image, &rendered.layers[1].image));
                LessonPicture {
                    layer: rendered.pictures.swap_remove(0),
                    values: Arc::unwrap_or_clone(rendered.layers.swap_remove(0).image),
                    noise,
                }
            }
        };
        // Drop older pictures, which will not be needed again.
        self.cache.drain(..self.cache.len().saturating_sub(MAX_CACHED - 1));
        self.cache.push((*shot, picture.clone()));
        Ok(picture)
    }

    /// Applies the lights, materials and mistake of a shot to the world.
    fn apply(&mut self, options: &ShotOptions) {
        let (lights, ambient) = match options.lights {
            true => (self.lights.clone(), self.ambient),
            false => (Vec::new(), Color::ONE),
        };
        let own = self.world.edit();
        (own.lights, own.ambient) = (lights, ambient);
        own.set_rules(self.rules.clone());
        // The mistakes that the lesson shows change only the rules.
        if let Some(mistake) = options.mistake.and_then(mistake_by_name) {
            let mut variant = SceneVariant::new(&self.scene, self.world.clone(), self.job.settings);
            (mistake.apply)(&mut variant, 0.0);
            let own = self.world.edit();
            own.set_rules(variant.world.rules().clone());
            own.shading = *variant.world.shading_rules();
        }
        let own = self.world.edit();
        own.materials = self.materials.clone();
        for material in &mut own.materials {
            let Material::Phong(phong) = material else { continue };
            phong.highlight = phong.highlight.filter(|_| options.highlights);
            // A flat colour includes textures, even if the dialect does not apply ambient light to
            // them.
            phong.ambient = phong.ambient.filter(|_| options.lights);
            if phong.fresnel && options.glass != Glass::Fresnel {
                (phong.fresnel, phong.reflective) = (false, Color::ZERO);
            }
            if let (Some(own), Some(PathSettings { disperses: false, .. })) = (&mut phong.principled, options.paths) {
                Arc::make_mut(own).definition.transmission_dispersion_scale = 0.0;
            }
        }
    }

    fn settings(&self, options: &ShotOptions) -> RenderSettings {
        let all = self.job.settings;
        RenderSettings {
            bounces: options.bounces.min(all.bounces),
            shadows: options.shadows && all.shadows,
            refraction: all.refraction && options.glass != Glass::None,
            ..all
        }
    }

    /// Returns either Whitted's method, or path tracing with the options of the job.
    fn method(&self, options: &ShotOptions) -> IntegratorKind {
        let Some(settings) = options.paths else { return IntegratorKind::WHITTED };
        let own = self.job.method.path_options().unwrap_or_default();
        let transport = PathOptions { direct: settings.direct, color: settings.color, ..own };
        match (settings.photons, self.job.method) {
            (false, _) => IntegratorKind::Path(transport),
            (true, IntegratorKind::Photons(photons)) => {
                IntegratorKind::Photons(PhotonParameters { transport, corrected: false, ..photons })
            }
            (true, _) => IntegratorKind::Photons(PhotonParameters { transport, ..PhotonParameters::default() }),
        }
    }

    /// Returns true if Whitted's method supports none of the scene's lights.
    pub(super) fn needs_paths(&self) -> bool {
        self.has_paths() && self.lights.is_empty()
    }

    /// Returns the options of a shot. Switches to path tracing if Whitted's method would show no
    /// light. For direct light, both methods show the same step.
    fn with_method(&self, options: ShotOptions) -> ShotOptions {
        match self.needs_paths() && options.lights && options.paths.is_none() && options.bounces == 0 {
            true => ShotOptions { paths: Some(PathSettings::PLAIN), sampled: true, ..options },
            false => options,
        }
    }

    /// Returns the reason why a step is not shown if the topic needs Whitted's method and that
    /// method does not support the scene's lights.
    pub(super) fn unsupported_by_method(&self, topic: &Topic) -> Option<&'static str> {
        let bounces = topic.shots.iter().any(|shot| shot.options.bounces > 0 && shot.options.paths.is_none());
        (self.needs_paths() && bounces).then_some(
            "its light comes from emissive surfaces or the environment, which Whitted's method does not support",
        )
    }

    /// Returns true if the job uses path tracing.
    pub(super) fn has_paths(&self) -> bool {
        self.job.method.path_options().is_some()
    }

    fn sampling(&self, options: &ShotOptions) -> Sampling {
        match (options.sampled, self.job.sampling) {
            (false, _) => Sampling::Center,
            (true, Sampling::Center) => Sampling::Filtered { samples: SAMPLES, filter: Filter::default() },
            (true, sampling) => sampling,
        }
    }

    /// Returns the ray directions through the pixel centres as colours from 0 to 1. Pixels without
    /// a ray are black.
    fn directions(&self, control: &Control) -> Result<LessonPicture, RenderError> {
        let (raster, (width, height)) = (self.raster(), self.size());
        // The ray, the coverage, the colour and the value of each pixel are stored.
        let bytes = size_of::<Option<Vec3>>() + size_of::<f32>() + 2 * size_of::<Vec3>();
        let needed = u64::from(width) * u64::from(height) * bytes as u64;
        control.check_memory(needed)?;
        if !can_allocate(needed) {
            return Err(RenderError::NoMemory(needed));
        }
        let rays: Vec<Option<Vec3>> = self
            .job
            .whole()
            .pixel_positions()
            .map(|place| Some(center_ray(&self.world, &raster, place)?.dir))
            .collect();
        let coverage = rays.iter().map(|dir| f32::from(u8::from(dir.is_some()))).collect();
        let pixels = rays.iter().map(|dir| dir.map_or(Vec3::ZERO, |dir| 0.5 * (dir + 1.0))).collect();
        let values = rays.iter().map(|dir| dir.unwrap_or(Vec3::ZERO)).collect();
        let layer = Layer::data("rays", Image::from_pixels(width, height, pixels)?).with_coverage(coverage);
        Ok(LessonPicture { layer, values: Image::from_pixels(width, height, values)?, noise: None })
    }

    /// Returns the distances `t` of the first hits of the rays through the pixel centres, leaving
    /// out rays that miss.
    fn distances(&self) -> Vec<f32> {
        let raster = self.raster();
        let ray = |place| center_ray(&self.world, &raster, place);
        let hits = self.job.whole().pixel_positions().filter_map(|place| self.world.intersect(&ray(place)?, &mut ()));
        hits.map(|at| at.hit.t).filter(|t| t.is_finite()).collect()
    }

    /// Describes, in a sentence, a picture that is not compared with another one. Returns `None` if
    /// it shows nothing worth describing.
    pub(super) fn describe(&self, shot: &Shot, picture: &LessonPicture) -> Option<String> {
        let values = &picture.values.pixels;
        match shot.aov {
            Some("rays") => {
                let middle = values[self.size().0 as usize * (self.size().1 / 2) as usize + self.size().0 as usize / 2];
                let seen = values.iter().filter(|dir| **dir != Vec3::ZERO);
                let widest = seen.map(|dir| middle.cross(*dir).length().min(1.0)).fold(0.0, f32::max);
                Some(match widest < 1e-6 {
                    true => {
                        "All rays are parallel here, so the picture has one colour: the rays differ in their origins."
                            .into()
                    }
                    false => {
                        "Red, green and blue are x, y and z of the direction, from -1 (dark) to 1 (bright).".into()
                    }
                })
            }
            Some("depth") => {
                let hits = self.distances();
                let least = hits.iter().copied().reduce(f32::min)?;
                let most = hits.iter().copied().reduce(f32::max)?;
                let share = percent(hits.len(), values.len());
                Some(format!("{share} of the rays hit something, at distances from {least:.2} to {most:.2}."))
            }
            Some("normals") => {
                let seen: Vec<Vec3> = values.iter().copied().filter(|n| *n != Vec3::ZERO).collect();
                let (raster, places) = (self.raster(), self.job.whole().pixel_positions());
                let away = |((x, y), n): ((u32, u32), &Vec3)| {
                    center_ray(&self.world, &raster, (x, y)).is_some_and(|ray| ray.dir.dot(*n) > 0.0)
                };
                let behind = places.zip(values).filter(|pixel| away(*pixel)).count();
                let share = percent(behind, values.len());
                (!seen.is_empty()).then(|| match behind {
                    0 => "All visible normals point towards the eye.".into(),
                    _ => format!(
                        "{share} of the pixels show a surface from behind: its normal points away from the eye."
                    ),
                })
            }
            _ => {
                let mut colors: Vec<_> =
                    picture.layer.image.pixels.iter().map(|p| p.to_array().map(f32::to_bits)).collect();
                colors.sort_unstable();
                colors.dedup();
                let count = colors.len();
                let sky =
                    if self.distances().len() < values.len() { ", that of the background among them" } else { "" };
                (count > 1).then(|| format!("The picture has {count} different colours{sky}."))
            }
        }
    }

    /// Names the object at the centre of a pixel by its keyword and its position in the scene file.
    pub(super) fn object_at(&self, pixel: (u32, u32)) -> String {
        let hit = center_ray(&self.world, &self.raster(), pixel).and_then(|ray| self.world.closest(&ray, &mut ()));
        let names = SceneNames { files: &self.files, scene: &self.scene, world: &self.world };
        hit.map_or("the background".into(), |hit| {
            let name = names.object(hit.object);
            // Drop the directory of the file.
            match name.split_once(' ') {
                Some((keyword, place)) => format!("{keyword} {}", place.rsplit(['/', '\\']).next().unwrap_or(place)),
                None => name,
            }
        })
    }
}

/// Returns a useful depth range for a scene with an infinite ground. The range starts at the
/// minimum depth and extends at most to three times the median.
fn depth_range(mut depths: Vec<f32>) -> Option<(f32, f32)> {
    depths.sort_by(f32::total_cmp);
    let (least, most) = (*depths.first()?, *depths.last()?);
    let end = most.min(least + 3.0 * (depths[depths.len() / 2] - least));
    (end > least).then_some((least, end))
}

/// Returns the mean standard error of the pixels relative to the mean luminance, computed from the
/// variances of the pixel means. Values are clipped to white because the edges of emitters would
/// dominate otherwise. The result is `None` for a black picture.
fn noise_of(colors: &Image, variances: &Image) -> Option<f64> {
    let light: f64 = colors.pixels.iter().map(|color| luminance_of(*color).min(1.0)).sum();
    let errors: f64 = variances.pixels.iter().map(|variance| f64::from(variance.x).sqrt().min(1.0)).sum();
    Some(errors / light).filter(|noise| noise.is_finite())
}

/// Formats a ratio as a percentage with one decimal place.
pub(super) fn percent(part: usize, all: usize) -> String {
    format!("{:.1} %", 100.0 * part as f64 / all.max(1) as f64)
}
