//! Descriptions of scene objects: their keywords and fields, each declared in one place.
//!
//! Every shape, camera, material and light declares its keyword and its fields in one `described!`
//! block. The scene readers and writers, the manual, and the generator of random test scenes all
//! use this description.

use crate::dialect::{Dialect, DialectSet};
use crate::math::Vec3;
use durer_diag::Span;
use serde::{Deserialize, Serialize};

/// Type of a field in scene files: a number, a vector, a path, a word or rows of numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FieldKind {
    /// A number.
    Float,
    /// A non-negative integer.
    Int,
    /// Three numbers that represent a point, a direction or a colour.
    Vec3,
    /// Path of a file.
    Path,
    /// One of the listed words.
    Word(&'static [&'static str]),
    /// Rows of `n` numbers each, enclosed in braces.
    Rows(usize),
}

/// Path of a file that a scene refers to, with its span in the scene's text.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FileName {
    /// Path as written in the scene.
    pub path: String,
    /// Span in the scene's text.
    #[serde(skip)]
    pub span: Span,
}

/// Value of a field of a scene object, as read from a scene file or from JSON.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Value {
    /// A number.
    Float(f32),
    /// An integer.
    Int(u32),
    /// Three numbers that represent a point, a direction or a colour.
    Vec3(Vec3),
    /// Path of a file as written in the scene.
    Path(FileName),
    /// A word.
    Word(String),
    /// Rows of numbers.
    Rows(Vec<Vec<f32>>),
}

impl Value {
    /// True if every number in the value is finite. Always true for paths and words.
    pub fn is_finite(&self) -> bool {
        match self {
            Value::Float(x) => x.is_finite(),
            Value::Vec3(v) => v.is_finite(),
            Value::Rows(rows) => rows.iter().flatten().all(|x| x.is_finite()),
            Value::Int(_) | Value::Path(_) | Value::Word(_) => true,
        }
    }
}

/// Constraint on the value of a field, in addition to the requirement that it is finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Constraint {
    /// No constraint.
    Any,
    /// Number greater than 0.
    Positive,
    /// Number greater than or equal to 0.
    NonNegative,
    /// Any vector other than 0 0 0.
    NonZero,
    /// Number strictly between two bounds.
    Between(f32, f32),
    /// Number between two bounds, including the bounds.
    Within(f32, f32),
    /// Number greater than 0 and at most the given maximum.
    UpTo(f32),
    /// Number from 0 to 1.
    UnitInterval,
    /// Integer that is at most the given maximum.
    AtMost(u32),
    /// Integer from 1 to the given maximum.
    OneTo(u32),
    /// Minimum and maximum number of rows.
    Rows(usize, usize),
    /// Vector of integers from 1 to the given maximum.
    Counts(u32),
}

impl Constraint {
    /// Checks a value: every number must be finite and satisfy this constraint.
    ///
    /// # Errors
    ///
    /// Returns the end of an error message that begins with the name of the field, such as "must be
    /// more than 0".
    pub fn validate(self, value: &Value) -> Result<(), String> {
        if !value.is_finite() {
            return Err("must be finite".into());
        }
        match (self, value) {
            (Constraint::Positive, Value::Float(x)) if *x <= 0.0 => Err("must be more than 0".into()),
            (Constraint::NonNegative, Value::Float(x)) if *x < 0.0 => Err("must not be less than 0".into()),
            (Constraint::NonZero, Value::Vec3(v)) if *v == Vec3::ZERO => Err("must not be 0 0 0".into()),
            (Constraint::NonZero, Value::Vec3(v)) if !v.length_squared().is_normal() => {
                Err("is too long or too short for a direction".into())
            }
            (Constraint::Between(low, high), Value::Float(x)) if *x <= low || *x >= high => {
                Err(format!("must be more than {low} and less than {high}"))
            }
            (Constraint::Within(low, high), Value::Float(x)) if *x < low || *x > high => {
                Err(format!("must be from {low} to {high}"))
            }
            (Constraint::UpTo(high), Value::Float(x)) if *x <= 0.0 || *x > high => {
                Err(format!("must be more than 0 and at most {high}"))
            }
            (Constraint::UnitInterval, Value::Float(x)) if *x < 0.0 || *x > 1.0 => Err("must be from 0 to 1".into()),
            (Constraint::Counts(most), Value::Vec3(v))
                if v.to_array().iter().any(|&n| n.fract() != 0.0 || n < 1.0 || n > most as f32) =>
            {
                Err(format!("must be whole numbers from 1 to {most}"))
            }
            (Constraint::OneTo(last), Value::Int(i)) if *i < 1 || *i > last => Err(format!("must be from 1 to {last}")),
            (Constraint::AtMost(most), Value::Int(i)) if *i > most => Err(format!("must be at most {most}")),
            (Constraint::Rows(least, most), Value::Rows(rows)) if rows.len() < least || rows.len() > most => {
                let wanted = if least == most { least.to_string() } else { format!("{least} to {most}") };
                Err(format!("must have {wanted} rows, but has {}", rows.len()))
            }
            _ => Ok(()),
        }
    }
}

