//! Writes lights without extent, and light from all around.

use super::element::Element;
use super::{PROGRAM, Writer};
use crate::export::light::{Around, PunctualLight};
use crate::extension;
use crate::mitsuba::light::FINE_ROWS;
use crate::mitsuba::transform::frame;
use durer_scene::light::Fade;
use durer_scene::math::{Vec3, fp};
use glam::DAffine3;

impl Writer<'_> {
    pub(super) fn emitters(&mut self) -> Vec<Element> {
        let lights = self.export.punctual_lights(PROGRAM);
        let mut emitters: Vec<Element> = lights.into_iter().map(|light| self.punctual_light(light)).collect();
        if let Some(around) = self.export.around(PROGRAM) {
            emitters.extend(self.around(around));
        }
        emitters
    }

    fn punctual_light(&mut self, light: PunctualLight) -> Element {
        match light {
            PunctualLight::Point { position, intensity } => {
                let light = Element::plugin("emitter", "point").vector("point", "position", position.to_array());
                light.rgb("intensity", intensity)
            }
            PunctualLight::Distant { direction, irradiance, .. } => {
                let light = Element::plugin("emitter", "directional");
                light.vector("vector", "direction", direction.to_array()).rgb("irradiance", irradiance)
            }
            PunctualLight::Spot { position, direction, intensity, angle, inner_angle, fade } => {
                if inner_angle < angle {
                    self.export.warn_lost(
                        "spot lights of Mitsuba fade linearly with the angle: the width of the beam is fitted",
                    );
                }
                let beam = if inner_angle < angle { beam_width([angle, inner_angle], fade) } else { angle };
                let map = DAffine3 { matrix3: frame(direction.as_dvec3()), translation: position.as_dvec3() };
                let spot = Element::plugin("emitter", "spot").transform("to_world", &map).rgb("intensity", intensity);
                spot.float("cutoff_angle", angle).float("beam_width", beam)
            }
        }
    }

    fn around(&mut self, around: Around) -> Option<Element> {
        let (environment, rows, file) = match around {
            Around::Even(color) => return Some(Element::plugin("emitter", "constant").rgb("radiance", color)),
            Around::Map { environment, rows, file } => (environment, rows, file),
        };
        // The centre of an environment map is +z in Mitsuba and -z in Dürer.
        let element = |path: &str, degrees: f32, scale: f32| {
            let turn = Element::new("rotate").with("y", 1).with("angle", 180.0 - degrees);
            let element = Element::plugin("emitter", "envmap").text("filename", path).float("scale", scale);
            element.and(Element::new("transform").with("name", "to_world").and(turn))
        };
        let kept = file.filter(|(_, _, scale)| rows >= FINE_ROWS && *scale == Vec3::splat(scale.x));
        if let Some((name, degrees, scale)) = kept {
            let export = &mut self.export;
            let picture = export.picture(&name);
            let path =
                export.file(name.path.clone(), picture.bytes.path(), &extension(picture.bytes.path()), |export| {
                    export.picture_bytes(&picture.bytes).map(|bytes| bytes.to_vec())
                });
            return path.map(|path| element(&path, degrees, scale.x));
        }
        let light = |dir: glam::DVec3| environment.at(dir.as_vec3());
        let path = self.export.panorama_file(rows.clamp(FINE_ROWS, 1024), light);
        path.map(|path| element(&path, 0.0, 1.0))
    }
}

/// Returns the width of the beam in degrees for which a light that fades linearly up to `angle`
/// emits as much as one that fades between the cosines of both angles.
fn beam_width([angle, inner]: [f32; 2], fade: Fade) -> f32 {
    const STEPS: u16 = 256;
    let cosine = |degrees: f32| fp::sin_cos_degrees(f64::from(degrees)).1 as f32;
    let [outer_cosine, inner_cosine] = [angle, inner].map(cosine);
    let flux = |share: &dyn Fn(f32) -> f32| -> f32 {
        let at = |i: u16| angle * (f32::from(i) + 0.5) / f32::from(STEPS);
        (0..STEPS).map(|i| share(at(i)) * fp::sin(at(i).to_radians())).sum()
    };
    let ours =
        flux(&|degrees| fade.at(((cosine(degrees) - outer_cosine) / (inner_cosine - outer_cosine)).clamp(0.0, 1.0)));
    let (mut low, mut high) = (0.0, angle);
    for _ in 0..24 {
        let beam = 0.5 * (low + high);
        let theirs = flux(&|degrees| ((angle - degrees) / (angle - beam).max(1e-6)).clamp(0.0, 1.0));
        if theirs < ours { low = beam } else { high = beam }
    }
    0.5 * (low + high)
}
