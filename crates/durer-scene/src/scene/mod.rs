//! Scene as its author wrote it, which is plain data with names, degrees, nested groups and file
//! paths.
//!
//! Nothing in this module is computed, cached or looked up. `compile` turns a scene into a world.

pub mod assets;
pub mod builder;
pub mod defaults;
pub mod extent;
pub mod matrix;
mod validate;

use crate::camera::Camera;
use crate::describe::{Constraint, FileName, described, described_words};
use crate::dialect::set;
use crate::light::Light;
use crate::material::{ColorNoise, HairMaterial, PatternMaterial, PhongMaterial, PrincipledMaterial};
use crate::math::{Color, Vec3, fp};
use crate::medium::Fog;
use crate::shape::{HeightField, MeshData, Primitive, Sphere, TriangleMesh, VoxelGrid};
use crate::texture::almanac::{self, Moment};
use crate::texture::cie_sky::OVERCAST;
use crate::texture::sky::{Irradiance, Perez, SKY_WIDTH, environment_map, perez};
use crate::texture::{CieSky, Sky, SkyModel};
pub use assets::{Assets, NamedTexture, PictureBytes, TextureImage};
pub use builder::{MaterialId, MeshId, SceneBuilder};
use durer_diag::Span;
use glam::{DAffine3, DMat4};
pub use matrix::{MatrixOp, MatrixRules};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

pub use validate::MAX_NESTING;

pub use defaults::{Axis, DefaultLighting, PresetView, SceneDefaults};

described_words! {
    /// Visibility of the emitters to the camera.
    Emitters { Shown = "shown", Hidden = "hidden" }
}

described! {
    /// Background seen by rays that hit nothing, and ambient light.
    Background ["Background" in set::ALL] {
        /// Colour of rays that hit nothing; 0.5 by default, or black with `path` in a scene of
        /// Dürer's own dialect without a `Background`.
        color: Vec3 = Vec3::splat(0.5), optional, Constraint::Any, ["color" in set::ALL];
        /// Ambient light on every surface.
        ambient_light: Vec3 = Vec3::ZERO, optional, Constraint::Any,
            ["ambientLight" in set::CLASSIC, "ambient_light" in set::F23];
        /// Folder with six images (left, right, up, down, front, back) that replace the colour.
        cube_map: Option<FileName> = None, optional, Constraint::Any,
            ["cubeMap" in set::F12A5 | set::F16 | set::DURER, "cube_map" in set::F23];
        /// Environment map that replaces the colour and lights the scene, preferably with high
        /// dynamic range (`.exr`, `.hdr`); its centre is at -z. Whitted ray tracing ignores its
        /// light.
        environment: Option<FileName> = None, optional, Constraint::Any, ["environment" in set::DURER];
        /// Direction to the sun, of any length, with y up. The sun and a clear sky light the scene,
        /// in cd/m^2; set `--exposure`, for example to -13.
        sun: Option<Vec3> = None, optional, Constraint::NonZero, ["sun" in set::DURER];
        /// Altitude of the sun, in degrees above the horizon; an alternative to `sun`.
        sun_altitude: Option<f32> = None, optional, Constraint::Within(-90.0, 90.0), ["sunAltitude" in set::DURER];
        /// Azimuth of the sun, in degrees from north (-z) towards east (x): 180 is south.
        sun_azimuth: Option<f32> = None, optional, Constraint::Any, ["sunAzimuth" in set::DURER];
        /// Latitude, in degrees north of the equator; together with date and time, an alternative
        /// to `sun`.
        latitude: Option<f32> = None, optional, Constraint::Within(-90.0, 90.0), ["latitude" in set::DURER];
        /// Longitude, in degrees east of Greenwich.
        longitude: Option<f32> = None, optional, Constraint::Within(-360.0, 360.0), ["longitude" in set::DURER];
        /// Year, month and day.
        date: Option<Vec3> = None, optional, Constraint::Counts(9999), ["date" in set::DURER];
        /// Hours, minutes and seconds of the local clock.
        time: Option<Vec3> = None, optional, Constraint::Any, ["time" in set::DURER];
        /// Offset of the local clock from UTC in hours, including daylight saving time; default 0.
        time_zone: Option<f32> = None, optional, Constraint::Within(-14.0, 14.0), ["timeZone" in set::DURER];
        /// Model of the sky: Preetham's clear sky, that of Hosek and Wilkie, which is closer to
        /// measured skies, or the all-weather sky of Perez for a measured irradiance.
        sky_model: Option<SkyModel> = None, optional, Constraint::Any, ["skyModel" in set::DURER];
        /// Irradiance from the sun on a surface that faces it, in W/m^2, for `skyModel perez`.
        direct_normal: Option<f32> = None, optional, Constraint::Within(0.0, 1500.0), ["directNormal" in set::DURER];
        /// Irradiance from the sky on a horizontal surface, in W/m^2, for `skyModel perez`.
        diffuse_horizontal: Option<f32> = None, optional, Constraint::Within(0.0, 1500.0),
            ["diffuseHorizontal" in set::DURER];
        /// Dew point in degrees Celsius, for `skyModel perez`; default 11.
        dew_point: Option<f32> = None, optional, Constraint::Within(-90.0, 60.0), ["dewPoint" in set::DURER];
        /// Turbidity of the air: 2 is clear, 3 average, 10 hazy; default 3.
        turbidity: Option<f32> = None, optional, Constraint::Positive, ["turbidity" in set::DURER];
        /// Number of a CIE standard sky, from 1 to 16 (1 overcast, 5 uniform, 12 clear, 16
        /// traditional overcast), which lights the scene in cd/m^2, without direct sunlight. All
        /// except 1, 3, 5 and 16 need the position of the sun, set by `sun`.
        cie_sky: Option<u32> = None, optional, Constraint::OneTo(OVERCAST), ["cieSky" in set::DURER];
        /// Luminance of the CIE sky at the zenith, in cd/m^2; default 10000.
        zenith_luminance: Option<f32> = None, optional, Constraint::Positive, ["zenithLuminance" in set::DURER];
        /// Fraction of the light from sun and sky that the ground below the horizon reflects. The
        /// default is 0.2; with Preetham's sky, the ground has a fifth of the zenith's light by
        /// default. A bright ground also brightens the sky of Hosek and Wilkie.
        ground_reflectance: Option<f32> = None, optional, Constraint::UnitInterval, ["groundReflectance" in set::DURER];
        /// Rotation of the environment about y, in degrees.
        environment_rotation: Option<f32> = None, optional, Constraint::Any, ["environmentRotation" in set::DURER];
        /// Factor on the environment.
        environment_scale: Option<Vec3> = None, optional, Constraint::Any, ["environmentScale" in set::DURER];
        /// `hidden`: the camera sees neither emissive surfaces nor the background, which still
        /// light the scene and are seen in mirrors, as with Mitsuba's `hide_emitters`; `path` only.
        emitters: Option<Emitters> = None, optional, Constraint::Any, ["emitters" in set::DURER];
    }
}

