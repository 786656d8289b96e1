//! Detects a binary PLY file whose header states the wrong byte order.

use super::header::{Element, Encoding, Header, NumberType};
use super::rows::CORNER_LISTS;
use super::values::{BinaryValues, ValueReader};
use crate::report::Report;

/// Maximum number of values that are read to find the first face.
const MAX_VALUES: u64 = 1 << 20;

/// Reports a byte order in the header that the first face contradicts. Returns true if the order is
/// wrong.
pub(super) fn report_wrong_order(bytes: &[u8], header: &Header, report: &mut Report) -> bool {
    let little = has_valid_face(BinaryValues::<false>::new(bytes, header.body), bytes, &header.elements);
    let big = has_valid_face(BinaryValues::<true>::new(bytes, header.body), bytes, &header.elements);
    let (found, right, stated) = match header.encoding {
        Encoding::LittleEndian if !little && big => ("big-endian", "binary_big_endian", "binary_little_endian"),
        Encoding::BigEndian if !big && little => ("little-endian", "binary_little_endian", "binary_big_endian"),
        _ => return false,
    };
    let message = format!("the data are {found}, but the header says `{stated}`");
    report.error(header.encoding_at.clone(), message).help = Some(format!("write `{right}` in the header"));
    true
}

/// Returns true if the first face has at least three vertices and all of them exist.
fn has_valid_face<V: ValueReader>(mut values: V, bytes: &[u8], elements: &[Element]) -> bool {
    let vertices = elements.iter().find(|element| &bytes[element.name.clone()] == b"vertex");
    let vertices = vertices.map_or(0, |element| element.rows).min(i64::MAX as u64) as i64;
    let mut left = MAX_VALUES;
    for element in elements {
        let is_face = &bytes[element.name.clone()] == b"face" && element.rows > 0;
        if !is_face && skip_all(&mut values, element, &mut left).is_none() {
            return false;
        }
        if !is_face {
            continue;
        }
        for property in &element.properties {
            let is_list = CORNER_LISTS.iter().any(|name| name.as_bytes() == &bytes[property.name.clone()]);
            let length = match property.length_type.map(|length| values.integer(length)) {
                None => 1,
                Some(Ok(length)) if (0..=values.most_left(property.number_type) as i64).contains(&length) => length,
                Some(_) => return false,
            };
            if is_list && property.length_type.is_some() {
                let mut exists = || values.integer(property.number_type).is_ok_and(|i| (0..vertices).contains(&i));
                return length >= 3 && (0..length).all(|_| exists());
            }
            if values.skip(property.number_type, length as usize).is_err() {
                return false;
            }
        }
        return false;
    }
    false
}

/// Skips all rows of an element. Returns `None` if the file ends or if the rows have too many
/// values.
fn skip_all<V: ValueReader>(values: &mut V, element: &Element, left: &mut u64) -> Option<()> {
    if element.properties.is_empty() {
        return Some(());
    }
    if element.properties.iter().all(|property| property.length_type.is_none()) {
        let row: usize = element.properties.iter().map(|property| property.number_type.size()).sum();
        return values.skip(NumberType::U8, usize::try_from(element.rows).ok()?.checked_mul(row)?).ok();
    }
    for _ in 0..element.rows {
        for property in &element.properties {
            *left = left.checked_sub(1)?;
            let length = match property.length_type {
                None => 1,
                Some(length) => usize::try_from(values.integer(length).ok()?).ok()?,
            };
            values.skip(property.number_type, length).ok()?;
        }
    }
    Some(())
}
