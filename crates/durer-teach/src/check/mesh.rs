//! Checks the meshes of a scene: triangles, edges and normals.

use super::finding::{Finding, counted, percent, vector};
use super::lines::lines;
use super::mesh_files::normals::InvalidNormals;
use super::mesh_files::topology::Topology;
use super::mesh_files::{Inwards, MeshFile};
use super::scene_probe::SceneProbe;
use durer_diag::{Diagnostic, Severity, Span};
use durer_render::world::{Material, Object as CompiledObject};
use durer_scene::dialect::Quirk;
use durer_scene::math::Vec3;

/// Fraction of zero-area triangles above which they cannot be only the poles of a surface of
/// revolution.
const MAX_DEGENERATE: f32 = 0.03;

/// Reports triangles with zero area.
pub(super) fn degenerate(scene_probe: &SceneProbe) -> Vec<Finding> {
    let mut findings = Vec::new();
    for mesh in scene_probe.meshes() {
        let (flat, all) = (&mesh.topology.degenerate, mesh.data.triangles.len());
        let Some(&first) = flat.first() else { continue };
        let count = counted(flat.len(), "triangle", "triangles");
        let message = format!("`{}` has {count} without area, of {all} in all", mesh.name.path);
        let mut diagnostic = mesh.at_triangle(scene_probe, Diagnostic::warning(message), first);
        if (flat.len() as f32) < MAX_DEGENERATE * all as f32 {
            diagnostic.severity = durer_diag::Severity::Note;
        }
        let diagnostic = diagnostic
            .effect("triangles without area are never hit, so they are invisible")
            .help("remove the triangles, or correct vertices that have the same index or position");
        findings.push(Finding::from(diagnostic).affecting_whole_picture(flat.len() == all));
    }
    findings.extend(scene_probe.models().iter().filter_map(|mesh| degenerate_model(scene_probe, mesh)));
    findings
}

/// Reports the mesh of a model if at least half of its triangles have no area.
fn degenerate_model(scene_probe: &SceneProbe, mesh: &MeshFile) -> Option<Finding> {
    let (flat, all) = (mesh.topology.degenerate.len(), mesh.data.triangles.len());
    if flat * 2 < all || all == 0 {
        return None;
    }
    let index = scene_probe.world().objects().iter().position(|object| mesh.is_used_at(object.span))? as u32;
    let name = scene_probe.object(index);
    let count = counted(flat, "triangle", "triangles");
    let diagnostic = Diagnostic::warning(format!("the {name} has {count} without area, of {all} in all"))
        .at(scene_probe.object_span(index))
        .effect("triangles without area are never hit, so they are invisible")
        .help("correct the vertices of these triangles: some have the same position, or all are on one line");
    Some(Finding::from(diagnostic).affecting_whole_picture(flat == all))
}

/// Reports holes and non-manifold edges in glass meshes, which must be closed.
pub(super) fn open_glass(scene_probe: &SceneProbe) -> Vec<Finding> {
    let mut findings = flat_glass(scene_probe);
    for mesh in scene_probe.meshes() {
        let Some(glass) = mesh.glass(scene_probe) else { continue };
        let Topology { open, non_manifold, some_edge, .. } = &mesh.topology;
        let Some([p, q]) = some_edge.map(|edge| edge.map(vector)) else { continue };
        let what = match (open, non_manifold) {
            (0, n) => {
                format!("has {} to more than two triangles", counted(*n, "edge that belongs", "edges that belong"))
            }
            (n, 0) => format!("is open: {} to only one triangle", counted(*n, "edge belongs", "edges belong")),
            (n, m) => format!(
                "is open: {} to only one triangle, {m} to more than two",
                counted(*n, "edge belongs", "edges belong")
            ),
        };
        let diagnostic = Diagnostic::warning(format!("the mesh `{}` is glass, but {what}", mesh.name.path))
            .at(glass.span)
            .effect("a ray that enters the glass through a hole never leaves it, so the refraction is wrong")
            .help(match scene_probe.model_format() {
                Some(_) => format!("close the mesh; one such edge goes from {p} to {q}"),
                None => format!(
                    "close the mesh, or write `walls thin` in its material if it is a pane; one such edge goes from {p} \
                     to {q}"
                ),
            });
        findings.push(Finding::from(diagnostic));
    }
    findings
}

