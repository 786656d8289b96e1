//! x
use nalgebra::Vector2;
pub struct Axis; impl Axis { pub fn parse(_:&str)->Option<Self>{None} }
pub struct VanishingLines{ pub size:[u32;2], pub center: Vector2<f64>, pub origin: Vector2<f64>, pub axes:[Axis;2], pub lines:[Vec<[Vector2<f64>;2]>;2] }
