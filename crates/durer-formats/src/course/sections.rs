//! Reads the grammar of 2003 to 2019, in which a scene consists of sections, groups and objects.

use super::fields::Order;
use super::lexer::TokenKind;
use super::reader::Reader;
use super::words::{DURER_SECTIONS, SECTIONS, block_of, camera_of, is_section};
use crate::report::quoted;
use durer_diag::{Diagnostic, Span, did_you_mean};
use durer_scene::camera::Camera;
use durer_scene::describe::{DescribedKind, FileName};
use durer_scene::dialect::{Dialect, DialectSet, Quirk, set};
use durer_scene::light::Light;
use durer_scene::material::presets;
use durer_scene::material::{ColorNoise, HairMaterial, PatternMaterial, PhongMaterial, PrincipledMaterial};
use durer_scene::medium::Fog;
use durer_scene::scene::{Background, CsgOperation, Group, Material, NamedTexture, Object, ObjectKind, Spanned};
use durer_scene::shape::{HeightField, Primitive, Sphere, TriangleMesh, VoxelGrid};

/// Returns the words that begin an object, in a group or in a transform.
pub(super) fn object_words() -> impl Iterator<Item = &'static str> {
    let shapes = Primitive::kinds().into_iter().map(|shape| shape.own_keyword());
    let solids = ["Union", "Merge", "Intersection", "Difference", "Xor"];
    ["Group", "Transform", "use"].into_iter().chain(shapes).chain(["TriangleMesh", "HeightField"]).chain(solids)
}

impl Reader<'_, '_> {
    /// Reads the whole file.
    pub(super) fn scene_file(&mut self) {
        // The dialects of the course have only two kinds of cameras.
        let dialect = self.options.dialect;
        let kinds = Camera::kinds();
        let cameras = kinds.iter().filter(|c| dialect == Dialect::Durer || c.keywords()[0].1 != set::DURER);
        let sections = SECTIONS.into_iter().filter(|word| dialect == Dialect::Durer || !DURER_SECTIONS.contains(word));
        let known: Vec<&str> = cameras.map(|camera| camera.keywords()[0].0).chain(sections).collect();
        self.top(&known, |reader, word, span| {
            match word {
                "Background" => reader.background(span),
                "Fog" => reader.fog(span),
                "Lights" => reader.lights(span),
                "Textures" => reader.textures(span),
                "Materials" => reader.materials(span),
                "Group" => reader.scene.root = Some(reader.group(span)),
                "define" => reader.define(span),
                _ => match camera_of(word) {
                    Some(camera) => reader.camera(camera, span),
                    None => return false,
                },
            }
            true
        });
    }

    /// Reads sections until the end of the file. The function `section` returns true if it has
    /// handled the word.
    pub(super) fn top(&mut self, known: &[&str], mut section: impl FnMut(&mut Self, &str, Span) -> bool) {
        let mut seen: Vec<(String, Span)> = Vec::new();
        while let Some(token) = self.peek() {
            let span = self.advance();
            let word = self.text(span);
            if token.kind == TokenKind::Open {
                self.step_back();
                self.skip_block();
                self.error(Diagnostic::error("`{` without a keyword").at(span));
            } else if token.kind == TokenKind::Close {
                let message = "this `}` has no matching `{`";
                let error = Diagnostic::error(message).code("extra-brace").at(span).fix(span, "");
                self.error(error.help("look for an extra `}` further up"));
            } else if !section(self, &word, span) {
                self.unknown(&word, span, "at the top of a scene", known);
            } else if word != "define" {
                // A scene can have only one camera of any kind.
                let kind = if word.ends_with("Camera") { "Camera".to_string() } else { word.clone() };
                if let Some((_, first)) = seen.iter().find(|(earlier, _)| *earlier == kind) {
                    let message = format!("the scene has more than one `{kind}`; only the last one is used");
                    let warning = Diagnostic::warning(message).code("repeated").at(span);
                    let warning = warning.related(*first, "the first one is here");
                    self.diagnostics.push(warning);
                } else {
                    seen.push((kind, span));
                }
            }
        }
    }

    /// Reads the block of a camera, and makes this camera the camera of the scene.
    pub(super) fn camera(&mut self, mut camera: Camera, keyword: Span) {
        self.check_keyword(&camera, keyword);
        self.fields(&mut camera, keyword, Order::Listed, |_, _, _| false);
        self.scene.camera = Some(camera);
        self.scene.camera_span = keyword;
    }

    /// Reads the `Background` block.
    pub(super) fn background(&mut self, keyword: Span) {
        let mut background = Background::default();
        self.fields(&mut background, keyword, Order::Any, |_, _, _| false);
        self.scene.background = background;
        self.scene.background_span = keyword;
    }

