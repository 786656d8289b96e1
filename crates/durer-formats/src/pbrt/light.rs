//! Converts point lights, distant lights, infinite lights and area lights. Values are radiances: a
//! pixel value of 1 is a radiance of 1.
//!
//! Source: *Physically Based Rendering*, 4th edition, chapter 12. In pbrt-v4, the spectrum of a
//! light is normalized to a luminance of `scale`, and `power` is a luminous flux. In pbrt-v3 (3rd
//! edition, chapter 12), values are absolute and `scale` is a colour.

use super::defs::{AreaLight, EnvironmentMapping, InfiniteLight};
use super::language::Language;
use super::params::{Kind, Param, Params};
use super::state::{LIGHT, Reader, State};
use crate::shared_report::suggest;
use durer_diag::Span;
use durer_scene::light::{DirectionalLight, Fade, Light, PointLight, SpotLight};
use durer_scene::math::{Color, Vec3, fp};
use durer_scene::scene::Spanned;
use glam::DVec3;
use std::f32::consts::PI;
use std::rc::Rc;

/// Returns the colour of a light, which is the parameter `name` times `scale`.
fn color(params: &Params, name: &'static str) -> Color {
    if params.language == Language::V3 {
        return params.spectrum(name).map_or(Vec3::ONE, |spectrum| spectrum.pbrt_v3_color()) * colored_scale(params);
    }
    let color = params.spectrum(name).map_or(Vec3::ONE, |spectrum| spectrum.light());
    color * params.float("scale").unwrap_or(1.0).max(0.0)
}

/// Returns the `scale` parameter of a pbrt-v3 light, which is a colour. A single number is ignored,
/// as in pbrt-v3.
fn colored_scale(params: &Params) -> Color {
    match params.get("scale") {
        Some(param) if param.kind == Kind::Float => {
            params.report.unsupported_once(
                param.at,
                "the `scale` of a light must be a colour in pbrt-v3: this number is ignored",
            );
            Vec3::ONE
        }
        _ => params.spectrum("scale").map_or(Vec3::ONE, |spectrum| spectrum.pbrt_v3_color()),
    }
}

