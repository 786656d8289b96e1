//! Loader for the files that a scene names. It reads and decodes each file only once.

use super::Resources;
use super::cache::AssetKey;
use super::decoded::{Encoding, decode, replace_invalid_texels, value_or_report};
use crate::world::MeshTree;
use durer_bvh::BuildQuality;
use durer_diag::{Diagnostic, Diagnostics, Severity, format_bytes_down, format_bytes_up};
use durer_image::{self as image, Encoded};
use durer_scene::describe::FileName;
use durer_scene::dialect::{DialectRules, MeshNormals, Quirk};
use durer_scene::light::{Illuminate as _, Light, PhotometricProfile};
use durer_scene::math::Aabb;
use durer_scene::medium::DensityGrid;
use durer_scene::scene::{Assets, Background, PictureBytes};
use durer_scene::shape::{HeightField, Mesh, MeshData};
use durer_scene::source::{Digest, SourceError};
use durer_scene::spectrum::{Curve, illuminants};
use durer_scene::texture::sky::SKY_WIDTH;
use durer_scene::texture::{CubeMap, Environment, Texture};
use rayon::prelude::*;
use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::Arc;

/// Temporary memory per triangle, in bytes, for building the BVH of a mesh.
const BVH_BYTES_PER_TRIANGLE: u64 = 200;
/// Temporary memory, in bytes, that each height of a height field needs while its normals are
/// computed. This is the size of two triangles with three corner normals each, plus a copy of these
/// in vertex order.
const HEIGHT_BYTES: u64 = 112;

/// Key of a decoded picture: its name and encoding.
pub(super) type PictureKey = (String, Encoding);

/// Loads the meshes, pictures, profiles, spectra and densities that are needed to compile a scene.
pub(super) struct Loader<'r> {
    pub(super) resources: Resources<'r>,
    rules: DialectRules,
    pub(super) assets: &'r Assets,
    /// Meshes by path. The value is `None` if the file could not be read, so that the error is
    /// reported only once.
    meshes: HashMap<String, Option<Arc<MeshTree>>>,
    /// Indices of textures by picture name, for Phong materials.
    texture_numbers: HashMap<String, Option<u32>>,
    /// Indices of the textures of layered materials, by picture name and encoding.
    pub(super) map_numbers: HashMap<PictureKey, Option<u32>>,
    /// Decoded pictures by file name or, for pictures in memory, by asset name.
    pub(super) decoded: HashMap<PictureKey, Option<Texture>>,
    /// Decoded pictures with mipmaps.
    pub(super) mipmapped: HashMap<PictureKey, Option<Texture>>,
    /// Pictures decoded in parallel before they are needed.
    pub(super) predecoded: HashMap<PictureKey, Texture>,
    pub(super) textures: Vec<Texture>,
}

impl<'r> Loader<'r> {
    pub(super) fn new(resources: Resources<'r>, rules: &DialectRules, assets: &'r Assets) -> Self {
        Loader {
            resources,
            rules: rules.clone(),
            assets,
            meshes: HashMap::new(),
            texture_numbers: HashMap::new(),
            map_numbers: HashMap::new(),
            decoded: HashMap::new(),
            mipmapped: HashMap::new(),
            predecoded: HashMap::new(),
            textures: Vec::new(),
        }
    }

    /// Builds the BVH of a mesh. If there are fewer rays than triangles, it chooses a faster build
    /// that gives a less efficient tree. Both trees give bit-identical hits.
    pub(super) fn tree(&self, mesh: Mesh) -> MeshTree {
        let few = self.resources.rays < mesh.len() as u64;
        MeshTree::new(mesh, if few { BuildQuality::Fast } else { BuildQuality::Balanced })
    }

