//! Controllers: skins, whose points follow joints.
//!
//! A point is the weighted sum over its joints of (joint) · (joint at binding)⁻¹ · (mesh at
//! binding) · point, in world space.

use super::document::Element;
use super::reader::Reader;
use super::transform::from_rows;
use durer_scene::math::Vec3;
use glam::{DAffine3, DMat3};
use std::collections::HashMap;

/// Transform of each point of a mesh.
pub(super) struct Skin {
    maps: Vec<DAffine3>,
}

impl Skin {
    /// Moves a point of the mesh.
    pub fn moved(&self, point: usize, position: Vec3) -> Vec3 {
        self.maps.get(point).map_or(position, |map| map.transform_point3(position.as_dvec3()).as_vec3())
    }

    /// Turns a normal at a point of the mesh.
    pub fn turned(&self, point: usize, normal: Vec3) -> Vec3 {
        let Some(map) = self.maps.get(point) else { return normal };
        // The cofactors are the inverse transpose, up to a factor.
        let DMat3 { x_axis, y_axis, z_axis } = map.matrix3;
        let cofactors = DMat3::from_cols(y_axis.cross(z_axis), z_axis.cross(x_axis), x_axis.cross(y_axis));
        let sign = if map.matrix3.determinant() < 0.0 { -1.0 } else { 1.0 };
        (sign * (cofactors * normal.as_dvec3())).as_vec3()
    }
}

impl<'r> Reader<'r> {
    /// Returns the geometry of a controller, and its skin. Morph targets are left out.
    pub fn controller(
        &mut self,
        instance: &'r Element<'r>,
        controller: &'r Element<'r>,
    ) -> Option<(&'r Element<'r>, Option<Skin>)> {
        let mut controller = controller;
        let mut skin = None;
        // A skin can use a morph, and the other way round.
        for _ in 0..8 {
            let own = controller.child("skin").or_else(|| controller.child("morph"))?;
            if own.name == "morph" {
                self.report.unsupported_once(own.at, "morph targets have no counterpart: they are left out");
            } else if skin.is_none() {
                skin = self.skin(instance, own);
            }
            let url = own.get("source")?.strip_prefix('#')?;
            match self.ids.get(url) {
                Some(next) if next.name == "controller" => controller = next,
                _ => return Some((self.referred(own, "source", "geometry")?, skin)),
            }
        }
        self.report.error(controller.at, "this controller uses itself");
        None
    }

    /// Returns the transform of each point, in world space.
    fn skin(&mut self, instance: &'r Element<'r>, skin: &'r Element<'r>) -> Option<Skin> {
        let (report, limits) = (self.report, self.limits);
        let shape = skin.child("bind_shape_matrix").and_then(|matrix| matrix.exactly(report, limits));
        let shape = shape.map_or(DAffine3::IDENTITY, from_rows);
        let joints = skin.child("joints")?;
        let weights = skin.child("vertex_weights")?;
        let input = |of: &'r Element<'r>, semantic: &str| {
            of.all("input").find(move |input| input.get("semantic") == Some(semantic))
        };
        let names = self.referred(input(joints, "JOINT")?, "source", "source")?;
        let list = names.child("Name_array").or_else(|| names.child("IDREF_array"))?;
        let binds = self.source(input(joints, "INV_BIND_MATRIX")?, 16)?;
        let places = self.joints(instance);
        let mut maps = Vec::new();
        for (i, name) in list.names().into_iter().enumerate() {
            let Some(place) = places.get(name).or_else(|| self.places.get(name)) else {
                let message = format!("the skeleton has no joint `{name}`: the mesh is shown without its skeleton");
                report.warn_once("bad-value", instance.at, message);
                return None;
            };
            limits.count_bytes_or_report(1, size_of::<DAffine3>(), report, skin.at).then_some(())?;
            let bind = from_rows(binds.vector::<16>(i).map(f64::from));
            maps.push(*place * bind * shape);
        }
        let weight_input = input(weights, "WEIGHT")?;
        let values = self.source(weight_input, 1)?;
        let offset = |input: Option<&Element>| {
            let offset = input.and_then(|input| input.get("offset")).and_then(|text| text.trim().parse::<usize>().ok());
            offset.unwrap_or(0).min(255)
        };
        let [joint_at, weight_at] = [offset(input(weights, "JOINT")), offset(Some(weight_input))];
        let stride = weights.all("input").map(|input| offset(Some(input))).max().unwrap_or(0) + 1;
        let counts = weights.child("vcount")?.integers(report, limits);
        let indices = weights.child("v")?.integers(report, limits);
        limits.count_bytes_or_report(counts.len(), size_of::<DAffine3>(), report, skin.at).then_some(())?;
        let mut rest = &indices[..];
        let mut points = Vec::with_capacity(counts.len());
        for count in counts {
            let Some((own, after)) = rest.split_at_checked((count as usize).saturating_mul(stride)) else {
                report.error(weights.at, "`vcount` lists more pairs of joint and weight than `v` has");
                return None;
            };
            rest = after;
            let (mut sum, mut total) = (DAffine3::ZERO, 0.0);
            for pair in own.chunks_exact(stride) {
                let [weight] = values.vector::<1>(pair[weight_at] as usize).map(f64::from);
                // The joint -1 is the mesh at binding.
                let map = maps.get(pair[joint_at] as usize).copied().unwrap_or(shape);
                sum.matrix3 += weight * map.matrix3;
                sum.translation += weight * map.translation;
                total += weight;
            }
            points.push(match total > 1e-6 {
                true => DAffine3 { matrix3: sum.matrix3 * (1.0 / total), translation: sum.translation / total },
                false => shape,
            });
        }
        Some(Skin { maps: points })
    }

    /// Returns the places of the joints below the skeletons that an instance names, by their sid
    /// and their id.
    fn joints(&self, instance: &'r Element<'r>) -> HashMap<&'r str, DAffine3> {
        let mut found = HashMap::new();
        let roots = instance.all("skeleton").filter_map(|root| self.ids.get(root.text().strip_prefix('#')?).copied());
        let mut left: Vec<&Element> = roots.collect();
        while let Some(node) = left.pop() {
            let Some(place) = self.world.get(&std::ptr::from_ref(node).addr()) else { continue };
            for name in [node.get("sid"), node.get("id")].into_iter().flatten() {
                found.entry(name).or_insert(*place);
            }
            left.extend(node.all("node"));
        }
        found
    }

    /// Remembers the place of each node of the visual scene.
    pub fn find_places(&mut self, scene: &'r Element<'r>) {
        let mut left: Vec<(&'r Element<'r>, DAffine3)> =
            scene.all("node").map(|node| (node, DAffine3::IDENTITY)).collect();
        while let Some((node, parent)) = left.pop() {
            let place = parent * self.local(node);
            if !self.limits.count_bytes_or_report(1, 4 * size_of::<DAffine3>(), self.report, node.at) {
                return;
            }
            self.world.insert(std::ptr::from_ref(node).addr(), place);
            for name in [node.get("sid"), node.get("id"), node.get("name")].into_iter().flatten() {
                self.places.entry(name).or_insert(place);
            }
            left.extend(node.all("node").map(|child| (child, place)));
        }
    }
}
