//! Editable contents of a world and the hash that identifies them.

use super::{DisplayRules, Geometry, HitRules, LightSampler, Material, Object, ShadingRules, World};
use durer_scene::camera::{Camera, CameraBasis, CameraRules};
use durer_scene::dialect::DialectRules;
use durer_scene::light::{Light, PhotometricProfile};
use durer_scene::math::Color;
use durer_scene::medium::Medium;
use durer_scene::source::Digest;
use durer_scene::spectrum::Curve;
use durer_scene::texture::{CubeMap, Environment, Texture};
use std::fmt::Write;
use std::sync::Arc;

/// Contents of a world that come from the scene file: camera, lights, materials, objects and rules.
/// The contents can be [edited](World::edit).
#[derive(Clone, Debug)]
pub struct Contents {
    /// Camera.
    pub camera: Camera,
    /// Basis vectors of the camera.
    pub frame: CameraBasis,
    /// Colour of rays that hit nothing.
    pub background: Color,
    /// True if paths see a black background because the scene does not define a background.
    pub is_black_for_paths: bool,
    /// True if the camera sees neither emissive surfaces nor the background.
    pub hides_emitters: bool,
    /// Ambient light.
    pub ambient: Color,
    /// Lights.
    pub lights: Vec<Light>,
    /// Materials, by index.
    pub materials: Vec<Material>,
    /// Objects, by index.
    pub objects: Vec<Object>,
    /// Rules for the camera and pixel positions.
    pub camera_rules: CameraRules,
    /// Ray intersection rules of an official program, if that program's arithmetic is in use.
    pub hits: Option<HitRules>,
    /// Rules for shading and for the Whitted integrator.
    pub shading: ShadingRules,
    /// Rules for displaying AOVs as pictures.
    pub display: DisplayRules,
    /// Dialect rules from which the other rules were derived. They are not used for rendering, only
    /// for checks, lessons and the student's tracer.
    pub(crate) rules: DialectRules,
}

/// Contents of a world that do not come from the scene file but from other files, such as textures
/// and environment maps.
#[derive(Clone, Debug, Default)]
pub struct Assets {
    /// Cube map that replaces the background colour.
    pub cube_map: Option<CubeMap>,
    /// Environment map, which replaces the background colour and the cube map.
    pub environment: Option<Environment>,
    /// Medium that fills the space outside all objects, if there is fog.
    pub fog: Option<Medium>,
    /// Measured intensity profiles of the lights, by light index; `None` for lights without one.
    /// The list can be shorter than the list of lights.
    pub profiles: Vec<Option<Arc<PhotometricProfile>>>,
    /// Measured spectra of the lights, by light index; `None` for lights without one. The list can
    /// be shorter than the list of lights.
    pub illuminants: Vec<Option<Arc<Curve>>>,
    /// Textures, by index.
    pub textures: Vec<Texture>,
}

impl World {
    /// Returns the contents so that they can be edited. Editing changes the world's
    /// [hash](World::digest). Data that was computed from the objects, such as the acceleration
    /// structure, is not updated.
    pub fn edit(&mut self) -> &mut Contents {
        self.edited = true;
        self.half_areas.clear();
        &mut self.contents
    }

    /// Replaces the camera. The world's new hash is computed from the old one and the camera,
    /// without the cost of hashing objects.
    pub fn set_camera(&mut self, camera: Camera) {
        let text = format!("{} {camera:?}", self.digest());
        self.contents.frame = CameraBasis::of(&camera, self.contents.camera_rules);
        self.contents.camera = camera;
        (self.source, self.edited) = (Digest::of(text.as_bytes()), false);
    }

    /// Returns the world with other light: `environment` and `lights` replace the background, all
    /// lights and the light of all surfaces.
    pub fn with_light(mut self, environment: Option<Environment>, lights: Vec<Light>) -> World {
        let contents = self.edit();
        (contents.background, contents.ambient, contents.lights) = (Color::ZERO, Color::ZERO, lights);
        for material in &mut contents.materials {
            if let Material::Phong(phong) = material {
                phong.emission = None;
            }
        }
        (self.assets.cube_map, self.assets.environment) = (None, environment);
        (self.assets.profiles, self.assets.illuminants) = (Vec::new(), Vec::new());
        self.half_areas = self.empty_half_areas();
        self.emitters = LightSampler::new(&self);
        self
    }

