//! Material used in the course, with a diffuse colour, a highlight, and weights for reflected and
//! refracted rays.

use super::MAX_OCTAVES;
use crate::describe::{Constraint, FileName, described};
use crate::dialect::set;
use crate::math::{Color, Vec3, noise};

described! {
    /// Material with a diffuse colour and a highlight, which can also reflect and transmit light.
    PhongMaterial ["PhongMaterial" in set::CLASSIC, "Material" in set::ALL] {
        /// Diffuse albedo; 1 1 1 by default.
        diffuse_color: Option<Vec3> = None, optional, Constraint::Any, ["diffuseColor" in set::CLASSIC, "diffuse" in set::F23];
        /// Strength of the highlight, and in some dialects also of the reflection.
        specular_color: Vec3 = Vec3::ZERO, optional, Constraint::Any,
            ["specularColor" in set::CLASSIC, "specular" in set::F23];
        /// Exponent of the Blinn highlight.
        exponent: Option<f32> = None, optional, Constraint::NonNegative, ["exponent" in set::OLD | set::DURER];
        /// Exponent of the Phong highlight.
        shininess: Option<f32> = None, optional, Constraint::NonNegative, ["shininess" in set::NEW | set::F23 | set::DURER];
        /// Weight of the reflected ray.
        reflective_color: Vec3 = Vec3::ZERO, optional, Constraint::Any, ["reflectiveColor" in set::OLD | set::DURER];
        /// Weight of the transmitted ray.
        transparent_color: Vec3 = Vec3::ZERO, optional, Constraint::Any, ["transparentColor" in set::OLD | set::DURER];
        /// Index of refraction of the transmitted ray. The weights of both rays are the colours,
        /// without Fresnel's equations.
        index_of_refraction: Option<f32> = None, optional, Constraint::Positive, ["indexOfRefraction" in set::OLD | set::DURER];
        /// Index of refraction of glass that reflects more light at grazing angles: in path tracing
        /// by Fresnel's equations, in Whitted's method by Schlick's approximation; 0 for no glass.
        refraction_index: Option<f32> = None, optional, Constraint::NonNegative,
            ["refractionIndex" in set::F12A5 | set::DURER];
        /// Texture that replaces the diffuse colour where the object has texture coordinates.
        texture: Option<FileName> = None, optional, Constraint::Any, ["texture" in set::F12A4 | set::F12A5 | set::DURER];
        /// Bump map; ignored, as it is by the official programs of every year.
        bump: Option<FileName> = None, optional, Constraint::Any, ["bump" in set::NEW | set::DURER];
    }
}

described! {
    /// Two colours in veins distorted by noise, which replace the diffuse colour.
    ColorNoise ["Noise" in set::F12A5 | set::DURER] {
        /// Colour where the sine is 1.
        color1: Vec3 = Vec3::ONE, required, Constraint::Any, ["color" in set::ALL];
        /// Colour where the sine is -1.
        color2: Vec3 = Vec3::ZERO, required, Constraint::Any, ["color" in set::ALL];
        /// Number of noise octaves, each with twice the frequency of the previous one.
        octaves: u32 = 0, optional, Constraint::AtMost(MAX_OCTAVES), ["octaves" in set::ALL];
        /// Number of veins per 2 pi along x.
        frequency: f32 = 1.0, optional, Constraint::Any, ["frequency" in set::ALL];
        /// Strength of the noise that distorts the veins.
        amplitude: f32 = 1.0, optional, Constraint::Any, ["amplitude" in set::ALL];
    }
}

impl ColorNoise {
    /// Colour at a point: w color1 + (1 - w) color2, where w = (sin(frequency x + amplitude N) + 1)
    /// / 2.
    pub fn color(&self, p: Vec3) -> Color {
        let w = noise::veins(p, p.x, self.frequency, self.amplitude, self.octaves);
        w * self.color1 + (1.0 - w) * self.color2
    }
}
