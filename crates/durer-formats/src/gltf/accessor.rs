//! Reads accessors, which describe numbers of all component types in buffers, with strides,
//! normalization and sparse values.

use super::Model;
use super::buffers::BufferView;
use super::json::JsonRef;
use rayon::prelude::*;

/// Number type of the components of a glTF accessor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ComponentType {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl ComponentType {
    fn of(code: u64) -> Option<ComponentType> {
        Some(match code {
            5120 => ComponentType::I8,
            5121 => ComponentType::U8,
            5122 => ComponentType::I16,
            5123 => ComponentType::U16,
            5125 => ComponentType::U32,
            5126 => ComponentType::F32,
            _ => return None,
        })
    }

    /// Returns the size of a number in bytes.
    pub fn size(self) -> usize {
        match self {
            ComponentType::I8 | ComponentType::U8 => 1,
            ComponentType::I16 | ComponentType::U16 => 2,
            ComponentType::U32 | ComponentType::F32 => 4,
        }
    }

    /// Returns the number at the start of `b`. A normalized number is between -1 and 1 if its type
    /// is signed, and between 0 and 1 otherwise (chapter 3.11 of the specification).
    fn float(self, b: &[u8], normalized: bool) -> f32 {
        let (value, most) = match self {
            ComponentType::I8 => (f32::from(b[0] as i8), 127.0),
            ComponentType::U8 => (f32::from(b[0]), 255.0),
            ComponentType::I16 => (f32::from(i16::from_le_bytes([b[0], b[1]])), 32767.0),
            ComponentType::U16 => (f32::from(u16::from_le_bytes([b[0], b[1]])), 65535.0),
            ComponentType::U32 => return u32::from_le_bytes([b[0], b[1], b[2], b[3]]) as f32,
            ComponentType::F32 => return f32::from_le_bytes([b[0], b[1], b[2], b[3]]),
        };
        if normalized { (value / most).max(-1.0) } else { value }
    }

    fn integer(self, b: &[u8]) -> u32 {
        match self {
            ComponentType::I8 | ComponentType::U8 => b[0].into(),
            ComponentType::I16 | ComponentType::U16 => u16::from_le_bytes([b[0], b[1]]).into(),
            ComponentType::U32 | ComponentType::F32 => u32::from_le_bytes([b[0], b[1], b[2], b[3]]),
        }
    }
}

/// glTF accessor, which describes rows of numbers in a buffer view and reads them.
#[derive(Clone)]
pub(super) struct Accessor {
    pub component: ComponentType,
    pub normalized: bool,
    /// Number of components in a row, which is 1 to 4, or 4, 9 or 16 for matrices.
    pub width: usize,
    pub is_matrix: bool,
    pub count: usize,
    view: Option<BufferView>,
    offset: usize,
    sparse: Option<SparseValues>,
    pub has_bounds: bool,
    /// True if the buffer view states a stride.
    pub strided: bool,
}

/// Sparse part of an accessor: rows of values, and the indices of the rows that they replace.
#[derive(Clone)]
struct SparseValues {
    count: usize,
    component: ComponentType,
    indices: (BufferView, usize),
    values: (BufferView, usize),
}

const TYPES: [(&str, usize); 7] =
    [("SCALAR", 1), ("VEC2", 2), ("VEC3", 3), ("VEC4", 4), ("MAT2", 4), ("MAT3", 9), ("MAT4", 16)];