    /// Returns the mesh of a file with its BVH.
    pub(super) fn mesh(&mut self, name: &FileName, diagnostics: &mut Diagnostics) -> Option<Arc<MeshTree>> {
        if let Some(known) = self.meshes.get(&name.path) {
            return known.clone();
        }
        let asset = self.assets.meshes.get(&name.path);
        let origin = self.origin(&name.path, || asset.map(|data| data.digest()));
        let known = origin.as_ref().and_then(|origin| self.resources.cache?.mesh(origin));
        if let Some(known) = known {
            self.remember(&name.path, origin.as_ref(), known.digest);
            let mesh = &known.value.mesh;
            let needed = mesh.bytes() as u64 + BVH_BYTES_PER_TRIANGLE * mesh.len() as u64;
            let tree = self.charge(name, needed, diagnostics).then_some(known.value);
            self.meshes.insert(name.path.clone(), tree.clone());
            return tree;
        }
        let count_before = diagnostics.iter().count();
        let mesh = match asset {
            Some(data) => Some(Arc::clone(data)),
            None => self.mesh_file(name, diagnostics).map(Arc::new),
        };
        let mesh = mesh.filter(|data| {
            let needed = data.bytes() as u64 + BVH_BYTES_PER_TRIANGLE * data.triangles.len() as u64;
            self.charge(name, needed, diagnostics)
        });
        let tree = mesh.map(|mut data| {
            if self.rules.has(Quirk::LooseTriangles) {
                Arc::make_mut(&mut data).separate_and_enlarge();
            }
            let by_vertex = self.rules.has(Quirk::NormalsByVertex) && Arc::make_mut(&mut data).use_normals_by_vertex();
            let normals = match self.rules.mesh_normals {
                MeshNormals::SmoothByFace if self.rules.has(Quirk::SpoiledNormals) => MeshNormals::SpoiledByFace,
                rule => rule,
            };
            let mesh = Mesh::new(data, normals, self.rules.file_normals || by_vertex);
            let mesh = self.centered(mesh);
            // The official program treats determinants smaller than this as zero.
            let least_volume = if self.rules.has(Quirk::ThinTriangles) { 1e-6 } else { 0.0 };
            Arc::new(self.tree(mesh).least_volume(least_volume))
        });
        // Cache only meshes without diagnostics, because each compilation must report the
        // diagnostics again.
        if let (Some(cache), Some(origin), Some(tree), true) =
            (self.resources.cache, origin, &tree, diagnostics.iter().count() == count_before)
        {
            cache.keep_mesh(origin, tree, self.resources.source.record().digest_of(&name.path));
        }
        self.meshes.insert(name.path.clone(), tree.clone());
        tree
    }

    /// Returns the cache key of a file or asset: the hash of the data if it is in memory, and
    /// otherwise the stamp of the file. Returns `None` if caching is off.
    pub(super) fn origin(&self, path: &str, memory: impl FnOnce() -> Option<Digest>) -> Option<AssetKey> {
        self.resources.cache?;
        memory().map(AssetKey::Memory).or_else(|| self.resources.source.stamp(path).map(AssetKey::File))
    }

    /// Records that a file was read, although its contents came from the cache.
    pub(super) fn remember(&self, path: &str, origin: Option<&AssetKey>, digest: Option<Digest>) {
        if let (Some(AssetKey::File(stamp)), Some(digest)) = (origin, digest) {
            self.resources.source.record_unchanged(path, stamp, digest);
        }
    }

    /// Reads a mesh file.
    fn mesh_file(&mut self, name: &FileName, diagnostics: &mut Diagnostics) -> Option<MeshData> {
        let (decoder, quirks) = (self.resources.decoder, self.rules.quirks);
        self.parsed(name, "mesh", diagnostics, |bytes, file, own| decoder.mesh(bytes, file, &name.path, quirks, own))
    }

    /// Parses a file. If the file has errors, the first one also shows the place where the scene
    /// names the file.
    fn parsed<T>(
        &mut self,
        name: &FileName,
        what: &str,
        diagnostics: &mut Diagnostics,
        read: impl FnOnce(&[u8], u32, &mut Diagnostics) -> Option<T>,
    ) -> Option<T> {
        let bytes = self.read(name, what, diagnostics)?;
        let file = self.resources.files.add(name.path.clone(), bytes.clone());
        let mut own = Diagnostics::default();
        let data = read(&bytes, file, &mut own);
        self.resources.files.truncate(file, 0, &own);
        own.add_to_first_error(|error| {
            if error.code.is_empty() {
                error.code = "bad-file";
            }
            error.effect.get_or_insert(format!("the {what} `{}` cannot be used", name.path));
            if name.span.has_position() {
                error.related.get_or_insert((name.span, "named here".into()));
            }
        });
        diagnostics.extend(own);
        data
    }

