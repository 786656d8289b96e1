//! The material of physically based pictures: layers with the names and meanings of OpenPBR Surface
//! 1.1.
//!
//! Source: *OpenPBR Surface specification*, version 1.1, Academy Software Foundation, 2024.

use crate::describe::{FileName, Rule, described, described_words};
use crate::dialect::set;
use crate::math::Vec3;

described_words! {
    /// Whether a surface is a thin sheet or bounds a body.
    Walls { Solid = "solid", Thin = "thin" }
}

described_words! {
    /// What the back of a surface does.
    Backs { Shown = "shown", Hidden = "hidden", Black = "black" }
}

described_words! {
    /// Whether something counts.
    Switch { On = "on", Off = "off" }
}

described_words! {
    /// Whether glass knows what it lies in.
    Surroundings { Nested = "nested", Ignored = "ignored" }
}

described! {
    /// A material of layers: fuzz on a coat on metal, glass or matte. Names and meanings are those
    /// of OpenPBR Surface.
    PrincipledMaterial ["PrincipledMaterial" in set::DURER] {
        /// Strength of the base, from 0 to 1: of the matte colour and of the metal's.
        base_weight: f32 = 1.0, optional, Rule::Share, ["baseWeight" in set::DURER];
        /// A picture that multiplies `baseWeight`. Of a picture that multiplies a number, red
        /// counts, or the channel after a colon: `file.png:g`.
        base_weight_texture: Option<FileName> = None, optional, Rule::Any, ["baseWeightTexture" in set::DURER];
        /// Share of light that the matte base scatters, and what a metal reflects at right angles;
        /// from 0 to 1.
        base_color: Vec3 = Vec3::splat(0.8), optional, Rule::Any, ["baseColor" in set::DURER];
        /// A file with a measured reflectance, which stands in place of `baseColor`: rows of
        /// nanometres and shares from 0 to 1; with several columns `file.csv:name` is one of them.
        /// `--color spectral` has it by wavelength, else its colour in daylight counts.
        base_spectrum: Option<FileName> = None, optional, Rule::Any, ["baseSpectrum" in set::DURER];
        /// A picture that multiplies `baseColor`; its values are read as sRGB, and its alpha
        /// multiplies `opacity`.
        base_color_texture: Option<FileName> = None, optional, Rule::Any, ["baseColorTexture" in set::DURER];
        /// How rough the matte base is, from 0 (Lambert) to 1.
        base_diffuse_roughness: f32 = 0.0, optional, Rule::Share, ["baseDiffuseRoughness" in set::DURER];
        /// A picture that multiplies `baseDiffuseRoughness`.
        base_diffuse_roughness_texture: Option<FileName> = None, optional, Rule::Any,
            ["baseDiffuseRoughnessTexture" in set::DURER];
        /// From 0 (glass or matte) to 1 (metal).
        base_metalness: f32 = 0.0, optional, Rule::Share, ["baseMetalness" in set::DURER];
        /// A picture that multiplies `baseMetalness`.
        base_metalness_texture: Option<FileName> = None, optional, Rule::Any, ["baseMetalnessTexture" in set::DURER];
        /// Strength of the reflection, from 0 to 1 or more: it scales what reflects at right
        /// angles.
        specular_weight: f32 = 1.0, optional, Rule::NonNegative, ["specularWeight" in set::DURER];
        /// A picture that multiplies the whole reflection, at all angles alike.
        specular_weight_texture: Option<FileName> = None, optional, Rule::Any, ["specularWeightTexture" in set::DURER];
        /// Tint of the reflection; on metal the colour near grazing angles.
        specular_color: Vec3 = Vec3::ONE, optional, Rule::Any, ["specularColor" in set::DURER];
        /// A picture that multiplies `specularColor`; its values are read as sRGB.
        specular_color_texture: Option<FileName> = None, optional, Rule::Any, ["specularColorTexture" in set::DURER];
        /// How rough the surface is, from 0 (a mirror) to 1; its square is GGX's alpha.
        specular_roughness: f32 = 0.3, optional, Rule::Share, ["specularRoughness" in set::DURER];
        /// A picture that multiplies `specularRoughness`.
        specular_roughness_texture: Option<FileName> = None, optional, Rule::Any,
            ["specularRoughnessTexture" in set::DURER];
        /// A picture whose green multiplies `specularRoughness` and whose blue multiplies
        /// `baseMetalness`.
        metallic_roughness_texture: Option<FileName> = None, optional, Rule::Any,
            ["metallicRoughnessTexture" in set::DURER];
        /// How much longer than wide the highlight is, from 0 (round) to 1.
        specular_anisotropy: f32 = 0.0, optional, Rule::Share, ["specularAnisotropy" in set::DURER];
        /// A picture that multiplies `specularAnisotropy`.
        specular_anisotropy_texture: Option<FileName> = None, optional, Rule::Any,
            ["specularAnisotropyTexture" in set::DURER];
        /// Turns the highlight about the normal, in whole turns, from the direction in which u
        /// grows.
        specular_rotation: f32 = 0.0, optional, Rule::Any, ["specularRotation" in set::DURER];
        /// A picture that is added to `specularRotation`, in whole turns; `file.png:angle` has it
        /// as a direction in red and green.
        specular_rotation_texture: Option<FileName> = None, optional, Rule::Any,
            ["specularRotationTexture" in set::DURER];
        /// Index of refraction inside.
        specular_ior: f32 = 1.5, optional, Rule::Positive, ["specularIor" in set::DURER];
        /// `nested`: glass in other glass or in water refracts by the indices of both; `ignored`:
        /// `specularIor` is the index inside over the index outside, whatever the surface lies in, as
        /// pbrt and Mitsuba have it.
        surroundings: Surroundings = Surroundings::Nested, optional, Rule::Any, ["surroundings" in set::DURER];
        /// `on`: light that a rough metal, glass or coat reflects between its facets is given back, so
        /// that none is lost; `off`: a ray is reflected or refracted once, as pbrt and Mitsuba have it,
        /// and the rougher the surface, the darker it is.
        energy_compensation: Switch = Switch::On, optional, Rule::Any,
            ["energyCompensation" in set::DURER];
        /// From 0 (matte) to 1 (glass).
        transmission_weight: f32 = 0.0, optional, Rule::Share, ["transmissionWeight" in set::DURER];
        /// A picture that multiplies `transmissionWeight`.
        transmission_weight_texture: Option<FileName> = None, optional, Rule::Any,
            ["transmissionWeightTexture" in set::DURER];
        /// Colour of light that went `transmissionDepth` deep; where that is 0, of all that passes
        /// the surface. Thin walls are that deep: at an angle more is lost.
        transmission_color: Vec3 = Vec3::ONE, optional, Rule::Any, ["transmissionColor" in set::DURER];
        /// A picture that multiplies `transmissionColor` where `transmissionDepth` is 0; its values
        /// are read as sRGB.
        transmission_color_texture: Option<FileName> = None, optional, Rule::Any,
            ["transmissionColorTexture" in set::DURER];
        /// How deep light goes until it has `transmissionColor`, in units of the world; 0: the
        /// surface tints it. Of thin walls any depth makes the inside absorb, what is reflected
        /// there too.
        transmission_depth: f32 = 0.0, optional, Rule::NonNegative, ["transmissionDepth" in set::DURER];
        /// Colour of the light that a body scatters inside, per `transmissionDepth`; 0 0 0: it is
        /// clear.
        transmission_scatter: Vec3 = Vec3::ZERO, optional, Rule::Any, ["transmissionScatter" in set::DURER];
        /// Where that light goes: from -1 (back) over 0 (evenly) to 1 (onwards).
        transmission_scatter_anisotropy: f32 = 0.0, optional, Rule::Between(-1.0, 1.0),
            ["transmissionScatterAnisotropy" in set::DURER];
        /// A file of densities (Mitsuba's `.vol`) that multiply what light loses in the body; its box lies in the world.
        transmission_density: Option<FileName> = None, optional, Rule::Any, ["transmissionDensity" in set::DURER];
        /// The box that `transmissionDensity` fills in place of the file's, in the world: a corner and the edges from
        /// there along the grid's x, y and z.
        transmission_density_box: Vec<[f32; 3]> = Vec::new(), optional, Rule::Rows(0, 4),
            ["transmissionDensityBox" in set::DURER];
        /// How much glass spreads colours, over what `transmissionDispersionAbbeNumber` says; 0:
        /// not at all. Only `--color spectral` shows it.
        transmission_dispersion_scale: f32 = 0.0, optional, Rule::Share, ["transmissionDispersionScale" in set::DURER];
        /// Abbe number of the glass: the lower, the more it spreads colours; 64 is crown glass, 30
        /// flint.
        transmission_dispersion_abbe_number: f32 = 20.0, optional, Rule::Positive,
            ["transmissionDispersionAbbeNumber" in set::DURER];
        /// From 0 (matte) to 1 (light goes into the body, is scattered there and comes out
        /// elsewhere: marble, milk, skin).
        subsurface_weight: f32 = 0.0, optional, Rule::Share, ["subsurfaceWeight" in set::DURER];
        /// A picture that multiplies `subsurfaceWeight`.
        subsurface_weight_texture: Option<FileName> = None, optional, Rule::Any,
            ["subsurfaceWeightTexture" in set::DURER];
        /// The colour that such a body shows.
        subsurface_color: Vec3 = Vec3::splat(0.8), optional, Rule::Any, ["subsurfaceColor" in set::DURER];
        /// A picture that multiplies `subsurfaceColor` where light enters; its values are read as
        /// sRGB.
        subsurface_color_texture: Option<FileName> = None, optional, Rule::Any, ["subsurfaceColorTexture" in set::DURER];
        /// How far light goes in it until it is scattered, on the mean, in units of the world.
        subsurface_radius: f32 = 1.0, optional, Rule::Positive, ["subsurfaceRadius" in set::DURER];
        /// What multiplies `subsurfaceRadius` for red, green and blue.
        subsurface_radius_scale: Vec3 = Vec3::new(1.0, 0.5, 0.25), optional, Rule::Any,
            ["subsurfaceRadiusScale" in set::DURER];
        /// Where light goes that is scattered in it: from -1 (back) over 0 (evenly) to 1 (onwards).
        subsurface_scatter_anisotropy: f32 = 0.0, optional, Rule::Between(-1.0, 1.0),
            ["subsurfaceScatterAnisotropy" in set::DURER];
        /// Strength of the clear coat, from 0 to 1.
        coat_weight: f32 = 0.0, optional, Rule::Share, ["coatWeight" in set::DURER];
        /// A picture that multiplies `coatWeight`.
        coat_weight_texture: Option<FileName> = None, optional, Rule::Any, ["coatWeightTexture" in set::DURER];
        /// Colour of what passes the coat down and up again at right angles.
        coat_color: Vec3 = Vec3::ONE, optional, Rule::Any, ["coatColor" in set::DURER];
        /// A picture that multiplies `coatColor`; its values are read as sRGB.
        coat_color_texture: Option<FileName> = None, optional, Rule::Any, ["coatColorTexture" in set::DURER];
        /// How rough the coat is, from 0 to 1.
        coat_roughness: f32 = 0.0, optional, Rule::Share, ["coatRoughness" in set::DURER];
        /// A picture that multiplies `coatRoughness`.
        coat_roughness_texture: Option<FileName> = None, optional, Rule::Any, ["coatRoughnessTexture" in set::DURER];
        /// Index of refraction of the coat.
        coat_ior: f32 = 1.6, optional, Rule::Positive, ["coatIor" in set::DURER];
        /// How much a coat darkens what it covers by reflecting light back down, from 0 to 1 (as
        /// physics has it).
        coat_darkening: f32 = 1.0, optional, Rule::Share, ["coatDarkening" in set::DURER];
        /// A picture that multiplies `coatDarkening`.
        coat_darkening_texture: Option<FileName> = None, optional, Rule::Any, ["coatDarkeningTexture" in set::DURER];
        /// Strength of the fuzz on top, as of velvet or dust, from 0 to 1.
        fuzz_weight: f32 = 0.0, optional, Rule::Share, ["fuzzWeight" in set::DURER];
        /// A picture that multiplies `fuzzWeight`.
        fuzz_weight_texture: Option<FileName> = None, optional, Rule::Any, ["fuzzWeightTexture" in set::DURER];
        /// Colour of the fuzz.
        fuzz_color: Vec3 = Vec3::ONE, optional, Rule::Any, ["fuzzColor" in set::DURER];
        /// A picture that multiplies `fuzzColor`; its values are read as sRGB.
        fuzz_color_texture: Option<FileName> = None, optional, Rule::Any, ["fuzzColorTexture" in set::DURER];
        /// How rough the fuzz is, from 0 to 1.
        fuzz_roughness: f32 = 0.5, optional, Rule::Share, ["fuzzRoughness" in set::DURER];
        /// A picture that multiplies `fuzzRoughness`.
        fuzz_roughness_texture: Option<FileName> = None, optional, Rule::Any, ["fuzzRoughnessTexture" in set::DURER];
        /// How much of the surface below the coat has a thin film on it, from 0 to 1: soap, oil,
        /// tempered steel, the layers of a pearl.
        thin_film_weight: f32 = 0.0, optional, Rule::Share, ["thinFilmWeight" in set::DURER];
        /// A picture that multiplies `thinFilmWeight`.
        thin_film_weight_texture: Option<FileName> = None, optional, Rule::Any, ["thinFilmWeightTexture" in set::DURER];
        /// How thick the film is, in micrometres.
        thin_film_thickness: f32 = 0.5, optional, Rule::NonNegative, ["thinFilmThickness" in set::DURER];
        /// A picture that multiplies `thinFilmThickness`.
        thin_film_thickness_texture: Option<FileName> = None, optional, Rule::Any,
            ["thinFilmThicknessTexture" in set::DURER];
        /// Index of refraction of the film.
        thin_film_ior: f32 = 1.4, optional, Rule::Positive, ["thinFilmIor" in set::DURER];
        /// How bright the surface shines, in cd/m^2; a pixel of value 1 shows 1 cd/m^2.
        emission_luminance: f32 = 0.0, optional, Rule::NonNegative, ["emissionLuminance" in set::DURER];
        /// Colour of its own light, which multiplies `emissionLuminance`.
        emission_color: Vec3 = Vec3::ONE, optional, Rule::Any, ["emissionColor" in set::DURER];
        /// The spectrum of its own light, which `emissionColor` multiplies: an illuminant (A, D50,
        /// D55, D65, D75, E, F2, F7, F11), a black body (`2700K`), or a file as for `baseSpectrum`,
        /// in any unit. `emissionLuminance` still says how bright it is.
        emission_spectrum: Option<FileName> = None, optional, Rule::Any, ["emissionSpectrum" in set::DURER];
        /// A picture that multiplies `emissionColor`; its values are read as sRGB.
        emission_texture: Option<FileName> = None, optional, Rule::Any, ["emissionTexture" in set::DURER];
        /// `on`: the colours of a mesh's vertices multiply `emissionColor`.
        emission_vertex_colors: Switch = Switch::Off, optional, Rule::Any, ["emissionVertexColors" in set::DURER];
        /// A picture of normals in tangent space, as glTF has it: red and green point along u and
        /// v, blue outwards.
        normal_texture: Option<FileName> = None, optional, Rule::Any, ["normalTexture" in set::DURER];
        /// A picture of heights, which bends the normals as if the surface rose where it is bright:
        /// a bump map.
        bump_texture: Option<FileName> = None, optional, Rule::Any, ["bumpTexture" in set::DURER];
        /// How far its white lies above its black, in units of the world; negative where white lies
        /// deep.
        bump_height: f32 = 0.01, optional, Rule::Any, ["bumpHeight" in set::DURER];
        /// `on`: normals of pictures that are turned away from who looks are bent until mirrors show what is
        /// outside; `off`: such places are black, as in Mitsuba.
        normal_bending: Switch = Switch::On, optional, Rule::Any, ["normalBending" in set::DURER];
        /// Share of the surface that is there, from 0 to 1: the rest lets light through as if
        /// nothing were there.
        opacity: f32 = 1.0, optional, Rule::Share, ["opacity" in set::DURER];
        /// A picture that multiplies `opacity`: its alpha where it has one, else red.
        opacity_texture: Option<FileName> = None, optional, Rule::Any, ["opacityTexture" in set::DURER];
        /// All is there whose opacity, by `opacity`, pictures and the alpha of vertices together, is at
        /// least this, and nothing of the rest; where it is not given, all is there in part.
        opacity_cutoff: Option<f32> = None, optional, Rule::NonNegative, ["opacityCutoff" in set::DURER];
        /// `thin`: a sheet without inside, through which light goes straight; `solid`: the skin of
        /// a body.
        walls: Walls = Walls::Solid, optional, Rule::Any, ["walls" in set::DURER];
        /// `shown`: both sides are seen; `hidden`: cameras and lights without extent look through
        /// faces that are turned away from them; `black`: such faces scatter no light.
        backs: Backs = Backs::Shown, optional, Rule::Any, ["backs" in set::DURER];
    }
}

impl PrincipledMaterial {
    /// Whether light goes into the body, is scattered there, and comes out again.
    pub fn has_subsurface(&self) -> bool {
        self.subsurface_weight > 0.0 && self.walls == Walls::Solid
    }

    /// Whether colours are spread.
    pub fn disperses(&self) -> bool {
        self.transmission_weight > 0.0 && self.transmission_dispersion_scale > 0.0 && self.walls == Walls::Solid
    }

    /// The index of refraction at a wavelength in nanometres; `None` for all of them.
    ///
    /// Source: Cauchy's formula through the indices that Abbe's number is made of, at the lines C,
    /// d and F; OpenPBR.
    pub fn ior_at(&self, nm: Option<f32>) -> f32 {
        const LINES: [f32; 3] = [656.3, 587.6, 486.1];
        let Some(nm) = nm.filter(|_| self.disperses()) else { return self.specular_ior };
        let [c, d, f] = LINES.map(|line| 1.0 / (line * line));
        let abbe = self.transmission_dispersion_abbe_number / self.transmission_dispersion_scale;
        let slope = (self.specular_ior - 1.0) / (abbe * (f - c));
        self.specular_ior + slope * (1.0 / (nm * nm) - d)
    }
}
