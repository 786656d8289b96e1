//! Parses meshes, the properties of their corners, and beam lattices.

use super::model::{Mesh, Property};
use super::parser::{ErrorReported, Parser};
use crate::report::range_text;
use crate::xml::Tag;
use durer_scene::math::Vec3;

impl Parser<'_, '_> {
    /// Parses a `<mesh>` element. `default` is the property of triangles that name none.
    pub fn mesh(&mut self, default: Option<Property>) -> Result<Mesh, ErrorReported> {
        let mut mesh = Mesh { default_property: default, ..Mesh::default() };
        while let Some(tag) = self.next()? {
            match tag.name {
                "vertices" => self.vertices(&mut mesh)?,
                "triangles" => {
                    mesh.at = tag.at;
                    self.triangles(&mut mesh)?;
                }
                "beamlattice" => self.lattice(&tag, &mut mesh)?,
                _ => self.skip()?,
            }
        }
        Ok(mesh)
    }

    fn vertices(&mut self, mesh: &mut Mesh) -> Result<(), ErrorReported> {
        while let Some(tag) = self.next()? {
            if tag.name == "vertex" {
                let coordinate = |name| {
                    if tag.get(name).is_none() {
                        self.report.error(tag.at, format!("a vertex needs `{name}=\"...\"`"));
                    }
                    self.number(&tag, name).unwrap_or(0.0)
                };
                mesh.positions.push(Vec3::new(coordinate("x"), coordinate("y"), coordinate("z")));
            }
            self.skip()?;
        }
        Ok(())
    }

    /// Reads a vertex index, which must be less than `count`.
    fn corner(&self, tag: &Tag, name: &str, count: usize) -> Option<u32> {
        let number = self.integer(tag, name)?;
        if number as usize >= count {
            let at = tag.get(name).map_or(tag.at, |attribute| attribute.at);
            let has = range_text(count, "vertex", "vertices");
            self.report.error(at, format!("vertex {number} does not exist: the mesh has {has}"));
            return None;
        }
        Some(number)
    }

    fn triangles(&mut self, mesh: &mut Mesh) -> Result<(), ErrorReported> {
        let count = mesh.positions.len();
        while let Some(tag) = self.next()? {
            self.skip()?;
            if tag.name != "triangle" {
                continue;
            }
            let [a, b, c] = ["v1", "v2", "v3"].map(|name| self.corner(&tag, name, count));
            let (Some(a), Some(b), Some(c)) = (a, b, c) else { continue };
            let property = self.property(&tag, mesh.default_property);
            if property.is_some() {
                mesh.properties.resize(mesh.triangles.len(), None);
                mesh.properties.push(property);
            }
            mesh.triangles.push([a, b, c]);
        }
        if !mesh.properties.is_empty() {
            mesh.properties.resize(mesh.triangles.len(), None);
        }
        Ok(())
    }

    /// Reads the properties of a triangle's corners; returns `None` if the triangle has none.
    fn property(&self, tag: &Tag, default: Option<Property>) -> Option<(u32, [u32; 3])> {
        let p1 = self.optional_number(tag, "p1")?;
        let Some(pid) = self.optional_number(tag, "pid").or(default.map(|default| default.0)) else {
            let at = tag.get("p1").map_or(tag.at, |attribute| attribute.at);
            self.report.error(at, "`p1` needs a `pid` of the triangle or of its object");
            return None;
        };
        let Some(count) = self.model.count(pid) else {
            let at = tag.get("pid").map_or(tag.at, |attribute| attribute.at);
            self.report.error(at, format!("no property list {pid} is defined before this point"));
            return None;
        };
        let corners = [Some(p1), self.optional_number(tag, "p2"), self.optional_number(tag, "p3")];
        let corners = corners.map(|corner| corner.unwrap_or(p1));
        if let Some(wrong) = corners.iter().find(|corner| **corner as usize >= count) {
            let has = range_text(count, "property", "properties");
            self.report.error(tag.at, format!("property {wrong} does not exist: the list {pid} has {has}"));
            return None;
        }
        Some((pid, corners))
    }

    fn lattice(&mut self, tag: &Tag, mesh: &mut Mesh) -> Result<(), ErrorReported> {
        let default = self.number(tag, "radius").unwrap_or(1.0);
        let count = mesh.positions.len();
        while let Some(part) = self.next()? {
            if part.name != "beams" {
                self.skip()?;
                continue;
            }
            while let Some(beam) = self.next()? {
                let first = self.number(&beam, "r1").unwrap_or(default);
                let radii = [first, self.number(&beam, "r2").unwrap_or(first)];
                let [a, b] = ["v1", "v2"].map(|name| self.corner(&beam, name, count));
                if radii.iter().any(|radius| *radius <= 0.0) {
                    self.report.error(beam.at, "the radius of a beam must be more than 0");
                } else if let (Some(a), Some(b)) = (a, b) {
                    mesh.beams.push(([a, b], radii));
                }
                self.skip()?;
            }
        }
        Ok(())
    }
}