    /// Reads the picture of a height field and returns the mesh of the field.
    pub(super) fn height_field(&mut self, field: &HeightField, diagnostics: &mut Diagnostics) -> Option<Arc<MeshTree>> {
        let name = &field.picture;
        let bytes = self.read(name, "height image", diagnostics)?;
        let encoded = value_or_report(name, &name.path, Encoded::open(&bytes, &name.path), diagnostics)?;
        let (width, height) = encoded.size();
        let mut refuse = |message: String| diagnostics.push(Diagnostic::error(message).code("bad-file").at(name.span));
        if width < 2 || height < 2 || width * height > HeightField::MAX_PIXELS {
            let most = HeightField::MAX_PIXELS;
            refuse(format!(
                "the image of a height field must have at least 2 x 2 pixels and at most {most} pixels in all, not \
                 {width} x {height}"
            ));
            return None;
        }
        let picture = encoded.read(self.resources.memory, image::decode_linear);
        let picture = value_or_report(name, &name.path, picture, diagnostics)?;
        let mut refuse = |message: String| diagnostics.push(Diagnostic::error(message).code("bad-file").at(name.span));
        let heights: Vec<f32> = picture.pixels.iter().map(|pixel| (pixel.x + pixel.y + pixel.z) / 3.0).collect();
        drop(picture);
        if heights.iter().any(|height| !height.is_finite()) {
            refuse(format!("the image `{}` has heights that are not finite", name.path));
            return None;
        }
        if let Some(least) = heights.iter().copied().reduce(f32::min).filter(|least| *least < 0.0) {
            refuse(format!("the image `{}` has a height of {least}: heights must not be less than 0", name.path));
            return None;
        }
        let needed = HEIGHT_BYTES * heights.len() as u64;
        let terrain = field.terrain(width, heights);
        let Some(terrain) = terrain else {
            refuse(format!("the coordinates of the height field `{}` overflow", name.path));
            return None;
        };
        if !self.charge(name, needed, diagnostics) {
            return None;
        }
        Some(Arc::new(self.tree(self.centered(Mesh::of_terrain(terrain, self.rules.mesh_normals)))))
    }

    /// Moves a distant mesh to the origin to improve precision, except in bit-compatible mode.
    fn centered(&self, mesh: Mesh) -> Mesh {
        if self.rules.is_bit_compatible() { mesh } else { mesh.centered() }
    }

    /// Returns the index of a Phong material's texture.
    pub(super) fn texture(&mut self, name: &FileName, diagnostics: &mut Diagnostics) -> Option<u32> {
        if let Some(known) = self.texture_numbers.get(&name.path) {
            return *known;
        }
        let encoding = if self.rules.srgb_textures { Encoding::Srgb } else { Encoding::Linear };
        let texture = self.picture(name, PictureBytes::File(name.path.clone()), encoding, diagnostics);
        let number = texture.map(|texture| {
            self.textures.push(texture);
            (self.textures.len() - 1) as u32
        });
        self.texture_numbers.insert(name.path.clone(), number);
        number
    }

    /// Returns the cube map in a folder. If the cube map is optional, its errors are reported as
    /// warnings.
    pub(super) fn cube_map(&mut self, name: &FileName, diagnostics: &mut Diagnostics) -> Option<CubeMap> {
        let mut own = Diagnostics::default();
        let map = self.faces(name, &mut own);
        for mut finding in own.iter().cloned() {
            if self.resources.sky_optional {
                finding.severity = Severity::Warning;
                finding.label = "the background's colour is used instead".into();
            }
            diagnostics.push(finding);
        }
        map
    }

    /// Returns the intensity profile of a light, if it has one.
    pub(super) fn profile(&mut self, light: &Light, diagnostics: &mut Diagnostics) -> Option<Arc<PhotometricProfile>> {
        let name = light.profile()?;
        match self.assets.profiles.get(&name.path) {
            Some(profile) => Some(Arc::clone(profile)),
            None => {
                let decoder = self.resources.decoder;
                let read = |bytes: &[u8], file: u32, own: &mut Diagnostics| decoder.profile(bytes, file, own);
                self.parsed(name, "photometric file", diagnostics, read).map(Arc::new)
            }
        }
    }

    /// Returns the densities in a file and the box that they occupy.
    pub(super) fn density(
        &mut self,
        name: &FileName,
        diagnostics: &mut Diagnostics,
    ) -> Option<(Aabb, Arc<DensityGrid>)> {
        if let Some(known) = self.assets.densities.get(&name.path) {
            return Some(known.clone());
        }
        let (decoder, memory) = (self.resources.decoder, self.resources.memory);
        let read = |bytes: &[u8], file: u32, own: &mut Diagnostics| decoder.density(bytes, file, memory, own);
        let (bounds, grid) = self.parsed(name, "density file", diagnostics, read)?;
        self.charge(name, grid.bytes() as u64, diagnostics).then(|| (bounds, Arc::new(grid)))
    }