/// Reports opaque meshes whose inside is visible through holes.
pub(super) fn holes(scene_probe: &SceneProbe) -> Vec<Finding> {
    let mut findings = Vec::new();
    for mesh in scene_probe.meshes().iter().filter(|mesh| mesh.glass(scene_probe).is_none() && mesh.topology.open > 0) {
        let hit = scene_probe.hits().filter(|(_, hit)| mesh.is_used_at(scene_probe.object_span(hit.object)));
        let (all, backs) = hit.fold((0, 0), |(all, backs), (_, s)| (all + 1, backs + usize::from(s.from_behind)));
        // Most rays hit the same side of an open sheet.
        if backs * 50 < all || backs * 10 > all * 7 || all == 0 {
            continue;
        }
        let edges = counted(mesh.topology.open, "edge belongs", "edges belong");
        let message = format!("`{}` has holes: {edges} to only one triangle", mesh.name.path);
        let diagnostic = Diagnostic::note(message)
            .at(mesh.name.span)
            .effect("the inside of the mesh is visible through the holes")
            .help("check whether faces are missing in the file");
        findings.push(Finding::from(diagnostic));
    }
    findings
}

/// Reports flat glass objects, which have no interior.
pub(super) fn flat_glass(scene_probe: &SceneProbe) -> Vec<Finding> {
    use super::shapes::{shape, triangle};
    use durer_scene::describe::DescribedKind as _;
    use durer_scene::shape::Shape as _;
    let world = scene_probe.world();
    let glass = |object: &&CompiledObject| {
        let refracts = |material: &Material| matches!(material, Material::Phong(phong) if phong.transparent.max_element() > 0.0 && phong.ior != 1.0);
        world.materials().get(object.material as usize).is_some_and(refracts)
    };
    let what = |object: &CompiledObject| {
        let shape = shape(object)?;
        shape.flip().map(|_| shape.own_keyword().to_lowercase())
    };
    let flat: Vec<(&CompiledObject, String)> =
        world.objects().iter().filter(glass).filter_map(|object| Some((object, what(object)?))).collect();
    // Triangles that form a closed surface enclose an interior.
    let corners: Vec<_> = flat
        .iter()
        .filter_map(|(object, _)| Some(triangle(object)?.map(|corner| object.world_point(corner))))
        .collect();
    let positions: Vec<_> = corners.iter().flatten().copied().collect();
    let triangles: Vec<[u32; 3]> = (0..corners.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let body = triangles.len() > 3 && Topology::of(&positions, &triangles).open == 0;
    let open = |(_, what): &&(&CompiledObject, String)| !(body && *what == "triangle");
    let say = |(object, what): &(&CompiledObject, String)| {
        let mut diagnostic = Diagnostic::warning(format!("this {what} is glass, but has no inside"))
            .at(object.span)
            .effect(
                "a ray that enters the glass is refracted only once, so everything behind appears to be inside the \
                 glass",
            )
            .help(match scene_probe.is_physical() && scene_probe.model_format().is_none() {
                true => "use a closed body, such as a sphere or a closed mesh, or write `walls thin` for a pane",
                false => "use a closed body, such as a sphere or a closed mesh, or set the index of refraction to 1",
            });
        // Water surfaces are often flat on purpose.
        if *what != "triangle" && !world.rules().is_bit_compatible() {
            diagnostic.severity = durer_diag::Severity::Note;
        }
        Finding::from(diagnostic)
    };
    flat.iter().filter(open).take(3).map(say).collect()
}

/// Returns the mesh files that have faces with more than three vertices. For each file, returns its
/// path, the number of such faces, the number of all faces, and the span of the first such face.
pub(super) fn large_faces<'s>(scene_probe: &SceneProbe<'s>) -> Vec<(&'s str, usize, usize, Span)> {
    let one = |mesh: &MeshFile<'s>| {
        let bytes = scene_probe.input.files.bytes(mesh.file)?;
        let (mut all, mut large, mut first) = (0, 0, None);
        for (span, line) in lines(bytes, mesh.file) {
            if line.starts_with(b"f ") || line.starts_with(b"f\t") {
                all += 1;
                if line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()).count() > 4 {
                    large += 1;
                    first.get_or_insert(span);
                }
            }
        }
        Some((&*mesh.name.path, large, all, first?))
    };
    scene_probe.meshes().iter().filter_map(one).collect()
}

