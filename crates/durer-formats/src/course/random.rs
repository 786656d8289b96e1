//! Generates random scenes from the descriptions of all statements, for tests and for fuzzing. In
//! fuzzing, the bytes from the fuzzer determine the choices.

use durer_scene::camera::Camera;
use durer_scene::describe::{Constraint, DescribedKind, Field, FieldKind, FileName, Value};
use durer_scene::dialect::Dialect;
use durer_scene::light::Light;
use durer_scene::material::{
    ColorNoise, HairMaterial, PatternMaterial, PhongMaterial, PrincipledMaterial, is_material_index,
};
use durer_scene::math::Vec3;
use durer_scene::medium::Fog;
use durer_scene::scene::{
    Assets, Background, CsgOperation, Group, Material, MatrixOp, NamedTexture, Object, ObjectKind, Scene, Spanned,
};
use durer_scene::shape::{HeightField, Primitive, Sphere, TriangleMesh, VoxelGrid};

/// Generator of random scenes for tests. The generator uses given bytes to make choices, and then a
/// linear congruential generator (Knuth's multiplier, upper half of the state).
pub struct SceneGenerator {
    state: u64,
    bytes: std::vec::IntoIter<u8>,
    /// True to generate scenes that can be rendered, with small numbers and with `a.obj` and
    /// `a.ppm` as the only files.
    renderable: bool,
}

impl SceneGenerator {
    /// Creates a generator from a seed.
    pub fn seeded(state: u64) -> Self {
        SceneGenerator { state, bytes: Vec::new().into_iter(), renderable: false }
    }

    /// Creates a generator that uses bytes to make choices, and that generates scenes which can be
    /// rendered.
    pub fn renderable(bytes: &[u8]) -> Self {
        SceneGenerator { state: 1, bytes: Vec::from(bytes).into_iter(), renderable: true }
    }

