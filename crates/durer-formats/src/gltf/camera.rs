//! Reads cameras, and the lights of KHR_lights_punctual.

use super::Model;
use super::json::JsonRef;
use super::nodes::NodeData;
use crate::named_choice::{NO_CAMERA, choose};
use durer_diag::Diagnostic;
use durer_scene::camera::{Camera, OrthographicCamera, PerspectiveCamera};
use durer_scene::light::{DirectionalLight, Light, PointLight, SpotLight};
use durer_scene::math::{Vec3, fp};
use durer_scene::scene::{Scene, Spanned};
use glam::{DAffine3, DVec3};
use std::f32::consts::PI;

/// Camera of a glTF file, before a node gives it a position.
#[derive(Clone)]
pub(super) struct CameraData {
    name: String,
    view: Projection,
}

/// Projection of a glTF camera.
#[derive(Clone, Copy)]
enum Projection {
    /// Vertical field of view in radians, and the aspect ratio if the file states one.
    Perspective(f32, Option<f32>),
    /// Half of the height of the view.
    Orthographic(f32),
}

/// Light of a glTF file, before a node gives it a position.
#[derive(Clone)]
pub(super) struct LightData {
    is_directional: bool,
    /// Inner and outer angles of the cone of a spot light, in degrees from its axis. The value is
    /// `None` if the light is not a spot light.
    cone: Option<[f32; 2]>,
    color: Vec3,
}

