//! Compilation of CSG solids. The parts of a solid must be closed.

use super::SceneFlattener;
use crate::world::csg::Csg;
use crate::world::solid::CsgTree;
use crate::world::{Geometry, Object};
use durer_diag::{Diagnostic, Span};
use durer_scene::math::Vec3;
use durer_scene::scene::{self, CsgOperation, Group, ObjectKind};
use durer_scene::shape::{Primitive, Shape};
use glam::DAffine3;
use std::sync::Arc;

impl SceneFlattener<'_, '_> {
    /// Compiles a solid that is either at the top level or part of a union.
    pub(super) fn solid(&mut self, span: Span, operation: CsgOperation, parts: &[scene::Object], to_world: DAffine3) {
        let (errors, before) = (self.diagnostics.error_count(), self.objects.len());
        self.check_count(span, operation, parts);
        if operation == CsgOperation::Union {
            return parts.iter().for_each(|part| self.part_of_union(part, to_world));
        }
        let solid = joined(operation, self.solids(parts, to_world));
        if self.diagnostics.error_count() > errors {
            return;
        }
        solid.into_iter().flat_map(CsgTree::pieces).for_each(|piece| self.piece(piece, span));
        if self.objects.len() == before && self.diagnostics.error_count() == errors {
            let message = format!("this `{}` is empty: its parts do not overlap", operation.keyword());
            self.diagnostics.push(Diagnostic::warning(message).code("empty-solid").at(span));
        }
    }

    /// Compiles a part of a union. The part becomes a separate object but must still be closed.
    fn part_of_union(&mut self, part: &scene::Object, to_world: DAffine3) {
        match &part.node {
            ObjectKind::Group(group) => {
                self.check_group(group, part.span);
                group.objects.iter().for_each(|inner| self.part_of_union(inner, to_world));
            }
            ObjectKind::Transform(ops, inner) => self.part_of_union(inner, to_world * self.product(ops)),
            ObjectKind::Solid(operation, parts) => self.solid(part.span, *operation, parts, to_world),
            _ => {
                let solid = self.closed(part, to_world);
                solid.into_iter().for_each(|solid| self.piece(solid, part.span));
            }
        }
    }

    /// Adds a piece of a solid as an object. The piece is disjoint from the other pieces.
    fn piece(&mut self, piece: CsgTree, span: Span) {
        if let CsgTree::Operand(object) = piece {
            return self.objects.push(Arc::unwrap_or_clone(object));
        }
        let (count, material) = {
            let parts = piece.parts();
            (parts.iter().map(|part| u64::from(part.parts())).sum::<u64>(), parts[0].material)
        };
        if count > Csg::MAX_PARTS {
            let message = format!("the parts of this solid have more than {} triangles", Csg::MAX_PARTS);
            self.diagnostics.push(Diagnostic::error(message).at(span));
            return;
        }
        let geometry = Geometry::Solid(Arc::new(Csg::new(piece)));
        let (to_world, matrices, center) = (None, Vec::new(), Vec3::ZERO);
        self.objects.push(Object { geometry, to_world, matrices, center, material, normal_length: 1.0, span });
    }

    /// Reports a solid without parts or a difference with only one part.
    fn check_count(&mut self, span: Span, operation: CsgOperation, parts: &[scene::Object]) {
        let name = operation.keyword();
        match parts.len() {
            0 => self.diagnostics.push(Diagnostic::error(format!("this `{name}` has no parts")).at(span)),
            1 if operation == CsgOperation::Difference => {
                let message = "this `Difference` removes nothing: it has only one part";
                self.diagnostics.push(Diagnostic::warning(message).at(span));
            }
            _ => {}
        }
    }

    /// Compiles the parts of a solid. The result omits parts with errors.
    fn solids(&mut self, parts: &[scene::Object], to_world: DAffine3) -> Vec<CsgTree> {
        parts.iter().filter_map(|part| self.closed(part, to_world)).collect()
    }

    /// Compiles a part of a solid, which must be closed. Returns `None` if there was an error.
    fn closed(&mut self, part: &scene::Object, to_world: DAffine3) -> Option<CsgTree> {
        match &part.node {
            ObjectKind::Group(group) => {
                self.check_group(group, part.span);
                Some(CsgTree::union(self.solids(&group.objects, to_world)))
            }
            ObjectKind::Transform(ops, inner) => self.closed(inner, to_world * self.product(ops)),
            ObjectKind::Solid(operation, parts) => {
                self.check_count(part.span, *operation, parts);
                joined(*operation, self.solids(parts, to_world))
            }
            ObjectKind::Primitive(shape) => {
                self.check_shape(shape, part.span);
                self.shape(part, to_world).map(|object| CsgTree::Operand(Arc::new(object)))
            }
            ObjectKind::Mesh(_) | ObjectKind::HeightField(_) | ObjectKind::Voxels(..) => {
                let object = self.shape(part, to_world)?;
                if let ObjectKind::Mesh(mesh) = &part.node {
                    self.check_mesh(&object, &mesh.obj_file.path, part.span);
                }
                Some(CsgTree::Operand(Arc::new(object)))
            }
        }
    }

    fn check_group(&mut self, group: &Group, span: Span) {
        if group.objects.is_empty() {
            self.diagnostics.push(Diagnostic::error("an empty `Group` cannot be part of a solid").at(span));
        }
    }

    /// Reports a shape that does not enclose a volume.
    fn check_shape(&mut self, shape: &Primitive, span: Span) {
        if shape.inside(glam::DVec3::ZERO).is_none() {
            let message = "a surface without an inside cannot be part of a solid";
            let help = "use closed shapes: a flat `Box` or `Cylinder`, for example, or a `Plane`, whose inside is the \
                        half space behind it";
            self.diagnostics.push(Diagnostic::error(message).code("open-solid").at(span).help(help));
        }
    }

    /// Reports a mesh that is not closed.
    fn check_mesh(&mut self, object: &Object, path: &str, span: Span) {
        let Geometry::Mesh(tree) = &object.geometry else { return };
        let edge = *self.open_edges.entry(path.to_string()).or_insert_with(|| tree.mesh.open_edges().first().copied());
        if let Some([p, q]) = edge {
            let message = format!("the mesh `{path}` is not closed and cannot be part of a solid");
            let text = |p: Vec3| format!("{} {} {}", p.x, p.y, p.z);
            let help = format!(
                "close the mesh; for example, the edge from {} to {} has an odd number of triangles",
                text(p),
                text(q)
            );
            self.diagnostics.push(Diagnostic::error(message).code("open-solid").at(span).help(help));
        }
    }
}

/// Combines solids with an operation. Returns `None` if there are no solids.
fn joined(operation: CsgOperation, mut parts: Vec<CsgTree>) -> Option<CsgTree> {
    if parts.is_empty() {
        return None;
    }
    Some(match operation {
        CsgOperation::Union | CsgOperation::Merge => CsgTree::union(parts),
        CsgOperation::Intersection => CsgTree::intersection(parts, Vec::new()),
        CsgOperation::Xor => CsgTree::xor(parts),
        CsgOperation::Difference => {
            let first = parts.remove(0);
            CsgTree::intersection(vec![first], parts)
        }
    })
}