impl Background {
    /// Returns the turbidity of the air.
    pub fn turbidity(&self) -> f32 {
        self.turbidity.unwrap_or(3.0)
    }

    /// Returns the direction to the sun, of any length, or `None` if the background has no sun.
    ///
    /// # Errors
    ///
    /// Fails if the sun's position is given twice, is incomplete, or has an invalid date or time.
    pub fn sun_direction(&self) -> Result<Option<Vec3>, String> {
        let angles = [("sunAltitude", self.sun_altitude.is_some()), ("sunAzimuth", self.sun_azimuth.is_some())];
        let clock = [
            ("latitude", self.latitude.is_some()),
            ("longitude", self.longitude.is_some()),
            ("date", self.date.is_some()),
            ("time", self.time.is_some()),
            ("timeZone", self.time_zone.is_some()),
        ];
        let direct = [("sun", self.sun.is_some())];
        let first_set =
            |words: &[(&'static str, bool)]| words.iter().find(|(_, first_set)| *first_set).map(|(word, _)| *word);
        if let [first, second, ..] =
            [first_set(&direct), first_set(&angles), first_set(&clock)].into_iter().flatten().collect::<Vec<_>>()[..]
        {
            return Err(format!("the sun's position is given twice, by `{first}` and by `{second}`"));
        }
        // A time without a time zone is in UTC.
        let missing = |words: &[(&'static str, bool)]| match first_set(words) {
            Some(word) => match words.iter().find(|(word, first_set)| !first_set && *word != "timeZone") {
                Some((missing_field, _)) => {
                    Err(format!("the sun's position is incomplete: `{word}` needs `{missing_field}`"))
                }
                None => Ok(()),
            },
            None => Ok(()),
        };
        missing(&angles)?;
        missing(&clock)?;
        if let (Some(altitude), Some(azimuth)) = (self.sun_altitude, self.sun_azimuth) {
            return Ok(Some(almanac::direction([altitude, azimuth].map(f64::from))));
        }
        let (Some(latitude), Some(longitude), Some(date), Some(time)) =
            (self.latitude, self.longitude, self.date, self.time)
        else {
            return Ok(self.sun);
        };
        let [hour, minute, second] = time.to_array().map(f64::from);
        let sixty = 0.0..60.0;
        if !(0.0..=24.0).contains(&hour) || !sixty.contains(&minute) || !sixty.contains(&second) {
            return Err("this `time` does not exist: write hours, minutes and seconds, for example 14 30 0".into());
        }
        let date = date.to_array().map(|part| part as i32);
        let hours = hour + minute / 60.0 + second / 3600.0;
        let moment = Moment { date, hours, zone: f64::from(self.time_zone.unwrap_or(0.0)) };
        if !moment.exists() {
            return Err("this `date` does not exist: write year, month and day, for example 2026 6 21".into());
        }
        Ok(Some(almanac::direction(almanac::sun([latitude, longitude].map(f64::from), &moment))))
    }

    /// Returns the direction to the sun, of any length, or `None` if the background has no sun or
    /// an invalid one.
    pub fn sun(&self) -> Option<Vec3> {
        self.sun_direction().ok().flatten()
    }

    /// True if the sun is below the horizon, in which case neither the sun nor its sky emits light.
    pub fn is_night(&self) -> bool {
        self.sun().is_some_and(|way| way.y < 0.0)
    }

    /// Returns the CIE standard sky if the background has one.
    pub fn cie_sky(&self) -> Option<CieSky> {
        let (zenith, ground) = (self.zenith_luminance.unwrap_or(10_000.0), self.ground_reflectance.unwrap_or(0.2));
        self.cie_sky.map(|number| CieSky::new(number, self.sun().unwrap_or(Vec3::Y), zenith, ground))
    }

    /// Returns the sky with a sun, if the background has a sun above the horizon and no CIE sky.
    pub fn clear_sky(&self) -> Option<Sky> {
        let sun = self.sun().filter(|_| self.cie_sky.is_none() && !self.is_night())?;
        let (turbidity, ground) = (self.turbidity(), self.ground_reflectance);
        Some(match self.sky_model.unwrap_or_default() {
            SkyModel::Preetham => Sky::preetham(sun, turbidity, ground),
            SkyModel::Hosek => Sky::hosek(sun, turbidity, ground),
            SkyModel::Perez => Sky::perez(Perez::new(sun, &self.irradiance()), ground),
        })
    }

    /// Returns the irradiance for an all-weather sky. If the background has a date, the distance
    /// from the sun is that of the date.
    fn irradiance(&self) -> Irradiance {
        let day = self.date.map(|date| almanac::day_of_year(date.to_array().map(|part| part as i32)));
        Irradiance {
            direct_normal: self.direct_normal.unwrap_or(0.0),
            diffuse_horizontal: self.diffuse_horizontal.unwrap_or(0.0),
            dew_point: self.dew_point.unwrap_or(perez::DEW_POINT),
            eccentricity: day.map_or(1.0, perez::eccentricity),
        }
    }

    /// Returns the direction in which the sunlight of a clear sky travels, not normalised, and its
    /// illuminance in lux, per colour channel, on a surface that faces the sun.
    pub fn sunlight(&self) -> Option<(Vec3, Color)> {
        // The CIE standard skies depend on the sun's position but have no direct sunlight.
        let (sky, to_sun) = self.clear_sky().zip(self.sun())?;
        let (turn, scale) = self.environment_transform();
        let (sin, cos) = fp::sin_cos_degrees(f64::from(-turn));
        let [sin, cos] = [sin, cos].map(|x| x as f32);
        let way = Vec3::new(cos * to_sun.x + sin * to_sun.z, to_sun.y.max(0.0), cos * to_sun.z - sin * to_sun.x);
        Some((-way, scale * sky.sun()))
    }

    /// Returns the texels of an environment map of the sky, [`SKY_WIDTH`] wide and half as high, or
    /// `None` if the background has no sky by a model.
    pub fn sky_texels(&self) -> Option<Vec<Color>> {
        match self.cie_sky() {
            Some(sky) => Some(environment_map(SKY_WIDTH, SKY_WIDTH / 2, |dir| sky.at(dir))),
            None => self.clear_sky().map(|sky| environment_map(SKY_WIDTH, SKY_WIDTH / 2, |dir| sky.at(dir))),
        }
    }

    /// Returns the rotation of the environment about the y axis in degrees, and the scale of the
    /// environment.
    pub fn environment_transform(&self) -> (f32, Vec3) {
        (self.environment_rotation.unwrap_or(0.0), self.environment_scale.unwrap_or(Vec3::ONE))
    }
}

/// Render settings that a scene file requests for its picture. Command-line options override these
/// settings.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RenderDefaults {
    /// Width and height in pixels.
    pub size: Option<(u32, u32)>,
    /// Part of the picture to render, given by its first column, first row, width and height.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub crop: Option<(u32, u32, u32, u32)>,
    /// Samples per pixel.
    pub samples: Option<u32>,
    /// Maximum number of scattering events after the first.
    pub bounces: Option<u32>,
    /// Maximum brightness of one contribution to a path after more than one scattering event.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub clamp: Option<f32>,
    /// Depth limit that allows no scattering, and its place in the file. Only pbrt and Mitsuba
    /// files can have such a limit; their readers make all materials black.
    #[serde(skip)]
    pub no_scattering: Option<(u32, Span)>,
}

impl RenderDefaults {
    fn is_empty(&self) -> bool {
        *self == RenderDefaults::default()
    }
}

/// Complete description of a scene, with its camera, background, lights, materials and objects.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Scene {
    /// The camera.
    pub camera: Option<Camera>,
    /// The background and the light that comes from it.
    pub background: Background,
    /// The fog.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fog: Option<Spanned<Fog>>,
    /// Lights in the scene, or `None` if the file has no section for lights.
    pub lights: Option<Vec<Spanned<Light>>>,
    /// Materials of the scene. Objects refer to materials by number.
    pub materials: Vec<Spanned<Material>>,
    /// The objects.
    pub root: Option<Group>,
    /// Assets that are in memory instead of in files.
    #[serde(skip_serializing_if = "Assets::is_empty", skip_deserializing)]
    pub assets: Assets,
    /// Settings that the file requests for its picture.
    #[serde(rename = "wishes", default, skip_serializing_if = "RenderDefaults::is_empty")]
    pub render_defaults: RenderDefaults,
    /// Up axis, if the format defines one.
    #[serde(skip)]
    pub up: Option<Axis>,
    /// True if the file describes its own light by surfaces or surroundings, so that no default
    /// lights are added.
    #[serde(skip)]
    pub is_lit: bool,
    /// Lumens per watt for red, green and blue, if the light in the scene is given in watts.
    #[serde(skip)]
    pub lumens_per_watt: Option<Vec3>,
    /// Span of the camera in the scene file.
    #[serde(skip)]
    pub camera_span: Span,
    /// Names of the cameras in the file of a model, in the order of their numbers. A camera without
    /// a name has an empty one.
    #[serde(skip)]
    pub camera_names: Vec<String>,
    /// Names and lengths in seconds of the animations of a glTF file.
    #[serde(skip)]
    pub animations: Vec<(String, f32)>,
    /// Span of the background in the scene file.
    #[serde(skip)]
    pub background_span: Span,
}

impl Scene {
    /// Adds a mesh in memory under `name`, which must be unique, and returns a node that uses it.
    pub fn add_mesh(&mut self, name: &str, data: Arc<MeshData>, span: Span) -> ObjectKind {
        self.assets.meshes.insert(name.to_string(), data);
        ObjectKind::Mesh(TriangleMesh { obj_file: FileName { path: name.to_string(), span } })
    }