    fn fog(&mut self, keyword: Span) {
        let mut fog = Fog::default();
        self.check_keyword(&fog, keyword);
        self.fields(&mut fog, keyword, Order::Any, |_, _, _| false);
        self.scene.fog = Some(Spanned { value: fog, span: keyword });
    }

    /// Warns about a keyword that this dialect does not have.
    pub(super) fn check_keyword<T: DescribedKind>(&mut self, item: &T, keyword: Span) {
        let word = self.text(keyword);
        let set = item.keywords().iter().find(|(w, _)| *w == word).map_or(0, |k| k.1);
        self.report_foreign_word(&word, keyword, set);
    }

    /// Reads `{ count n element ... }`. The count must be equal to the number of elements.
    fn counted(&mut self, keyword: Span, count_word: &str, mut element: impl FnMut(&mut Self, &str, Span) -> bool) {
        let errors = self.errors();
        let name = self.text(keyword);
        if !self.open(keyword) {
            return;
        }
        let (mut count, mut found) = (None, 0u32);
        loop {
            let Some((word, span)) = self.word_before_close() else {
                let short = count.is_none_or(|(n, _)| n > found);
                if !short || !self.closed_early(&name) {
                    break;
                }
                self.reopen_block(keyword, found);
                continue;
            };
            if word == count_word || word == "num_objects" && count_word == "numObjects" {
                if word == "num_objects" {
                    self.report_foreign_word(&word, span, set::F03);
                }
                if found > 0 && self.options.strict {
                    self.error(Diagnostic::error(format!("`{word}` must come first in `{name}`")).at(span));
                }
                if let Some((_, first)) = count {
                    let message = format!("`{word}` is given twice; the last one is used");
                    let warning = Diagnostic::warning(message).code("repeated").at(span);
                    self.diagnostics.push(warning.related(first, "first given here"));
                }
                match self.integer(&word) {
                    Some(n) => count = Some((n, span.join(self.last_span()))),
                    None => self.skip_values(),
                }
            } else if element(self, &word, span) {
                found += 1;
            }
        }
        if self.errors() > errors {
            return;
        }
        match count {
            Some((n, span)) if n != found => {
                let message =
                    format!("`{count_word}` says {n}, but {found} {}", if found == 1 { "follows" } else { "follow" });
                let fixed = format!("{count_word} {found}");
                let error = Diagnostic::error(message).code("wrong-count").at(span).fix(span, &*fixed);
                self.error(error.help(format!("write `{fixed}`")));
            }
            None if self.options.strict => {
                self.error(Diagnostic::error(format!("`{name}` has no `{count_word}`")).at(keyword));
            }
            _ => {}
        }
    }

    /// Returns true if a superfluous `}` has ended a top-level section. In that case, the next word
    /// belongs to that section.
    fn closed_early(&self, name: &str) -> bool {
        let word = self.peek_word().unwrap_or_default();
        // A definition may stand between the sections.
        self.depth == 0 && !is_section(&word) && word != "define" && block_of(&word) == Some(name)
    }

    fn lights(&mut self, keyword: Span) {
        let mut lights = Vec::new();
        self.counted(keyword, "numLights", |reader, word, span| {
            let light = Light::from_keyword(word).filter(|_| word.ends_with("Light"));
            let Some(mut light) = light else {
                reader.unknown(word, span, "among lights", &["DirectionalLight", "PointLight", "numLights"]);
                return false;
            };
            reader.check_keyword(&light, span);
            // Since the last assignment of 2012, the fields of point lights can be in any order.
            let free = matches!(reader.options.dialect, Dialect::F12a5 | Dialect::F16 | Dialect::Durer);
            let order = if free && matches!(light, Light::Point(_)) { Order::Any } else { Order::Listed };
            reader.fields(&mut light, span, order, |_, _, _| false);
            lights.push(Spanned { value: light, span });
            true
        });
        let added = self.options.compat & Quirk::AddedLights.bit() != 0;
        let mut known = self.scene.lights.take().filter(|_| added).unwrap_or_default();
        known.extend(lights);
        self.scene.lights = Some(known);
    }

