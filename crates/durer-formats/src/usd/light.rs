//! Lights of UsdLux.
//!
//! Source: *OpenUSD documentation*, UsdLux: the emission is color · intensity · 2^exposure, in
//! nits, divided by the area of the light if `normalize` is set.

use super::files::joined;
use super::reader::{Emission, Reader};
use super::stage::Prim;
use crate::panorama;
use crate::pictures::{asset, picture_error};
use durer_diag::Diagnostic;
use durer_scene::describe::FileName;
use durer_scene::light::{DirectionalLight, Light, PointLight, SpotLight};
use durer_scene::math::{Vec3, fp};
use durer_scene::scene::{Axis, Object, ObjectKind, PictureBytes, Spanned, TextureImage};
use durer_scene::shape::{Cylinder, Disc, Rectangle, Sphere};
use durer_scene::texture::{Mapping, Wrap};
use glam::{DAffine3, DVec3};
use std::f64::consts::PI;

/// Height in pixels of an environment map that is resampled.
const MAX_ROWS: u32 = 2048;

impl Reader<'_, '_> {
    /// Adds a light.
    pub fn light(&mut self, prim: &Prim, kind: &str, to_world: DAffine3, objects: &mut Vec<Object>) {
        let (report, at) = (self.stage.files.report, prim.span());
        let Some((radiance, spectrum)) = self.radiance(prim, kind) else {
            // A black dome states that nothing is around the scene.
            if kind.starts_with("DomeLight") && !self.has_dome {
                (self.has_dome, self.scene.is_lit, self.scene.background_span) = (true, true, at);
                self.scene.background.color = Vec3::ZERO;
            }
            return;
        };
        self.scene.is_lit = true;
        if kind.starts_with("DomeLight") {
            // The pole of a DomeLight_1 is the up axis of the scene, unless it states another.
            let pole = self.text(prim, "poleAxis");
            let is_z = match pole.as_deref() {
                _ if kind == "DomeLight" => false,
                Some("Y") => false,
                Some("Z") => true,
                _ => self.scene.up == Some(Axis::Z),
            };
            let turned = if is_z { to_world * DAffine3::from_rotation_x(PI / 2.0) } else { to_world };
            return self.dome(prim, radiance, turned);
        }
        if kind == "DistantLight" {
            return self.distant_light(prim, radiance, spectrum, to_world);
        }
        let input = |name: &str, default: f64| self.input(prim, name).unwrap_or(default);
        let scale = f64::from(fp::pow(to_world.matrix3.determinant().abs() as f32, 1.0 / 3.0));
        let radius = input("radius", 0.5).max(0.0);
        let (width, height) = (input("width", 1.0), input("height", 1.0));
        let length = input("length", 1.0);
        let axes = to_world.matrix3;
        let area = match kind {
            "SphereLight" => 4.0 * PI * (radius * scale) * (radius * scale),
            "RectLight" => width * height * axes.x_axis.cross(axes.y_axis).length(),
            "DiskLight" => PI * radius * radius * axes.x_axis.cross(axes.y_axis).length(),
            _ => 2.0 * PI * radius * length * scale * scale,
        };
        let is_point = kind == "SphereLight" && (radius == 0.0 || self.boolean(prim, "treatAsPoint") == Some(true));
        let cone = self.input(prim, "shaping:cone:angle").filter(|angle| *angle < 90.0);
        if self.input(prim, "shaping:focus").is_some_and(|focus| focus != 0.0)
            || prim.get(self.stage, "inputs:shaping:ies:file").is_some_and(|file| file.value.text() != Some(""))
        {
            report.unsupported_once(at, "the focus and IES profile of lights have no counterpart: they are left out");
        }
        let normalize = self.boolean(prim, "inputs:normalize") == Some(true);
        if kind == "SphereLight" && (is_point || cone.is_some()) {
            // Seen from far away, a sphere is a disc. The intensity of a normalized sphere does not
            // depend on its radius.
            let intensity = if normalize { 0.25 } else { PI * (radius * scale) * (radius * scale) };
            let color = radiance * (intensity / PI) as f32;
            let position = to_world.translation.as_vec3();
            let spectrum = spectrum.map(|path| FileName { path, span: at });
            let value: Light = match cone {
                Some(angle) => {
                    let softness = self.input(prim, "shaping:cone:softness").unwrap_or(0.0).clamp(0.0, 1.0);
                    let angle = angle.max(1e-3) as f32;
                    let direction = to_world.transform_vector3(DVec3::NEG_Z).normalize_or(DVec3::NEG_Z).as_vec3();
                    let inner_angle = angle * (1.0 - softness as f32);
                    SpotLight { position, direction, color, angle, inner_angle, spectrum, ..SpotLight::default() }
                        .into()
                }
                None => {
                    PointLight { position, color, attenuation: Some(Vec3::Z), spectrum, ..PointLight::default() }.into()
                }
            };
            self.scene.lights.get_or_insert_default().push(Spanned { value, span: at });
            return;
        }
        if cone.is_some() {
            report.unsupported_once(at, "the cone of lights other than spheres has no counterpart: it is left out");
        }
        if [width, height, length].iter().any(|size| *size <= 0.0) || radius <= 0.0 {
            return report.warn_once("empty-shape", at, "a light whose size is not greater than 0 is left out");
        }
        let radiance = if normalize { radiance / area as f32 } else { radiance };
        let picture = self.light_picture(prim, kind);
        let material = self.emitter(&Emission { radiance, spectrum, picture }, at);
        let (width, height, radius) = (width as f32, height as f32, radius as f32);
        let half = 0.5 * length as f32 * Vec3::X;
        let shape = match kind {
            "SphereLight" => Sphere { center: Vec3::ZERO, radius }.into(),
            // Seen from -z, where the light goes, x points to the left.
            "RectLight" => Rectangle {
                corner: Vec3::new(0.5 * width, -0.5 * height, 0.0),
                edge0: Vec3::NEG_X * width,
                edge1: Vec3::Y * height,
            }
            .into(),
            "DiskLight" => Disc { center: Vec3::ZERO, normal: Vec3::NEG_Z, radius, inner_radius: 0.0 }.into(),
            _ => Cylinder { base: -half, top: half, radius }.into(),
        };
        self.add(ObjectKind::Primitive(shape), Some(material), to_world, at, objects);
        if kind == "CylinderLight" {
            // The caps do not emit light: a black disc covers each of them.
            let black = self.emitter(&Emission { radiance: Vec3::ZERO, spectrum: None, picture: None }, at);
            for end in [-half, half] {
                let disc = Disc { center: end * (1.0 + 1e-4), normal: end, radius, inner_radius: 0.0 };
                self.add(ObjectKind::Primitive(disc.into()), Some(black), to_world, at, objects);
            }
        }
    }