/// Reports mesh files that the dialect's program misreads. It drops their last line, does not
/// understand faces with normals, or assigns normals to other vertices than the faces do.
pub(super) fn quirky_files(scene_probe: &SceneProbe) -> Vec<Finding> {
    let rules = scene_probe.world().rules();
    let mut findings = Vec::new();
    for mesh in scene_probe.meshes() {
        let Some(bytes) = scene_probe.input.files.bytes(mesh.file).filter(|_| mesh.name.path.ends_with(".obj")) else {
            continue;
        };
        let last = bytes.rsplit(|b| *b == b'\n').next().unwrap_or_default();
        if rules.has(Quirk::LostLastLine) && (last.starts_with(b"f ") || last.starts_with(b"v ")) {
            let start = (bytes.len() - last.len()) as u32;
            let span = Span { file: mesh.file, start, end: bytes.len() as u32 };
            let end = Span { start: span.end, ..span };
            let diagnostic =
                Diagnostic::warning(format!("the last line of `{}` does not end with a newline", mesh.name.path))
                    .at(span)
                    .related(mesh.name.span, "the mesh is used here")
                    .effect("this year's program loses the last line, so a face is missing and leaves a hole")
                    .help("end the file with a newline")
                    .fix(end, "\n");
            findings.push(Finding::from(diagnostic));
        }
        if rules.has(Quirk::LostLastLine)
            && let Some(span) = first_face(bytes, mesh.file, |corner| corner.matches('/').count() == 2)
        {
            let diagnostic = Diagnostic::warning(format!("faces of `{}` have normal indices", mesh.name.path))
                .at(span)
                .label("the first of them")
                .related(mesh.name.span, "the mesh is used here")
                .effect("this year's program understands only `f 1 2 3` and `f 1/1 2/2 3/3`, so it misreads the faces")
                .help("export the mesh without normals");
            findings.push(Finding::from(diagnostic));
        }
        if rules.has(Quirk::NormalsByVertex)
            && let Some(span) = first_face(bytes, mesh.file, has_different_normal)
        {
            let diagnostic = Diagnostic::warning(format!("faces of `{}` use normal indices that differ from the vertex indices", mesh.name.path))
                .at(span)
                .label("the first of them")
                .related(mesh.name.span, "the mesh is used here")
                .effect("this year's program uses normal i for vertex i and ignores the normal indices of the faces, \
                         so the shading is wrong")
                .help("write one `vn` for each `v`, in the same order, and faces as `f 1//1 2//2 3//3`; or remove the `vn` lines");
            findings.push(Finding::from(diagnostic));
        }
    }
    findings
}

/// Returns true if the normal index of a corner differs from its vertex index.
fn has_different_normal(corner: &str) -> bool {
    let mut parts = corner.split('/');
    matches!((parts.next(), parts.nth(1)), (Some(v), Some(n)) if !n.is_empty() && v != n)
}

/// Returns the first face of an OBJ file that has a corner with a property.
fn first_face(bytes: &[u8], file: u32, is_wanted: impl Fn(&str) -> bool) -> Option<Span> {
    let has_corner = |line: &[u8]| {
        line.starts_with(b"f ") && String::from_utf8_lossy(line).split_ascii_whitespace().skip(1).any(&is_wanted)
    };
    lines(bytes, file).find(|(_, line)| has_corner(line)).map(|(span, _)| span)
}

