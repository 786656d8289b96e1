//! BSDFs and emission at surface points, used for path tracing.

use super::{Geometry, Material, Object, Phong, Principled, SurfaceInteraction, WeightedMaterial, World};
use crate::world::HighlightModel;
use crate::world::emitters::LightId;
use crate::world::material::Emission;
use durer_scene::bsdf::layers;
use durer_scene::bsdf::lobe::blinn::Blinn;
use durer_scene::bsdf::lobe::diffuse::Diffuse;
use durer_scene::bsdf::lobe::glass::{Mirror, Refraction, StraightTransmission};
use durer_scene::bsdf::view::View;
use durer_scene::bsdf::{Bsdf, Frame, fresnel};
use durer_scene::material::Pattern;
use durer_scene::material::PrincipledMaterial;
use durer_scene::material::principled::{Backs, NormalBacks, NormalBending, Surroundings, Switch, Walls};
use durer_scene::math::{Color, Vec3, fp};
use durer_scene::medium::Medium;
use durer_scene::shape::SurfacePoint;
use durer_scene::spectrum::{Curve, Lanes, Spectrum};

/// BSDF at a surface point, with its shading frame and the direction from which it is seen, for
/// path tracing.
#[derive(Clone, Debug)]
pub struct Shading<'w> {
    /// Shading frame whose z axis is the shading normal on the visible side.
    pub frame: Frame,
    /// Geometric normal on the visible side.
    pub n_geo: Vec3,
    /// Unit direction to the ray's origin, in coordinates of the shading frame.
    pub wo: Vec3,
    /// Combined BSDF of all materials at the point.
    pub bsdf: Bsdf<'w>,
    /// Light that a mapped normal makes the surface hide from itself.
    pub shadowing: Option<NormalShadowing>,
}

/// Facets that stand for the bumps of a bump or normal map, and that hide light from each other.
///
/// Source: Estevez, Lecocq and Stein, *A Microfacet-Based Shadowing Function to Solve the Bump
/// Terminator Problem*, Ray Tracing Gems, 2019.
#[derive(Clone, Copy, Debug)]
pub struct NormalShadowing {
    /// Normal without the map.
    n: Vec3,
    /// Square of the facets' GGX alpha.
    alpha2: f32,
}

impl NormalShadowing {
    /// Creates the facets for a point whose normal `n` was mapped to `mapped`.
    fn new(n: Vec3, mapped: Vec3) -> Self {
        NormalShadowing { n, alpha2: (0.125 * squared_tangent(mapped.dot(n))).min(1.0) }
    }

    /// Returns the share of the light from a direction that is not hidden.
    fn share(&self, wi: Vec3) -> f32 {
        2.0 / (1.0 + (1.0 + self.alpha2 * squared_tangent(wi.dot(self.n))).sqrt())
    }
}

/// Returns the squared tangent of an angle that is given by its cosine.
fn squared_tangent(cosine: f32) -> f32 {
    let square = (cosine * cosine).clamp(1e-9, 1.0);
    (1.0 - square) / square
}

impl Shading<'_> {
    /// Returns BSDF · cosine for a direction in world space, and the density of the direction per
    /// steradian. The value is zero if `wi` is above the shading surface but below the geometric
    /// surface, or vice versa, since shading normals are approximate.
    pub fn eval(&self, wi: Vec3) -> (Spectrum, f32) {
        let local = self.frame.to_local(wi);
        let (value, pdf) = self.bsdf.eval(self.wo, local);
        let same_side = (local.z > 0.0) == (wi.dot(self.n_geo) > 0.0) || self.bsdf.is_fibre();
        (if same_side { value * self.lit_share(wi) } else { Spectrum::ZERO }, pdf)
    }

    /// Returns the share of the light from a direction in world space that the bumps of a map do
    /// not hide.
    pub fn lit_share(&self, wi: Vec3) -> f32 {
        self.shadowing.map_or(1.0, |shadowing| shadowing.share(wi))
    }
}

