//! Fields of cameras and materials that a web page shows as sliders.

use crate::protocol::FieldState;
use durer::describe::{Constraint, DescribedKind, Field, FieldKind, Value};
use durer::dialect::Dialect;
use durer::math::Vec3;

/// Returns the fields of an item with their values.
pub(crate) fn field_states(list: &impl DescribedKind) -> Vec<FieldState> {
    list.fields().iter().enumerate().map(|(i, field)| state(field, list.get(i))).collect()
}

/// Value of a field that a page has set: numbers or a word.
#[derive(Clone, Copy)]
pub(crate) struct NewValue<'a> {
    pub numbers: &'a [f32],
    pub word: Option<&'a str>,
}

/// Sets the value of the field whose keyword in the scene language is `name`.
pub(crate) fn set_value(list: &mut impl DescribedKind, name: &str, new: NewValue) -> Result<(), String> {
    let fields = list.fields();
    let at = fields.iter().position(|field| spelled(field) == name).ok_or_else(|| format!("no field `{name}`"))?;
    let value = match (fields[at].kind, new.numbers, new.word) {
        (FieldKind::Vec3, &[x, y, z], None) => Value::Vec3(Vec3::new(x, y, z)),
        (FieldKind::Int, &[x], None) if x >= 0.0 => Value::Int(x as u32),
        (FieldKind::Float, &[x], None) => Value::Float(x),
        (FieldKind::Word(words), [], Some(word)) if words.contains(&word) => Value::Word(word.into()),
        (FieldKind::Word(words), ..) => return Err(format!("`{name}` must be one of {}", words.join(", "))),
        _ => return Err(format!("`{name}` takes a different number or type of values")),
    };
    fields[at].constraint.validate(&value).map_err(|wrong| format!("`{name}` {wrong}"))?;
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
        Constraint::AtMost(most) => (Some(0.0), Some(most as f32)),
        Constraint::OneTo(most) | Constraint::Counts(most) => (Some(1.0), Some(most as f32)),
        Constraint::Any | Constraint::NonZero | Constraint::Rows(..) => (None, None),
    };
    let is_between = matches!(field.constraint, Constraint::Between(..));
    let choices = match field.kind {
        FieldKind::Word(words) => words.iter().map(|word| (*word).into()).collect(),
        _ => Vec::new(),
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
    FieldState {
        name: spelled(field).into(),
        doc: field.doc.trim().into(),
        values,
        text,
        least,
        most,
        above_least: is_between || matches!(field.constraint, Constraint::Positive | Constraint::UpTo(_)),
        below_most: is_between,
        whole: matches!(field.kind, FieldKind::Int) || matches!(field.constraint, Constraint::Counts(_)),
        choices,
    }
}