impl Model<'_> {
    /// Reads all accessors, and returns `None` in place of each invalid one.
    pub(super) fn accessors(&self, root: &JsonRef) -> Vec<Option<Accessor>> {
        let Some(accessors) = root.get("accessors") else { return Vec::new() };
        accessors.items().map(|accessor| self.accessor_of(&accessor)).collect()
    }

    fn component(&self, at: &JsonRef) -> Option<ComponentType> {
        let code = at.integer(..)?;
        let component = ComponentType::of(code);
        if component.is_none() {
            at.error("VALUE_NOT_IN_LIST", format!("value {code} is not a component type"));
        }
        component
    }

    fn accessor_of(&self, at: &JsonRef) -> Option<Accessor> {
        at.object()?;
        let component = at.required("componentType").and_then(|code| self.component(&code));
        let count = at.required("count").and_then(|count| count.integer(1..=u64::from(u32::MAX)));
        let width = at.required("type").and_then(|kind| kind.word(&TYPES));
        let normalized = at.get("normalized").and_then(|flag| flag.boolean()).unwrap_or(false);
        let (component, count, width) = (component?, count?, width?);
        let is_matrix = at.get("type").and_then(|kind| kind.string()).is_some_and(|kind| kind.starts_with("MAT"));
        let offset = at.get("byteOffset").map_or(Some(0), |offset| offset.integer(..))? as usize;
        let view = match at.get("bufferView") {
            Some(view) => Some(self.views[view.index(self.views.len())?].clone()?),
            None => {
                if let Some(offset) = at.get("byteOffset") {
                    offset.error("UNSATISFIED_DEPENDENCY", "`byteOffset` needs a `bufferView`");
                }
                None
            }
        };
        let has_bounds = at.get("min").is_some() && at.get("max").is_some();
        let strided = view.as_ref().is_some_and(|view| view.stride.is_some());
        let count = count as usize;
        let mut accessor = Accessor {
            component,
            normalized,
            width,
            is_matrix,
            count,
            view,
            offset,
            sparse: None,
            has_bounds,
            strided,
        };
        accessor.check(at)?;
        // Missing bytes have already been reported.
        accessor.view.as_ref().map_or(Some(()), |view| view.slice.as_ref().map(|_| ()))?;
        accessor.sparse = match at.get("sparse") {
            Some(sparse) => Some(self.sparse(&sparse, &accessor)?),
            None => None,
        };
        if accessor.view.is_some() {
            self.charge(count, 4 * width, at)?;
            accessor.check_values(at);
        }
        Some(accessor)
    }

    fn sparse(&self, at: &JsonRef, accessor: &Accessor) -> Option<SparseValues> {
        let count = at.required("count")?.integer(1..)? as usize;
        if count > accessor.count {
            let message =
                format!("the sparse data replace {count} rows, but the accessor has only {} rows", accessor.count);
            at.get("count").unwrap_or(*at).error("ACCESSOR_SPARSE_COUNT_OUT_OF_RANGE", message);
            return None;
        }
        let (indices, values) = (at.required("indices")?, at.required("values")?);
        let component = self.component(&indices.required("componentType")?)?;
        if matches!(component, ComponentType::I8 | ComponentType::I16 | ComponentType::F32) {
            indices.error("VALUE_NOT_IN_LIST", "sparse indices must be unsigned integers");
            return None;
        }
        let place = |at: &JsonRef, size: usize| {
            let view = at.required("bufferView")?;
            let source = self.views[view.index(self.views.len())?].clone()?;
            if source.stride.is_some() {
                view.error("BUFFER_VIEW_INVALID_BYTE_STRIDE", "sparse data must be tightly packed");
                return None;
            }
            let offset = at.get("byteOffset").map_or(Some(0), |offset| offset.integer(..))? as usize;
            let end = count.checked_mul(size).and_then(|size| size.checked_add(offset));
            if end.is_none_or(|end| end > source.length) {
                at.error("ACCESSOR_TOO_LONG", "the sparse data do not fit into their buffer view");
                return None;
            }
            source.slice.as_ref()?;
            Some((source, offset))
        };
        let places = (place(&indices, component.size()), place(&values, accessor.row()));
        let sparse = SparseValues { count, component, indices: places.0?, values: places.1? };
        self.charge(count, 4, at)?;
        let mut previous = None;
        for i in 0..count {
            let index = sparse.index(i);
            if index as usize >= accessor.count {
                indices.error("ACCESSOR_SPARSE_INDEX_OOB", format!("sparse index {index} is out of range"));
                return None;
            }
            if previous.is_some_and(|previous| index <= previous) {
                indices.error("ACCESSOR_SPARSE_INDICES_NON_INCREASING", "sparse indices must strictly increase");
                return None;
            }
            previous = Some(index);
        }
        Some(sparse)
    }
}