/// Bends a shading normal towards the geometric normal until the mirrored direction points
/// outwards. Interpolated and mapped normals can face away from the ray's origin; the geometric
/// normal cannot.
///
/// In the plane of the geometric normal and `n`, let the view direction be (x, z), and let a be the
/// angle between the geometric and the bent normal. The mirrored direction then has the height x
/// sin 2a + z cos 2a above the surface, which should be at least `least`.
fn bend_normal(n: Vec3, n_geo: Vec3, wo: Vec3) -> Vec3 {
    let (cosine, z) = (n.dot(n_geo), wo.dot(n_geo).max(1e-6));
    let least = (0.9 * z).min(0.01);
    if 2.0 * n.dot(wo) * cosine - z >= least && cosine > 0.0 {
        return n;
    }
    let across = n - cosine * n_geo;
    // A difference that is only due to rounding has no meaningful direction.
    if across.length_squared() < 1e-8 {
        return n_geo;
    }
    let across = across.normalize();
    let x = wo.dot(across);
    let square = x * x + z * z;
    let twice = ((z * least - x * (square - least * least).sqrt()) / square).clamp(-1.0, 1.0);
    (0.5 * (1.0 - twice)).sqrt() * across + (0.5 * (1.0 + twice)).sqrt() * n_geo
}

impl World {
    /// Returns the diffuse colour at a surface point, which comes from the noise if there is any,
    /// else from the texture, or else from the material. For `tinted` materials, it is the product
    /// of the material's colour, the texture and the vertex colours.
    #[inline]
    pub fn diffuse_color(&self, phong: &Phong, surface: &SurfacePoint) -> Color {
        let texture = phong.texture.and_then(|i| Some(self.textures()[i as usize].at(surface.uv.get()?)));
        if phong.tinted {
            let [r, g, b, _] = surface.color;
            return phong.diffuse * Color::new(r, g, b) * texture.unwrap_or(Color::ONE);
        }
        let noise = phong.noise.as_ref().map(|noise| noise.color(surface.position));
        noise.or(texture).unwrap_or(phong.diffuse)
    }

