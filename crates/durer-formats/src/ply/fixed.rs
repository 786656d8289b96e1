//! Fast reader for binary rows of a fixed size, which nearly all large files have.
//!
//! Rows that are invalid or vary in size are left to the slower reader of single rows, which
//! reports the errors.

use super::body::RowReader;
use super::header::{Element, NumberType};
use super::rows::COLUMNS;
use super::values::ValueReader;
use durer_scene::math::{Vec2, Vec3};
use rayon::prelude::*;

/// Number of rows that one parallel task reads. This many rows fit into a core's cache while their
/// columns are read one after another.
const BLOCK: usize = 1 << 11;

/// Binary rows of one PLY element that all have the same size.
struct Rows<'a> {
    bytes: &'a [u8],
    /// Size of each row in bytes.
    size: usize,
    big_endian: bool,
}

/// Visits a column of numbers of one type and returns true if all of them are valid.
macro_rules! column {
    ($rows:expr, $at:expr, $number:ty, |$i:ident, $value:ident| $is_good:expr) => {{
        let (rows, mut good) = ($rows, true);
        for ($i, row) in rows.bytes.chunks_exact(rows.size).enumerate() {
            let Some(&bytes) = row[$at..].first_chunk() else { return false };
            let $value =
                if rows.big_endian { <$number>::from_be_bytes(bytes) } else { <$number>::from_le_bytes(bytes) };
            good &= $is_good;
        }
        good
    }};
}

/// Type of a number, and its byte offset within a row.
type NumberLayout = (NumberType, usize);

impl Rows<'_> {
    /// Reads `N` numbers from each row; returns `None` if any of them is not finite.
    fn gather<const N: usize>(&self, places: [NumberLayout; N]) -> Option<Vec<[f32; N]>> {
        let mut all = vec![[0.0; N]; self.bytes.len() / self.size];
        let blocks = all.par_chunks_mut(BLOCK).zip(self.bytes.par_chunks(BLOCK * self.size));
        let sound = blocks.map(|(block, bytes)| {
            let rows = Rows { bytes, ..*self };
            (0..N).all(|k| rows.each(places[k], |i, value| block[i][k] = value))
        });
        sound.all(|sound| sound).then_some(all)
    }

    /// Reads `N` numbers from each row; returns an empty list if one of the columns is missing.
    fn all<const N: usize>(&self, places: &[Option<NumberLayout>]) -> Option<Vec<[f32; N]>> {
        let places: Option<Vec<NumberLayout>> = places.iter().copied().collect();
        match places.and_then(|places| places.try_into().ok()) {
            Some(places) => self.gather::<N>(places),
            None => Some(Vec::new()),
        }
    }

    /// Passes one number from each row to `put`; returns true if all of them are finite.
    fn each(&self, (scalar, at): NumberLayout, mut put: impl FnMut(usize, f32)) -> bool {
        macro_rules! read {
            ($number:ty) => {
                column!(self, at, $number, |i, number| {
                    let value = number as f32;
                    put(i, value);
                    value.is_finite()
                })
            };
        }
        match scalar {
            NumberType::I8 => read!(i8),
            NumberType::U8 => read!(u8),
            NumberType::I16 => read!(i16),
            NumberType::U16 => read!(u16),
            NumberType::I32 => read!(i32),
            NumberType::U32 => read!(u32),
            NumberType::F32 => read!(f32),
            NumberType::F64 => read!(f64),
        }
    }

    /// Reads three vertex indices of each row from the list at the given position; returns `None`
    /// if a list has another length or if an index is not less than `vertices`.
    fn triangles(&self, count: NumberLayout, corners: NumberType, vertices: usize) -> Option<Vec<[u32; 3]>> {
        let mut all = vec![[0; 3]; self.bytes.len() / self.size];
        let first = count.1 + count.0.size();
        let blocks = all.par_chunks_mut(BLOCK).zip(self.bytes.par_chunks(BLOCK * self.size));
        let sound = blocks.map(|(block, bytes)| {
            let rows = Rows { bytes, ..*self };
            let mut corner = |k: usize| {
                rows.all_integers((corners, first + k * corners.size()), |i, corner| {
                    block[i][k] = corner as u32;
                    (0..vertices as i64).contains(&corner)
                })
            };
            rows.all_integers(count, |_, length| length == 3) && (0..3).all(&mut corner)
        });
        sound.all(|sound| sound).then_some(all)
    }

    /// Passes one integer from each row to `is_good`; returns true if it accepts all of them.
    fn all_integers(&self, (scalar, at): NumberLayout, mut is_good: impl FnMut(usize, i64) -> bool) -> bool {
        macro_rules! read {
            ($number:ty) => {
                column!(self, at, $number, |i, number| is_good(i, number.into()))
            };
        }
        match scalar {
            NumberType::I8 => read!(i8),
            NumberType::U8 => read!(u8),
            NumberType::I16 => read!(i16),
            NumberType::U16 => read!(u16),
            NumberType::I32 => read!(i32),
            NumberType::U32 => read!(u32),
            NumberType::F32 | NumberType::F64 => false,
        }
    }
}