    /// True if the scene has lights or materials that only a path tracer can render. Such features
    /// are principled or hair materials, fog, an environment, a sun and a sky.
    pub fn is_physical(&self) -> bool {
        let layered = |m: &Spanned<Material>| matches!(m.value, Material::Principled(_) | Material::Hair(_));
        let background = &self.background;
        background.environment.is_some()
            || background.sun().is_some()
            || background.cie_sky.is_some()
            || self.fog.is_some()
            || self.materials.iter().any(layered)
    }
}

impl Scene {
    /// Iterates over all objects in the order of the file. Groups, transforms and solids precede
    /// the objects of which they consist.
    pub fn objects(&self) -> impl Iterator<Item = &Object> {
        let mut next: Vec<&Object> = self.root.iter().flat_map(|root| root.objects.iter().rev()).collect();
        std::iter::from_fn(move || {
            let object = next.pop()?;
            next.extend(object.node.children().iter().rev());
            Some(object)
        })
    }

    /// True if the lights of a studio were added to the scene. Only they come with a clamp.
    pub fn has_studio(&self) -> bool {
        self.render_defaults.clamp.is_some()
    }

    /// True if a surface, an environment map or the sun emits light.
    pub fn emits_light(&self) -> bool {
        let emits = |material: &Spanned<Material>| match &material.value {
            Material::Principled(layers) => layers.emission_luminance > 0.0,
            _ => false,
        };
        self.background.environment.is_some() || self.background.sun().is_some() || self.materials.iter().any(emits)
    }
}

/// Value in a scene, together with its position in the scene file for diagnostics.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Spanned<T> {
    /// The value.
    pub value: T,
    /// Position of the value in the scene file.
    #[serde(skip)]
    pub span: Span,
}