    /// Computes the BSDF at a hit for light that leaves towards the ray's origin. `eta` is the
    /// ratio of the index of refraction behind the surface to that in front of it.
    pub fn shading(&self, at: &SurfaceInteraction, eta: f32, lanes: &Lanes) -> Shading<'_> {
        let (dir, surface, inside) = (at.ray.dir(), &at.surface, at.inside());
        let parts = self.materials_at(at);
        // In a mixture, the first material with a normal or bump map determines the normal of all
        // materials.
        let mut mapped = parts.iter().filter_map(|part| part.phong.principled.as_ref());
        let mapped = mapped.find(|principled| principled.maps.normal.is_some() || principled.maps.bump.is_some());
        let n_shade = mapped.and_then(|principled| self.mapped_normal(&principled.maps, at)).unwrap_or(surface.n_shade);
        let mirrors = mapped.is_some_and(|principled| principled.definition.normal_backs == NormalBacks::Mirrored);
        let mirrored = |n: Vec3| 2.0 * n.dot(surface.n_shade) * surface.n_shade - n;
        let n_shade = if inside && mirrors { mirrored(n_shade) } else { n_shade };
        let [n, n_geo, unmapped] = [n_shade, surface.n_geo, surface.n_shade].map(|n| if inside { -n } else { n });
        let wo = -dir.normalize_or(-n_geo);
        let mut n = n.normalize_or(n_geo);
        let first = mapped.or_else(|| parts.first().and_then(|part| part.phong.principled.as_ref()));
        let bending = first.map_or(NormalBending::On, |principled| principled.definition.normal_bending);
        let keeps = bending != NormalBending::On;
        if bending == NormalBending::Turned && mapped.is_some() && n.dot(wo) * unmapped.dot(wo) <= 0.0 {
            n = 2.0 * n.dot(unmapped) * unmapped - n;
        }
        let is_turned_away = keeps && n.dot(wo) <= 0.0;
        let bent = if keeps && !is_turned_away { n } else { bend_normal(n, n_geo, wo) };
        let frame = self.frame(&parts, at, bent);
        let normal = if bent == n { Vec3::Z } else { frame.to_local(n) };
        let wo = frame.to_local(wo);
        let wo = Vec3::new(wo.x, wo.y, wo.z.max(1e-6));
        let view = View { lanes, wo, normal, inside, eta };
        let shadows = mapped.is_some_and(|principled| principled.definition.normal_shadowing == Switch::On);
        let shadowing = shadows.then(|| NormalShadowing::new(unmapped, n));
        let mut shading = Shading { frame, n_geo, wo, bsdf: Bsdf::default(), shadowing };
        if is_turned_away {
            return shading;
        }
        let bsdf = &mut shading.bsdf;
        for part in &parts {
            if let Some(fibre) = &part.phong.fibre {
                bsdf.push(fibre.lobe(lanes), Spectrum::splat(part.share), part.share);
                continue;
            }
            match &part.phong.principled {
                Some(principled) if inside && principled.definition.backs == Backs::Black => {}
                Some(principled) => {
                    let here = self.parameters_at(principled, at);
                    layers::push_lobes(bsdf, part.share, &here, &principled.tables, view);
                }
                None => phong_lobes(bsdf, part, self.diffuse_color(part.phong, surface), view),
            }
        }
        shading
    }

    /// Returns the shading frame around a normal. For anisotropic materials, the tangent is the
    /// direction of increasing u, rotated by the material's angle.
    fn frame(&self, parts: &[WeightedMaterial], at: &SurfaceInteraction, n: Vec3) -> Frame {
        // An anisotropy of 0 cannot be changed by a texture.
        if parts.iter().any(|part| part.phong.fibre.is_some()) {
            return Frame::along(n, self.tangent(at));
        }
        let principled = parts.iter().filter_map(|part| part.phong.principled.as_deref());
        let long = principled.filter(|principled| principled.parameters.specular_anisotropy > 0.0);
        let mut long = long.map(|principled| self.parameters_at(principled, at));
        let Some(long) = long.find(|here| here.specular_anisotropy > 0.0) else { return Frame::around(n) };
        let frame = Frame::along(n, self.tangent(at));
        let (sin, cos) = fp::sin_cos_degrees(360.0 * f64::from(long.specular_rotation));
        Frame::along(n, cos as f32 * frame.tangent + sin as f32 * frame.bitangent)
    }

    /// Returns true if a material emits light anywhere. Of a mixture, one material is enough.
    pub fn emits(&self, material: u32) -> bool {
        match self.materials().get(material as usize) {
            Some(Material::Phong(phong)) => phong.emission.is_some(),
            Some(Material::Mix(pattern, ..)) => pattern.materials().iter().any(|&part| self.emits(part)),
            None => false,
        }
    }

    /// Returns true if no light passes the surfaces of a material anywhere.
    pub(super) fn is_opaque(&self, material: u32) -> bool {
        let of_principled = |principled: &Principled| {
            let m = &principled.definition;
            let scatters = m.subsurface_weight > 0.0 || m.transmission_weight > 0.0;
            !scatters && m.backs != Backs::Hidden && !self.is_cutout(principled)
        };
        match &self.materials()[material as usize] {
            Material::Phong(phong) => {
                phong.transparent == Color::ZERO
                    && phong.fibre.is_none()
                    && phong.principled.as_deref().is_none_or(of_principled)
            }
            Material::Mix(pattern, ..) => pattern.materials().iter().all(|&part| self.is_opaque(part)),
        }
    }

    /// Returns true if shadow rays from smooth meshes of a material start on the curved surface
    /// that the normals imply.
    pub fn has_smooth_shadows(&self, material: u32) -> bool {
        match &self.materials()[material as usize] {
            Material::Phong(phong) => {
                phong.principled.as_ref().is_none_or(|it| it.definition.smooth_shadows == Switch::On)
            }
            Material::Mix(pattern, ..) => pattern.materials().iter().all(|&part| self.has_smooth_shadows(part)),
        }
    }

    /// Returns the emission of a material, multiplied by its opacity, if both are uniform so that
    /// light sampling can use them.
    pub(super) fn emission_of(&self, material: u32) -> Option<Emission> {
        let Material::Phong(phong) = self.materials().get(material as usize)? else { return None };
        let emission = phong.emission.as_ref().filter(|emission| !emission.textured)?;
        let Some(principled) = &phong.principled else { return Some(*emission) };
        let radiance = principled.definition.opacity * emission.radiance;
        let chosen = radiance.max_element() > 0.0
            && !self.has_holes(principled)
            && principled.definition.opacity_cutoff.is_none();
        chosen.then_some(Emission { radiance, ..*emission })
    }

    /// Returns the radiance that a surface emits towards the ray's origin.
    pub fn emission(&self, at: &SurfaceInteraction) -> Color {
        let inside = at.inside();
        let of_phong = |phong: &Phong| {
            let emission = phong.emission.as_ref().filter(|emission| emission.two_sided || !inside)?;
            let principled = phong.principled.as_ref().filter(|_| emission.textured);
            Some(emission.radiance * principled.map_or(Color::ONE, |principled| self.emission_at(principled, at)))
        };
        if !self.has_emission(at) {
            return Color::ZERO;
        }
        let parts = self.materials_at(at);
        parts.iter().filter_map(|part| of_phong(part.phong).map(|light| part.share * light)).sum()
    }

    /// Returns the measured emission spectrum of a light or emissive surface, if there is one.
    pub fn illuminant(&self, light: LightId) -> Option<&Curve> {
        match light {
            LightId::Light(number) => self.illuminants().get(number as usize)?.as_deref(),
            LightId::Surface(object, _) => self.material_illuminant(self.objects()[object as usize].material),
            LightId::Environment => None,
        }
    }

    /// Returns the measured emission spectrum of a material, if there is one.
    pub fn material_illuminant(&self, material: u32) -> Option<&Curve> {
        match &self.materials()[material as usize] {
            Material::Phong(phong) => phong.principled.as_ref()?.illuminant.as_deref(),
            Material::Mix(..) => None,
        }
    }

    /// Returns true if a material can emit light. The result is false for mixtures.
    pub fn may_emit(&self, material: u32) -> bool {
        matches!(&self.materials()[material as usize], Material::Phong(phong) if phong.emission.is_some())
    }

    /// Returns true if an emissive material emits on both sides, false if it emits only on the side
    /// to which the normal points. Returns `None` if light sampling cannot use the material.
    pub fn emits_on_both_sides(&self, material: u32) -> Option<bool> {
        self.emission_of(material).map(|emission| emission.two_sided)
    }

    /// Returns true if a surface may emit light. This is a fast test that excludes most materials.
    fn has_emission(&self, at: &SurfaceInteraction) -> bool {
        match &self.materials()[at.material as usize] {
            Material::Phong(phong) => phong.emission.is_some(),
            Material::Mix(..) => true,
        }
    }

    /// Returns the index of refraction behind a surface that light can enter. In a mixture, the
    /// result is the index of the material with the largest share. Returns `None` if light cannot
    /// enter.
    pub fn refraction_index(&self, at: &SurfaceInteraction, lanes: &Lanes) -> Option<f32> {
        let of = |phong: &Phong| {
            let ior =
                || phong.principled.as_ref().map_or(phong.ior, |principled| principled.definition.ior_at(lanes.hero()));
            phong.is_entered().then(ior)
        };
        if !self.may_enter(at) {
            return None;
        }
        let mut most = (0.0, None);
        for part in self.materials_at(at) {
            let ior = of(part.phong);
            most = if ior.is_some() && part.share > most.0 { (part.share, ior) } else { most };
        }
        most.1
    }

    /// Returns true if the glass that was hit uses its index of refraction relative to air, no
    /// matter which medium surrounds it.
    pub fn ignores_surroundings(&self, at: &SurfaceInteraction) -> bool {
        let of_phong = |phong: &Phong| {
            let principled = phong.principled.as_ref();
            principled.is_some_and(|principled| principled.definition.surroundings == Surroundings::Ignored)
        };
        self.materials_at(at).iter().any(|part| of_phong(part.phong))
    }

    /// Returns the opacity at a hit, from 0 to 1.
    pub fn opacity(&self, at: &SurfaceInteraction) -> f32 {
        let of_phong = |phong: &Phong| match (&phong.fibre, &phong.principled) {
            // The hair model computes all scattering inside the fibre at the point where light
            // enters.
            (Some(_), _) => f32::from(u8::from(!at.inside())),
            (None, Some(principled)) => self.opacity_at(principled, at),
            (None, None) => 1.0,
        };
        self.materials_at(at).iter().map(|part| part.share * of_phong(part.phong)).sum()
    }

    /// Returns true if a hit is on a hidden back, which is invisible to the camera and to lights
    /// without extent. `dir` is the viewing direction.
    pub fn is_hidden(&self, dir: Vec3, at: &SurfaceInteraction) -> bool {
        dir.dot(at.surface.n_geo) > 0.0 && self.materials_at(at).iter().all(|part| hides_backs(part.phong))
    }

    /// Returns true if the backs of some material's surfaces are hidden.
    pub(crate) fn finds_hidden_backs(&self) -> bool {
        self.materials().iter().any(|material| matches!(material, Material::Phong(phong) if hides_backs(phong)))
    }

    /// Returns true if the camera looks through the surface of a hit, as all its materials are
    /// `seenByCamera off`.
    pub fn is_unseen(&self, at: &SurfaceInteraction) -> bool {
        self.has_unseen() && self.materials_at(at).iter().all(|part| is_unseen(part.phong))
    }

    /// Returns true if some material is not seen by the camera.
    pub(crate) fn finds_unseen(&self) -> bool {
        self.materials().iter().any(|material| matches!(material, Material::Phong(phong) if is_unseen(phong)))
    }

    /// Returns true if some material or mesh has an opacity below 1.
    pub(crate) fn finds_cutouts(&self) -> bool {
        let of_phong = |phong: &Phong| {
            phong.fibre.is_some() || phong.principled.as_ref().is_some_and(|principled| self.is_cutout(principled))
        };
        let clear = |object: &Object| match &object.geometry {
            Geometry::Mesh(tree) => tree.mesh.colors().iter().any(|color| color[3] < 1.0),
            _ => false,
        };
        self.materials().iter().any(|material| matches!(material, Material::Phong(phong) if of_phong(phong)))
            || self.objects().iter().any(clear)
    }

    /// Returns the medium inside an object or, if the object is `None`, the medium of the air.
    pub fn medium(&self, object: Option<u32>) -> Option<&Medium> {
        let Some(object) = object else { return self.fog() };
        match &self.materials()[self.objects()[object as usize].material as usize] {
            Material::Phong(phong) => phong.principled.as_ref()?.medium.as_ref(),
            Material::Mix(..) => None,
        }
    }

    /// Returns true if light reaches a medium without refraction, so that points in the medium can
    /// be lit directly. This is the case for the air and for objects that are only the boundary of
    /// a medium.
    pub fn is_directly_lit(&self, object: Option<u32>) -> bool {
        object.is_none_or(|object| self.is_interface_material(self.objects()[object as usize].material))
    }

    /// Returns true if a surface has no effect when the indices of refraction on both sides are
    /// equal.
    pub fn is_interface(&self, at: &SurfaceInteraction) -> bool {
        self.has_interfaces() && self.is_interface_material(at.material)
    }

    /// Returns true if a material is only the boundary of a medium.
    fn is_interface_material(&self, material: u32) -> bool {
        matches!(&self.materials()[material as usize],
            Material::Phong(phong) if phong.principled.as_ref().is_some_and(|principled| principled.interface))
    }

    /// Returns true if some material is only the boundary of a medium.
    pub(crate) fn finds_interfaces(&self) -> bool {
        (0..self.materials().len() as u32).any(|material| self.is_interface_material(material))
    }

    /// Returns the indices of the objects that paths can enter. The list is empty if no interior
    /// absorbs or scatters light.
    pub(crate) fn finds_bodies(&self) -> Vec<u32> {
        let of = |number: u32| match &self.materials()[number as usize] {
            Material::Phong(phong) => Some(phong),
            Material::Mix(..) => None,
        };
        let is_filled = |phong: &Phong| phong.principled.as_ref().is_some_and(|principled| principled.medium.is_some());
        if !(0..self.materials().len() as u32).filter_map(of).any(is_filled) {
            return Vec::new();
        }
        let enters = |object: &Object| of(object.material).is_some_and(Phong::is_entered);
        (0..).zip(self.objects()).filter(|(_, object)| enters(object)).map(|(number, _)| number).collect()
    }

    /// Returns true if some material is a thin sheet that lets light pass straight through.
    pub(crate) fn finds_sheets(&self) -> bool {
        let is_sheet = |m: &PrincipledMaterial| m.walls == Walls::Thin && m.transmission_weight > 0.0;
        let of_phong =
            |phong: &Phong| phong.principled.as_ref().is_some_and(|principled| is_sheet(&principled.definition));
        self.materials().iter().any(|material| matches!(material, Material::Phong(phong) if of_phong(phong)))
    }

    /// Returns true if light may enter an object at a hit. This is a fast test that excludes most
    /// materials.
    #[inline]
    pub fn may_enter(&self, at: &SurfaceInteraction) -> bool {
        match &self.materials()[at.material as usize] {
            Material::Phong(phong) => {
                phong.transparent != Color::ZERO
                    || phong.principled.as_ref().is_some_and(|principled| principled.definition.has_subsurface())
            }
            Material::Mix(..) => true,
        }
    }

    /// Returns true if the surface that was hit causes dispersion.
    pub fn disperses(&self, at: &SurfaceInteraction) -> bool {
        let of = |phong: &Phong| phong.principled.as_ref().is_some_and(|principled| principled.definition.disperses());
        self.may_enter(at) && self.materials_at(at).iter().any(|part| of(part.phong))
    }
}