    fn textures(&mut self, keyword: Span) {
        self.report_foreign_word("Textures", keyword, set::DURER);
        self.counted(keyword, "numTextures", |reader, word, span| {
            let Some(mut texture) = NamedTexture::from_keyword(word) else {
                reader.unknown(word, span, "among textures", &["Texture"]);
                return false;
            };
            let errors = reader.errors();
            reader.fields(&mut texture, span, Order::Any, |_, _, _| false);
            let FileName { path: name, span: at } = texture.name.clone();
            let twice = reader.scene.assets.pictures.insert(name.clone(), texture.picture()).is_some();
            if twice && reader.errors() == errors {
                reader.error(Diagnostic::error(format!("a texture `{name}` already exists")).code("repeated").at(at));
            }
            true
        });
    }

    fn materials(&mut self, keyword: Span) {
        if let (Some(_), true) = (&self.scene.root, self.options.strict) {
            self.error(Diagnostic::error("`Materials` must come before `Group`").at(keyword));
        }
        self.scene.materials.clear();
        self.named.clear_materials();
        self.counted(keyword, "numMaterials", |reader, word, span| {
            let name = reader.material_name();
            let Some(value) = reader.material(word, span) else { return false };
            if let Some(name) = name {
                reader.name_material(name);
            }
            reader.scene.materials.push(Spanned { value, span });
            true
        });
    }

    /// Reads a material if it begins with the given word.
    pub(super) fn material(&mut self, word: &str, span: Span) -> Option<Material> {
        let errors = self.errors();
        if let Some(mut solid) = PatternMaterial::from_keyword(word) {
            self.check_keyword(&solid, span);
            let mut transform = Vec::new();
            self.fields(&mut solid, span, Order::Listed, |reader, word, span| {
                let known = word == "Transform";
                if known && reader.open(span) {
                    transform = reader.matrices();
                }
                known
            });
            if self.errors() == errors {
                self.record_solid(&solid, span);
            }
            return Some(Material::Solid(solid, transform));
        }
        if let Some(mut principled) = PrincipledMaterial::from_keyword(word) {
            self.check_keyword(&principled, span);
            // If a preset comes first, later fields can change its values.
            let first = self.ahead(1).filter(|token| self.at_open() && self.text(token.span) == "preset");
            let name = first.and_then(|_| self.ahead(2)).map(|token| self.text(token.span));
            principled = name.as_deref().and_then(presets::preset).unwrap_or(principled);
            let mut seen = first.map(|token| token.span.start);
            self.fields(&mut principled, span, Order::Any, |reader, word, span| {
                let known = word == "preset";
                if known {
                    reader.preset(span, seen.take() == Some(span.start));
                }
                known
            });
            return Some(Material::Principled(Box::new(principled)));
        }
        if let Some(mut hair) = HairMaterial::from_keyword(word) {
            self.check_keyword(&hair, span);
            self.fields(&mut hair, span, Order::Any, |_, _, _| false);
            return Some(Material::Hair(hair));
        }
        let Some(mut phong) = PhongMaterial::from_keyword(word) else {
            let known = [
                "PhongMaterial",
                "PrincipledMaterial",
                "HairMaterial",
                "Material",
                "Checkerboard",
                "Noise",
                "Marble",
                "Wood",
                "Mix",
                "TwoSided",
                "numMaterials",
            ];
            self.unknown(word, span, "among materials", &known);
            return None;
        };
        self.check_keyword(&phong, span);
        let mut noise = None;
        self.fields(&mut phong, span, Order::Any, |reader, word, span| {
            let known = word == "Noise";
            if known {
                let mut colors = ColorNoise::default();
                reader.check_keyword(&colors, span);
                reader.fields(&mut colors, span, Order::Any, |_, _, _| false);
                noise = Some(colors);
            }
            known
        });
        Some(Material::Phong(Box::new(phong), noise))
    }

    /// Reads the name of a preset. A preset that comes first has already been applied at this
    /// point.
    fn preset(&mut self, word: Span, first: bool) {
        let Some(name) = self.peek_word() else { return self.expected("a name", "preset") };
        let span = self.advance();
        if presets::preset(&name).is_none() {
            let near = did_you_mean(&name, presets::PRESETS.iter().map(|row| row.0));
            let error = Diagnostic::error(format!("unknown preset `{name}`")).code("unknown-word").at(span);
            self.error(match near {
                Some(near) => error.help(format!("did you mean `{near}`?")).fix(span, near),
                None => error.help("run `durer words preset` to list the presets"),
            });
        } else if !first {
            let error = Diagnostic::error("`preset` must come first in its block").at(word);
            self.error(error.help("write `preset` before the other fields, because it sets all of them"));
        }
    }