/// Material of a scene, which can be of any kind.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Material {
    /// Material with a diffuse colour, highlight, mirror and glass. Noise can replace the diffuse
    /// colour.
    Phong(Box<PhongMaterial>, Option<ColorNoise>),
    /// Principled material with layers, as in OpenPBR.
    Principled(Box<PrincipledMaterial>),
    /// Material for fibres of hair or fur.
    Hair(HairMaterial),
    /// Two earlier materials that are mixed by a pattern, and the transform from world space to
    /// pattern space.
    Solid(PatternMaterial, Vec<MatrixOp>),
}

/// Group of objects in a scene. The root of the scene is such a group.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Group {
    /// Objects in the order of the file.
    pub objects: Vec<Object>,
}

/// Object of a scene, with the material that was current at the position of the object in the file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Object {
    /// Kind of the object.
    pub node: ObjectKind,
    /// Number of the current material, or `None` before the first material.
    pub material: Option<u32>,
    /// Span of the object's keyword in the file.
    #[serde(skip)]
    pub span: Span,
}

impl Object {
    /// Wraps the object in a transform, or returns it unchanged if the transform is the identity.
    pub fn transformed(self, map: DAffine3) -> Object {
        if map == DAffine3::IDENTITY {
            return self;
        }
        let matrix = DMat4::from(map).transpose().to_cols_array().map(|x| x as f32);
        let (material, span) = (self.material, self.span);
        Object { node: ObjectKind::Transform(vec![MatrixOp::Matrix(matrix)], Box::new(self)), material, span }
    }
}

