//! Contents of a world, and its identity.

use super::{DisplayRules, Geometry, HitRules, Material, Object, ShadingRules, World};
use durer_scene::camera::{Camera, CameraBasis, CameraRules};
use durer_scene::dialect::Rules;
use durer_scene::light::{Light, Profile};
use durer_scene::math::Color;
use durer_scene::medium::Medium;
use durer_scene::source::Digest;
use durer_scene::spectrum::Curve;
use durer_scene::texture::{CubeMap, Environment, Texture};
use std::fmt::Write;
use std::sync::Arc;

/// Data from the description, which may be [edited](World::edit).
#[derive(Clone, Debug)]
pub struct Contents {
    /// Camera.
    pub camera: Camera,
    /// Camera basis.
    pub frame: CameraBasis,
    /// Colour of rays that miss.
    pub background: Color,
    /// True if paths see a black background, because the scene defines none.
    pub dark: bool,
    /// Ambient light.
    pub ambient: Color,
    /// Lights.
    pub lights: Vec<Light>,
    /// Materials, by index.
    pub materials: Vec<Material>,
    /// Objects, by index.
    pub objects: Vec<Object>,
    /// Rules of the camera and the raster.
    pub camera_rules: CameraRules,
    /// Hit rules of an official program, if its arithmetic is active.
    pub hits: Option<HitRules>,
    /// Rules of hits and of Whitted's integrator.
    pub shading: ShadingRules,
    /// Rules for displaying AOVs.
    pub display: DisplayRules,
    /// Rules of the dialect from which the others were resolved. They are not used for rendering,
    /// but by checks, lessons and the student's tracer.
    pub(crate) rules: Rules,
}

/// Data from files.
#[derive(Clone, Debug, Default)]
pub struct Assets {
    /// Cube map that replaces the background's colour.
    pub cube_map: Option<CubeMap>,
    /// Environment light, which replaces colour and cube map.
    pub environment: Option<Environment>,
    /// Medium of the air, if there is fog.
    pub fog: Option<Medium>,
    /// Intensity profile of each light, if measured; by index, missing at the end.
    pub profiles: Vec<Option<Arc<Profile>>>,
    /// Measured spectrum of each light, if it has one; by index, missing at the end.
    pub illuminants: Vec<Option<Arc<Curve>>>,
    /// Textures, by index.
    pub textures: Vec<Texture>,
}

impl World {
    /// Edits the description's data. Changes the world's [identity](World::digest); data derived
    /// from objects, such as the acceleration structure, is kept.
    pub fn edit(&mut self) -> &mut Contents {
        self.edited = true;
        self.extents.clear();
        &mut self.contents
    }

    /// Replaces the camera. The new hash of the world combines the previous hash with the camera,
    /// without looking at any object.
    pub fn look_through(&mut self, camera: Camera) {
        let text = format!("{} {camera:?}", self.digest());
        self.contents.frame = CameraBasis::of(&camera, self.contents.camera_rules);
        self.contents.camera = camera;
        (self.source, self.edited) = (Digest::of(text.as_bytes()), false);
    }

    /// Returns the hash of the contents. For an unedited world it is the hash of its sources:
    /// description, files, rules.
    pub fn digest(&self) -> Digest {
        if !self.edited {
            return self.source;
        }
        let Contents { camera, frame, background, ambient, lights, materials, objects, rules, .. } = &self.contents;
        let resolved = (self.contents.camera_rules, self.contents.hits, self.contents.shading, self.contents.display);
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

    /// Returns the camera basis.
    pub fn camera_frame(&self) -> &CameraBasis {
        &self.contents.frame
    }

    /// Returns the colour of rays that miss.
    pub fn background(&self) -> Color {
        self.contents.background
    }

    /// Returns true if paths see a black background, because the scene defines none.
    pub fn is_dark(&self) -> bool {
        self.contents.dark
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

    /// Returns the rules of the camera and the raster.
    pub fn camera_rules(&self) -> CameraRules {
        self.contents.camera_rules
    }

    /// Returns the hit rules of an official program, if its arithmetic is active.
    pub fn hit_rules(&self) -> Option<HitRules> {
        self.contents.hits
    }

    /// Returns the rules of hits and of Whitted's integrator.
    pub fn shading_rules(&self) -> &ShadingRules {
        &self.contents.shading
    }

    /// Returns the rules for displaying AOVs.
    pub fn display_rules(&self) -> DisplayRules {
        self.contents.display
    }

    /// Returns the dialect's rules with which the scene was compiled, for checks, lessons and the
    /// student's tracer.
    pub fn rules(&self) -> &Rules {
        &self.contents.rules
    }

    /// Returns the cube map that replaces the background's colour.
    pub fn cube_map(&self) -> Option<&CubeMap> {
        self.assets.cube_map.as_ref()
    }

    /// Returns the environment light, which replaces colour and cube map.
    pub fn environment(&self) -> Option<&Environment> {
        self.assets.environment.as_ref()
    }

    /// Returns the medium of the air, if there is fog.
    pub fn fog(&self) -> Option<&Medium> {
        self.assets.fog.as_ref()
    }

    /// Returns the intensity profile of each light, if measured; by index, missing at the end.
    pub fn profiles(&self) -> &[Option<Arc<Profile>>] {
        &self.assets.profiles
    }

    /// Returns the measured spectrum of each light, if it has one; by index, missing at the end.
    pub fn illuminants(&self) -> &[Option<Arc<Curve>>] {
        &self.assets.illuminants
    }

    /// Returns the textures, by index.
    pub fn textures(&self) -> &[Texture] {
        &self.assets.textures
    }
}
