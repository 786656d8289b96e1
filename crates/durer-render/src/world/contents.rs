//! What a world is made of, and its identity.

use super::{DisplayRules, Geometry, Material, Object, ShadingRules, World};
use durer_scene::camera::{Camera, CameraBasis, CameraRules};
use durer_scene::dialect::Rules;
use durer_scene::light::{Light, Profile};
use durer_scene::math::{Color, Vec3};
use durer_scene::medium::Medium;
use durer_scene::source::Digest;
use durer_scene::spectrum::Curve;
use durer_scene::texture::{CubeMap, Environment, Texture};
use std::fmt::Write;
use std::sync::Arc;

/// What the description says: it may be [changed](World::edit).
#[derive(Clone, Debug)]
pub struct Contents {
    /// Whence it is seen.
    pub camera: Camera,
    /// The camera's axes.
    pub frame: CameraBasis,
    /// Colour of rays that hit nothing.
    pub background: Color,
    /// Light that is everywhere.
    pub ambient: Color,
    /// Lights.
    pub lights: Vec<Light>,
    /// Materials, by number.
    pub materials: Vec<Material>,
    /// Everything that a ray can hit, by number.
    pub objects: Vec<Object>,
    /// Rules of the camera and of pixels.
    pub camera_rules: CameraRules,
    /// Rules of hits and of Whitted's integrator.
    pub shading: ShadingRules,
    /// Rules of pictures of values.
    pub display: DisplayRules,
    /// The dialect that all these were resolved from. Rendering does not ask it; checks, lessons
    /// and mistakes of the course do.
    pub(crate) rules: Rules,
}

/// What the files became that it names.
#[derive(Clone, Debug, Default)]
pub struct Assets {
    /// Surroundings that replace the background's colour.
    pub cube_map: Option<CubeMap>,
    /// Light from all around, which replaces colour and cube map.
    pub environment: Option<Environment>,
    /// What is in the air, if light loses something there.
    pub fog: Option<Medium>,
    /// How strong each light shines in each direction, where that was measured; by number, those
    /// behind the last have none.
    pub profiles: Vec<Option<Arc<Profile>>>,
    /// The measured spectrum of each light, if it has one; by number, those behind the last have
    /// none.
    pub illuminants: Vec<Option<Arc<Curve>>>,
    /// Decoded pictures, by number.
    pub textures: Vec<Texture>,
}

impl World {
    /// Changes what the description said. The world has another [identity](World::digest) then;
    /// what was found about its objects stays as it was found.
    pub fn edit(&mut self) -> &mut Contents {
        self.edited = true;
        self.extents.clear();
        &mut self.contents
    }

    /// Puts another camera into its place. The hash of the world is then that of the former with the
    /// camera's: no object is looked at.
    pub fn look_through(&mut self, camera: Camera) {
        let text = format!("{} {camera:?}", self.digest());
        self.contents.frame = CameraBasis::of(&camera, self.contents.camera_rules);
        self.contents.camera = camera;
        (self.source, self.edited) = (Digest::of(text.as_bytes()), false);
    }

    /// The hash of all that it holds. As it was compiled, that is the hash of what it was made of:
    /// description, files, rules.
    pub fn digest(&self) -> Digest {
        if !self.edited {
            return self.source;
        }
        let Contents { camera, frame, background, ambient, lights, materials, objects, rules, .. } = &self.contents;
        let resolved = (self.contents.camera_rules, self.contents.shading, self.contents.display);
        let mut text =
            format!("{:?}", (self.source, camera, frame, background, ambient, lights, materials, rules, resolved));
        for Object { geometry, to_world, center, material, normal_length, span: _ } in objects {
            let geometry = match geometry {
                Geometry::Mesh(tree) => tree.mesh.digest().to_string(),
                other => format!("{other:?}"),
            };
            // Text can always be written into text.
            let _ = write!(text, "{:?}", (geometry, to_world, center, material, normal_length));
        }
        Digest::of(text.as_bytes())
    }

    /// Whence it is seen.
    pub fn camera(&self) -> &Camera {
        &self.contents.camera
    }

    /// The camera's axes.
    pub fn camera_frame(&self) -> &CameraBasis {
        &self.contents.frame
    }

    /// Colour of rays that hit nothing.
    pub fn background(&self) -> Color {
        self.contents.background
    }

    /// Light that is everywhere.
    pub fn ambient(&self) -> Color {
        self.contents.ambient
    }

    /// Lights.
    pub fn lights(&self) -> &[Light] {
        &self.contents.lights
    }

    /// Materials, by number.
    pub fn materials(&self) -> &[Material] {
        &self.contents.materials
    }

    /// Everything that a ray can hit, by number.
    pub fn objects(&self) -> &[Object] {
        &self.contents.objects
    }

    /// Rules of the camera and of pixels.
    pub fn camera_rules(&self) -> CameraRules {
        self.contents.camera_rules
    }

    /// Rules of hits and of Whitted's integrator.
    pub fn shading_rules(&self) -> &ShadingRules {
        &self.contents.shading
    }

    /// Rules of pictures of values.
    pub fn display_rules(&self) -> DisplayRules {
        self.contents.display
    }

    /// The rules of the dialect that it was compiled with: for checks, lessons and mistakes.
    pub fn rules(&self) -> &Rules {
        &self.contents.rules
    }

    /// Surroundings that replace the background's colour.
    pub fn cube_map(&self) -> Option<&CubeMap> {
        self.assets.cube_map.as_ref()
    }

    /// Light from all around, which replaces colour and cube map.
    pub fn environment(&self) -> Option<&Environment> {
        self.assets.environment.as_ref()
    }

    /// What is in the air, if light loses something there.
    pub fn fog(&self) -> Option<&Medium> {
        self.assets.fog.as_ref()
    }

    /// How strong each light shines in each direction, where that was measured; by number, those
    /// behind the last have none.
    pub fn profiles(&self) -> &[Option<Arc<Profile>>] {
        &self.assets.profiles
    }

    /// The measured spectrum of each light, if it has one; by number, those behind the last have
    /// none.
    pub fn illuminants(&self) -> &[Option<Arc<Curve>>] {
        &self.assets.illuminants
    }

    /// Decoded pictures, by number.
    pub fn textures(&self) -> &[Texture] {
        &self.assets.textures
    }
}