/// Kind of an object in a scene, such as a group, a transform, a shape, a mesh or a solid.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum ObjectKind {
    /// Group of objects.
    Group(Group),
    /// An object that is transformed by M = M1 M2 ...
    Transform(Vec<MatrixOp>, Box<Object>),
    /// A shape.
    Primitive(Primitive),
    /// A mesh in a file.
    Mesh(TriangleMesh),
    /// Grid of cells, in which the cells inside the balls are filled.
    Voxels(VoxelGrid, Vec<Sphere>),
    /// A terrain from a picture.
    HeightField(HeightField),
    /// Closed objects combined into one solid.
    Solid(CsgOperation, Vec<Object>),
}

impl ObjectKind {
    /// Returns the objects of which a group, a transform or a solid consists.
    pub fn children(&self) -> &[Object] {
        match self {
            ObjectKind::Group(group) => &group.objects,
            ObjectKind::Transform(_, object) => std::slice::from_ref(object),
            ObjectKind::Solid(_, parts) => parts,
            ObjectKind::Primitive(_) | ObjectKind::Mesh(_) | ObjectKind::Voxels(..) | ObjectKind::HeightField(_) => &[],
        }
    }
}

/// Boolean operation that combines closed objects into a solid. A group counts as the union of its
/// objects.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum CsgOperation {
    /// Union of the parts. Unless it is nested in another operation, the surfaces inside other
    /// parts are kept.
    Union,
    /// Union of the parts as one solid, without the surfaces inside other parts.
    Merge,
    /// Intersection of all parts.
    Intersection,
    /// The first part minus all others.
    Difference,
    /// Points inside an odd number of parts.
    Xor,
}

impl CsgOperation {
    /// All operations, each with its keyword.
    pub const ALL: [(&str, CsgOperation); 5] = [
        ("Union", CsgOperation::Union),
        ("Merge", CsgOperation::Merge),
        ("Intersection", CsgOperation::Intersection),
        ("Difference", CsgOperation::Difference),
        ("Xor", CsgOperation::Xor),
    ];

    /// Returns a description of the points inside the result.
    pub fn doc(self) -> &'static str {
        match self {
            CsgOperation::Union => {
                "Union of the parts. Unless it is nested in another operation, the surfaces inside other parts are \
                 kept."
            }
            CsgOperation::Merge => "Union of the parts as one solid, without the surfaces inside other parts.",
            CsgOperation::Intersection => "Intersection of all parts.",
            CsgOperation::Difference => "The first part minus all others.",
            CsgOperation::Xor => "Points inside an odd number of parts.",
        }
    }

    /// Returns the operation with a keyword.
    pub fn from_keyword(word: &str) -> Option<CsgOperation> {
        CsgOperation::ALL.iter().find(|row| row.0 == word).map(|row| row.1)
    }

    /// Returns the keyword of the operation.
    pub fn keyword(self) -> &'static str {
        CsgOperation::ALL[self as usize].0
    }
}
