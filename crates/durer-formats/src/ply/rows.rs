//! Reads the vertices, faces, and triangle strips of a PLY file.

use super::body::{ErrorReported, RowReader};
use super::header::{Element, Property};
use super::values::{ValueError, ValueReader};
use crate::number::NumberError;
use crate::report::{quoted, range_text};
use durer_diag::did_you_mean;
use durer_image::decode_srgb;
use durer_scene::math::{Vec2, Vec3};
use durer_scene::shape::mesh::NO_INDEX;

/// Vertex properties that are read, each with all of its possible names, in the order in which a
/// [`Row`] stores them.
///
/// The last ten are Dürer extensions for other attributes of a mesh.
pub(super) const COLUMNS: [&[&str]; 22] = [
    &["x"],
    &["y"],
    &["z"],
    &["nx"],
    &["ny"],
    &["nz"],
    &["u", "s", "texture_u", "texture_s"],
    &["v", "t", "texture_v", "texture_t"],
    &["red", "r", "diffuse_red"],
    &["green", "g", "diffuse_green"],
    &["blue", "b", "diffuse_blue"],
    &["alpha", "a", "diffuse_alpha"],
    &["linear_red"],
    &["linear_green"],
    &["linear_blue"],
    &["linear_alpha"],
    &["second_u"],
    &["second_v"],
    &["tangent_x"],
    &["tangent_y"],
    &["tangent_z"],
    &["tangent_w"],
];

/// Values of one vertex: position, normal, texture coordinates, colour and opacity, linear colour
/// and opacity, second texture coordinates, and tangent.
type Row = [f32; COLUMNS.len()];

/// Names of the list that contains the vertices of a face.
pub(super) const CORNER_LISTS: [&str; 2] = ["vertex_indices", "vertex_index"];

impl<V: ValueReader> RowReader<'_, '_, V> {
    /// Returns the column of a [`Row`] that each property is read into; `None` if a property is not
    /// read.
    fn columns(&mut self, element: &Element) -> Result<Vec<Option<usize>>, ErrorReported> {
        let mut columns = vec![None; element.properties.len()];
        let mut found: [Option<usize>; COLUMNS.len()] = [None; COLUMNS.len()];
        for (i, property) in element.properties.iter().enumerate() {
            let name = &self.bytes[property.name.clone()];
            let Some(column) = COLUMNS.iter().position(|names| names.iter().any(|n| n.as_bytes() == name)) else {
                continue;
            };
            // A list that has the name of a colour has a different meaning.
            if property.length_type.is_some() && column >= 8 {
                continue;
            }
            if property.length_type.is_some() {
                self.report.error(property.name.clone(), format!("{} must be a number, not a list", quoted(name)));
            }
            match found[column] {
                // Some files contain two sets of texture coordinates, of which the first is used.
                Some(_) if column >= 6 => continue,
                Some(first) => {
                    let first = self.report.span(element.properties[first].name.clone());
                    let message = format!("the element `vertex` has a second property {}", quoted(name));
                    self.report.error(property.name.clone(), message).related =
                        Some((first, "the first one is here".into()));
                }
                None => found[column] = Some(i),
            }
            columns[i] = Some(column);
        }
        for (names, _) in COLUMNS[..3].iter().zip(found).filter(|(_, found)| found.is_none()) {
            self.report.error(element.name.clone(), format!("the vertices have no property `{}`", names[0]));
        }
        if self.report.has_errors() { Err(ErrorReported) } else { Ok(columns) }
    }