impl SparseValues {
    fn index(&self, i: usize) -> u32 {
        let (view, offset) = &self.indices;
        self.component.integer(&view.bytes()[offset + i * self.component.size()..])
    }
}

impl Accessor {
    /// Returns the byte offset of the i-th number in a row. The columns of a matrix are aligned to
    /// multiples of four bytes.
    fn byte_offset(&self, i: usize) -> usize {
        let size = self.component.size();
        let rows = match self.width {
            9 => 3,
            4 if self.is_matrix => 2,
            _ => return i * size,
        };
        (i / rows) * (rows * size).next_multiple_of(4) + (i % rows) * size
    }

    /// Returns the buffer view, if the accessor has one.
    pub fn view(&self) -> Option<&BufferView> {
        self.view.as_ref()
    }

    /// Returns the size of a row in bytes.
    fn row(&self) -> usize {
        self.byte_offset(self.width - 1) + self.component.size()
    }

    fn stride(&self) -> usize {
        let dense = if self.is_matrix { self.row().next_multiple_of(self.component.size()) } else { self.row() };
        self.view.as_ref().and_then(|view| view.stride).unwrap_or(dense)
    }

    /// Returns true if bytes are probably 16-bit numbers: the accessor is the first half of its
    /// view, and every second byte is 0.
    pub fn holds_shorts(&self) -> bool {
        let Some(view) = self.view.as_ref().filter(|_| self.sparse.is_none() && self.offset == 0) else { return false };
        let bytes = view.bytes();
        let is_half = bytes.len() == (2 * self.count).next_multiple_of(4) || bytes.len() == 2 * self.count;
        self.count > 2 && is_half && bytes.as_chunks::<2>().0.iter().all(|pair| pair[1] == 0)
    }

    /// Checks that the accessor fits into its buffer view.
    fn check(&self, at: &JsonRef) -> Option<()> {
        let Some(view) = &self.view else { return Some(()) };
        let bytes = view.length;
        if self.stride() < self.row() {
            let message = format!("rows of {} bytes have a stride of only {} bytes", self.row(), self.stride());
            at.error("ACCESSOR_SMALL_BYTESTRIDE", message);
            return None;
        }
        if !self.offset.is_multiple_of(self.component.size()) {
            let message = format!("offset {} is not a multiple of the component's size", self.offset);
            at.get("byteOffset").unwrap_or(*at).error("ACCESSOR_OFFSET_ALIGNMENT", message);
            return None;
        }
        let start = view.offset.saturating_add(self.offset);
        if !start.is_multiple_of(self.component.size()) {
            let size = self.component.size();
            let message = format!("the data begin at byte {start} of the buffer, which is not a multiple of {size}");
            at.warning("ACCESSOR_TOTAL_OFFSET_ALIGNMENT", message);
        }
        let end = self.stride().checked_mul(self.count - 1).and_then(|end| end.checked_add(self.offset + self.row()));
        if end.is_none_or(|end| end > bytes) {
            let message = format!(
                "{} rows from byte {} on do not fit into a buffer view of {bytes} bytes",
                self.count, self.offset
            );
            at.error("ACCESSOR_TOO_LONG", message);
            return None;
        }
        Some(())
    }

    /// Replaces the data with tightly packed numbers that may have another component type.
    pub fn fill(&mut self, component: ComponentType, view: BufferView) {
        (self.component, self.view, self.offset, self.sparse, self.strided) = (component, Some(view), 0, None, false);
    }

