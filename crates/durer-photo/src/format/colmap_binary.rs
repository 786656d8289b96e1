//! Reads and writes COLMAP's tables as little-endian binary files.

use super::colmap::{ColmapTables, ImageRow, MODELS, PointRow, error, features, insert_unique, lens, parameters};
use crate::model::quaternion_of;
use crate::{Error, Reconstruction};

/// Reader of little-endian numbers from a binary file. It checks the length, and reports byte
/// offsets in errors.
pub struct ByteReader<'b> {
    file: &'b str,
    bytes: &'b [u8],
    at: usize,
}

impl<'b> ByteReader<'b> {
    /// Creates a reader for the bytes of a file. `file` is the name that error messages contain.
    pub fn new(file: &'b str, bytes: &'b [u8]) -> Self {
        ByteReader { file, bytes, at: 0 }
    }

    /// Creates an error at the current position.
    pub fn error(&self, why: impl AsRef<str>) -> Error {
        Error::in_file(self.file, format!("at byte {}: {}", self.at, why.as_ref()))
    }

    /// Reads the next `count` bytes.
    pub fn take(&mut self, count: usize) -> Result<&'b [u8], Error> {
        let taken = self.at.checked_add(count).and_then(|end| self.bytes.get(self.at..end));
        let taken = taken.ok_or_else(|| self.error("the file ends too early"))?;
        self.at += count;
        Ok(taken)
    }

    /// Reads the next `N` bytes as an array.
    pub fn array<const N: usize>(&mut self) -> Result<[u8; N], Error> {
        let mut array = [0; N];
        array.copy_from_slice(self.take(N)?);
        Ok(array)
    }

    /// Reads a 32-bit integer.
    pub fn u32(&mut self) -> Result<u32, Error> {
        Ok(u32::from_le_bytes(self.array()?))
    }

    /// Reads a 64-bit integer.
    pub fn u64(&mut self) -> Result<u64, Error> {
        Ok(u64::from_le_bytes(self.array()?))
    }

    /// Reads a finite 64-bit number.
    pub fn f64(&mut self) -> Result<f64, Error> {
        let number = f64::from_le_bytes(self.array()?);
        if number.is_finite() { Ok(number) } else { Err(self.error(format!("{number} is not finite"))) }
    }

    /// Reads `N` finite 64-bit numbers.
    pub fn numbers<const N: usize>(&mut self) -> Result<[f64; N], Error> {
        let mut numbers = [0.0; N];
        for number in &mut numbers {
            *number = self.f64()?;
        }
        Ok(numbers)
    }

    /// Reads the number of entries in a list, where each entry takes at least `bytes` bytes.
    fn count(&mut self, bytes: usize) -> Result<usize, Error> {
        let count = self.u64()?;
        let fits = usize::try_from(count).ok().filter(|count| *count <= (self.bytes.len() - self.at) / bytes);
        fits.ok_or_else(|| self.error(format!("the file is too short for {count} entries")))
    }

    fn end(&self) -> Result<(), Error> {
        if self.at == self.bytes.len() { Ok(()) } else { Err(self.error("the file should end here")) }
    }
}

