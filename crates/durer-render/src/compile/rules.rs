//! Translation of a dialect into rules for each part of the renderer. Only the compilation of a
//! scene depends on the dialect. All later code uses these rules.

use crate::world::{Contents, DisplayRules, Epsilon, HitRules, ShadingRules, VectorLibrary};
use durer_scene::camera::{CameraRules, RayArithmetic, UpRule};
use durer_scene::dialect::{Arithmetic, Dialect, DialectRules, Falloff, Quirk};
use durer_scene::light::{DirectionalLight, Illuminate as _, Light, PointLight};
use durer_scene::math::Vec3;
use durer_scene::scene::MatrixRules;

/// Returns the rules for cameras and for the positions of pixels.
pub fn camera_rules(rules: &DialectRules) -> CameraRules {
    let up = match () {
        () if rules.has(Quirk::RawUp) => UpRule::Raw,
        () if rules.has(Quirk::SkewUp) => UpRule::Skew,
        () => UpRule::Perpendicular,
    };
    CameraRules {
        up,
        ray_arithmetic: match rules.arithmetic {
            Arithmetic::Own if rules.has(Quirk::ScreenPoint) => RayArithmetic::ScreenPoint,
            Arithmetic::Own => RayArithmetic::Own,
            Arithmetic::Of2012 => RayArithmetic::Of2012,
            Arithmetic::Of2016 => RayArithmetic::Of2016,
            Arithmetic::Of2020 => RayArithmetic::Of2020,
        },
        border_pixels: rules.has(Quirk::BorderPixels),
        stretch: rules.has(Quirk::Stretch),
    }
}

/// Returns true if scenes of the dialect consist of nodes, which changes the help texts.
pub(super) fn is_nodes(rules: &DialectRules) -> bool {
    rules.name == Dialect::F23.name()
}

/// Returns the rules for multiplying transform matrices.
pub fn matrix_rules(rules: &DialectRules) -> MatrixRules {
    MatrixRules {
        matrix_on_left: rules.has(Quirk::MatrixOnLeft),
        drop_shear: rules.has(Quirk::DroppedShear),
        ignore_tiny: rules.has(Quirk::TinyTransforms),
    }
}

/// Returns the rules of an official program for ray intersections, or `None` for Dürer's own
/// arithmetic.
pub fn hit_rules(rules: &DialectRules) -> Option<HitRules> {
    let vectors = match rules.arithmetic {
        Arithmetic::Own => return None,
        Arithmetic::Of2012 | Arithmetic::Of2016 => VectorLibrary::Vecmath,
        Arithmetic::Of2020 => VectorLibrary::Glm,
    };
    Some(HitRules {
        vectors,
        triangle_matrix: rules.arithmetic == Arithmetic::Of2012,
        tied_triangles: rules.has(Quirk::TiedTriangles),
        closed_planes: rules.has(Quirk::ClosedPlanes),
        closed_spheres: vectors == VectorLibrary::Glm,
        raw_normals: rules.has(Quirk::RawNormals),
        octree: rules.has(Quirk::OctreeHoles),
    })
}

/// Returns the rules for shading and for the Whitted integrator.
pub fn shading_rules(rules: &DialectRules) -> ShadingRules {
    let official = rules.is_bit_compatible();
    ShadingRules {
        epsilon: rules.epsilon.map(match rules.has(Quirk::MovedStarts) {
            true => Epsilon::OffsetOrigin,
            false => Epsilon::MinT,
        }),
        points_on_ray: official,
        one_medium: official,
        weight_by_length: official,
        shaded_sides: rules.has(Quirk::ShadedSides),
        black_backs: rules.has(Quirk::BlackBacks),
        spoiled_normals: rules.has(Quirk::SpoiledNormals),
        unit_light: rules.has(Quirk::UnitLight),
        raw_normals: rules.has(Quirk::RawNormals),
        raw_refraction: rules.has(Quirk::RawRefraction),
        long_mirrors: rules.has(Quirk::LongMirrors),
        exit_r0: rules.has(Quirk::ExitR0),
        shadow_fronts: rules.has(Quirk::ShadowFronts),
        air_at_eye: rules.has(Quirk::AirAtEye),
        mesh_textures: rules.has(Quirk::MeshTextures),
        moved_normals: rules.has(Quirk::MovedNormals),
        conic_rings: rules.has(Quirk::ConicRings),
        stale_texels: rules.has(Quirk::StaleTexels),
    }
}

/// Returns the rules for displaying AOVs as pictures. `lumens` is the luminous efficacy that the
/// scene uses.
pub fn display_rules(rules: &DialectRules, lumens: Option<Vec3>) -> DisplayRules {
    DisplayRules {
        normals: rules.normals_picture,
        depth: rules.depth_picture,
        whole_depths: rules.has(Quirk::WholeDepths),
        black_sky: rules.has(Quirk::BlackSky),
        stale_normals: rules.has(Quirk::StaleNormals),
        clamped_depths: rules.has(Quirk::ClampedDepths),
        lumens,
    }
}

impl Contents {
    /// Applies other rules to a compiled world. The axes of the camera, the lights, the materials
    /// and the objects do not change.
    pub fn set_rules(&mut self, rules: DialectRules) {
        self.camera_rules = camera_rules(&rules);
        self.hits = hit_rules(&rules);
        self.shading = shading_rules(&rules);
        self.display = display_rules(&rules, self.display.lumens);
        self.rules = rules;
    }
}

/// Returns a light whose colour includes its power and whose attenuation follows the dialect.
pub(super) fn light(light: &Light, rules: &DialectRules) -> Light {
    match light {
        Light::Point(emitter) if emitter.candela.or(emitter.lumens).is_none() => {
            PointLight { attenuation: attenuation(emitter, rules), falloff: None, ..emitter.clone() }.into()
        }
        // Normalizing a zero direction gives NaN, so the light from this source is NaN too.
        Light::Directional(sun) if sun.direction == Vec3::ZERO => {
            DirectionalLight { color: Vec3::NAN, ..sun.clone() }.into()
        }
        light => light.with_unit_color(),
    }
}

/// Returns the coefficients of a0 + a1 d + a2 d^2, the divisor for a point light at a distance d.
fn attenuation(light: &PointLight, rules: &DialectRules) -> Option<Vec3> {
    let divides_by_zero = rules.has(Quirk::MissingFalloff);
    match (rules.falloff, light.falloff) {
        (Falloff::None, _) => None,
        (Falloff::Polynomial, Some(f)) => Some(Vec3::new(1.0, 0.0, f)),
        (Falloff::Polynomial, None) => light.attenuation,
        (Falloff::InverseSquare(_), Some(f)) if f > 0.0 || divides_by_zero => Some(Vec3::new(0.0, 0.0, f)),
        (Falloff::InverseSquare(Some(default)), None) => Some(Vec3::new(0.0, 0.0, default)),
        (Falloff::InverseSquare(None), None) if divides_by_zero => Some(Vec3::ZERO),
        (Falloff::InverseSquare(_), _) => None,
    }
}

#[cfg(test)]
mod tests;
