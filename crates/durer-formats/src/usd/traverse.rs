//! Traversal of the prims, which adds objects, lights and cameras to the scene.

use super::primvar::DISPLAY_COLOR;
use super::reader::{Inherited, Reader};
use super::skel::binding;
use super::stage::Prim;
use super::transform::local_transform;
use durer_scene::scene::Object;
use std::rc::Rc;

/// Maximum nesting depth of prims.
const MAX_DEPTH: u32 = 256;

impl Reader<'_, '_> {
    /// Adds a prim and its descendants.
    pub fn visit(&mut self, prim: &Prim, inherited: &Inherited, objects: &mut Vec<Object>, depth: u32) {
        let report = self.stage.files.report;
        if report.is_full() {
            return;
        }
        if depth > MAX_DEPTH {
            return report.error(prim.span(), format!("prims are nested more than {MAX_DEPTH} deep"));
        }
        let (local, resets) = local_transform(self.stage, prim);
        let mut here = inherited.clone();
        here.to_world = if resets { local } else { inherited.to_world * local };
        if let Some((material, is_stronger)) = self.bound_material(prim).filter(|_| !inherited.is_stronger) {
            (here.material, here.is_stronger) = (Some(material), is_stronger);
        }
        here.skeleton = binding(prim, inherited);
        let type_name = prim.type_name().to_string();
        // Materials and skeletons have no visible descendants.
        if matches!(
            type_name.as_str(),
            "Material" | "Shader" | "NodeGraph" | "Skeleton" | "SkelAnimation" | "GeomSubset"
        ) {
            return;
        }
        if prim.property_names().contains(DISPLAY_COLOR) && !is_shape(&type_name) {
            here.display = Some(Rc::new(prim.clone()));
        }
        if type_name == "Camera" {
            // An invisible camera can be used.
            self.read_camera(prim, here.to_world);
        }
        if self.text(prim, "visibility").as_deref() == Some("invisible") {
            self.invisible.push((prim.span(), "visibility", "invisible"));
            return;
        }
        let purpose = self.text(prim, "purpose");
        if let Some(left_out) = ["proxy", "guide"].into_iter().find(|word| purpose.as_deref() == Some(*word)) {
            self.invisible.push((prim.span(), "purpose", left_out));
            return;
        }
        if type_name == "PointInstancer" {
            return self.instances(prim, &here, objects, depth);
        }
        self.shape(prim, &type_name, &here, objects);
        for child in self.stage.children(prim) {
            self.visit(&child, &here, objects, depth + 1);
        }
    }

    /// Adds the shape, the light or nothing of a prim.
    fn shape(&mut self, prim: &Prim, type_name: &str, here: &Inherited, objects: &mut Vec<Object>) {
        let report = self.stage.files.report;
        match type_name {
            "Mesh" => self.mesh(prim, here, objects),
            "Sphere" | "Cube" | "Cylinder" | "Cylinder_1" | "Cone" | "Capsule" | "Capsule_1" | "Plane" => {
                self.simple_shape(prim, type_name.trim_end_matches("_1"), here, objects);
            }
            "Points" => self.points(prim, here, objects),
            "BasisCurves" => self.curves(prim, here, objects),
            "DistantLight" | "SphereLight" | "RectLight" | "DiskLight" | "CylinderLight" | "DomeLight"
            | "DomeLight_1" => self.light(prim, type_name, here.to_world, objects),
            "NurbsPatch" | "NurbsCurves" | "HermiteCurves" | "TetMesh" | "Volume" | "GeometryLight" | "PluginLight"
            | "PortalLight" => {
                report.unsupported_once(prim.span(), format!("a {type_name} has no counterpart: it is left out"));
            }
            _ => {}
        }
        if prim.has_api("MeshLightAPI") {
            report.unsupported_once(prim.span(), "the light of a mesh with MeshLightAPI is left out");
        }
        if !prim.targets("skel:blendShapeTargets").is_empty() {
            report.unsupported_once(prim.span(), "blend shapes have no counterpart: they are left out");
        }
    }
}

/// Returns true for prims with geometry, whose display colour can vary over their surface.
fn is_shape(type_name: &str) -> bool {
    matches!(
        type_name,
        "Mesh"
            | "Sphere"
            | "Cube"
            | "Cylinder"
            | "Cylinder_1"
            | "Cone"
            | "Capsule"
            | "Capsule_1"
            | "Plane"
            | "Points"
            | "BasisCurves"
    )
}
