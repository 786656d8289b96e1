//! Principled material for physically based rendering: layers with the names and meanings of
//! OpenPBR Surface 1.1.
//!
//! Source: *OpenPBR Surface specification*, version 1.1, Academy Software Foundation, 2024.

use crate::describe::{Constraint, FileName, described, described_words};
use crate::dialect::set;
use crate::math::Vec3;

described_words! {
    /// Interpretation of a surface as a thin sheet or as the boundary of a solid body.
    Walls { Solid = "solid", Thin = "thin" }
}

described_words! {
    /// Treatment of the back side of a surface by a principled material.
    Backs { Shown = "shown", Hidden = "hidden", Black = "black" }
}

described_words! {
    /// Switch for an option of a principled material.
    Switch { On = "on", Off = "off" }
}

described_words! {
    /// Model that combines the layers of a principled material.
    Layering { OpenPbr = "openPbr", Disney = "disney" }
}

described_words! {
    /// Distribution of the microfacets of a rough surface, and how they hide each other. `ggx` is
    /// GGX with masking that is correlated by height. The others multiply the masking of both
    /// directions, as Mitsuba does.
    Facets { Ggx = "ggx", GgxSeparable = "ggxSeparable", Beckmann = "beckmann" }
}

described_words! {
    /// Treatment of interpolated and mapped normals that face away from the viewer.
    NormalBending { On = "on", Off = "off", Turned = "turned" }
}

described_words! {
    /// Direction along which the green channel of a normal map tilts the normal.
    NormalGreen { V = "v", Cross = "cross" }
}

described_words! {
    /// Mapped normals on the back of a surface.
    NormalBacks { Turned = "turned", Mirrored = "mirrored" }
}

described_words! {
    /// Gradient of a bump map.
    BumpGradient { Smooth = "smooth", Exact = "exact" }
}

described_words! {
    /// Treatment of the medium around glass when light is refracted at it.
    Surroundings { Nested = "nested", Ignored = "ignored" }
}