/// Reads the contents of cameras.bin, images.bin, and points3D.bin. Each is given with its file
/// name.
pub fn read(folder: &str, [cameras, images, points]: [(&str, &[u8]); 3]) -> Result<Reconstruction, Error> {
    let mut tables = ColmapTables::default();
    let mut bytes = ByteReader::new(cameras.0, cameras.1);
    for _ in 0..bytes.count(24)? {
        let (id, number) = (bytes.u32()?, bytes.u32()? as i32);
        let model = MODELS.iter().position(|model| model.1 == number);
        let model = model.ok_or_else(|| bytes.error(format!("the camera model {number} is not supported")))?;
        let size = [bytes.u64()?, bytes.u64()?].map(|side| side.min(u64::from(u32::MAX)) as u32);
        let numbers = (0..MODELS[model].2).map(|_| bytes.f64()).collect::<Result<Vec<_>, _>>()?;
        let lens = lens(model, size, &numbers).map_err(|why| bytes.error(why))?;
        insert_unique(&mut tables.cameras, id, lens).map_err(|why| bytes.error(why))?;
    }
    bytes.end()?;
    let mut bytes = ByteReader::new(images.0, images.1);
    for _ in 0..bytes.count(73)? {
        let id = bytes.u32()?;
        let (quaternion, translation, camera) = (bytes.numbers()?, bytes.numbers()?, bytes.u32()?);
        let mut name = Vec::new();
        loop {
            match bytes.array()? {
                [0] => break,
                [byte] => name.push(byte),
            }
        }
        let mut list = Vec::new();
        for _ in 0..bytes.count(24)? {
            list.push(bytes.numbers()?);
            bytes.u64()?;
        }
        let name = String::from_utf8_lossy(&name).into_owned();
        let image = ImageRow { quaternion, translation, camera, name, features: list };
        insert_unique(&mut tables.images, id, image).map_err(|why| bytes.error(why))?;
    }
    bytes.end()?;
    let mut bytes = ByteReader::new(points.0, points.1);
    for _ in 0..bytes.count(51)? {
        let id = bytes.u64()?;
        let (position, color) = (bytes.numbers()?, bytes.array()?);
        bytes.f64()?;
        let mut track = Vec::new();
        for _ in 0..bytes.count(8)? {
            track.push((bytes.u32()?, bytes.u32()? as usize));
        }
        insert_unique(&mut tables.points, id, PointRow { position, color, track }).map_err(|why| bytes.error(why))?;
    }
    bytes.end()?;
    tables.into_reconstruction(folder)
}

fn put(into: &mut Vec<u8>, numbers: impl IntoIterator<Item = f64>) {
    numbers.into_iter().for_each(|number| into.extend(number.to_le_bytes()));
}

/// Writes cameras.bin, images.bin, and points3D.bin. Photographs without a pose are omitted.
pub fn write(reconstruction: &Reconstruction) -> [Vec<u8>; 3] {
    let (features, numbers) = features(reconstruction);
    let mut cameras = (reconstruction.lenses.len() as u64).to_le_bytes().to_vec();
    for (i, lens) in reconstruction.lenses.iter().enumerate() {
        let (model, p) = parameters(lens);
        cameras.extend((i as u32 + 1).to_le_bytes());
        cameras.extend(MODELS[model].1.to_le_bytes());
        lens.size.iter().for_each(|side| cameras.extend(u64::from(*side).to_le_bytes()));
        put(&mut cameras, p);
    }
    let mut images = (reconstruction.registered_count() as u64).to_le_bytes().to_vec();
    for (i, view) in reconstruction.views.iter().enumerate() {
        let Some(pose) = &view.pose else { continue };
        images.extend((i as u32 + 1).to_le_bytes());
        put(&mut images, quaternion_of(&pose.rotation).into_iter().chain(pose.translation.iter().copied()));
        images.extend((view.lens as u32 + 1).to_le_bytes());
        images.extend(view.name.bytes().filter(|byte| *byte != 0).chain([0]));
        images.extend((features[i].len() as u64).to_le_bytes());
        for (pixel, id) in &features[i] {
            put(&mut images, [pixel.x, pixel.y]);
            images.extend((*id as u64).to_le_bytes());
        }
    }
    let mut points = (reconstruction.points.len() as u64).to_le_bytes().to_vec();
    for (i, point) in reconstruction.points.iter().enumerate() {
        points.extend((i as u64 + 1).to_le_bytes());
        put(&mut points, point.position.iter().copied());
        points.extend(point.color);
        put(&mut points, [error(reconstruction, point)]);
        let posed = point
            .track
            .iter()
            .zip(&numbers[i])
            .filter(|(observation, _)| reconstruction.views[observation.view].pose.is_some());
        let track: Vec<(u32, u32)> =
            posed.map(|(observation, number)| (observation.view as u32 + 1, *number as u32)).collect();
        points.extend((track.len() as u64).to_le_bytes());
        for (view, number) in track {
            points.extend(view.to_le_bytes());
            points.extend(number.to_le_bytes());
        }
    }
    [cameras, images, points]
}