/// Description of one field of a scene object: its name, type, constraint and keywords.
#[derive(Clone, Copy, Debug)]
pub struct Field {
    /// Name of the field in Rust code and in JSON.
    pub name: &'static str,
    /// Type of the value.
    pub kind: FieldKind,
    /// True if a scene must set the field.
    pub required: bool,
    /// Constraint on the value.
    pub constraint: Constraint,
    /// Keyword of the field in each dialect.
    pub keywords: &'static [(&'static str, DialectSet)],
    /// Meaning and unit of the field.
    pub doc: &'static str,
}

impl Field {
    /// Returns the keyword of this field in a dialect, or `None` if the dialect does not have it.
    pub fn keyword(&self, dialect: Dialect) -> Option<&'static str> {
        self.keywords.iter().find(|(_, set)| dialect.is_in(*set)).map(|(word, _)| *word)
    }

    /// Returns the value that official programs use instead of a value that violates the
    /// constraint; see [`Quirk::AnyValues`]. `keyword` is the keyword of the object. Returns `None`
    /// if the programs render nothing meaningful with such a value.
    ///
    /// [`Quirk::AnyValues`]: crate::dialect::Quirk::AnyValues
    pub fn quirk_value(&self, keyword: &str, value: &Value) -> Option<Value> {
        match (keyword, self.name, value) {
            // The program squares the radius, so its sign does not matter. No smaller radius is
            // usable.
            ("Sphere", "radius", Value::Float(r)) => Some(Value::Float(r.abs().max(f32::MIN_POSITIVE))),
            ("PhongMaterial" | "Material", "shininess", Value::Float(x)) => Some(Value::Float(*x)),
            ("PerspectiveCamera", "angle", Value::Float(180.0)) => Some(Value::Float(180.0)),
            ("DirectionalLight", "direction", Value::Vec3(Vec3::ZERO)) => Some(Value::Vec3(Vec3::ZERO)),
            _ => None,
        }
        .filter(Value::is_finite)
    }
}

/// Type of scene object that describes its keywords and fields. The [`described!`] macro implements
/// this trait.
pub trait Describe: Default {
    /// Keywords of the object. The scene writer uses the first one.
    const KEYWORDS: &'static [(&'static str, DialectSet)];
    /// Documentation of the object.
    const DOC: &'static str;
    /// Fields of the object, in the order in which the scene writer writes them.
    const FIELDS: &'static [Field];

    /// Returns the value of the field with this index, or `None` if it is not set.
    fn get(&self, field: usize) -> Option<Value>;

    /// Sets the field with this index. A value of the wrong kind is ignored.
    fn set(&mut self, field: usize, value: Value);
}

/// Rust type that a described field can have, with conversions from and to [`Value`].
pub trait FieldType: Sized {
    /// Type of the field in scene files.
    const KIND: FieldKind;
    /// Returns the value, or `None` if it is not set.
    fn value(&self) -> Option<Value>;
    /// Converts a value of this kind to the Rust type.
    fn from_value(value: Value) -> Option<Self>;
}

macro_rules! field_type {
    ($type:ty, $kind:ident) => {
        impl FieldType for $type {
            const KIND: FieldKind = FieldKind::$kind;
            fn value(&self) -> Option<Value> {
                Some(Value::$kind(self.clone()))
            }
            fn from_value(value: Value) -> Option<Self> {
                match value {
                    Value::$kind(x) => Some(x),
                    _ => None,
                }
            }
        }
    };
}

field_type!(f32, Float);
field_type!(u32, Int);
field_type!(Vec3, Vec3);
field_type!(FileName, Path);

impl<const N: usize> FieldType for Vec<[f32; N]> {
    const KIND: FieldKind = FieldKind::Rows(N);
    fn value(&self) -> Option<Value> {
        Some(Value::Rows(self.iter().map(|row| row.to_vec()).collect()))
    }
    fn from_value(value: Value) -> Option<Self> {
        match value {
            Value::Rows(rows) => rows.into_iter().map(|row| row.try_into().ok()).collect(),
            _ => None,
        }
    }
}