described! {
    /// Layered material with the parameters of OpenPBR Surface: fuzz over a coat over metal, glass
    /// or a diffuse base.
    PrincipledMaterial ["PrincipledMaterial" in set::DURER] {
        /// `openPbr`: each layer gets the light that the layers above let through. `disney`: the
        /// sum of the lobes of Disney's material of 2015, as in Mitsuba's `principled` and, with
        /// thin walls, `principledthin`; it does not conserve energy. Its coat has an index of 1.5
        /// and a quarter of `coatWeight`; its sheen is the fuzz. It ignores the roughness of the
        /// fuzz, films, subsurface scattering in solids, and all colours but `baseColor` and
        /// `fuzzColor`.
        layering: Layering = Layering::OpenPbr, optional, Constraint::Any, ["layering" in set::DURER];
        /// Strength of the base, from 0 to 1; scales the colours of the diffuse base and the metal.
        base_weight: f32 = 1.0, optional, Constraint::UnitInterval, ["baseWeight" in set::DURER];
        /// Texture that multiplies `baseWeight`. Textures of scalars use the red channel, or the
        /// channel after a colon, for example `file.png:g`.
        base_weight_texture: Option<FileName> = None, optional, Constraint::Any, ["baseWeightTexture" in set::DURER];
        /// Albedo of the diffuse base, or reflectance of the metal at normal incidence, from 0 to
        /// 1.
        base_color: Vec3 = Vec3::splat(0.8), optional, Constraint::Any, ["baseColor" in set::DURER];
        /// File with a measured reflectance that replaces `baseColor`: rows of a wavelength in
        /// nanometres and a reflectance from 0 to 1. `file.csv:name` selects one of several
        /// columns. `--color spectral` uses the spectrum; otherwise its RGB colour in daylight is
        /// used.
        base_spectrum: Option<FileName> = None, optional, Constraint::Any, ["baseSpectrum" in set::DURER];
        /// Texture that multiplies `baseColor`, read as sRGB; its alpha multiplies `opacity`.
        base_color_texture: Option<FileName> = None, optional, Constraint::Any, ["baseColorTexture" in set::DURER];
        /// Roughness of the diffuse base, from 0 (Lambert) to 1.
        base_diffuse_roughness: f32 = 0.0, optional, Constraint::UnitInterval, ["baseDiffuseRoughness" in set::DURER];
        /// Texture that multiplies `baseDiffuseRoughness`.
        base_diffuse_roughness_texture: Option<FileName> = None, optional, Constraint::Any,
            ["baseDiffuseRoughnessTexture" in set::DURER];
        /// Metalness, from 0 (glass or diffuse) to 1 (metal).
        base_metalness: f32 = 0.0, optional, Constraint::UnitInterval, ["baseMetalness" in set::DURER];
        /// Texture that multiplies `baseMetalness`.
        base_metalness_texture: Option<FileName> = None, optional, Constraint::Any, ["baseMetalnessTexture" in set::DURER];
        /// With `layering disney`: share of the diffuse base that is replaced by an approximation
        /// of subsurface scattering, from 0 to 1.
        base_flatness: f32 = 0.0, optional, Constraint::UnitInterval, ["baseFlatness" in set::DURER];
        /// Factor on the reflectance at normal incidence, usually from 0 to 1.
        specular_weight: f32 = 1.0, optional, Constraint::NonNegative, ["specularWeight" in set::DURER];
        /// Texture that multiplies the reflection equally at all angles.
        specular_weight_texture: Option<FileName> = None, optional, Constraint::Any, ["specularWeightTexture" in set::DURER];
        /// Tint of the reflection, or for metal the colour near grazing angles.
        specular_color: Vec3 = Vec3::ONE, optional, Constraint::Any, ["specularColor" in set::DURER];
        /// Texture that multiplies `specularColor`, read as sRGB.
        specular_color_texture: Option<FileName> = None, optional, Constraint::Any, ["specularColorTexture" in set::DURER];
        /// With `layering disney`: share of the reflection of a dielectric that has the hue of
        /// `baseColor`, from 0 to 1.
        specular_tint: f32 = 0.0, optional, Constraint::UnitInterval, ["specularTint" in set::DURER];
        /// Roughness of the surface, from 0 (a mirror) to 1; its square is GGX's alpha.
        specular_roughness: f32 = 0.3, optional, Constraint::UnitInterval, ["specularRoughness" in set::DURER];
        /// Texture that multiplies `specularRoughness`.
        specular_roughness_texture: Option<FileName> = None, optional, Constraint::Any,
            ["specularRoughnessTexture" in set::DURER];
        /// Texture whose green channel multiplies `specularRoughness` and whose blue channel
        /// multiplies `baseMetalness`.
        metallic_roughness_texture: Option<FileName> = None, optional, Constraint::Any,
            ["metallicRoughnessTexture" in set::DURER];
        /// Distribution of the microfacets: `ggx`, as in pbrt and OpenPBR; `ggxSeparable`, where
        /// the masking of both directions is multiplied, as in Mitsuba; `beckmann`, Mitsuba's
        /// default, also with multiplied masking. `energyCompensation` adds what `ggx` loses.
        specular_facets: Facets = Facets::Ggx, optional, Constraint::Any, ["specularFacets" in set::DURER];
        /// Elongation of the highlight, from 0 (round) to 1.
        specular_anisotropy: f32 = 0.0, optional, Constraint::UnitInterval, ["specularAnisotropy" in set::DURER];
        /// Texture that multiplies `specularAnisotropy`.
        specular_anisotropy_texture: Option<FileName> = None, optional, Constraint::Any,
            ["specularAnisotropyTexture" in set::DURER];
        /// Rotation of the highlight about the normal, from the direction of increasing u; 1 is a
        /// full turn.
        specular_rotation: f32 = 0.0, optional, Constraint::Any, ["specularRotation" in set::DURER];
        /// Texture added to `specularRotation`; 1 is a full turn. `file.png:angle` reads a
        /// direction from the red and green channels.
        specular_rotation_texture: Option<FileName> = None, optional, Constraint::Any,
            ["specularRotationTexture" in set::DURER];
        /// Index of refraction of the inside of the object.
        specular_ior: f32 = 1.5, optional, Constraint::Positive, ["specularIor" in set::DURER];
        /// Real part of the complex index of refraction of the metal, for red, green and blue. With
        /// it, the metal reflects as Fresnel's equations say, times `specularColor`.
        metal_ior: Option<Vec3> = None, optional, Constraint::Any, ["metalIor" in set::DURER];
        /// Imaginary part of the complex index of refraction of the metal; needs `metalIor`.
        metal_extinction: Vec3 = Vec3::ZERO, optional, Constraint::Any, ["metalExtinction" in set::DURER];
        /// `nested`: refraction at glass inside other glass or water uses both indices. `ignored`:
        /// `specularIor` is the ratio of the index inside to the index outside, regardless of the
        /// surrounding medium, as in pbrt and Mitsuba.
        surroundings: Surroundings = Surroundings::Nested, optional, Constraint::Any, ["surroundings" in set::DURER];
        /// `on`: adds the light that is scattered several times between the facets of rough metal,
        /// glass or coats, so that no energy is lost. `off`: single scattering only, as in pbrt and
        /// Mitsuba, which makes rough surfaces darker.
        energy_compensation: Switch = Switch::On, optional, Constraint::Any,
            ["energyCompensation" in set::DURER];
        /// Blend between a diffuse base at 0 and glass at 1.
        transmission_weight: f32 = 0.0, optional, Constraint::UnitInterval, ["transmissionWeight" in set::DURER];
        /// Texture that multiplies `transmissionWeight`.
        transmission_weight_texture: Option<FileName> = None, optional, Constraint::Any,
            ["transmissionWeightTexture" in set::DURER];
        /// Colour of white light after travelling `transmissionDepth` through the material, or
        /// after passing the surface if that is 0. Thin walls are treated as `transmissionDepth`
        /// thick, so they absorb more at grazing angles.
        transmission_color: Vec3 = Vec3::ONE, optional, Constraint::Any, ["transmissionColor" in set::DURER];
        /// Texture that multiplies `transmissionColor` if `transmissionDepth` is 0, read as sRGB.
        transmission_color_texture: Option<FileName> = None, optional, Constraint::Any,
            ["transmissionColorTexture" in set::DURER];
        /// Distance in world units after which white light has `transmissionColor`. At 0, the
        /// surface tints the light instead; with thin walls, any other value makes the wall absorb
        /// light, including internal reflections.
        transmission_depth: f32 = 0.0, optional, Constraint::NonNegative, ["transmissionDepth" in set::DURER];
        /// Colour of the light scattered inside the material over the distance `transmissionDepth`;
        /// 0 0 0 for a clear material.
        transmission_scatter: Vec3 = Vec3::ZERO, optional, Constraint::Any, ["transmissionScatter" in set::DURER];
        /// Mean cosine of the scattering angle inside the material: -1 is backward, 0 isotropic, 1
        /// forward.
        transmission_scatter_anisotropy: f32 = 0.0, optional, Constraint::Between(-1.0, 1.0),
            ["transmissionScatterAnisotropy" in set::DURER];
        /// Density file (Mitsuba's `.vol`) that multiplies the extinction inside the material; its
        /// box is in world space.
        transmission_density: Option<FileName> = None, optional, Constraint::Any, ["transmissionDensity" in set::DURER];
        /// Box in world space for `transmissionDensity` that replaces the box in the file: a
        /// corner, and the edges from it along the grid's x, y and z axes.
        transmission_density_box: Vec<[f32; 3]> = Vec::new(), optional, Constraint::Rows(0, 4),
            ["transmissionDensityBox" in set::DURER];
        /// Strength of the dispersion set by `transmissionDispersionAbbeNumber`, from 0 (none) to
        /// 1; only visible with `--color spectral`.
        transmission_dispersion_scale: f32 = 0.0, optional, Constraint::UnitInterval, ["transmissionDispersionScale" in set::DURER];
        /// Abbe number of the glass, lower for stronger dispersion: 64 for crown glass, 30 for
        /// flint.
        transmission_dispersion_abbe_number: f32 = 20.0, optional, Constraint::Positive,
            ["transmissionDispersionAbbeNumber" in set::DURER];
        /// Blend between a diffuse base at 0 and subsurface scattering at 1, where light enters the
        /// object, scatters and leaves elsewhere, as in marble, milk and skin.
        subsurface_weight: f32 = 0.0, optional, Constraint::UnitInterval, ["subsurfaceWeight" in set::DURER];
        /// Texture that multiplies `subsurfaceWeight`.
        subsurface_weight_texture: Option<FileName> = None, optional, Constraint::Any,
            ["subsurfaceWeightTexture" in set::DURER];
        /// Perceived colour of an object with subsurface scattering.
        subsurface_color: Vec3 = Vec3::splat(0.8), optional, Constraint::Any, ["subsurfaceColor" in set::DURER];
        /// Texture that multiplies `subsurfaceColor` where light enters, read as sRGB.
        subsurface_color_texture: Option<FileName> = None, optional, Constraint::Any, ["subsurfaceColorTexture" in set::DURER];
        /// Mean free path inside the object, in world units.
        subsurface_radius: f32 = 1.0, optional, Constraint::Positive, ["subsurfaceRadius" in set::DURER];
        /// Factors on `subsurfaceRadius` for red, green and blue.
        subsurface_radius_scale: Vec3 = Vec3::new(1.0, 0.5, 0.25), optional, Constraint::Any,
            ["subsurfaceRadiusScale" in set::DURER];
        /// Mean cosine of the subsurface scattering angle: -1 is backward, 0 isotropic, 1 forward.
        subsurface_scatter_anisotropy: f32 = 0.0, optional, Constraint::Between(-1.0, 1.0),
            ["subsurfaceScatterAnisotropy" in set::DURER];
        /// With `walls thin`: colour of the light that passes through the sheet, from 0 to 1.
        /// `subsurfaceColor` is then the colour of the light that the sheet reflects, and
        /// `subsurfaceScatterAnisotropy` has no effect.
        subsurface_through: Option<Vec3> = None, optional, Constraint::Any, ["subsurfaceThrough" in set::DURER];
        /// Strength of the clear coat, from 0 to 1.
        coat_weight: f32 = 0.0, optional, Constraint::UnitInterval, ["coatWeight" in set::DURER];
        /// Texture that multiplies `coatWeight`.
        coat_weight_texture: Option<FileName> = None, optional, Constraint::Any, ["coatWeightTexture" in set::DURER];
        /// Transmittance of the coat for light that passes down and up again at normal incidence.
        coat_color: Vec3 = Vec3::ONE, optional, Constraint::Any, ["coatColor" in set::DURER];
        /// Texture that multiplies `coatColor`, read as sRGB.
        coat_color_texture: Option<FileName> = None, optional, Constraint::Any, ["coatColorTexture" in set::DURER];
        /// Roughness of the coat, from 0 to 1.
        coat_roughness: f32 = 0.0, optional, Constraint::UnitInterval, ["coatRoughness" in set::DURER];
        /// Texture that multiplies `coatRoughness`.
        coat_roughness_texture: Option<FileName> = None, optional, Constraint::Any, ["coatRoughnessTexture" in set::DURER];
        /// Index of refraction of the coat.
        coat_ior: f32 = 1.6, optional, Constraint::Positive, ["coatIor" in set::DURER];
        /// Darkening of the base by internal reflection in the coat, from 0 (none) to 1 (physically
        /// correct).
        coat_darkening: f32 = 1.0, optional, Constraint::UnitInterval, ["coatDarkening" in set::DURER];
        /// Texture that multiplies `coatDarkening`.
        coat_darkening_texture: Option<FileName> = None, optional, Constraint::Any, ["coatDarkeningTexture" in set::DURER];
        /// Strength of the fuzz layer on top, for example velvet or dust, from 0 to 1.
        fuzz_weight: f32 = 0.0, optional, Constraint::UnitInterval, ["fuzzWeight" in set::DURER];
        /// Texture that multiplies `fuzzWeight`.
        fuzz_weight_texture: Option<FileName> = None, optional, Constraint::Any, ["fuzzWeightTexture" in set::DURER];
        /// Colour of the fuzz.
        fuzz_color: Vec3 = Vec3::ONE, optional, Constraint::Any, ["fuzzColor" in set::DURER];
        /// Texture that multiplies `fuzzColor`, read as sRGB.
        fuzz_color_texture: Option<FileName> = None, optional, Constraint::Any, ["fuzzColorTexture" in set::DURER];
        /// Roughness of the fuzz, from 0 to 1.
        fuzz_roughness: f32 = 0.5, optional, Constraint::UnitInterval, ["fuzzRoughness" in set::DURER];
        /// Texture that multiplies `fuzzRoughness`.
        fuzz_roughness_texture: Option<FileName> = None, optional, Constraint::Any, ["fuzzRoughnessTexture" in set::DURER];
        /// Fraction of the surface below the coat that is covered by a thin film, from 0 to 1, for
        /// example soap, oil, tempered steel or mother-of-pearl.
        thin_film_weight: f32 = 0.0, optional, Constraint::UnitInterval, ["thinFilmWeight" in set::DURER];
        /// Texture that multiplies `thinFilmWeight`.
        thin_film_weight_texture: Option<FileName> = None, optional, Constraint::Any, ["thinFilmWeightTexture" in set::DURER];
        /// Thickness of the film in micrometres.
        thin_film_thickness: f32 = 0.5, optional, Constraint::NonNegative, ["thinFilmThickness" in set::DURER];
        /// Texture that multiplies `thinFilmThickness`.
        thin_film_thickness_texture: Option<FileName> = None, optional, Constraint::Any,
            ["thinFilmThicknessTexture" in set::DURER];
        /// Index of refraction of the film.
        thin_film_ior: f32 = 1.4, optional, Constraint::Positive, ["thinFilmIor" in set::DURER];
        /// Luminance of the emission in cd/m^2; a pixel value of 1 stands for 1 cd/m^2.
        emission_luminance: f32 = 0.0, optional, Constraint::NonNegative, ["emissionLuminance" in set::DURER];
        /// Colour of the emission, which multiplies `emissionLuminance`.
        emission_color: Vec3 = Vec3::ONE, optional, Constraint::Any, ["emissionColor" in set::DURER];
        /// Spectrum of the emission, multiplied by `emissionColor`: an illuminant (A, D50, D55,
        /// D65, D75, E, F2, F7, F11), a black body (`2700K`), or a file as for `baseSpectrum`, in
        /// any unit. `emissionLuminance` still sets the brightness.
        emission_spectrum: Option<FileName> = None, optional, Constraint::Any, ["emissionSpectrum" in set::DURER];
        /// Texture that multiplies `emissionColor`, read as sRGB.
        emission_texture: Option<FileName> = None, optional, Constraint::Any, ["emissionTexture" in set::DURER];
        /// `on`: the vertex colours of a mesh multiply `emissionColor`.
        emission_vertex_colors: Switch = Switch::Off, optional, Constraint::Any, ["emissionVertexColors" in set::DURER];
        /// Tangent-space normal map, as in glTF: red and green point along u and v, and blue points
        /// outwards.
        normal_texture: Option<FileName> = None, optional, Constraint::Any, ["normalTexture" in set::DURER];
        /// Bump map: a height texture that tilts the normals as if bright areas were raised.
        bump_texture: Option<FileName> = None, optional, Constraint::Any, ["bumpTexture" in set::DURER];
        /// Height difference between white and black in the bump map, in world units; negative if
        /// white is deeper.
        bump_height: f32 = 0.01, optional, Constraint::Any, ["bumpHeight" in set::DURER];
        /// Gradient of the bump map. `smooth`: differences over one texel. `exact`: the derivative
        /// of the interpolated heights, which jumps at the centres of texels, as in Mitsuba; a map
        /// with `nearest` texels is then flat.
        bump_gradient: BumpGradient = BumpGradient::Smooth, optional, Constraint::Any, ["bumpGradient" in set::DURER];
        /// Direction of green in the normal map. `v`: along increasing v. `cross`: along the cross
        /// product of the normal and the direction of increasing u, which transforms of the texture
        /// do not turn, as in Mitsuba.
        normal_green: NormalGreen = NormalGreen::V, optional, Constraint::Any, ["normalGreen" in set::DURER];
        /// `on`: bends interpolated and mapped normals that face away from the viewer, so that
        /// mirrored rays leave the surface. `off`: leaves such points black, as in Mitsuba.
        /// `turned`: like `off`, but first turns mapped normals that face away half around the
        /// interpolated normal, as Mitsuba's `flip_invalid_normals` does.
        normal_bending: NormalBending = NormalBending::On, optional, Constraint::Any, ["normalBending" in set::DURER];
        /// `turned`: the back of the surface has the bumps of the front, seen from behind.
        /// `mirrored`: it has the mapped normals of the front, mirrored at the surface, as with
        /// Mitsuba's `twosided` around a map.
        normal_backs: NormalBacks = NormalBacks::Turned, optional, Constraint::Any, ["normalBacks" in set::DURER];
        /// `on`: points with mapped normals reflect less light from grazing directions, as facets
        /// hide each other, so that their shading fades before the light sets. Mitsuba does so.
        normal_shadowing: Switch = Switch::Off, optional, Constraint::Any, ["normalShadowing" in set::DURER];
        /// `on`: shadow rays from a smooth mesh start on the curved surface that its normals imply,
        /// so that triangles do not show where the light becomes grazing. `off`: they start on the
        /// triangle, as in Mitsuba and pbrt.
        smooth_shadows: Switch = Switch::On, optional, Constraint::Any, ["smoothShadows" in set::DURER];
        /// Fraction of the surface that is present, from 0 to 1; the remaining light passes through
        /// unchanged.
        opacity: f32 = 1.0, optional, Constraint::UnitInterval, ["opacity" in set::DURER];
        /// Texture that multiplies `opacity` by its alpha channel if there is one, otherwise by its
        /// red channel.
        opacity_texture: Option<FileName> = None, optional, Constraint::Any, ["opacityTexture" in set::DURER];
        /// Threshold for the combined opacity (`opacity`, textures and vertex alpha): the surface
        /// is fully present at or above it and absent below. Without it, partial opacity is kept.
        opacity_cutoff: Option<f32> = None, optional, Constraint::NonNegative, ["opacityCutoff" in set::DURER];
        /// `thin`: a sheet without an inside, which light crosses in a straight line. `solid`: the
        /// surface of a solid object.
        walls: Walls = Walls::Solid, optional, Constraint::Any, ["walls" in set::DURER];
        /// `shown`: both sides are visible. `hidden`: faces that are turned away from the camera,
        /// or from a light without extent, are transparent to it. `black`: faces turned away
        /// scatter no light.
        backs: Backs = Backs::Shown, optional, Constraint::Any, ["backs" in set::DURER];
        /// `off`: the camera looks through the surface, which still lights the scene, casts shadows
        /// and is seen in mirrors, like the lights of Blender; `path` only.
        seen_by_camera: Switch = Switch::On, optional, Constraint::Any, ["seenByCamera" in set::DURER];
    }
}

impl PrincipledMaterial {
    /// True if light enters the body, scatters there and leaves again.
    pub fn has_subsurface(&self) -> bool {
        self.subsurface_weight > 0.0 && self.walls == Walls::Solid
    }

    /// True if the material disperses light.
    pub fn disperses(&self) -> bool {
        self.transmission_weight > 0.0 && self.transmission_dispersion_scale > 0.0 && self.walls == Walls::Solid
    }

    /// Index of refraction at a wavelength in nanometres, or `specular_ior` for `None`.
    ///
    /// Source: Cauchy's formula, fitted to the indices at the spectral lines C, d and F, which
    /// define the Abbe number; OpenPBR.
    pub fn ior_at(&self, nm: Option<f32>) -> f32 {
        const LINES: [f32; 3] = [656.3, 587.6, 486.1];
        let Some(nm) = nm.filter(|_| self.disperses()) else { return self.specular_ior };
        let [c, d, f] = LINES.map(|line| 1.0 / (line * line));
        let abbe = self.transmission_dispersion_abbe_number / self.transmission_dispersion_scale;
        let slope = (self.specular_ior - 1.0) / (abbe * (f - c));
        self.specular_ior + slope * (1.0 / (nm * nm) - d)
    }
}