    /// Checks that all numbers are finite.
    pub fn check_values(&self, at: &JsonRef) {
        if self.component != ComponentType::F32 {
            return;
        }
        let Some(view) = &self.view else { return };
        let (bytes, stride, last) = (&view.bytes()[self.offset..], self.stride(), self.byte_offset(self.width - 1));
        // Fast path for the usual case of tightly packed data without infinities or NaN.
        const EXPONENT: u32 = 0x7f80_0000;
        let is_finite = |number: &[u8; 4]| u32::from_le_bytes(*number) & EXPONENT != EXPONENT;
        let are_finite = |some: &[[u8; 4]]| some.iter().fold(true, |all, number| all & is_finite(number));
        let dense = if stride == self.row() { &bytes[..self.count * stride] } else { &[] };
        if !dense.is_empty() && dense.as_chunks::<4>().0.par_chunks(1 << 15).all(are_finite) {
            return;
        }
        // The columns of single-precision matrices need no padding.
        let is_sound = |i: &usize| {
            let (numbers, _) = bytes[i * stride..][..last + 4].as_chunks::<4>();
            numbers.iter().all(is_finite)
        };
        if let Some(i) = (0..self.count).into_par_iter().with_min_len(1 << 13).find_first(|i| !is_sound(i)) {
            at.error("ACCESSOR_INVALID_FLOAT", format!("row {i} contains an infinite value or NaN"));
        }
    }

    fn dense(&self, i: usize, row: &mut [f32]) {
        match &self.view {
            Some(view) => {
                let bytes = &view.bytes()[self.offset + i * self.stride()..];
                (0..row.len())
                    .for_each(|k| row[k] = self.component.float(&bytes[self.byte_offset(k)..], self.normalized));
            }
            None => row.fill(0.0),
        }
    }

    /// Returns all rows after applying `of` to each of them. Missing components are 0.
    pub fn rows<const N: usize, T: Send>(&self, of: impl Fn([f32; N]) -> T + Sync + Send) -> Vec<T> {
        let width = self.width.min(N);
        let is_plain = self.component == ComponentType::F32 && !self.is_matrix;
        let plain = self.view.as_ref().filter(|_| is_plain).map(|view| (&view.bytes()[self.offset..], self.stride()));
        let row = |i: usize| {
            let mut row = [0.0; N];
            let Some((bytes, stride)) = plain else {
                self.dense(i, &mut row[..width]);
                return row;
            };
            let (numbers, _) = bytes[i * stride..][..4 * width].as_chunks::<4>();
            match numbers.first_chunk::<N>() {
                Some(all) => return all.map(f32::from_le_bytes),
                None => row.iter_mut().zip(numbers).for_each(|(x, number)| *x = f32::from_le_bytes(*number)),
            }
            row
        };
        let mut rows: Vec<T> = (0..self.count).into_par_iter().with_min_len(1 << 13).map(|i| of(row(i))).collect();
        if let Some(sparse) = &self.sparse {
            let (view, offset) = &sparse.values;
            for i in 0..sparse.count {
                let (bytes, mut row) = (&view.bytes()[offset + i * self.row()..], [0.0; N]);
                (0..width).for_each(|k| row[k] = self.component.float(&bytes[self.byte_offset(k)..], self.normalized));
                rows[sparse.index(i) as usize] = of(row);
            }
        }
        rows
    }

    /// Returns the numbers of all rows as unsigned integers.
    pub fn integers(&self) -> Vec<u32> {
        let mut all: Vec<u32> = match &self.view {
            Some(view) => {
                let (bytes, stride) = (&view.bytes()[self.offset..], self.stride());
                let rows = (0..self.count).into_par_iter().with_min_len(1 << 13);
                match self.component {
                    ComponentType::U32 => rows.map(|i| ComponentType::U32.integer(&bytes[i * stride..])).collect(),
                    ComponentType::U16 => rows.map(|i| ComponentType::U16.integer(&bytes[i * stride..])).collect(),
                    other => rows.map(|i| other.integer(&bytes[i * stride..])).collect(),
                }
            }
            None => vec![0; self.count],
        };
        if let Some(sparse) = &self.sparse {
            let (view, offset) = &sparse.values;
            for i in 0..sparse.count {
                all[sparse.index(i) as usize] = self.component.integer(&view.bytes()[offset + i * self.row()..]);
            }
        }
        all
    }
}