    /// Replaces the decoded values of 8-bit codes in the textures with the given indices. The
    /// world's new hash is computed from the old one and these values.
    pub fn decode_textures(&mut self, textures: &[u32], decode: fn(u8) -> f32) {
        let values: Vec<f32> = (0..=255).map(decode).collect();
        let text = format!("{} {textures:?} {values:?}", self.digest());
        for (index, texture) in (0..).zip(&mut self.assets.textures) {
            if textures.contains(&index) {
                *texture = texture.clone().with_decoding(decode);
            }
        }
        (self.source, self.edited) = (Digest::of(text.as_bytes()), false);
    }

    /// Returns a hash that identifies the contents. For an unedited world, it is the hash of its
    /// sources: the scene file, the files it refers to and the rules.
    pub fn digest(&self) -> Digest {
        if !self.edited {
            return self.source;
        }
        let Contents { camera, frame, background, ambient, lights, materials, objects, rules, .. } = &self.contents;
        let Contents { camera_rules, hits, shading, display, hides_emitters, .. } = &self.contents;
        let resolved = (camera_rules, hits, shading, display, hides_emitters);
        let mut text =
            format!("{:?}", (self.source, camera, frame, background, ambient, lights, materials, rules, resolved));
        for Object { geometry, to_world, matrices, center, material, normal_length, span: _ } in objects {
            let geometry = match geometry {
                Geometry::Mesh(tree) => tree.mesh.digest().to_string(),
                other => format!("{other:?}"),
            };
            // Writing to a string never fails.
            let _ = write!(text, "{:?}", (geometry, to_world, matrices, center, material, normal_length));
        }
        Digest::of(text.as_bytes())
    }

    /// Returns the camera.
    pub fn camera(&self) -> &Camera {
        &self.contents.camera
    }

    /// Returns the basis vectors of the camera.
    pub fn camera_frame(&self) -> &CameraBasis {
        &self.contents.frame
    }

    /// Returns the colour of rays that hit nothing.
    pub fn background(&self) -> Color {
        self.contents.background
    }

    /// Returns true if paths see a black background because the scene does not define a background.
    pub fn is_dark(&self) -> bool {
        self.contents.is_black_for_paths
    }

    /// Returns true if paths that come directly from the camera pass emissive surfaces and see a
    /// black background.
    pub fn hides_emitters(&self) -> bool {
        self.contents.hides_emitters
    }

    /// Returns the ambient light.
    pub fn ambient(&self) -> Color {
        self.contents.ambient
    }

    /// Returns the lights.
    pub fn lights(&self) -> &[Light] {
        &self.contents.lights
    }

    /// Returns the materials, by index.
    pub fn materials(&self) -> &[Material] {
        &self.contents.materials
    }

    /// Returns the objects, by index.
    pub fn objects(&self) -> &[Object] {
        &self.contents.objects
    }

    /// Returns the rules for the camera and pixel positions.
    pub fn camera_rules(&self) -> CameraRules {
        self.contents.camera_rules
    }

    /// Returns the ray intersection rules of an official program, if that program's arithmetic is
    /// in use.
    pub fn hit_rules(&self) -> Option<HitRules> {
        self.contents.hits
    }

    /// Returns the rules for shading and for the Whitted integrator.
    pub fn shading_rules(&self) -> &ShadingRules {
        &self.contents.shading
    }

    /// Returns the rules for displaying AOVs as pictures.
    pub fn display_rules(&self) -> DisplayRules {
        self.contents.display
    }

    /// Returns the dialect rules with which the scene was compiled, for checks, lessons and the
    /// student's tracer.
    pub fn rules(&self) -> &DialectRules {
        &self.contents.rules
    }

    /// Returns the cube map that replaces the background colour.
    pub fn cube_map(&self) -> Option<&CubeMap> {
        self.assets.cube_map.as_ref()
    }

    /// Returns the environment map, which replaces the background colour and the cube map.
    pub fn environment(&self) -> Option<&Environment> {
        self.assets.environment.as_ref()
    }

    /// Returns the medium that fills the space outside all objects, if there is fog.
    pub fn fog(&self) -> Option<&Medium> {
        self.assets.fog.as_ref()
    }

    /// Returns the measured intensity profiles of the lights, by light index. The list can be
    /// shorter than the list of lights.
    pub fn profiles(&self) -> &[Option<Arc<PhotometricProfile>>] {
        &self.assets.profiles
    }

    /// Returns the measured spectra of the lights, by light index. The list can be shorter than the
    /// list of lights.
    pub fn illuminants(&self) -> &[Option<Arc<Curve>>] {
        &self.assets.illuminants
    }

    /// Returns the textures, by index.
    pub fn textures(&self) -> &[Texture] {
        &self.assets.textures
    }
}