    /// Reads the rows of the `vertex` element.
    pub(super) fn read_vertices(&mut self, element: &Element) -> Result<(), ErrorReported> {
        let columns = self.columns(element)?;
        if self.fixed_vertices(element, &columns).is_some() {
            return Ok(());
        }
        let has = |range: std::ops::Range<usize>| range.clone().all(|column| columns.contains(&Some(column)));
        let (has_normals, has_uvs, has_colors) = (has(3..6), has(6..8), has(8..11));
        let (has_linear, has_second, has_tangents) = (has(12..16), has(16..18), has(18..22));
        // Integer colours are fractions of the maximum value of their type.
        let most = |column: usize| {
            let at = columns.iter().position(|found| *found == Some(column));
            at.map_or(1.0, |at| element.properties[at].number_type.full_intensity())
        };
        let most: [f32; 4] = std::array::from_fn(|i| most(8 + i));
        let rows = self.likely_rows(element);
        self.mesh.positions.reserve_exact(rows);
        self.mesh.normals.reserve_exact(if has_normals { rows } else { 0 });
        self.mesh.uvs.reserve_exact(if has_uvs { rows } else { 0 });
        self.mesh.colors.reserve_exact(if has_colors || has_linear { rows } else { 0 });
        for row in 0..element.rows {
            let mut values: Row = [0.0; COLUMNS.len()];
            for (property, &column) in element.properties.iter().zip(&columns) {
                let Some(column) = column else {
                    self.skip_property(element, row, property)?;
                    continue;
                };
                match self.values.float(property.number_type) {
                    Ok(value) => values[column] = value,
                    Err(ValueError::Number(NumberError::NotFinite)) if (8..12).contains(&column) => {
                        values[column] = 1.0
                    }
                    Err(error) => self.report_and_continue(error, element, row)?,
                }
            }
            let [x, y, z, nx, ny, nz, u, v, color @ ..] = values;
            let [_, _, _, _, red, green, blue, alpha, second_u, second_v, tangent @ ..] = color;
            self.mesh.positions.push(Vec3::new(x, y, z));
            if has_normals {
                self.mesh.normals.push(Vec3::new(nx, ny, nz));
            }
            if has_uvs {
                self.mesh.uvs.push(Vec2::new(u, v));
            }
            if has_second {
                self.mesh.second_uvs.push(Vec2::new(second_u, second_v));
            }
            if has_tangents {
                self.mesh.tangents.push(tangent);
            }
            if has_linear {
                self.mesh.colors.push([red, green, blue, alpha]);
            } else if has_colors {
                let share = |i: usize| (color[i] / most[i]).clamp(0.0, 1.0);
                let light = |i: usize| decode_srgb((share(i) * 255.0 + 0.5) as u8);
                let opacity = if columns.contains(&Some(11)) { share(3) } else { 1.0 };
                self.mesh.colors.push([light(0), light(1), light(2), opacity]);
            }
        }
        Ok(())
    }

    /// Reads faces or triangle strips, depending on the name of the element.
    pub(super) fn read_faces(&mut self, element: &Element) -> Result<(), ErrorReported> {
        if element.rows == 0 {
            return Ok(());
        }
        let strips = &self.bytes[element.name.clone()] == b"tristrips";
        let list = self.corner_list(element)?;
        let colors = self.color_columns(element);
        if !strips && colors.is_none() && self.fixed_faces(element, list).is_some() {
            return Ok(());
        }
        if !strips {
            let likely = self.likely_rows(element);
            self.mesh.triangles.reserve(likely);
        }
        for row in 0..element.rows {
            let (mut color, count) = ([1.0; 4], self.mesh.triangles.len());
            for (i, property) in element.properties.iter().enumerate() {
                if i != list {
                    let channel = colors.and_then(|colors| colors.iter().position(|column| *column == Some(i)));
                    match channel {
                        Some(channel) => color[channel] = self.intensity(element, row, property)?,
                        None => self.skip_property(element, row, property)?,
                    }
                    continue;
                }
                // An invalid vertex index has already been reported, so skip the face.
                match self.read_corners(element, row, list, strips)? {
                    true if strips => self.split_strip(),
                    true => self.cut_face()?,
                    false => {}
                }
            }
            if colors.is_some() {
                let [r, g, b, alpha] = color;
                let color = [r, g, b].map(|share| decode_srgb((share * 255.0 + 0.5) as u8));
                // Faces of an earlier element without colours are white.
                self.face_colors.resize(count, [1.0; 4]);
                self.face_colors.resize(self.mesh.triangles.len(), [color[0], color[1], color[2], alpha]);
            }
        }
        Ok(())
    }

    /// Returns the properties of an element that hold red, green, blue and, if there is one, alpha;
    /// `None` without colours.
    fn color_columns(&self, element: &Element) -> Option<[Option<usize>; 4]> {
        let column = |names: &[&str]| {
            let is_named = |property: &Property| {
                let name = &self.bytes[property.name.clone()];
                property.length_type.is_none() && names.iter().any(|known| known.as_bytes() == name)
            };
            element.properties.iter().position(is_named)
        };
        let columns: [Option<usize>; 4] = std::array::from_fn(|channel| column(COLUMNS[8 + channel]));
        columns[..3].iter().all(Option::is_some).then_some(columns)
    }

