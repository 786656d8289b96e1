//! Colours of surfaces and the sky, with the mistakes of a student's tracer.

use super::BuggyTracer;
use crate::mistakes::bugs::{ColorBugs, PatternSpace};
use durer_render::world::{Material, MaterialMix, Phong, SurfaceInteraction, WeightedMaterial};
use durer_scene::material::{Pattern, PatternMaterial};
use durer_scene::math::{Color, Vec3};

impl<'w> BuggyTracer<'w> {
    /// Returns the light of the sky along a ray with the given direction.
    pub(super) fn sky(&self, direction: Vec3) -> Color {
        let bugs = self.bugs.colors;
        let looked_up = bugs.sky.of(direction);
        match (self.world.environment(), self.world.cube_map()) {
            (None, Some(map)) if bugs != ColorBugs::default() => bugs.faces.color(map, looked_up, bugs.face_texture),
            _ => self.world.background_radiance(looked_up),
        }
    }

    /// Returns the diffuse colour of a material at a hit.
    pub(super) fn diffuse_color(&self, phong: &Phong, at: &SurfaceInteraction) -> Color {
        let (bugs, surface) = (self.bugs.colors, &at.surface);
        if bugs == ColorBugs::default() {
            return self.world.diffuse_color(phong, surface);
        }
        let texture =
            phong.texture.and_then(|i| Some(bugs.texture.color(&self.world.textures()[i as usize], surface.uv.get()?)));
        if phong.tinted {
            let [r, g, b, _] = surface.color;
            return phong.diffuse * Color::new(r, g, b) * texture.unwrap_or(Color::ONE);
        }
        let noise = phong.noise.as_ref().map(|noise| {
            let point = match bugs.space {
                PatternSpace::Object => self.own_point(at),
                _ => surface.position,
            };
            bugs.noise_color(noise, point)
        });
        noise.or(texture).unwrap_or(phong.diffuse)
    }

    /// Returns the materials at a hit with their shares.
    pub(super) fn materials_at(&self, at: &SurfaceInteraction) -> MaterialMix<'w> {
        if self.bugs.colors == ColorBugs::default() {
            return self.world.materials_at(at);
        }
        let mut parts = MaterialMix::new();
        self.mix(at.material, at, 1.0, &mut parts);
        parts
    }

    /// Adds the materials of a mixture, which may be nested, with their shares.
    fn mix(&self, material: u32, at: &SurfaceInteraction, share: f32, parts: &mut MaterialMix<'w>) {
        let (pattern, to_pattern, picture) = match &self.world.materials()[material as usize] {
            Material::Phong(phong) => return parts.push(WeightedMaterial { phong, share }),
            Material::Mix(pattern, to_pattern, picture) => (pattern, to_pattern, picture),
        };
        let bugs = self.bugs.colors;
        let point = at.surface.position.as_dvec3();
        let q = match bugs.space {
            PatternSpace::Correct => to_pattern.transform_point3(point).as_vec3(),
            PatternSpace::World => at.surface.position,
            PatternSpace::Inverse => to_pattern.inverse().transform_point3(point).as_vec3(),
            PatternSpace::Object => to_pattern.transform_point3(self.own_point(at).as_dvec3()).as_vec3(),
        };
        let weight = match pattern {
            PatternMaterial::TwoSided(_) => f32::from(u8::from(!at.inside())),
            _ => {
                let pictured = picture.map_or(1.0, |picture| self.world.number_at(picture, at));
                bugs.pattern_share(pattern, q, self.world.shading_rules().conic_rings) * pictured
            }
        };
        let [first, second] = pattern.materials();
        for (index, weight) in [(first, weight), (second, 1.0 - weight)] {
            if weight != 0.0 {
                self.mix(index, at, share * weight, parts);
            }
        }
    }

    /// Returns the position of a hit in the space of the object.
    fn own_point(&self, at: &SurfaceInteraction) -> Vec3 {
        let object = &self.world.objects()[at.hit.object as usize];
        let position = at.surface.position;
        object.to_world.as_ref().map_or(position, |to_world| to_world.inverse_point(position) + object.center)
    }
}
