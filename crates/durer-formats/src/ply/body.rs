//! Reads the rows of a PLY file, and decides which elements to read and in which order.

use super::header::{Element, Property};
use super::values::{ValueError, ValueReader};
use crate::face_colors::color_faces;
use crate::number::{NumberError, report_number};
use crate::polygon::Triangulator;
use crate::report::{Report, count_text, quoted};
use durer_scene::shape::mesh::MeshData;
use std::ops::Range;

/// Error type of the PLY reader, which means that reading cannot continue and that the error has
/// already been reported.
pub(super) struct ErrorReported;

/// Reader that converts the rows of all elements in a PLY file to a mesh.
pub(super) struct RowReader<'a, 'r, V> {
    pub bytes: &'a [u8],
    pub report: &'r mut Report,
    pub values: V,
    pub mesh: MeshData,
    pub triangulator: Triangulator,
    /// Corners of the current face or triangle strip.
    pub corners: Vec<u32>,
    /// Colour of each triangle; empty if faces have no colours.
    pub face_colors: Vec<[f32; 4]>,
}

impl<'a, 'r, V: ValueReader> RowReader<'a, 'r, V> {
    pub fn new(bytes: &'a [u8], values: V, report: &'r mut Report) -> Self {
        let triangulator = Triangulator::new(bytes.len());
        let (mesh, corners, face_colors) = (MeshData::default(), Vec::new(), Vec::new());
        RowReader { bytes, report, values, mesh, triangulator, corners, face_colors }
    }

    /// Reads all elements, starting with the vertices, wherever they are in the file.
    pub fn read(mut self, elements: &[Element]) -> Option<MeshData> {
        self.read_elements(elements).ok()?;
        Some(self.mesh)
    }

    fn read_elements(&mut self, elements: &[Element]) -> Result<(), ErrorReported> {
        let mut has_vertices = false;
        // Faces that come before the vertices are skipped here and read at the end.
        let mut later: Vec<(&Element, V)> = Vec::new();
        for element in elements {
            self.check_rows(element)?;
            match &self.bytes[element.name.clone()] {
                b"vertex" if has_vertices => {
                    self.report.error(
                        element.name.clone(),
                        "a file can have only one element `vertex`, and this is the second",
                    );
                    return Err(ErrorReported);
                }
                b"vertex" => {
                    self.read_vertices(element)?;
                    has_vertices = true;
                }
                b"face" | b"tristrips" if has_vertices => self.read_faces(element)?,
                b"face" | b"tristrips" => {
                    later.push((element, self.values.clone()));
                    self.skip_rows(element)?;
                }
                _ => self.skip_rows(element)?,
            }
        }
        if !has_vertices {
            let first = elements.first().map_or(0..0, |element| element.name.clone());
            self.report.error(first, "the file has no element `vertex`");
            return Err(ErrorReported);
        }
        self.check_remainder();
        for (element, values) in later {
            self.values = values;
            self.read_faces(element)?;
        }
        let MeshData { uvs, normals, triangles, triangle_uvs, triangle_normals, .. } = &mut self.mesh;
        // Texture coordinates and normals are stored per vertex, so they have the same indices as
        // the vertices.
        if !uvs.is_empty() {
            triangle_uvs.clone_from(triangles);
        }
        if !normals.is_empty() {
            triangle_normals.clone_from(triangles);
        }
        color_faces(&mut self.mesh, &self.face_colors);
        Ok(())
    }

    /// Reports an element whose rows cannot all fit into the rest of the file.
    fn check_rows(&mut self, element: &Element) -> Result<(), ErrorReported> {
        let sizes = element.properties.iter().map(|p| p.length_type.map_or(V::fixed_size(p.number_type), |_| None));
        let Some(size) = sizes.sum::<Option<usize>>() else { return Ok(()) };
        let left = self.values.remainder().len();
        if (left as u64) < element.rows.saturating_mul(size as u64) {
            let what = quoted(&self.bytes[element.name.clone()]);
            let message = format!(
                "the header declares {} rows of {size} bytes for element {what}, but only {left} bytes follow",
                element.rows
            );
            let end = self.bytes.len();
            let here = self.report.span(element.name.clone());
            self.report.error(end..end, message).related = Some((here, "the rows are declared here".into()));
            return Err(ErrorReported);
        }
        Ok(())
    }