impl<V: ValueReader> RowReader<'_, '_, V> {
    /// Returns the rows of an element, each `size` bytes long, if the file contains all of them.
    fn rows(&self, element: &Element, size: usize) -> Option<Rows<'_>> {
        let big_endian = V::BIG_ENDIAN?;
        let left = &self.bytes[self.values.remainder()];
        let length = usize::try_from(element.rows).ok()?.checked_mul(size)?;
        Some(Rows { bytes: left.get(..length).filter(|_| size > 0)?, size, big_endian })
    }

    /// Reads all vertices at once; returns `None` if they must be read row by row.
    pub(super) fn fixed_vertices(&mut self, element: &Element, columns: &[Option<usize>]) -> Option<()> {
        let mut places = [None; COLUMNS.len()];
        let mut size = 0;
        for (property, column) in element.properties.iter().zip(columns) {
            if property.length_type.is_some() {
                return None;
            }
            if let Some(column) = column {
                places[*column] = Some((property.number_type, size));
            }
            size += property.number_type.size();
        }
        // Colours must be decoded and clamped, which the reader of single rows does.
        if places[8..12].iter().any(Option::is_some) {
            return None;
        }
        let rows = self.rows(element, size)?;
        let positions = rows.gather([places[0]?, places[1]?, places[2]?])?;
        let normals = rows.all(&places[3..6])?;
        let uvs = rows.all(&places[6..8])?;
        let (colors, second_uvs, tangents) =
            (rows.all(&places[12..16])?, rows.all(&places[16..18])?, rows.all(&places[18..22])?);
        let length = rows.bytes.len();
        self.mesh.positions = positions.into_iter().map(Vec3::from_array).collect();
        self.mesh.normals = normals.into_iter().map(Vec3::from_array).collect();
        self.mesh.uvs = uvs.into_iter().map(Vec2::from_array).collect();
        self.mesh.second_uvs = second_uvs.into_iter().map(Vec2::from_array).collect();
        (self.mesh.colors, self.mesh.tangents) = (colors, tangents);
        self.values.skip(NumberType::U8, length).ok()
    }

    /// Reads all faces at once if they are triangles; returns `None` if they must be read row by
    /// row.
    pub(super) fn fixed_faces(&mut self, element: &Element, list: usize) -> Option<()> {
        let mut size = 0;
        let mut found = None;
        for (i, property) in element.properties.iter().enumerate() {
            match property.length_type {
                Some(count) if i == list => {
                    found = Some(((count, size), property.number_type));
                    size += count.size() + 3 * property.number_type.size();
                }
                Some(_) => return None,
                None => size += property.number_type.size(),
            }
        }
        let (count, corners) = found?;
        let rows = self.rows(element, size)?;
        let triangles = rows.triangles(count, corners, self.mesh.positions.len())?;
        let length = rows.bytes.len();
        match self.mesh.triangles.is_empty() {
            true => self.mesh.triangles = triangles,
            false => self.mesh.triangles.extend(triangles),
        }
        self.values.skip(NumberType::U8, length).ok()
    }
}