/// Declares an `enum` for a field whose value is one of several words. The first word is the
/// default.
#[macro_export]
macro_rules! described_words {
    ($(#[doc = $doc:literal])+ $name:ident { $first:ident = $first_word:literal $(, $variant:ident = $word:literal)* }) => {
        $(#[doc = $doc])+
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
        pub enum $name {
            #[doc = concat!("`", $first_word, "`")] #[default] $first,
            $(#[doc = concat!("`", $word, "`")] $variant,)*
        }

        impl $crate::describe::FieldType for $name {
            const KIND: $crate::describe::FieldKind = $crate::describe::FieldKind::Word(&[$first_word $(, $word)*]);
            fn value(&self) -> Option<$crate::describe::Value> {
                let word = match self { $name::$first => $first_word, $($name::$variant => $word,)* };
                Some($crate::describe::Value::Word(word.into()))
            }
            fn from_value(value: $crate::describe::Value) -> Option<Self> {
                let $crate::describe::Value::Word(word) = value else { return None };
                match word.as_str() { $first_word => Some($name::$first), $($word => Some($name::$variant),)* _ => None }
            }
        }
    };
}

impl<T: FieldType> FieldType for Option<T> {
    const KIND: FieldKind = T::KIND;
    fn value(&self) -> Option<Value> {
        self.as_ref().and_then(T::value)
    }
    fn from_value(value: Value) -> Option<Self> {
        T::from_value(value).map(Some)
    }
}

/// Declares a struct for a scene object together with its description.
///
/// Each field is declared with its doc comment, name, type, default, `required` or `optional`,
/// constraint, and keywords in each dialect.
#[macro_export]
macro_rules! described {
    (
        $(#[doc = $doc:literal])+
        $name:ident [$($keyword:literal in $kset:expr),+] {
            $( $(#[doc = $fdoc:literal])+
               $field:ident : $type:ty = $default:expr, $presence:ident, $rule:expr, [$($word:literal in $fset:expr),+]; )*
        }
    ) => {
        $(#[doc = $doc])+
        #[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
        pub struct $name { $( $(#[doc = $fdoc])+ pub $field: $type, )* }

        impl Default for $name {
            fn default() -> Self { $name { $($field: $default,)* } }
        }

        impl $crate::describe::Describe for $name {
            const KEYWORDS: &'static [(&'static str, $crate::dialect::DialectSet)] = &[$(($keyword, $kset)),+];
            const DOC: &'static str = concat!($($doc, "\n"),+);
            const FIELDS: &'static [$crate::describe::Field] = &[$(
                $crate::describe::Field {
                    name: stringify!($field),
                    kind: <$type as $crate::describe::FieldType>::KIND,
                    required: $crate::describe::presence::$presence,
                    constraint: $rule,
                    keywords: &[$(($word, $fset)),+],
                    doc: concat!($($fdoc, "\n"),+),
                },
            )*];

            #[allow(unused_assignments, unused_mut, unused_variables)]
            fn get(&self, field: usize) -> Option<$crate::describe::Value> {
                let mut i = 0;
                $( if field == i { return $crate::describe::FieldType::value(&self.$field); } i += 1; )*
                None
            }

            #[allow(unused_assignments, unused_mut, unused_variables)]
            fn set(&mut self, field: usize, value: $crate::describe::Value) {
                let mut i = 0;
                $( if field == i {
                    if let Some(x) = $crate::describe::FieldType::from_value(value) { self.$field = x; }
                    return;
                } i += 1; )*
            }
        }
    };
    // Report a field that has no doc comment, and continue with the remaining fields.
    (
        $(#[doc = $doc:literal])+
        $name:ident [$($keyword:literal in $kset:expr),+] {
            $( $(#[doc = $fdoc:literal])*
               $field:ident : $type:ty = $default:expr, $presence:ident, $rule:expr, [$($word:literal in $fset:expr),+]; )*
        }
    ) => {
        $( $crate::described!(@documented $name $field [$($fdoc)*]); )*
        $crate::described! {
            $(#[doc = $doc])+
            $name [$($keyword in $kset),+] {
                $( $(#[doc = $fdoc])* #[doc = ""]
                   $field : $type = $default, $presence, $rule, [$($word in $fset),+]; )*
            }
        }
    };
    (@documented $name:ident $field:ident [$($doc:literal)+]) => {};
    (@documented $name:ident $field:ident []) => {
        compile_error!(concat!(
            "described!: `", stringify!($name), "::", stringify!($field),
            "` has no doc comment; describe its meaning, unit and range",
        ));
    };
    // Report a struct that has no doc comment.
    ($name:ident [$($keyword:tt)+] $fields:tt) => {
        compile_error!(concat!("described!: `", stringify!($name), "` has no doc comment; describe the object"));
    };
}

/// Words in [`described!`] that state whether a scene must set a field.
#[allow(non_upper_case_globals)]
#[doc(hidden)]
pub mod presence {
    /// Marks a field that every scene must set.
    pub const required: bool = true;
    /// Marks a field that has a default.
    pub const optional: bool = false;
}

/// Declares an `enum` with one variant for each of the listed types, which must be described types.
/// The enum forwards its methods to the type of its variant.
///
/// The path after the colon is the trait that all the types implement. The name after `=>` is a
/// macro that receives the names of the variants and implements the trait for the enum.
#[macro_export]
macro_rules! described_list {
    ($(#[doc = $doc:literal])+ $name:ident : $trait:path => $delegate:ident { $($variant:ident($type:ty),)+ }) => {
        // This check comes first, so that the first compiler error names the trait and points at
        // the type.
        const _: fn() = || {
            fn is_described<T: $crate::describe::Describe>() {}
            fn is_one<T: $trait>() {}
            $( is_described::<$type>(); is_one::<$type>(); )+
        };

        $delegate!($($variant),+);

        $(#[doc = $doc])+
        #[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
        pub enum $name { $(#[doc = concat!("A `", stringify!($variant), "`.")] $variant($type),)+ }

        $(impl From<$type> for $name {
            fn from(x: $type) -> Self { $name::$variant(x) }
        })+

        impl $crate::describe::DescribedKind for $name {
            fn kinds() -> Vec<Self> {
                vec![$($name::$variant(<$type>::default()),)+]
            }
            fn keywords(&self) -> &'static [(&'static str, $crate::dialect::DialectSet)] {
                match self { $($name::$variant(_) => <$type as $crate::describe::Describe>::KEYWORDS,)+ }
            }
            fn doc(&self) -> &'static str {
                match self { $($name::$variant(_) => <$type as $crate::describe::Describe>::DOC,)+ }
            }
            fn fields(&self) -> &'static [$crate::describe::Field] {
                match self { $($name::$variant(_) => <$type as $crate::describe::Describe>::FIELDS,)+ }
            }
            fn get(&self, field: usize) -> Option<$crate::describe::Value> {
                match self { $($name::$variant(x) => $crate::describe::Describe::get(x, field),)+ }
            }
            fn set(&mut self, field: usize, value: $crate::describe::Value) {
                match self { $($name::$variant(x) => $crate::describe::Describe::set(x, field, value),)+ }
            }
        }
    };
}

pub use {described, described_list, described_words};

/// Scene object of one of several described types, such as any shape or any light. The
/// [`described_list!`] macro implements this trait.
pub trait DescribedKind: Sized {
    /// Returns one object of each type with default field values.
    fn kinds() -> Vec<Self>;
    /// Keywords of the object.
    fn keywords(&self) -> &'static [(&'static str, DialectSet)];
    /// Documentation of the object.
    fn doc(&self) -> &'static str;
    /// Fields of the object.
    fn fields(&self) -> &'static [Field];
    /// Returns the value of the field with this index.
    fn get(&self, field: usize) -> Option<Value>;
    /// Sets the field with this index.
    fn set(&mut self, field: usize, value: Value);

    /// True if the object exists only in Dürer's own dialect.
    fn is_durer_only(&self) -> bool {
        self.keywords().iter().all(|(_, set)| *set == Dialect::Durer as DialectSet)
    }

    /// Keyword in Dürer's own dialect.
    fn own_keyword(&self) -> &'static str {
        self.keyword(Dialect::Durer)
    }

    /// Returns the object that has this keyword in any dialect, with default values.
    fn from_keyword(word: &str) -> Option<Self> {
        Self::kinds().into_iter().find(|kind| kind.keywords().iter().any(|(keyword, _)| *keyword == word))
    }

    /// Keyword of the object in a dialect, or its first keyword if it has none in that dialect.
    fn keyword(&self, dialect: Dialect) -> &'static str {
        let words = self.keywords();
        words.iter().find(|(_, set)| dialect.is_in(*set)).unwrap_or(&words[0]).0
    }
}

/// Every described type also counts as a list of one type, so the reader needs only one code path.
impl<T: Describe> DescribedKind for T {
    fn kinds() -> Vec<Self> {
        vec![T::default()]
    }
    fn keywords(&self) -> &'static [(&'static str, DialectSet)] {
        T::KEYWORDS
    }
    fn doc(&self) -> &'static str {
        T::DOC
    }
    fn fields(&self) -> &'static [Field] {
        T::FIELDS
    }
    fn get(&self, field: usize) -> Option<Value> {
        Describe::get(self, field)
    }
    fn set(&mut self, field: usize, value: Value) {
        Describe::set(self, field, value)
    }
}