impl Model<'_> {
    /// Reads all cameras, and returns `None` in place of each invalid one.
    pub(super) fn read_cameras(&self, root: &JsonRef) -> Vec<Option<CameraData>> {
        root.list("cameras", |at| {
            at.object()?;
            let name = at.get("name").and_then(|name| name.value.as_str()).unwrap_or_default().to_string();
            if at.get("perspective").is_some() && at.get("orthographic").is_some() {
                at.error("ONE_OF_MISMATCH", "exactly one of `perspective` and `orthographic` must be defined");
            }
            let is_flat = at.required("type")?.word(&[("perspective", false), ("orthographic", true)])?;
            let lens = at.required(if is_flat { "orthographic" } else { "perspective" })?;
            let far = lens.get("zfar").and_then(|far| far.number_in(0.0..));
            if let (Some(far), Some(near)) = (far, lens.get("znear").and_then(|near| near.number_in(0.0..)))
                && far <= near
            {
                lens.error("CAMERA_ZFAR_LEQUAL_ZNEAR", format!("`zfar` {far} must be greater than `znear` {near}"));
            }
            let view = match is_flat {
                true => Projection::Orthographic(lens.required("ymag")?.number().filter(|half| *half != 0.0)?.abs()),
                false => {
                    let yfov = lens.required("yfov")?;
                    let angle = yfov.number_in(1e-4..)?;
                    if angle >= 180.0 {
                        yfov.warning("CAMERA_YFOV_GEQUAL_PI", "`yfov` must be less than pi");
                    } else if angle >= PI {
                        let radians = angle.to_radians();
                        let message = format!(
                            "`yfov` is in radians and must be less than pi; if {angle} is in degrees, write {radians:.3}"
                        );
                        yfov.warning("CAMERA_YFOV_GEQUAL_PI", message);
                    }
                    let aspect = lens.get("aspectRatio").and_then(|aspect| aspect.number_in(1e-4..));
                    Projection::Perspective(angle.min(3.1), aspect)
                }
            };
            Some(CameraData { name, view })
        })
    }

    /// Reads all lights of KHR_lights_punctual, and returns `None` in place of each invalid one.
    pub(super) fn read_lights(&self, root: &JsonRef) -> Vec<Option<LightData>> {
        let extensions = root.get("extensions");
        let Some(punctual) = extensions.as_ref().and_then(|e| e.get("KHR_lights_punctual")) else { return Vec::new() };
        punctual.list("lights", |at| {
            at.object()?;
            let kinds = [("directional", (true, false)), ("point", (false, false)), ("spot", (false, true))];
            let (is_directional, is_spot) = at.required("type")?.word(&kinds)?;
            let color = at.get("color").and_then(|color| color.numbers::<3>()).map_or(Vec3::ONE, Vec3::from_array);
            let intensity = at.get("intensity").and_then(|intensity| intensity.number_in(0.0..)).unwrap_or(1.0);
            let spot = if is_spot { at.required("spot") } else { None };
            let cone = spot.map(|spot| {
                let angle =
                    |name: &str, default: f32| spot.get(name).and_then(|a| a.number_in(0.0..)).unwrap_or(default);
                [angle("innerConeAngle", 0.0), angle("outerConeAngle", 0.25 * PI)].map(f32::to_degrees)
            });
            // Intensities are photometric, and a white diffuse surface reflects 1 / pi of the
            // incident light in each direction.
            Some(LightData { is_directional, cone, color: color * (intensity / PI) })
        })
    }

    /// Returns the nodes with cameras, in the order of their numbers.
    fn placed_cameras(&self, order: &[usize], nodes: &[NodeData]) -> Vec<(usize, &CameraData)> {
        order.iter().filter_map(|&i| Some((i, self.cameras[nodes[i].camera?].as_ref()?))).collect()
    }

    /// Returns the names of the cameras of the scene, in the order of their numbers.
    pub(super) fn camera_names(&self, order: &[usize], nodes: &[NodeData]) -> Vec<String> {
        let name = |(i, camera): (usize, &CameraData)| {
            [&nodes[i].name, &camera.name].into_iter().find(|name| !name.is_empty()).cloned().unwrap_or_default()
        };
        self.placed_cameras(order, nodes).into_iter().map(name).collect()
    }

    /// Returns the requested camera, or otherwise the first camera of the scene, and the index of
    /// its node.
    pub(super) fn camera(&self, order: &[usize], nodes: &[NodeData], maps: &[DAffine3]) -> Option<(Camera, usize)> {
        let there = self.placed_cameras(order, nodes);
        let names: Vec<_> = there.iter().map(|&(i, camera)| vec![&*nodes[i].name, &*camera.name]).collect();
        let chosen = choose("camera", &names, self.input.scene_defaults.camera.as_deref());
        let refuse = |message: String| self.report.report(Diagnostic::error, NO_CAMERA, "", &message);
        let index = chosen.map_err(refuse).ok()??;
        let (node, camera) = there[index];
        let map = maps[node];
        let direction = map.transform_vector3(DVec3::NEG_Z).normalize_or(DVec3::NEG_Z).as_vec3();
        let up = map.transform_vector3(DVec3::Y).normalize_or(DVec3::Y).as_vec3();
        let center = map.translation.as_vec3();
        // Angles and sizes in a Dürer scene are measured across the larger side of the picture.
        let own = if let Projection::Perspective(_, aspect) = camera.view { aspect } else { None };
        let wide = self.input.scene_defaults.aspect.or(own).unwrap_or(1.0).max(1.0);
        let camera = match camera.view {
            Projection::Perspective(angle, _) => {
                let half = fp::tan_f64(f64::from(angle) / 2.0) * f64::from(wide);
                let angle = (2.0 * fp::atan_f64(half)).to_degrees() as f32;
                PerspectiveCamera { center, direction, up, angle: angle.min(179.9) }.into()
            }
            Projection::Orthographic(half) => {
                OrthographicCamera { center, direction, up, size: 2.0 * half * wide, ..Default::default() }.into()
            }
        };
        Some((camera, node))
    }

    /// Adds the light of a node to the scene if the node has one.
    pub(super) fn light(&self, number: usize, node: &NodeData, map: DAffine3, scene: &mut Scene) {
        let Some(LightData { is_directional, cone, color }) = node.light.and_then(|i| self.lights[i].clone()) else {
            return;
        };
        let direction = map.transform_vector3(DVec3::NEG_Z).normalize_or(DVec3::NEG_Z).as_vec3();
        let position = map.translation.as_vec3();
        let value: Light = match (is_directional, cone) {
            (true, _) => DirectionalLight { direction, color, ..DirectionalLight::default() }.into(),
            (false, Some([inner_angle, angle])) => {
                let angle = angle.clamp(1e-3, 180.0);
                SpotLight { position, direction, color, angle, inner_angle, ..SpotLight::default() }.into()
            }
            (false, None) => PointLight { position, color, attenuation: Some(Vec3::Z), ..PointLight::default() }.into(),
        };
        scene.lights.get_or_insert_default().push(Spanned { value, span: self.report.node(number) });
    }
}
