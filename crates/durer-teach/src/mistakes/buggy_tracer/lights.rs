//! Direct light of one light, with the mistakes of a student's tracer.

use super::{BuggyTracer, mirrored};
use crate::mistakes::bugs::{Attenuation, Cosine, HalfVector, PointLightDirection};
use durer_render::world::HighlightModel;
use durer_scene::camera::Projection;
use durer_scene::light::{Illuminate, Light, LightLiSample};
use durer_scene::math::{Color, Vec3, fp};
use glam::DVec3;

impl BuggyTracer<'_> {
    /// Returns the incident light, including mistakes in its direction and attenuation.
    /// `ray_length` is the distance from the origin of the ray to the point.
    pub(super) fn illuminated(&self, light: &Light, point: DVec3, ray_length: f32) -> LightLiSample {
        let mut li = light.illuminate(point);
        if self.bugs.lights.all_negated {
            li.to_light = -li.to_light;
        }
        // The course's programs have only these two kinds of lights.
        match light {
            Light::Directional(_) if self.bugs.lights.negated => li.to_light = -li.to_light,
            Light::Point(point) => {
                let d = li.distance;
                let falloff = |d: f32| {
                    let a = point.attenuation.unwrap_or(Vec3::X);
                    a.x + a.y * d + a.z * d * d
                };
                match self.bugs.lights.attenuation {
                    Attenuation::Correct => {}
                    Attenuation::Multiplied => li.color = point.color * falloff(d),
                    Attenuation::Linear => li.color = point.color / d,
                    Attenuation::Square => li.color = point.color / (d * d),
                    Attenuation::SquaredTwice => li.color = point.color / falloff(d * d),
                    Attenuation::Root => li.color = point.color / falloff(d).sqrt(),
                    Attenuation::RayLength => li.color = point.color / falloff(ray_length),
                    Attenuation::FromEye => {
                        let eye = self.world.camera().pose().center;
                        li.color = point.color / falloff((point.position - eye).length());
                    }
                }
                match self.bugs.lights.points {
                    PointLightDirection::Correct => {}
                    PointLightDirection::Negated => li.to_light = -li.to_light,
                    PointLightDirection::Position => li.to_light = point.position.normalize_or(li.to_light),
                    PointLightDirection::PositionAlone => {
                        let d = point.position.length();
                        li.to_light = point.position.normalize_or(li.to_light);
                        (li.color, li.distance) = (point.color / falloff(d), d);
                    }
                    PointLightDirection::FromEye(whole) => {
                        let way = point.position - self.world.camera().pose().center;
                        li.to_light = way.normalize_or(li.to_light);
                        if whole {
                            (li.color, li.distance) = (point.color / falloff(way.length()), way.length());
                        }
                    }
                    PointLightDirection::MinusPosition => li.to_light = -point.position.normalize_or(li.to_light),
                }
            }
            _ => {}
        }
        li
    }

    /// Returns the light vector that is used in products. It has unit length unless a mistake
    /// changes that.
    fn light_vector(&self, light: &Light, li: &LightLiSample) -> Vec3 {
        match light {
            Light::Directional(sun) if self.bugs.lights.long => li.to_light * sun.direction.length(),
            Light::Point(_) if self.bugs.lights.long_points => li.to_light * li.distance,
            _ => li.to_light,
        }
    }

    /// Returns the diffuse term and the highlight that one light causes.
    pub(super) fn direct(
        &self,
        highlight: Option<(Color, f32, HighlightModel)>,
        diffuse: Color,
        n: Vec3,
        view: Vec3,
        light: &Light,
        li: &LightLiSample,
    ) -> Color {
        let bugs = self.bugs.highlights;
        let to_light = self.light_vector(light, li);
        let view = if bugs.eye_negated { -view } else { view };
        let cosine = n.dot(to_light);
        let factor = match self.bugs.cosine {
            Cosine::Clamped => cosine.max(0.0),
            Cosine::TwoSided => cosine.abs(),
            Cosine::Signed => cosine,
            Cosine::One => 1.0,
            Cosine::None => 0.0,
            Cosine::Squared => cosine.max(0.0) * cosine.max(0.0),
            Cosine::Half => 0.5 * cosine + 0.5,
            Cosine::Step => f32::from(cosine > 0.0),
            Cosine::OverPi => cosine.max(0.0) / std::f32::consts::PI,
            Cosine::View => n.dot(-view).max(0.0),
        };
        let factor = factor * self.bugs.diffuse_factor.unwrap_or(1.0);
        let diffuse = if self.bugs.diffuse_twice { diffuse * diffuse } else { diffuse };
        let plain = self.bugs.plain_diffuse && diffuse != Color::ZERO;
        let mut color = factor * if plain { Color::ONE } else { diffuse };
        if self.bugs.diffuse_lightless {
            // This cancels the multiplication by `seen.color` at the end.
            color /= li.color.max(Color::splat(1e-6));
        }
        // Light without attenuation, as a multiple of the light that arrives.
        let unfaded = |highlight: bool| match light {
            Light::Point(point) if self.bugs.lights.unfaded == Some(highlight) => {
                point.color / li.color.max(Color::splat(1e-12))
            }
            _ => Color::ONE,
        };
        if self.bugs.lights.unfaded == Some(false) {
            color *= unfaded(false);
        }
        if let Some((specular, exponent, model)) = highlight {
            let half = |sum: Vec3| match bugs.half {
                HalfVector::Unit => sum.normalize_or_zero(),
                HalfVector::Sum => sum,
                HalfVector::Mean => 0.5 * sum,
            };
            let base = match model {
                HighlightModel::Blinn => (cosine > 0.0 || bugs.everywhere).then(|| n.dot(half(to_light - view))),
                HighlightModel::Phong { behind } => {
                    (behind || cosine > 0.0).then(|| mirrored(view, n, bugs.mirror).dot(to_light))
                }
            };
            if let Some(base) = base {
                let base = if bugs.two_sided { base.abs() } else { base.max(0.0) };
                let mut strength = fp::pow(base, exponent);
                if bugs.times_cosine {
                    strength *= cosine.max(0.0);
                }
                strength *= bugs.factor.unwrap_or(1.0);
                let specular = if bugs.bare { Color::ONE } else { specular };
                let specular = if bugs.times_diffuse { specular * diffuse } else { specular };
                let specular = specular * unfaded(true);
                if bugs.lightless {
                    return color * li.color + strength * specular;
                }
                color += strength * specular;
            }
        }
        color * li.color
    }
}