    /// Returns a reflectance spectrum from a file.
    pub(super) fn reflectance(&mut self, name: &FileName, diagnostics: &mut Diagnostics) -> Option<Arc<Curve>> {
        let rows = self.curve(name, diagnostics)?;
        if let Some([nm, share]) = rows.iter().find(|row| row[1] > 1.0) {
            let message = format!("the reflectance at {nm} nm is {share}: it must be from 0 to 1");
            diagnostics.push(Diagnostic::error(message).code("bad-file").at(name.span));
            return None;
        }
        Curve::reflectance(rows).map(Arc::new)
    }

    /// Returns the emission spectrum of a light, which is either a named illuminant or read from a
    /// file.
    pub(super) fn illuminant(&mut self, name: &FileName, diagnostics: &mut Diagnostics) -> Option<Arc<Curve>> {
        if let Some(known) = illuminants::illuminant(&name.path) {
            return Some(Arc::new(known));
        }
        if !name.path.contains('.') {
            let message = format!("unknown illuminant `{}`", name.path);
            let names = illuminants::NAMES;
            let help = format!("use {names}, a black body from 1000K to 20000K, or the path of a file");
            diagnostics.push(Diagnostic::error(message).code("bad-file").at(name.span).help(help));
            return None;
        }
        let emitter = Curve::light(self.curve(name, diagnostics)?);
        if emitter.is_none() {
            let message = format!("the spectrum `{}` has no visible light", name.path);
            diagnostics.push(Diagnostic::error(message).code("bad-file").at(name.span));
        }
        emitter.map(Arc::new)
    }

    /// Returns the rows of a spectrum file. A name of the form `path:column` selects one column.
    /// Otherwise, the file must contain only one spectrum.
    fn curve(&mut self, name: &FileName, diagnostics: &mut Diagnostics) -> Option<Vec<[f32; 2]>> {
        let (path, column) = match name.path.rsplit_once(':') {
            Some((path, column)) if !column.contains(['/', '\\']) => (path, Some(column)),
            _ => (&name.path[..], None),
        };
        let file = FileName { path: path.into(), span: name.span };
        let decoder = self.resources.decoder;
        let read = |bytes: &[u8], file: u32, own: &mut Diagnostics| decoder.spectrum(bytes, column, file, own);
        self.parsed(&file, "spectrum", diagnostics, read)
    }

    /// Returns the environment map, which is either read from a picture file or computed from a sky
    /// model.
    pub(super) fn environment(&mut self, written: &Background, diagnostics: &mut Diagnostics) -> Option<Environment> {
        let Some(name) = written.environment.as_ref() else {
            if written.is_night() {
                return None;
            }
            let picture = written.sky_texels()?;
            let (turn, scale) = written.environment_transform();
            return Environment::new(SKY_WIDTH, SKY_WIDTH / 2, picture, turn, scale);
        };
        let bytes = match self.assets.pictures.get(&name.path).map(|picture| &picture.bytes) {
            Some(PictureBytes::Memory(_, bytes)) => bytes.clone(),
            _ => self.read(name, "environment", diagnostics)?,
        };
        let encoded = value_or_report(name, &name.path, Encoded::open(&bytes, &name.path), diagnostics)?;
        let picture = encoded.read_for(Environment::BUILD_BYTES_PER_TEXEL, self.resources.memory, image::decode_srgb);
        let mut picture = value_or_report(name, &name.path, picture, diagnostics)?;
        let (width, height) = (picture.width, picture.height);
        let (turn, scale) = written.environment_transform();
        if let Some(message) = replace_invalid_texels(&mut picture.pixels, width, &name.path) {
            diagnostics.push(Diagnostic::warning(message).code("bad-texels").at(name.span));
        }
        let environment = Environment::new(width, height, picture.pixels, turn, scale);
        if environment.is_none() {
            let message = format!("the environment `{}` is black: it emits no light", name.path);
            let warning = Diagnostic::warning(message).code("bad-file");
            // A file name that was given by a command-line option has no position in the scene.
            diagnostics.push(if name.span.has_position() { warning.at(name.span) } else { warning });
        }
        environment.filter(|environment| self.charge(name, environment.bytes() as u64, diagnostics))
    }