    /// Returns the number of rows that the header promises, limited by what the size of the file
    /// allows. The result is used to reserve memory.
    pub fn likely_rows(&self, element: &Element) -> usize {
        // Even an empty list stores its length, and a value in a text file takes at least one digit
        // and one space.
        let smallest = |p: &Property| V::fixed_size(p.length_type.unwrap_or(p.number_type)).unwrap_or(2);
        let row = element.properties.iter().map(smallest).sum::<usize>().max(1);
        element.rows.min((self.values.remainder().len() / row + 1) as u64) as usize
    }

    fn skip_rows(&mut self, element: &Element) -> Result<(), ErrorReported> {
        // Rows without properties take no bytes, so a header can promise any number of them.
        if element.properties.is_empty() {
            return Ok(());
        }
        for row in 0..element.rows {
            for property in &element.properties {
                self.skip_property(element, row, property)?;
            }
        }
        Ok(())
    }

    /// Skips the value or list that a property has in one row.
    pub fn skip_property(&mut self, element: &Element, row: u64, property: &Property) -> Result<(), ErrorReported> {
        let count = match property.length_type {
            Some(_) => self.list_length(element, row, property)?,
            None => 1,
        };
        self.values.skip(property.number_type, count).map_err(|error| self.fail(error, element, row))
    }

    /// Reads the length of a list and checks that this many values can fit into the rest of the
    /// file.
    pub fn list_length(&mut self, element: &Element, row: u64, property: &Property) -> Result<usize, ErrorReported> {
        let Some(scalar) = property.length_type else { return Ok(1) };
        let length = self.values.integer(scalar).map_err(|error| self.fail(error, element, row))?;
        let most = self.values.most_left(property.number_type);
        match usize::try_from(length) {
            Ok(length) if length <= most => Ok(length),
            Ok(_) => {
                let message = format!("the list should have {length} values, but the file ends before the last value");
                self.report.error(self.values.last(), message);
                Err(ErrorReported)
            }
            Err(_) => {
                let message = format!("a list cannot have a negative number of values: {length}");
                self.report.error(self.values.last(), message);
                Err(ErrorReported)
            }
        }
    }

    /// Reports a missing or invalid value. The caller must stop reading unless it can skip the
    /// value.
    pub fn fail(&mut self, error: ValueError, element: &Element, row: u64) -> ErrorReported {
        let at = self.values.last();
        match error {
            ValueError::End => {
                let name = quoted(&self.bytes[element.name.clone()]);
                let rows = count_text(element.rows as usize, "row", "rows");
                let message = format!("the file ends in row {} of element {name}, which should have {rows}", row + 1);
                let promised = self.report.span(element.name.clone());
                self.report.error(at, message).related = Some((promised, "the rows are declared here".into()));
            }
            ValueError::Number(error) => self.wrong_number(error, at),
        }
        ErrorReported
    }

    /// Reports an invalid value and continues, unless the file has ended or no more errors can be
    /// reported.
    pub fn report_and_continue(&mut self, error: ValueError, element: &Element, row: u64) -> Result<(), ErrorReported> {
        let stop = self.fail(error, element, row);
        if error == ValueError::End || self.report.is_full() { Err(stop) } else { Ok(()) }
    }

    fn wrong_number(&mut self, error: NumberError, at: Range<usize>) {
        let value = &self.bytes[at.clone()];
        // The raw bytes of a binary value would not help the user.
        if V::fixed_size(super::header::NumberType::U8).is_some() {
            self.report.error(at, "expected a finite number, found an infinite value or NaN").help =
                Some("numbers must lie within the range of 32-bit floating point, about ±3.4e38".into());
        } else {
            report_number(self.report, error, at.clone(), value);
        }
    }

    fn check_remainder(&mut self) {
        let rest = self.values.remainder();
        if !rest.is_empty() {
            let bytes = count_text(rest.len(), "byte", "bytes");
            self.report.warning(rest.start..rest.start + 1, format!("ignored {bytes} after the last row")).help =
                Some("check whether the header declares too few rows or properties".into());
        }
    }
}