    /// Returns the numeric input of a light.
    fn input(&self, prim: &Prim, name: &str) -> Option<f64> {
        self.number(prim, &format!("inputs:{name}")).or_else(|| self.number(prim, name))
    }

    /// Returns the emission without `normalize`, and the colour temperature; `None` for a light
    /// that is off.
    fn radiance(&self, prim: &Prim, kind: &str) -> Option<(Vec3, Option<String>)> {
        let default = if kind == "DistantLight" { 50_000.0 } else { 1.0 };
        let intensity = self.input(prim, "intensity").unwrap_or(default);
        let exposure = self.input(prim, "exposure").unwrap_or(0.0).clamp(-100.0, 100.0);
        let color = self.triple(prim, "inputs:color").or_else(|| self.triple(prim, "color")).unwrap_or([1.0; 3]);
        let factor = intensity * f64::from(fp::pow(2.0, exposure as f32));
        let radiance = DVec3::from_array(color) * factor;
        let has_temperature = ["inputs:enableColorTemperature", "enableColorTemperature"];
        let has_temperature = has_temperature.iter().any(|name| self.boolean(prim, name) == Some(true));
        let temperature = self.input(prim, "colorTemperature").unwrap_or(6500.0).clamp(1000.0, 10_000.0);
        let spectrum = has_temperature.then(|| format!("{temperature}K"));
        let shines = radiance.min_element() >= 0.0 && radiance.max_element() > 0.0;
        // A black dome keeps a scene dark.
        if !shines && kind != "DomeLight" {
            let cause = if intensity <= 0.0 { "`inputs:intensity` is not above 0" } else { "`inputs:color` is black" };
            let message = format!("the light `{}` emits nothing: {cause}", prim.name());
            let diagnostic = Diagnostic::warning(message).code("black-light").at(prim.span());
            self.stage.files.report.push(diagnostic.help("give the light an intensity and a colour above 0"));
        }
        shines.then(|| (radiance.as_vec3(), spectrum))
    }

