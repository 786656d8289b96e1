//! Meaning of a scene's dialect for each part of the renderer. Code after this module does not
//! depend on dialects.

use crate::world::{Contents, DisplayRules, Epsilon, HitRules, ShadingRules, Vectors};
use durer_scene::camera::{Aim, CameraRules, UpRule};
use durer_scene::dialect::{Arithmetic, Compat, Falloff, Rules};
use durer_scene::light::{DirectionalLight, Emitter as _, Light, PointLight};
use durer_scene::math::Vec3;
use durer_scene::scene::MatrixRules;

/// Rules of cameras and pictures.
pub fn camera_rules(rules: &Rules) -> CameraRules {
    let up = match () {
        () if rules.has(Compat::RawUp) => UpRule::Raw,
        () if rules.has(Compat::SkewUp) => UpRule::Skew,
        () => UpRule::Perpendicular,
    };
    CameraRules {
        up,
        aim: match rules.arithmetic {
            Arithmetic::Own if rules.has(Compat::ScreenPoint) => Aim::ScreenPoint,
            Arithmetic::Own => Aim::Own,
            Arithmetic::Of2012 => Aim::Of2012,
            Arithmetic::Of2016 => Aim::Of2016,
            Arithmetic::Of2020 => Aim::Of2020,
        },
        border_pixels: rules.has(Compat::BorderPixels),
        stretch: rules.has(Compat::Stretch),
    }
}

/// Rules of products of matrices.
pub fn matrix_rules(rules: &Rules) -> MatrixRules {
    MatrixRules {
        matrix_on_left: rules.has(Compat::MatrixOnLeft),
        dropped_shear: rules.has(Compat::DroppedShear),
        dropped_tiny: rules.has(Compat::TinyTransforms),
    }
}

/// Hit rules of an official program; `None` for Dürer's own arithmetic.
pub fn hit_rules(rules: &Rules) -> Option<HitRules> {
    let vectors = match rules.arithmetic {
        Arithmetic::Own => return None,
        Arithmetic::Of2012 | Arithmetic::Of2016 => Vectors::Vecmath,
        Arithmetic::Of2020 => Vectors::Glm,
    };
    Some(HitRules {
        vectors,
        triangle_matrix: rules.arithmetic == Arithmetic::Of2012,
        tied_triangles: rules.has(Compat::TiedTriangles),
        closed_planes: rules.has(Compat::ClosedPlanes),
        closed_spheres: vectors == Vectors::Glm,
        raw_normals: rules.has(Compat::RawNormals),
        octree: rules.has(Compat::OctreeHoles),
    })
}

/// Rules of hits and of Whitted's integrator.
pub fn shading_rules(rules: &Rules) -> ShadingRules {
    let official = rules.is_official();
    ShadingRules {
        epsilon: rules.epsilon.map(match rules.has(Compat::MovedStarts) {
            true => Epsilon::Along,
            false => Epsilon::Least,
        }),
        points_on_ray: official,
        one_medium: official,
        weight_by_length: official,
        shaded_sides: rules.has(Compat::ShadedSides),
        black_backs: rules.has(Compat::BlackBacks),
        spoiled_normals: rules.has(Compat::SpoiledNormals),
        unit_light: rules.has(Compat::UnitLight),
        raw_normals: rules.has(Compat::RawNormals),
        raw_refraction: rules.has(Compat::RawRefraction),
        long_mirrors: rules.has(Compat::LongMirrors),
        exit_r0: rules.has(Compat::ExitR0),
        shadow_fronts: rules.has(Compat::ShadowFronts),
        air_at_eye: rules.has(Compat::AirAtEye),
        mesh_textures: rules.has(Compat::MeshTextures),
        moved_normals: rules.has(Compat::MovedNormals),
        conic_rings: rules.has(Compat::ConicRings),
        stale_texels: rules.has(Compat::StaleTexels),
    }
}

/// Display rules of pictures of values. `lumens` are those of the scene.
pub fn display_rules(rules: &Rules, lumens: Option<Vec3>) -> DisplayRules {
    DisplayRules {
        normals: rules.normals_picture,
        depth: rules.depth_picture,
        whole_depths: rules.has(Compat::WholeDepths),
        black_sky: rules.has(Compat::BlackSky),
        stale_normals: rules.has(Compat::StaleNormals),
        clamped_depths: rules.has(Compat::ClampedDepths),
        lumens,
    }
}

impl Contents {
    /// Resolves other rules; the camera's axes, lights, materials and objects stay as they are.
    pub fn set_rules(&mut self, rules: Rules) {
        self.camera_rules = camera_rules(&rules);
        self.hits = hit_rules(&rules);
        self.shading = shading_rules(&rules);
        self.display = display_rules(&rules, self.display.lumens);
        self.rules = rules;
    }
}

/// Returns a light with its power folded into its colour, and with the attenuation that its dialect
/// defines.
pub(super) fn light(light: &Light, rules: &Rules) -> Light {
    match light {
        Light::Point(lamp) if lamp.candela.or(lamp.lumens).is_none() => {
            PointLight { attenuation: attenuation(lamp, rules), falloff: None, ..lamp.clone() }.into()
        }
        // The direction normalizes to NaN, and so does all light from it.
        Light::Directional(sun) if sun.direction == Vec3::ZERO => {
            DirectionalLight { color: Vec3::NAN, ..sun.clone() }.into()
        }
        light => light.in_units(),
    }
}

/// Divisor of a point light at distance d, as a0 + a1 d + a2 d^2.
fn attenuation(lamp: &PointLight, rules: &Rules) -> Option<Vec3> {
    let divides_by_zero = rules.has(Compat::MissingFalloff);
    match (rules.falloff, lamp.falloff) {
        (Falloff::None, _) => None,
        (Falloff::OnePlus, Some(f)) => Some(Vec3::new(1.0, 0.0, f)),
        (Falloff::OnePlus, None) => lamp.attenuation,
        (Falloff::Bare(_), Some(f)) if f > 0.0 || divides_by_zero => Some(Vec3::new(0.0, 0.0, f)),
        (Falloff::Bare(Some(default)), None) => Some(Vec3::new(0.0, 0.0, default)),
        (Falloff::Bare(None), None) if divides_by_zero => Some(Vec3::ZERO),
        (Falloff::Bare(_), _) => None,
    }
}

#[cfg(test)]
mod tests;