/// Adds the lobes of a Phong material in physical units: a matte lobe of `diffuseColor` / pi,
/// Blinn's or Phong's highlight, and delta lobes for mirror and glass. All lobes are scaled down if
/// they would reflect more light than arrives.
fn phong_lobes(bsdf: &mut Bsdf, part: &WeightedMaterial, color: Color, view: View) {
    let View { lanes, wo, normal, eta, .. } = view;
    let phong = part.phong;
    let (strength, exponent, model) = phong.highlight.unwrap_or((Color::ZERO, 1.0, HighlightModel::Blinn));
    let [color, strength, reflective, transparent] =
        [color, strength, phong.reflective, phong.transparent].map(|color| lanes.reflectance(color));
    let reflected = match phong.fresnel {
        true => fresnel::dielectric(wo.z, eta),
        false => 1.0,
    };
    // Without Fresnel reflection, both rays have their full weight.
    let passing = if phong.fresnel { 1.0 - reflected } else { 1.0 };
    let (mirror, through) = (reflected * reflective, passing * transparent);
    let all = color + Blinn::bound(exponent) * strength + mirror + through;
    let scale = part.share / all.max_element().max(1.0);
    let diffuse = Diffuse { normal, ..Diffuse::lambert(color) };
    bsdf.push(diffuse, Spectrum::splat(scale), scale * color.max_element());
    let highlight = Blinn { color: strength, exponent, phong: matches!(model, HighlightModel::Phong { .. }) };
    bsdf.push(highlight, Spectrum::splat(scale), scale * Blinn::bound(exponent) * strength.max_element());
    bsdf.push(Mirror, scale * mirror, scale * mirror.max_element());
    let through = scale * through;
    match eta == 1.0 {
        true => bsdf.push(StraightTransmission, through, through.max_element()),
        false => bsdf.push(Refraction { eta }, through, through.max_element()),
    }
}

/// Returns true if the backs of a material's surfaces are invisible to the camera.
fn hides_backs(phong: &Phong) -> bool {
    phong.principled.as_ref().is_some_and(|principled| principled.definition.backs == Backs::Hidden)
}

/// Returns true if the camera looks through the surfaces of a material.
fn is_unseen(phong: &Phong) -> bool {
    phong.principled.as_ref().is_some_and(|principled| principled.definition.seen_by_camera == Switch::Off)
}

#[cfg(test)]
mod tests;