impl Reader<'_> {
    /// Executes a `LightSource` directive.
    pub fn light(&mut self, kind: &str, at: Span, list: Vec<Rc<Param>>) {
        let params = self.params(list, Some(LIGHT), at);
        let (transform, exposure) = (self.map(at), self.exposure());
        let end = |name: &'static str, default: DVec3| params.triple(name).map_or(default, |p| p.as_dvec3());
        let (from, to) = (end("from", DVec3::ZERO), end("to", DVec3::Z));
        let place = transform.transform_point3(from).as_vec3();
        let direction = transform.transform_vector3(to - from);
        let aimed = || {
            let direction = direction.try_normalize();
            if direction.is_none() {
                params.report.error(params.span("to"), "`to` of a light must differ from `from`");
            }
            direction.unwrap_or(DVec3::Z).as_vec3()
        };
        let third = self.language == Language::V3;
        let flux = || params.float("power").filter(|power| *power > 0.0);
        let power = if third { None } else { flux() };
        // In Dürer, the colour of a light is the radiance of a white diffuse surface that it
        // illuminates, which is the illuminance divided by pi.
        let value: Light = match kind {
            "goniometric" | "projection" => {
                let color = color(&params, "I") * exposure;
                self.pictured_light(kind, &params, transform, (color, power));
                params.mark_known(&["scale", "power"]);
                return params.warn_unused("this light");
            }
            "point" => {
                let strength = power.map_or(1.0, |power| power / (4.0 * PI));
                let color = color(&params, "I") * (strength * exposure / PI);
                PointLight { position: place, color, attenuation: Some(Vec3::Z), ..PointLight::default() }.into()
            }
            "spot" => {
                let cone = [params.float("coneangle").unwrap_or(30.0), params.float("conedeltaangle").unwrap_or(5.0)];
                if !(cone[0] > 0.0 && cone[0] <= 180.0) {
                    self.report
                        .error(params.span("coneangle"), "`coneangle` must be more than 0 and at most 180 degrees");
                }
                let [outer, inner] = [cone[0], (cone[0] - cone[1]).max(0.0)];
                let cosine = |degrees: f32| fp::sin_cos_degrees(f64::from(degrees)).1 as f32;
                // Count half of the solid angle of the region between the two cones.
                let solid_angle = PI * (2.0 - cosine(inner) - cosine(outer));
                let strength = power.map_or(1.0, |power| power / solid_angle);
                let color = color(&params, "I") * (strength * exposure / PI);
                SpotLight {
                    position: place,
                    direction: aimed(),
                    color,
                    angle: outer.clamp(1e-3, 180.0),
                    inner_angle: inner,
                    fade: if third { Fade::Fourth } else { Fade::Smooth },
                    ..SpotLight::default()
                }
                .into()
            }
            "distant" => {
                let strength = if third { None } else { params.float("illuminance").filter(|e| *e > 0.0) };
                let color = color(&params, "L") * (strength.unwrap_or(1.0) * exposure / PI);
                DirectionalLight { direction: aimed(), color, ..DirectionalLight::default() }.into()
            }
            "infinite" | "exinfinite" => {
                self.infinite_light(&params, exposure);
                return params.warn_unused("this light");
            }
            other => {
                let known = ["point", "distant", "spot", "goniometric", "projection", "infinite"];
                return self.report.error_with_help(at, format!("unknown light `{other}`"), suggest(other, known));
            }
        };
        params.mark_known(&["from", "to", "scale"]);
        if !third {
            params.mark_known(&["power"]);
        }
        params.warn_unused("this light");
        self.scene.lights.get_or_insert_default().push(Spanned { value, span: at });
    }

    fn infinite_light(&mut self, params: &Params, exposure: f32) {
        self.scene.background_span = params.at;
        if self.language == Language::V3 {
            let color = color(params, "L") * exposure;
            params.mark_known(&["samples", "nsamples"]);
            let infinite = match params.text("mapname").filter(|name| !name.is_empty()) {
                Some(name) => {
                    let at = params.get("mapname").map_or(params.at, |param| param.values_at);
                    let to_light = self.map(params.at).inverse();
                    let transform = EnvironmentMapping::Equirectangular;
                    InfiniteLight::Picture {
                        name: name.to_string(),
                        at,
                        scale: color,
                        map: transform,
                        to_light,
                        illuminance: None,
                    }
                }
                None => InfiniteLight::Constant(color),
            };
            return self.infinite.push(infinite);
        }
        let illuminance = params.float("illuminance").filter(|e| *e > 0.0);
        params.warn_unsupported(&["portal"], "the whole environment is sampled");
        let infinite = match params.text("filename") {
            Some(name) => {
                let at = params.get("filename").map_or(params.at, |param| param.values_at);
                let scale = params.float("scale").unwrap_or(1.0).max(0.0) * exposure;
                let to_light = self.map(params.at).inverse();
                let (scale, transform) = (Vec3::splat(scale), EnvironmentMapping::EqualArea);
                InfiniteLight::Picture { name: name.to_string(), at, scale, map: transform, to_light, illuminance }
            }
            None => InfiniteLight::Constant(color(params, "L") * (exposure * illuminance.map_or(1.0, |e| e / PI))),
        };
        params.mark_known(&["from", "to", "power", "scale"]);
        self.infinite.push(infinite);
    }

    /// Warns about area lights outside of any scope that apply to shapes with different materials.
    pub fn report_open_lights(&self) {
        for (at, shapes, materials) in self.open_lights.values().filter(|(.., materials)| materials.len() > 1) {
            let count = materials.len();
            let message = format!(
                "`AreaLightSource` applies to all {shapes} shapes after it, which have {count} materials, because no \
                 `AttributeBegin` precedes it"
            );
            let warning = durer_diag::Diagnostic::warning(message).code("bad-place").at(*at);
            let help = "write `AttributeBegin` before this directive, and `AttributeEnd` after the shape of the light";
            self.report.push(warning.help(help));
        }
    }

    /// Warns about an area light that no shape follows in its scope. `outer` is the light of the
    /// enclosing scope, and `end` the directive that closes the scope.
    pub fn check_area_light(&self, outer: Option<&Rc<AreaLight>>, end: Option<(&str, Span)>) {
        let Some(light) = &self.state.area_light else { return };
        let is_outer = outer.is_some_and(|outer| (outer.at.file, outer.at.start) == (light.at.file, light.at.start));
        if is_outer || self.used_lights.contains(&(light.at.file, light.at.start)) {
            return;
        }
        let message = match end {
            Some((end, _)) => format!("this `AreaLightSource` has no shape: no `Shape` follows it before `{end}`"),
            None => "this `AreaLightSource` has no shape: no `Shape` follows it".to_string(),
        };
        let warning = durer_diag::Diagnostic::warning(message).code("bad-place").at(light.at);
        let warning = warning.effect("the light emits nothing").help("write it before its shape, in the same scope");
        self.report.push(match end {
            Some((_, at)) => warning.related(at, "the scope ends here"),
            None => warning,
        });
    }

    /// Warns about a material that no shape of its scope follows, but that a shape precedes.
    /// `outer` is the state of the enclosing scope, and `end` the directive that closes the scope.
    pub fn check_material(&self, outer: &State, (end, closed): (&str, Span)) {
        let place = |at: Option<Span>| at.map(|at| (at.file, at.start));
        let (own, before) = (self.state.material_at, self.state.shapes > outer.shapes);
        let Some(at) = own.filter(|_| before && place(own) != place(outer.material_at)) else { return };
        if self.used_materials.contains(&(at.file, at.start)) {
            return;
        }
        let message = format!("this material applies to no shape: no `Shape` follows it before `{end}`");
        let warning =
            durer_diag::Diagnostic::warning(message).code("bad-place").at(at).related(closed, "the scope ends here");
        let warning = warning.effect("the shape before it has another material");
        self.report.push(warning.help("write the material before its shape"));
    }

    /// Executes an `AreaLightSource` directive.
    pub fn area_light(&mut self, kind: &str, at: Span, list: Vec<Rc<Param>>) {
        let third = self.language == Language::V3;
        if kind != "diffuse" && !(third && kind == "area") {
            return self.report.error_with_help(
                at,
                format!("unknown area light `{kind}`"),
                Some("write `diffuse`".into()),
            );
        }
        let params = self.params(list, Some(LIGHT), at);
        let picture = if third { None } else { params.text("filename").map(str::to_string) };
        if picture.is_some() && params.get("L").is_some() {
            self.report.error(params.span("filename"), "a light takes either `L` or `filename`");
        }
        let light = AreaLight {
            radiance: color(&params, "L") * self.exposure(),
            power: if third { None } else { params.float("power").filter(|power| *power > 0.0) },
            two_sided: params.boolean("twosided").unwrap_or(false),
            picture,
            at,
            is_enclosed: !self.stack.is_empty(),
        };
        if third {
            params.mark_known(&["samples", "nsamples"]);
        }
        params.warn_unused("this light");
        if light.radiance == Vec3::ZERO {
            self.report.push(durer_diag::Diagnostic::note("this light is black").code("black-light").at(at));
        }
        self.state.area_light = Some(Rc::new(light));
    }
}
