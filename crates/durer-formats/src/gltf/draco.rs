//! Decodes primitives whose triangles are compressed with Draco.
//!
//! Source: *KHR_draco_mesh_compression*, Khronos Group. The accessors of such a primitive describe
//! the decompressed data, but they have no buffer view. This module sets the data of these
//! accessors.

use super::Model;
use super::accessor::ComponentType;
use super::buffers::{BufferView, SharedBytes};
use super::json::JsonRef;
use draco_core::{DataType, DecodeLimits, DecoderBuffer, Mesh, MeshDecoder, PointAttribute, PointIndex};
use durer_image::panics::catch_panic;

const DRACO: &str = "KHR_draco_mesh_compression";

impl Model<'_> {
    /// Decodes all primitives that are compressed with Draco.
    pub(super) fn unpack_primitives(&mut self, root: &JsonRef) {
        let Some(meshes) = root.get("meshes") else { return };
        for mesh in meshes.items() {
            let Some(primitives) = mesh.get("primitives") else { continue };
            for primitive in primitives.items() {
                let extensions = primitive.get("extensions");
                if let Some(draco) = extensions.as_ref().and_then(|extensions| extensions.get(DRACO)) {
                    self.unpack_primitive(&primitive, &draco);
                }
            }
        }
    }

    fn unpack_primitive(&mut self, primitive: &JsonRef, at: &JsonRef) -> Option<()> {
        at.object()?;
        let mode = primitive.get("mode").and_then(|mode| mode.value.as_u64()).unwrap_or(4);
        if !matches!(mode, 4 | 5) {
            at.error("VALUE_NOT_IN_LIST", format!("{DRACO} supports only triangles, not mode {mode}"));
            return None;
        }
        let view = at.required("bufferView")?;
        let packed = self.views[view.index(self.views.len())?].clone()?.slice?;
        let mesh = match decode(packed.bytes(), self.work.left().min(self.kept.left())) {
            Ok(mesh) => mesh,
            Err(message) => {
                at.error("compressed-data", format!("the Draco data cannot be decoded ({message})"));
                return None;
            }
        };
        let points = mesh.num_points();
        if let Some(indices) = primitive.get("indices") {
            let bytes = mesh.faces().iter().flatten().flat_map(|corner| corner.0.to_le_bytes()).collect();
            self.set_accessor_data(&indices, (ComponentType::U32, 1, 3 * mesh.num_faces()), bytes)?;
        }
        let (attributes, packed) = (primitive.required("attributes")?, at.required("attributes")?);
        for key in packed.object()?.keys() {
            let number = packed.get(key)?;
            let id = number.integer(..=u64::from(u32::MAX))? as u32;
            let Some(attribute) = mesh.attribute_by_unique_id(id) else {
                number.error("UNRESOLVED_REFERENCE", format!("the compressed data have no attribute {id}"));
                continue;
            };
            let Some(component) = component(attribute.data_type()) else {
                number.error("VALUE_NOT_IN_LIST", "this attribute has a data type that glTF lacks");
                continue;
            };
            let width = usize::from(attribute.num_components());
            self.charge(points, 2 * width * component.size(), &number)?;
            let bytes = rows(attribute, points, width * component.size());
            self.set_accessor_data(&attributes.required(key)?, (component, width, points), bytes);
        }
        Some(())
    }

    /// Stores decoded bytes, which are `count` rows of `width` numbers, in the accessor whose index
    /// is the value `at`.
    fn set_accessor_data(
        &mut self,
        at: &JsonRef,
        (component, width, count): (ComponentType, usize, usize),
        bytes: Vec<u8>,
    ) -> Option<()> {
        let number = at.index(self.accessors.len())?;
        let accessor = self.accessors[number].as_mut()?;
        if (accessor.width, accessor.count) != (width, count) {
            let (own_width, own_count) = (accessor.width, accessor.count);
            let message = format!(
                "the accessor has {own_count} rows of {own_width} numbers, but the compressed data have {count} rows \
                 of {width} numbers"
            );
            at.error("MESH_PRIMITIVE_UNEQUAL_ACCESSOR_COUNT", message);
            return None;
        }
        accessor.fill(
            component,
            BufferView { offset: 0, length: bytes.len(), slice: Some(SharedBytes::whole(bytes.into())), stride: None },
        );
        accessor.check_values(at);
        Some(())
    }
}

/// Decodes points and triangles with at most `left` bytes of memory.
fn decode(bytes: &[u8], left: u64) -> Result<Mesh, String> {
    let limits =
        DecodeLimits::default().with_max_points(left / 16).with_max_faces(left / 64).with_max_decoded_bytes(left);
    let decode = || {
        let mut mesh = Mesh::new();
        let mut buffer = DecoderBuffer::new(bytes).with_limits(limits);
        MeshDecoder::new().decode(&mut buffer, &mut mesh).map(|()| mesh)
    };
    match catch_panic(decode) {
        Some(Ok(mesh)) if mesh.num_points() <= u32::MAX as usize => Ok(mesh),
        Some(Ok(_)) => Err("too many points".into()),
        Some(Err(error)) => Err(error.to_string()),
        None => Err("the decoder failed".into()),
    }
}

/// Returns the tightly packed rows of an attribute, with one row for each point. Missing data is
/// replaced with 0.
fn rows(attribute: &PointAttribute, points: usize, size: usize) -> Vec<u8> {
    let (data, stride) = (attribute.buffer().data(), attribute.byte_stride().max(0) as usize);
    let mut all = vec![0; points * size];
    for (i, row) in all.chunks_exact_mut(size.max(1)).enumerate() {
        let start = (attribute.mapped_index(PointIndex(i as u32)).0 as usize).saturating_mul(stride);
        if let Some(bytes) = start.checked_add(size).and_then(|end| data.get(start..end)) {
            row.copy_from_slice(bytes);
        }
    }
    all
}

fn component(kind: DataType) -> Option<ComponentType> {
    Some(match kind {
        DataType::Int8 => ComponentType::I8,
        DataType::Uint8 => ComponentType::U8,
        DataType::Int16 => ComponentType::I16,
        DataType::Uint16 => ComponentType::U16,
        DataType::Uint32 => ComponentType::U32,
        DataType::Float32 => ComponentType::F32,
        _ => return None,
    })
}