/// Reports triangles whose winding is opposite to that of their neighbours.
pub(super) fn winding(scene_probe: &SceneProbe) -> Vec<Finding> {
    let mut findings = Vec::new();
    for mesh in scene_probe.meshes().iter().filter(|mesh| mesh.odd_normals.is_none()) {
        let (turned, all) = (&mesh.topology.reversed, mesh.data.triangles.len());
        let Some(&first) = turned.first().filter(|_| !mesh.is_negligible(turned.len())) else { continue };
        let message = format!(
            "`{}` has {} whose winding is opposite to that of the neighbours, of {all} in all",
            mesh.name.path,
            counted(turned.len(), "triangle", "triangles")
        );
        let diagnostic = mesh
            .at_triangle(scene_probe, Diagnostic::warning(message), first)
            .effect("the normals of these triangles point to the opposite side, so patches are dark or wrongly shaded")
            .help("swap two vertices of each of these triangles");
        findings.push(Finding::from(diagnostic));
    }
    findings
}

/// Reports closed meshes whose normals point inwards.
pub(super) fn inside_out(scene_probe: &SceneProbe) -> Vec<Finding> {
    let mut findings = Vec::new();
    for mesh in scene_probe
        .meshes()
        .iter()
        .filter(|mesh| mesh.is_inside_out() && !mesh.is_room(scene_probe) && !mesh.is_hollow(scene_probe))
    {
        let hit = scene_probe
            .hits()
            .filter(|(_, hit)| mesh.objects.iter().any(|o| scene_probe.object_span(hit.object).start == o.span.start));
        let most = hit.count() * 2 > scene_probe.hits().count();
        let diagnostic = Diagnostic::warning(format!("the normals of `{}` point inwards", mesh.name.path))
            .at(mesh.name.span)
            .effect(
                "a ray tracer that does not flip normals shows the mesh black; as glass, the mesh refracts light \
                 the wrong way",
            )
            .help(match mesh.inwards() {
                Inwards::Normals => "negate the `vn` vectors of the file",
                Inwards::Triangles => "order the vertices of the faces counter-clockwise, as seen from outside",
                Inwards::Both => {
                    "negate the `vn` vectors of the file, and reverse the order of the vertices of its faces"
                }
            });
        findings.push(Finding::from(diagnostic).affecting_whole_picture(most));
    }
    // A mesh file that is read as a scene is both a file and a model.
    let known: Vec<u32> = findings.iter().filter_map(|found| Some(found.diagnostic.span?.file)).collect();
    let is_new = |found: &Finding| found.diagnostic.span.is_none_or(|span| !known.contains(&span.file));
    findings.extend(models_inside_out(scene_probe).into_iter().filter(is_new));
    findings
}

/// Reports closed meshes in model files whose triangles are clockwise when seen from outside.
fn models_inside_out(scene_probe: &SceneProbe) -> Vec<Finding> {
    // File formats reverse the winding under a mirroring transform, so mirrored meshes are skipped.
    let kept = |object: &CompiledObject| {
        object.to_world.as_ref().is_none_or(|to_world| {
            to_world.vector(Vec3::X).cross(to_world.vector(Vec3::Y)).dot(to_world.vector(Vec3::Z)) > 0.0
        })
    };
    let turned = scene_probe.models().iter().filter(|mesh| {
        mesh.is_inside_out()
            && !mesh.is_room(scene_probe)
            && !mesh.is_hollow(scene_probe)
            && mesh.compiled_objects(scene_probe).all(kept)
    });
    let turned: Vec<&MeshFile> = turned.collect();
    let against = scene_probe.models().iter().filter(|mesh| {
        !mesh.is_inside_out()
            && mesh.odd_normals.as_ref().is_some_and(InvalidNormals::is_against_all)
            && mesh.compiled_objects(scene_probe).all(kept)
    });
    let hidden: Vec<Finding> = against.filter_map(|mesh| wound_against_normals(scene_probe, mesh)).collect();
    // If all meshes are inside out, the program that wrote the file reversed them.
    let all = turned.len() == scene_probe.models().len();
    let say = |mesh: &MeshFile| {
        let index = scene_probe.world().objects().iter().position(|object| mesh.is_used_at(object.span))? as u32;
        let hit = scene_probe.hits().filter(|(_, hit)| mesh.is_used_at(scene_probe.object_span(hit.object))).count();
        let most = hit * 2 > scene_probe.hits().count();
        let name = scene_probe.object(index);
        let message = match mesh.inwards() {
            Inwards::Normals => format!("the normals of the {name} point inwards, against its triangles"),
            Inwards::Triangles => format!("the {name} is closed, but inside out"),
            Inwards::Both => format!("the {name} is inside out: its triangles and its normals point inwards"),
        };
        let diagnostic = Diagnostic::warning(message)
            .at(scene_probe.object_span(index))
            .effect(
                "programs that cull back faces show the inside of the mesh; as glass, the mesh refracts light the \
                 wrong way",
            )
            .help(match mesh.inwards() {
                Inwards::Normals => "negate the normals of the vertices",
                Inwards::Triangles => "order the vertices of the faces counter-clockwise, as seen from outside",
                Inwards::Both => "reverse the order of the vertices of each face, and negate the normals",
            });
        // Modelling programs often leave small inverted pieces that are hardly visible.
        let severity = if most || all { Severity::Warning } else { Severity::Note };
        Some(Finding::from(Diagnostic { severity, ..diagnostic }))
    };
    turned.into_iter().filter_map(say).chain(hidden).collect()
}

