//! Validation of a scene, which checks every field against its constraint, and combinations of
//! fields.
//!
//! Readers check their input and report errors with spans. The check in this module is for scenes
//! that are built in code, and for formats whose readers do not check values.

use super::{Background, Group, Material, MatrixOp, NamedTexture, Object, ObjectKind, Scene, Spanned};
use crate::camera::Projection;
use crate::describe::{DescribedKind, Value};
use crate::dialect::{Dialect, Quirk, QuirkSet};
use crate::light::Illuminate;
use crate::material::Pattern;
use crate::medium::Fog;
use crate::shape::Shape;
use crate::texture::CieSky;
use crate::texture::sky::{SkyModel, hosek};
use durer_diag::{Diagnostic, Diagnostics, Span};

/// Maximum nesting depth of objects. The scene language allows 200 levels, each of which becomes at
/// most three levels in a scene.
pub const MAX_NESTING: usize = 640;

/// Maximum nesting depth of materials that are made of other materials, and maximum number of
/// leaves in one material.
const MAX_MATERIAL_NESTING: u32 = 64;
const MAX_MATERIAL_PARTS: u64 = 4096;

impl Scene {
    /// Checks all values. Each field is checked against its constraint, and numbers must be finite.
    /// Combinations of fields, the numbers of materials, and nesting depths are also checked. Only
    /// errors are reported. The compiler calls this method first.
    ///
    /// An object that was read from a file may have a material number that does not exist. In this
    /// case, the reader reports a warning, and the object is rendered in plain grey, as in the
    /// course's programs.
    pub fn validate(&self) -> Diagnostics {
        self.validate_as(0)
    }

    /// Version of [`Scene::validate`] that accepts all values that official programs render, if
    /// [`Quirk::AnyValues`] is set.
    pub fn validate_as(&self, compat: QuirkSet) -> Diagnostics {
        let accept_any = compat & Quirk::AnyValues.bit() != 0;
        let mut validator =
            Validator { diagnostics: Diagnostics::default(), materials: self.materials.len(), accept_any };
        if let Some(camera) = &self.camera {
            validator.check_fields(camera, self.camera_span, Projection::validate);
        }
        validator.check_fields(&self.background, self.background_span, Background::validate);
        if let Some(Spanned { value, span }) = &self.fog {
            validator.check_fields(value, *span, Fog::validate);
        }
        for Spanned { value, span } in self.lights.iter().flatten() {
            validator.check_fields(value, *span, Illuminate::validate);
        }
        self.materials.iter().for_each(|material| validator.material(material));
        validator.nested_materials(self);
        if let Some(root) = &self.root {
            validator.group(root, 1);
        }
        validator.assets(self);
        if self.lumens_per_watt.is_some_and(|lumens| !lumens.is_finite()) {
            validator.error("Scene: lumens must be finite", Span::default());
        }
        validator.diagnostics
    }
}

impl Background {
    /// Checks that the fields are valid in combination.
    ///
    /// # Errors
    ///
    /// Fails if the sun's position is given twice, is incomplete, or has an invalid time, if a
    /// standard sky depends on the sun but there is no sun, if the sky's model has no data for the
    /// turbidity, or if an all-weather sky has no irradiance.
    pub fn validate(&self) -> Result<(), String> {
        let sun = self.sun_direction()?;
        let lacks_sun = self.environment.is_none() && self.cie_sky.is_some_and(CieSky::depends_on_sun) && sun.is_none();
        if lacks_sun {
            return Err("this `cieSky` needs the position of the sun, but the background has no `sun`".into());
        }
        if self.sky_model == Some(SkyModel::Perez) {
            let lacks = [("directNormal", self.direct_normal), ("diffuseHorizontal", self.diffuse_horizontal)];
            if let Some((word, _)) = lacks.iter().find(|(_, value)| value.is_none()) {
                return Err(format!("`skyModel perez` needs `{word}`, an irradiance in W/m^2"));
            }
        }
        let (low, high) = hosek::TURBIDITIES.into_inner();
        match self.sky_model == Some(SkyModel::Hosek) && !(low..=high).contains(&self.turbidity()) {
            true => Err(format!("with `skyModel hosek`, `turbidity` must be from {low} to {high}")),
            false => Ok(()),
        }
    }
}

impl Fog {
    /// Checks that the fields are valid in combination.
    ///
    /// # Errors
    ///
    /// Fails if only one corner of the box is given, or if the box is empty.
    pub fn validate(&self) -> Result<(), String> {
        match (self.min, self.max) {
            (Some(min), Some(max)) if !min.cmplt(max).all() => {
                Err("each coordinate of the fog's `max` must be greater than the same coordinate of `min`".into())
            }
            (Some(_), None) | (None, Some(_)) => Err("a box of fog needs both `min` and `max`".into()),
            _ => Ok(()),
        }
    }
}

/// Checks the values of a scene and collects the errors, for [`Scene::validate`].
struct Validator {
    diagnostics: Diagnostics,
    /// Number of materials in the scene.
    materials: usize,
    /// True to accept values that official programs render.
    accept_any: bool,
}

impl Validator {
    fn error(&mut self, message: impl Into<String>, span: Span) {
        self.report(Diagnostic::error(message), span);
    }

    /// Reports an error with its span, if the error has one. Errors in scenes that are built in
    /// code have no span.
    fn report(&mut self, error: Diagnostic, span: Span) {
        let error = error.code("bad-value");
        self.diagnostics.push(if span.has_position() { error.at(span) } else { error });
    }

