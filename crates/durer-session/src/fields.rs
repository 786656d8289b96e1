//! Fields of cameras and materials that a web page shows as sliders.

use crate::protocol::FieldState;
use durer::describe::{Constraint, DescribedKind, Field, Value};
use durer::dialect::Dialect;
use durer::math::Vec3;

/// Returns the fields of an item with their values.
pub(crate) fn field_states(list: &impl DescribedKind) -> Vec<FieldState> {
    list.fields().iter().enumerate().map(|(i, field)| state(field, list.get(i))).collect()
}

/// Sets the numbers of the field whose keyword in the scene language is `word`.
pub(crate) fn set_numbers(list: &mut impl DescribedKind, word: &str, numbers: &[f32]) -> Result<(), String> {
    let fields = list.fields();
    let at = fields.iter().position(|field| spelled(field) == word).ok_or_else(|| format!("no field `{word}`"))?;
    let value = match (list.get(at), numbers) {
        (Some(Value::Vec3(_)), &[x, y, z]) => Value::Vec3(Vec3::new(x, y, z)),
        (Some(Value::Int(_)), &[x]) if x >= 0.0 => Value::Int(x as u32),
        (Some(Value::Float(_)) | None, &[x]) => Value::Float(x),
        _ => return Err(format!("`{word}` takes a different number or type of values")),
    };
    fields[at].constraint.validate(&value).map_err(|wrong| format!("`{word}` {wrong}"))?;
    list.set(at, value);
    Ok(())
}

fn spelled(field: &Field) -> &'static str {
    field.keyword(Dialect::Durer).unwrap_or(field.name)
}

fn state(field: &Field, value: Option<Value>) -> FieldState {
    let (least, most) = match field.constraint {
        Constraint::Between(low, high) | Constraint::Within(low, high) => (Some(low), Some(high)),
        Constraint::Positive | Constraint::NonNegative => (Some(0.0), None),
        Constraint::UnitInterval => (Some(0.0), Some(1.0)),
        Constraint::UpTo(most) => (Some(0.0), Some(most)),
        _ => (None, None),
    };
    let values = match &value {
        Some(Value::Float(x)) => vec![*x],
        Some(Value::Int(i)) => vec![*i as f32],
        Some(Value::Vec3(v)) => v.to_array().to_vec(),
        _ => Vec::new(),
    };
    let text = match value {
        Some(Value::Word(word)) => word,
        Some(Value::Path(name)) => name.path,
        _ => String::new(),
    };
    FieldState { name: spelled(field).into(), doc: field.doc.trim().into(), values, text, least, most }
}