    /// Reads and decodes the six faces of a cube map.
    fn faces(&mut self, name: &FileName, diagnostics: &mut Diagnostics) -> Option<CubeMap> {
        let folder = name.path.trim_end_matches(['/', '\\']);
        let (mut files, mut unread) = (Vec::with_capacity(6), Diagnostics::default());
        let candidates =
            |face: &str| ["bmp", "png", "tga", "ppm"].map(|extension| format!("{folder}/{face}.{extension}"));
        let position = |face| candidates(face).iter().position(|c| self.resources.source.contains(c));
        let positions = CubeMap::FACES.map(position);
        // A missing face should have the format of the others.
        let usual = positions.into_iter().find_map(|position| position).unwrap_or(0);
        for (face, position) in CubeMap::FACES.into_iter().zip(positions) {
            let path = candidates(face)[position.unwrap_or(usual)].clone();
            let file = FileName { path, span: name.span };
            let Some(bytes) = self.read(&file, "face of the cube map", &mut unread) else { break };
            files.push((file.path, bytes));
        }
        // The faces are decoded in parallel. Each face may use the memory that is left by the faces
        // before it.
        let mut memory = self.resources.memory;
        let mut left = Vec::with_capacity(6);
        for (path, bytes) in &files {
            left.push(memory);
            memory = memory.saturating_sub(Encoded::open(bytes, path).map_or(0, |face| face.memory_needed_raster()));
        }
        // Most of the time is spent on decoding. Errors are reported in the order of the faces.
        let srgb = self.rules.srgb_textures;
        let one = |((path, bytes), left): (&(String, Arc<[u8]>), &u64)| {
            let mut own = Diagnostics::default();
            (decode(name, path, bytes, srgb, *left, &mut own), own)
        };
        let decoded: Vec<(Option<Texture>, Diagnostics)> = files.par_iter().zip(&left).map(one).collect();
        let mut faces = Vec::with_capacity(6);
        for (face, own) in decoded {
            diagnostics.extend(own);
            faces.push(face?);
        }
        diagnostics.extend(unread);
        let bytes = faces.iter().map(|face: &Texture| face.bytes() as u64).sum();
        let affordable = self.charge(name, bytes, diagnostics);
        let mirrored_back = self.rules.has(Quirk::MirroredBack);
        Some(CubeMap { faces: faces.try_into().ok()?, mirrored_back }).filter(|_| affordable)
    }

    /// Reserves memory. If too little memory is left, reports an error and returns false.
    pub(super) fn charge(&mut self, name: &FileName, needed: u64, diagnostics: &mut Diagnostics) -> bool {
        let left = self.resources.memory;
        self.resources.memory = left.saturating_sub(needed);
        if needed > left {
            let (needed, left) = (format_bytes_up(needed), format_bytes_down(left));
            let message = format!("`{}` needs about {needed} of memory, but only {left} is left", name.path);
            diagnostics.push(Diagnostic::error(message).at(name.span).help("see `--memory`"));
        }
        needed <= left
    }

    /// Reads a file. Reports an error at the place where the scene names the file.
    pub(super) fn read(&self, name: &FileName, what: &str, diagnostics: &mut Diagnostics) -> Option<Arc<[u8]>> {
        // Skip the file if no more diagnostics can be reported.
        if diagnostics.is_full() {
            return None;
        }
        let error = match self.resources.source.read(&name.path) {
            Ok(bytes) => return Some(bytes),
            Err(error) => error,
        };
        let message = format!("the {what} cannot be read: {error}");
        let diagnostic = Diagnostic::error(message).code("missing-file").at(name.span);
        diagnostics.push(match error {
            SourceError::Missing { tried, similar, .. } => {
                let (help, folder) =
                    (missing_help(&tried, similar.as_deref()), name.path.rfind('/').map_or(0, |at| at + 1));
                // For cube maps, the scene names only the folder, so no fix can be suggested.
                match similar.filter(|_| matches!(what, "mesh" | "texture" | "height image")) {
                    Some(similar) => diagnostic.help(help).fix(name.span, format!("{}{similar}", &name.path[..folder])),
                    None => diagnostic.help(help),
                }
            }
            SourceError::Outside { .. } => diagnostic
                .help("a scene can only use files in or below its own folder, unless `--allow-outside` is given"),
            _ => diagnostic,
        });
        None
    }
}

/// Returns a help text that lists the searched paths and suggests a similar file name, if there is
/// one.
fn missing_help(tried: &[PathBuf], near: Option<&str>) -> String {
    let shown: Vec<String> = tried.iter().map(|path| path.display().to_string()).collect();
    match near {
        Some(near) if tried.is_empty() => format!("did you mean `{near}`?"),
        None if tried.is_empty() => "the scene is in memory and has no file of this name".into(),
        Some(near) => format!("did you mean `{near}`? Looked for {}", shown.join(", ")),
        None => format!("looked for {}", shown.join(", ")),
    }
}