    /// Returns a number below `n`, which must not be 0.
    pub fn below(&mut self, n: usize) -> usize {
        // For more than 256 choices, two bytes are needed.
        let count = if n > 256 { 2 } else { 1 };
        if self.bytes.len() >= count {
            return self.bytes.by_ref().take(count).fold(0, |number, byte| number << 8 | usize::from(byte)) % n;
        }
        self.state = self.state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.state >> 33) as usize % n
    }

    /// Returns any finite number, which can be a special value.
    pub fn float(&mut self) -> f32 {
        if self.renderable {
            return self.below(129) as f32 / 16.0 - 4.0;
        }
        match self.below(6) {
            0 => [0.0, -0.0, 1.0, f32::MAX, f32::MIN_POSITIVE, 1e-45, 16777216.0, 0.1][self.below(8)],
            1 => self.below(100) as f32 / 8.0 - 5.0,
            _ => loop {
                let value = f32::from_bits((self.below(1 << 16) << 16 | self.below(1 << 16)) as u32);
                if value.is_finite() {
                    break value;
                }
            },
        }
    }

    fn vec3(&mut self) -> Vec3 {
        Vec3::new(self.float(), self.float(), self.float())
    }

    /// Returns a valid value for a field. Indices of materials are below `materials`.
    fn value(&mut self, field: &Field, materials: usize) -> Value {
        loop {
            let value = match field.kind {
                FieldKind::Float => Value::Float(self.float()),
                FieldKind::Int if is_material_index(field) => Value::Int(self.below(materials) as u32),
                FieldKind::Int => Value::Int(self.below(40) as u32),
                FieldKind::Vec3 => Value::Vec3(self.vec3()),
                FieldKind::Path if self.renderable => {
                    let path = if field.name == "obj_file" { "a.obj" } else { "a.ppm" }.into();
                    Value::Path(FileName { path, ..Default::default() })
                }
                FieldKind::Path => {
                    let path = ["a.obj", "meshes/B-2.OBJ", "../x", "Sphere", "\\w\\é.bmp"][self.below(5)].into();
                    Value::Path(FileName { path, ..Default::default() })
                }
                FieldKind::Word(words) => Value::Word(words[self.below(words.len())].into()),
                FieldKind::Rows(width) => {
                    Value::Rows((0..self.below(6)).map(|_| (0..width).map(|_| self.float()).collect()).collect())
                }
            };
            // A random number rarely satisfies a narrow constraint, so draw a number from the range
            // of the constraint.
            let value = match (field.constraint, value) {
                (Constraint::Counts(most), _) => {
                    Value::Vec3(Vec3::from([0; 3].map(|_| 1.0 + self.below(most as usize) as f32)))
                }
                (Constraint::Within(low, high), _) => {
                    Value::Float(low + (high - low) * self.below(1001) as f32 / 1000.0)
                }
                (Constraint::Between(low, high), _) => {
                    Value::Float(low + (high - low) * (1 + self.below(998)) as f32 / 1000.0)
                }
                (Constraint::UnitInterval, _) => Value::Float(self.below(1001) as f32 / 1000.0),
                (Constraint::UpTo(high), _) => Value::Float(high * (1 + self.below(1000)) as f32 / 1000.0),
                (_, value) => value,
            };
            if field.constraint.validate(&value).is_ok() {
                return value;
            }
        }
    }

    fn item<T: DescribedKind>(&mut self, materials: usize) -> T {
        let mut kinds = T::kinds();
        let mut entry = kinds.remove(self.below(kinds.len()));
        for (i, field) in entry.fields().iter().enumerate() {
            // A cube map requires six files.
            let missing = self.renderable && field.name.to_lowercase().starts_with("cube");
            if field.required || self.below(2) == 0 && !missing {
                let value = self.value(field, materials);
                entry.set(i, value);
            }
        }
        entry
    }

    fn matrix(&mut self) -> MatrixOp {
        let nonzero = |random: &mut Self| loop {
            let v = random.vec3();
            if !v.to_array().contains(&0.0) {
                break v;
            }
        };
        match self.below(8) {
            0 => MatrixOp::Translate(self.vec3()),
            1 => MatrixOp::Scale(nonzero(self)),
            2 => MatrixOp::UniformScale(nonzero(self).x),
            3 => MatrixOp::XRotate(self.float()),
            4 => MatrixOp::YRotate(self.float()),
            5 => MatrixOp::ZRotate(self.float()),
            6 => MatrixOp::Rotate(nonzero(self), self.float()),
            _ => {
                let mut rows = std::array::from_fn(|_| self.float());
                rows[12..].copy_from_slice(&[0.0, 0.0, 0.0, 1.0]);
                MatrixOp::Matrix(rows)
            }
        }
    }

    fn matrices(&mut self) -> Vec<MatrixOp> {
        (0..self.below(4)).map(|_| self.matrix()).collect()
    }

    fn object(&mut self, depth: usize, materials: usize, current: &mut Option<u32>, may_change: bool) -> Object {
        if may_change && materials > 0 && self.below(2) == 0 {
            *current = Some(self.below(materials + 1) as u32);
        }
        let material = *current;
        let node = match self.below(if depth > 4 { 5 } else { 8 }) {
            0 | 1 => ObjectKind::Primitive(self.item::<Primitive>(materials)),
            2 => ObjectKind::Mesh(self.item::<TriangleMesh>(materials)),
            3 => ObjectKind::HeightField(self.item::<HeightField>(materials)),
            4 => ObjectKind::Voxels(
                self.item::<VoxelGrid>(materials),
                (0..self.below(3))
                    .map(|_| Sphere { center: self.vec3(), radius: 1.0 + self.below(9) as f32 })
                    .collect(),
            ),
            5 => ObjectKind::Solid(
                CsgOperation::ALL[self.below(5)].1,
                (0..self.below(4)).map(|_| self.object(depth + 1, materials, current, true)).collect(),
            ),
            6 => ObjectKind::Group(Group {
                objects: (0..self.below(4)).map(|_| self.object(depth + 1, materials, current, true)).collect(),
            }),
            _ => {
                let ops = self.matrices();
                ObjectKind::Transform(ops, Box::new(self.object(depth + 1, materials, current, false)))
            }
        };
        Object { node, material, span: Default::default() }
    }

    /// Returns textures with different names.
    fn textures(&mut self) -> Assets {
        let mut assets = Assets::default();
        for i in 0..self.below(3) {
            assets.pictures.insert(format!("t{i}"), self.item::<NamedTexture>(0).picture());
        }
        assets
    }

    /// Returns a scene that can be written in the dialect, in the form that it has after it is read
    /// back.
    pub fn scene(&mut self, dialect: Dialect) -> Scene {
        let nodes = dialect == Dialect::F23;
        fn spanned<T>(value: T) -> Spanned<T> {
            Spanned { value, span: Default::default() }
        }
        let mut materials = Vec::new();
        for i in 0..self.below(6) {
            materials.push(spanned(if i > 0 && self.below(3) == 0 {
                Material::Solid(self.item::<PatternMaterial>(i), self.matrices())
            } else if dialect == Dialect::Durer && self.below(3) == 0 {
                Material::Principled(Box::new(self.item::<PrincipledMaterial>(i)))
            } else if dialect == Dialect::Durer && self.below(4) == 0 {
                Material::Hair(self.item::<HairMaterial>(i))
            } else {
                let noise = (self.below(3) == 0).then(|| self.item::<ColorNoise>(i));
                Material::Phong(Box::new(self.item::<PhongMaterial>(i)), noise)
            }));
        }
        let light = |random: &mut Self| {
            // Only two kinds of lights are possible in scenes with nodes.
            let mut value = loop {
                let value = random.item::<Light>(0);
                if !(nodes && value.is_durer_only()) {
                    break value;
                }
            };
            if let (Light::Point(point), true) = (&mut value, nodes) {
                // The reader adds the position of the node to 0, which turns -0 into 0.
                point.position += Vec3::ZERO;
            }
            Spanned { value, span: Default::default() }
        };
        let lights = (nodes || self.below(4) > 0).then(|| (0..self.below(4)).map(|_| light(self)).collect());
        let mut current = None;
        let objects = (0..self.below(5)).map(|_| self.object(0, materials.len(), &mut current, true)).collect();
        Scene {
            render_defaults: Default::default(),
            camera: (self.below(4) > 0).then(|| self.item::<Camera>(0)),
            background: self.item::<Background>(0),
            fog: (dialect == Dialect::Durer && self.below(3) == 0).then(|| spanned(self.item::<Fog>(0))),
            lights,
            materials,
            root: (nodes || self.below(8) > 0).then_some(Group { objects }),
            assets: if dialect == Dialect::Durer { self.textures() } else { Default::default() },
            up: None,
            is_lit: false,
            lumens_per_watt: None,
            camera_span: Default::default(),
            camera_names: Vec::new(),
            animations: Vec::new(),
            background_span: Default::default(),
        }
    }
}