/// Reports a mesh whose material hides the backs if the order of the vertices of its triangles
/// contradicts its normals.
fn wound_against_normals(scene_probe: &SceneProbe, mesh: &MeshFile) -> Option<Finding> {
    let objects = scene_probe.world().objects();
    let index = objects.iter().position(|object| mesh.is_used_at(object.span))? as u32;
    if !super::visibility::hides_backs_of(scene_probe, index) {
        return None;
    }
    let message = format!("the triangles of the {} are wound against its normals", scene_probe.object(index));
    let diagnostic = Diagnostic::warning(message)
        .at(scene_probe.object_span(index))
        .effect("the sides to which its normals point are hidden, because its material is not double-sided")
        .help("reverse the order of the vertices of each triangle, which must be counter-clockwise as seen from the front");
    Some(Finding::from(diagnostic))
}

/// Returns true if an object uses a mesh that `inside-out` reports.
pub(super) fn is_inside_out_object(scene_probe: &SceneProbe, object: u32) -> bool {
    let span = scene_probe.object_span(object);
    let turned = scene_probe
        .meshes()
        .iter()
        .filter(|mesh| mesh.is_inside_out() && !mesh.is_room(scene_probe) && !mesh.is_hollow(scene_probe));
    turned.into_iter().any(|mesh| mesh.objects.iter().any(|own| own.span.start == span.start))
}

/// Reports normals in a mesh file that contradict its faces, are missing for some faces, or have
/// length zero.
pub(super) fn file_normals(scene_probe: &SceneProbe) -> Vec<Finding> {
    let mut findings = Vec::new();
    for mesh in scene_probe.meshes() {
        let Some(odd_normals) = &mesh.odd_normals else { continue };
        let all = mesh.data.triangles.len();
        let some = |list: &[u32]| list.first().copied().filter(|_| !mesh.is_negligible(list.len()));
        let mut say = |list: &[u32], first: u32, what: &str, effect: &str, help: &str| {
            let message = format!("{} of the triangles of `{}` {what}", percent(list.len(), all), mesh.name.path);
            let diagnostic =
                mesh.at_triangle(scene_probe, Diagnostic::warning(message), first).effect(effect).help(help);
            findings.push(Finding::from(diagnostic));
        };
        if let Some(first) = some(&odd_normals.opposed) {
            say(
                &odd_normals.opposed,
                first,
                "have normals that contradict the order of their vertices",
                "these triangles are shaded as back faces: dark, or lit from the wrong side",
                "negate the `vn` lines of these triangles, or swap two vertices of the faces",
            );
        }
        if let Some(first) = some(&odd_normals.missing) {
            say(
                &odd_normals.missing,
                first,
                "have no normals in the file, although others have some",
                "triangles without normals look faceted, or differ from their neighbours",
                "write either all faces as `f 1//1 2//2 3//3`, or none",
            );
        }
        if let Some(first) = some(&odd_normals.zero) {
            say(
                &odd_normals.zero,
                first,
                "have a normal of length 0",
                "a normal of length 0 has no direction, so the shading there is wrong",
                "give each normal a length of 1",
            );
        }
    }
    findings
}