    /// Checks each field of an object. If all fields are valid, the method also checks them in
    /// combination.
    fn check_fields<T: DescribedKind>(
        &mut self,
        entry: &T,
        span: Span,
        together: impl FnOnce(&T) -> Result<(), String>,
    ) {
        let name = entry.keyword(Dialect::Durer);
        let mut is_valid = true;
        for (at, field) in entry.fields().iter().enumerate() {
            let Some(value) = entry.get(at) else { continue };
            if let Err(violation) = field.constraint.validate(&value) {
                if self.accept_any && field.quirk_value(name, &value).as_ref() == Some(&value) {
                    continue;
                }
                is_valid = false;
                self.error(format!("{name}: {}{} {violation}", field.name, format_value(&value)), span);
            }
        }
        if is_valid && let Err(message) = together(entry) {
            let error = Diagnostic::error(message);
            let lacks_sun = error.message.contains("`cieSky`");
            let help = "write `sun x y z`, the direction to the sun with y up; skies 1, 3, 5 and 16 need no sun";
            self.report(if lacks_sun { error.help(help) } else { error }, span);
        }
    }

    fn material(&mut self, material: &Spanned<Material>) {
        let span = material.span;
        match &material.value {
            Material::Phong(phong, noise) => {
                self.check_fields(&**phong, span, |_| Ok(()));
                if let Some(noise) = noise {
                    self.check_fields(noise, span, |_| Ok(()));
                }
            }
            Material::Principled(layers) => self.check_fields(&**layers, span, |_| Ok(())),
            Material::Hair(hair) => self.check_fields(hair, span, |_| Ok(())),
            Material::Solid(solid, ops) => {
                self.check_fields(solid, span, |_| Ok(()));
                self.matrices(ops, span);
            }
        }
    }

    /// Rejects materials that consist of themselves or of later materials, are nested too deeply,
    /// or have too many parts.
    fn nested_materials(&mut self, scene: &Scene) {
        // Nesting depth and maximum number of parts of each material.
        let mut sizes: Vec<(u32, u64)> = Vec::with_capacity(scene.materials.len());
        for material in &scene.materials {
            let Material::Solid(solid, _) = &material.value else {
                sizes.push((0, 1));
                continue;
            };
            let parts = solid.materials().map(|i| sizes.get(i as usize).copied());
            let [Some(first), Some(second)] = parts else {
                return self.error("a solid material can only use materials that precede it", material.span);
            };
            let (nesting, parts) = (1 + first.0.max(second.0), first.1 + second.1);
            if nesting > MAX_MATERIAL_NESTING || parts > MAX_MATERIAL_PARTS {
                let message = format!("this material is nested {nesting} levels deep and has {parts} parts");
                let help = format!("use at most {MAX_MATERIAL_NESTING} levels and {MAX_MATERIAL_PARTS} parts");
                return self.report(Diagnostic::error(message).help(help), material.span);
            }
            sizes.push((nesting, parts));
        }
    }

    fn group(&mut self, group: &Group, level: usize) {
        group.objects.iter().for_each(|object| self.object(object, level));
    }

    fn object(&mut self, object: &Object, level: usize) {
        let span = object.span;
        if level > MAX_NESTING {
            return self.error(format!("objects are nested more than {MAX_NESTING} levels deep"), span);
        }
        if let Some(index) = object.material
            && index as usize >= self.materials
            && !span.has_position()
        {
            let there = match self.materials {
                0 => "no materials".into(),
                1 => "only material 0".into(),
                count => format!("only {count} materials (0 to {})", count - 1),
            };
            self.error(format!("an object has material {index}, but the scene has {there}"), span);
        }
        match &object.node {
            ObjectKind::Group(group) => self.group(group, level + 1),
            ObjectKind::Transform(ops, inner) => {
                self.matrices(ops, span);
                self.object(inner, level + 1);
            }
            ObjectKind::Solid(_, parts) => parts.iter().for_each(|part| self.object(part, level + 1)),
            ObjectKind::Primitive(shape) => self.check_fields(shape, span, Shape::validate),
            ObjectKind::Mesh(mesh) => self.check_fields(mesh, span, |_| Ok(())),
            ObjectKind::HeightField(field) => self.check_fields(field, span, |field| field.validate()),
            ObjectKind::Voxels(grid, balls) => {
                self.check_fields(grid, span, |grid| grid.validate());
                balls.iter().for_each(|ball| self.check_fields(ball, span, Shape::validate));
            }
        }
    }

    fn matrices(&mut self, ops: &[MatrixOp], span: Span) {
        // A rotation about a NaN axis has a finite matrix, which is that of a rotation about y.
        // Therefore, check the axis as well.
        let is_finite = |op: &MatrixOp| match op {
            MatrixOp::Rotate(axis, _) => axis.is_finite() && op.matrix().is_finite(),
            _ => op.matrix().is_finite(),
        };
        if !ops.iter().all(is_finite) {
            self.error("the numbers of a transform must be finite", span);
        }
    }

    fn assets(&mut self, scene: &Scene) {
        for (name, mesh) in &scene.assets.meshes {
            if let Err(message) = mesh.validate() {
                self.error(format!("mesh `{name}`: {message}"), Span::default());
            }
        }
        for (name, picture) in &scene.assets.pictures {
            let texture = NamedTexture::with_mapping(name, picture.bytes.path(), picture.mapping);
            self.check_fields(&texture, Span::default(), |_| Ok(()));
        }
    }
}

/// Formats a short value for a message, with a leading space. Returns an empty string for rows.
fn format_value(value: &Value) -> String {
    match value {
        Value::Float(x) => format!(" {x}"),
        Value::Int(i) => format!(" {i}"),
        Value::Vec3(v) => format!(" {} {} {}", v.x, v.y, v.z),
        Value::Path(name) => format!(" {}", name.path),
        Value::Word(word) => format!(" {word}"),
        Value::Rows(_) => String::new(),
    }
}

#[cfg(test)]
mod tests;