    /// Reads a channel of a colour, from 0 to 1.
    fn intensity(&mut self, element: &Element, row: u64, property: &Property) -> Result<f32, ErrorReported> {
        match self.values.float(property.number_type) {
            Ok(value) => Ok((value / property.number_type.full_intensity()).clamp(0.0, 1.0)),
            Err(ValueError::Number(NumberError::NotFinite)) => Ok(1.0),
            Err(error) => self.report_and_continue(error, element, row).map(|()| 1.0),
        }
    }

    /// Returns the index of the property that lists the vertices of a face.
    fn corner_list(&mut self, element: &Element) -> Result<usize, ErrorReported> {
        let named = |i: &usize| {
            CORNER_LISTS.iter().any(|list| list.as_bytes() == &self.bytes[element.properties[*i].name.clone()])
        };
        let Some(list) = (0..element.properties.len()).find(named) else {
            // Suggest a list that has a similar name.
            let text = |p: &Property| String::from_utf8_lossy(&self.bytes[p.name.clone()]);
            let near = element.properties.iter().find(|p| did_you_mean(&text(p), CORNER_LISTS).is_some());
            let help = near.map(|p| format!("rename {} to `vertex_indices`", quoted(&self.bytes[p.name.clone()])));
            let message =
                format!("the element {} has no list `vertex_indices`", quoted(&self.bytes[element.name.clone()]));
            self.report.error(near.map_or(element.name.clone(), |p| p.name.clone()), message).help = help;
            return Err(ErrorReported);
        };
        let property = &element.properties[list];
        if property.length_type.is_none() || !property.number_type.is_integer() {
            self.report.error(property.name.clone(), "the vertex indices must be a list with an integer type");
            return Err(ErrorReported);
        }
        Ok(list)
    }

    /// Reads the vertex indices of one face; returns `false` if one of them is invalid.
    fn read_corners(&mut self, element: &Element, row: u64, list: usize, strips: bool) -> Result<bool, ErrorReported> {
        let property = &element.properties[list];
        let length = self.list_length(element, row, property)?;
        let length_at = self.values.last();
        self.corners.clear();
        self.corners.reserve(length);
        let vertices = self.mesh.positions.len();
        let mut all_good = true;
        for _ in 0..length {
            match self.values.integer(property.number_type) {
                Ok(index) if (0..vertices as i64).contains(&index) => self.corners.push(index as u32),
                Ok(-1) if strips => self.corners.push(NO_INDEX),
                Ok(index) => {
                    all_good = false;
                    let has = range_text(vertices, "vertex", "vertices");
                    let message = format!("vertex {index} does not exist: the file has {has}");
                    self.report.error(self.values.last(), message);
                    if self.report.is_full() {
                        return Err(ErrorReported);
                    }
                }
                Err(error) => {
                    all_good = false;
                    self.report_and_continue(error, element, row)?;
                }
            }
        }
        if length < 3 && !strips {
            self.report.error(length_at, format!("a face needs at least 3 vertices, found {length}"));
            return if self.report.is_full() { Err(ErrorReported) } else { Ok(false) };
        }
        Ok(all_good)
    }

    fn cut_face(&mut self) -> Result<(), ErrorReported> {
        let (corners, positions, triangles) = (&self.corners, &self.mesh.positions, &mut self.mesh.triangles);
        let position = |i: usize| positions[corners[i] as usize];
        let cut = self
            .triangulator
            .triangulate(corners.len(), position, |triangle| triangles.push(triangle.map(|i| corners[i])));
        cut.map_err(|_| {
            let message = format!("this face is too complex to triangulate ({} vertices)", self.corners.len());
            self.report.error(self.values.last(), message).help =
                Some("triangulate the face in a modelling program".into());
            ErrorReported
        })
    }

    /// Splits a strip into triangles. Each corner forms a triangle with the two corners before it,
    /// and the winding alternates from one triangle to the next.
    fn split_strip(&mut self) {
        for strip in self.corners.split(|&corner| corner == NO_INDEX) {
            for (i, window) in strip.windows(3).enumerate() {
                let [a, b, c] = [window[0], window[1], window[2]];
                // Degenerate triangles serve only to join strips, so skip them.
                if a != b && b != c && a != c {
                    self.mesh.triangles.push(if i % 2 == 0 { [a, b, c] } else { [b, a, c] });
                }
            }
        }
    }
}