    /// Records the first material that a solid texture uses but that does not precede the texture,
    /// because this could form a cycle. The error is reported when the number of materials is
    /// known.
    fn record_solid(&mut self, solid: &PatternMaterial, span: Span) {
        let own = self.scene.materials.len() as u32;
        let numbers = std::mem::take(&mut self.index_spans);
        if let Some(index) = durer_scene::material::Pattern::materials(solid).into_iter().find(|index| *index >= own) {
            let number = numbers.iter().rev().find(|(other, _)| *other == index).map_or(span, |(_, at)| *at);
            self.solid_uses.push((own, index, number));
        }
    }

    /// Reads the block of a group.
    pub(super) fn group(&mut self, keyword: Span) -> Group {
        let mut objects = Vec::new();
        self.counted(keyword, "numObjects", |reader, word, span| {
            match word {
                "MaterialIndex" => {
                    match reader.material_number(word) {
                        Some(index) => {
                            reader.material = Some(index);
                            reader.material_uses.push((index, span.join(reader.last_span())));
                        }
                        None => reader.skip_values(),
                    }
                    false
                }
                "define" => {
                    reader.define(span);
                    false
                }
                // In the dialect of 2003, materials are defined where they are used.
                "Material" | "PhongMaterial" if !reader.at_open() && reader.peek_word().is_some() => {
                    let found = reader.peek_word().unwrap_or_default();
                    let message = format!("`{word}` needs `{{`, but found {}", quoted(found.as_bytes()));
                    let help = format!("`MaterialIndex {found}` selects a material that is defined above");
                    let error = Diagnostic::error(message).code("syntax").at(span).help(help);
                    reader.error(error.fix(span, "MaterialIndex"));
                    reader.advance();
                    false
                }
                "Material" | "PhongMaterial" => {
                    reader.report_foreign_word("Material in Group", span, set::F03);
                    if let Some(value) = reader.material(word, span) {
                        reader.material = Some(reader.scene.materials.len() as u32);
                        reader.scene.materials.push(Spanned { value, span });
                    }
                    false
                }
                _ => reader.object(word, span).map(|object| objects.push(object)).is_some(),
            }
        });
        Group { objects }
    }

    /// Reads a voxel grid, which is a box of cells, and spheres that fill some of the cells. In
    /// files with nodes, a voxel grid is a component of type `Grid`.
    pub(super) fn voxels(&mut self, keyword: Span) -> ObjectKind {
        let (mut grid, mut balls) = (VoxelGrid::default(), Vec::new());
        self.fields(&mut grid, keyword, Order::Any, |reader, word, span| {
            match word {
                "type" => {
                    reader.advance();
                }
                "rasterizeSphere" => {
                    let mut ball = Sphere::default();
                    reader.fields(&mut ball, span, Order::Any, |_, _, _| false);
                    balls.push(ball);
                }
                _ => return false,
            }
            true
        });
        ObjectKind::Voxels(grid, balls)
    }

    /// Reads an object if it begins with the given word.
    pub(super) fn object(&mut self, word: &str, span: Span) -> Option<Object> {
        if !self.descend("objects", span) {
            return None;
        }
        // The current material is the material of this object. If the object is a group, the
        // material can change inside it.
        let material = self.material;
        let classic = |words: &[(&str, DialectSet)]| words.iter().any(|(w, s)| *w == word && s & set::CLASSIC != 0);
        let node = if word == "Group" {
            Some(ObjectKind::Group(self.group(span)))
        } else if word == "Transform" {
            self.transform(span)
        } else if word == "use" {
            self.use_object(span)
        } else if let Some(operation) = CsgOperation::from_keyword(word) {
            self.report_foreign_word(word, span, set::DURER);
            Some(ObjectKind::Solid(operation, self.group(span).objects))
        } else if word == "HeightField" {
            let mut field = HeightField::default();
            self.check_keyword(&field, span);
            self.fields(&mut field, span, Order::Any, |_, _, _| false);
            Some(ObjectKind::HeightField(field))
        } else if let Some(mut shape) = Primitive::from_keyword(word).filter(|s| classic(s.keywords())) {
            self.check_keyword(&shape, span);
            self.fields(&mut shape, span, Order::Listed, |_, _, _| false);
            Some(ObjectKind::Primitive(shape))
        } else if word == "TriangleMesh" {
            let mut mesh = TriangleMesh::default();
            self.fields(&mut mesh, span, Order::Listed, |_, _, _| false);
            Some(ObjectKind::Mesh(mesh))
        } else if word == "Grid" {
            Some(self.voxels(span))
        } else {
            let known: Vec<_> = object_words().chain(["MaterialIndex", "numObjects", "Grid", "define"]).collect();
            self.unknown(word, span, "among objects", &known);
            None
        };
        self.depth -= 1;
        node.map(|node| Object { node, material, span })
    }
}