    fn distant_light(&mut self, prim: &Prim, radiance: Vec3, spectrum: Option<String>, to_world: DAffine3) {
        let angle = self.input(prim, "angle").unwrap_or(0.53).clamp(0.0, 180.0);
        let half = 0.5 * angle;
        let (sin, _) = fp::sin_cos_degrees(half);
        // Without `normalize`, the emission is the luminance of a disc of this size in the sky.
        let is_normalized = self.boolean(prim, "inputs:normalize") == Some(true) || angle == 0.0;
        let illuminance = if is_normalized { 1.0 } else { PI * sin * sin };
        let direction = to_world.transform_vector3(DVec3::NEG_Z).normalize_or(DVec3::NEG_Z).as_vec3();
        let light = DirectionalLight {
            direction,
            color: radiance * (illuminance / PI) as f32,
            spread: (half > 0.0).then_some(half as f32),
            spectrum: spectrum.map(|path| FileName { path, span: prim.span() }),
            ..DirectionalLight::default()
        };
        self.scene.lights.get_or_insert_default().push(Spanned { value: light.into(), span: prim.span() });
    }

    /// Returns the picture of a light.
    fn light_picture(&mut self, prim: &Prim, kind: &str) -> Option<FileName> {
        let opinion = prim.get(self.stage, "inputs:texture:file").or_else(|| prim.get(self.stage, "texture:file"))?;
        let name = joined(&opinion.layer, opinion.value.text().filter(|name| !name.is_empty())?);
        if kind != "RectLight" {
            let message = "only a RectLight can have a picture: the picture of other lights is left out";
            self.stage.files.report.unsupported_once(opinion.span, message);
            return None;
        }
        let bytes = self.stage.files.picture(&name, opinion.span)?;
        // The picture is seen from the side to which the light goes.
        let mapping = Mapping { wrap: [Wrap::Clamp; 2], ..Mapping::default() };
        Some(asset(&mut self.scene, TextureImage { bytes, mapping }, opinion.span))
    }

    /// Sets the environment of the scene to that of a dome light.
    fn dome(&mut self, prim: &Prim, radiance: Vec3, to_world: DAffine3) {
        let (files, at) = (self.stage.files, prim.span());
        if std::mem::replace(&mut self.has_dome, true) {
            return files.report.unsupported_once(at, "only the first dome light is used");
        }
        self.scene.background_span = at;
        let background = &mut self.scene.background;
        background.color = Vec3::ZERO;
        let opinion = prim.get(self.stage, "inputs:texture:file").or_else(|| prim.get(self.stage, "texture:file"));
        let named = opinion.and_then(|opinion| {
            let name = joined(&opinion.layer, opinion.value.text().filter(|name| !name.is_empty())?);
            Some((files.picture(&name, opinion.span)?, opinion.span))
        });
        let Some((bytes, span)) = named else {
            background.color = radiance;
            return;
        };
        let y = to_world.matrix3.y_axis.normalize_or(DVec3::Y);
        let is_upright = (y - DVec3::Y).length() < 1e-6 && to_world.matrix3.determinant() > 0.0;
        if is_upright {
            // The centre of the picture is at +z in USD, and at -z in Dürer.
            let z = to_world.matrix3.z_axis.as_vec3();
            let degrees = 180.0 - fp::atan2(z.x, z.z).to_degrees();
            let path = bytes.path().to_string();
            if matches!(bytes, PictureBytes::Memory(..)) {
                let picture = TextureImage { bytes, mapping: Mapping::default() };
                self.scene.assets.pictures.insert(path.clone(), picture);
            }
            let background = &mut self.scene.background;
            background.environment = Some(FileName { path, span });
            background.environment_rotation = (degrees != 0.0).then_some(degrees);
            background.environment_scale = (radiance != Vec3::ONE).then_some(radiance);
            return;
        }
        let pictures = files.pictures();
        let image = match &bytes {
            PictureBytes::File(name) => pictures.image(name, span),
            PictureBytes::Memory(name, bytes) => pictures.of_bytes(name, bytes, span),
        };
        let Some(image) = image else { return };
        let to_light = to_world.inverse();
        let light = |dir: DVec3| {
            let DVec3 { x, y, z } = to_light.transform_vector3(dir).normalize_or(DVec3::Y);
            radiance * panorama::nearest(&image, DVec3::new(-x, y, -z))
        };
        let memory = panorama::remaining_memory([&image], files.input.memory);
        let rows = image.height.min(MAX_ROWS);
        let name = format!("{}#{}", files.input.name, prim.path);
        if let Err(error) = panorama::set_environment(&mut self.scene, (&name, span), rows, memory, light) {
            files.report.push(picture_error(&name, &error).at(span));
        }
    }
}
