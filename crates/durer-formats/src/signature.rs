//! Signatures of file formats, which are first bytes that identify a file regardless of its name.

use durer_diag::{Diagnostic, Span, stand_in};

/// List of signatures, each with its bytes, the kind of file, and the extension that the file's
/// name should have. The extension is `None` if Dürer does not read such files as scenes.
const SIGNATURES: &[(&[u8], &str, Option<&str>)] = &[
    (b"glTF", "binary glTF", Some("glb")),
    (b"ply\n", "PLY", Some("ply")),
    (b"ply\r", "PLY", Some("ply")),
    (b"PK\x03\x04", "a ZIP archive, such as 3MF", Some("3mf")),
    (b"\x89PNG", "a picture (PNG)", None),
    (b"\xff\xd8\xff", "a picture (JPEG)", None),
    (b"v/1\x01", "a picture (OpenEXR)", None),
    (b"\xabKTX 20", "a picture (KTX2)", None),
    (b"GIF8", "a picture (GIF)", None),
    (b"%PDF", "a PDF", None),
    (b"BLENDER", "a Blender file", None),
    (b"OFF\n", "OFF", Some("off")),
    (b"OFF\r", "OFF", Some("off")),
    (b"COFF", "OFF", Some("off")),
    (b"NOFF", "OFF", Some("off")),
    (b"STOFF", "OFF", Some("off")),
    (b"IESNA", LUMINAIRE, None),
    (b"P3\n", "a picture (PPM)", None),
    (b"P6\n", "a picture (PPM)", None),
    (b"#?RADIANCE", "a picture (Radiance's)", None),
    (b"II*\0", "a picture (TIFF)", None),
    (b"MM\0*", "a picture (TIFF)", None),
    (b"7z\xbc\xaf", "a 7z archive", None),
    (b"Rar!", "a RAR archive", None),
    (b"ISO-10303-21", "STEP", None),
    (b"#VRML", "VRML", None),
    (b"{\\rtf", "a text of a word processor (RTF)", None),
    (b"\x7fELF", "a program", None),
    (b"Kaydara FBX Binary", FBX, None),
    (b"; FBX", FBX, None),
    (b"PXR-USDC", "binary USD", Some("usdc")),
    (b"#usda", "USD", Some("usda")),
];

/// Name of a format that no library in Rust reads completely; see `docs/models.md`.
const FBX: &str = "FBX";

/// Kind of a photometric file, which describes a light rather than a scene.
const LUMINAIRE: &str = "a measured luminaire (IES)";

/// Returns an error if the signature of a file shows that the file is not in the format with these
/// extensions.
pub(super) fn wrong_format_error(bytes: &[u8], file: u32, name: &str, extensions: &[&str]) -> Option<Diagnostic> {
    let last = name.rsplit(['/', '\\']).next().unwrap_or(name);
    // XML files state their encoding, and the reader of XML converts UTF-16.
    let is_xml = extensions.iter().any(|own| matches!(*own, "dae" | "xml"));
    if (bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff")) && !is_xml {
        // The bytes of the file cannot be shown, so the error has no position.
        let message = format!("`{last}` is text in UTF-16, but the text must be in UTF-8");
        return Some(Diagnostic::error(message).code("syntax").help("save the file as UTF-8 in the text editor"));
    }
    if let Some(found) = stand_in(bytes) {
        let message = format!("`{last}` is {}", found.what);
        let span = Span { file, start: 0, end: found.length as u32 };
        return Some(Diagnostic::error(message).code("bad-file").at(span).help(found.help));
    }
    if super::extension(last) == "csv" && extensions.is_empty() {
        let help = format!(
            "a measured spectrum belongs in a light or a material: `spectrum {last}`; points to measure are given by \
             `durer measure SCENE --points {last}`"
        );
        return Some(Diagnostic::error(format!("`{last}` is a table and no scene")).code("bad-file").help(help));
    }
    if super::extension(last) == "pov" && extensions.is_empty() {
        let message = format!("`{last}` is a scene of POV-Ray, which is not supported");
        let help = "write it in the scene language: docs/coming/povray.md has the words of both";
        return Some(Diagnostic::error(message).code("bad-file").help(help));
    }
    let stl: (&[u8], &str, Option<&str>) = (b"solid", "STL", Some("stl"));
    let is_stl = super::stl::is_text(bytes);
    let obj: (&[u8], &str, Option<&str>) = (b"v", "Wavefront OBJ", Some("obj"));
    let is_obj = || extensions.contains(&"stl") && super::obj::is_certain(bytes);
    let signature = SIGNATURES.iter().find(|(start, ..)| bytes.starts_with(start));
    let (start, what, own) = signature.or(is_stl.then_some(&stl)).or_else(|| is_obj().then_some(&obj))?;
    // Packages of USD are ZIP archives too.
    let own_package = *own == Some("3mf") && extensions.contains(&"usdz");
    if own_package || own.is_some_and(|own| extensions.contains(&own)) {
        return None;
    }
    let stem = last.rsplit_once('.').map_or(last, |(stem, _)| stem);
    let message = format!("`{last}` is {what}, according to its first bytes");
    let error = Diagnostic::error(message).code("bad-file");
    // A line of binary data shows nothing.
    let line = bytes.split(|byte| *byte == b'\n').next().unwrap_or_default();
    let is_text = line.iter().all(|byte| byte.is_ascii_graphic() || byte.is_ascii_whitespace());
    let span = Span { file, start: 0, end: start.trim_ascii_end().len() as u32 };
    let error = if is_text { error.at(span) } else { error };
    Some(error.help(match (own, what.starts_with("a picture")) {
        (Some(own), _) if super::extension(last) == *own => {
            format!("convert the file: `durer convert {last} -o {stem}.ply` for a mesh, or `-o {stem}.txt` for a scene")
        }
        (Some(own), _) => format!("rename the file to `{stem}.{own}`"),
        (None, _) if *what == LUMINAIRE => {
            format!("use the file in a scene: `PhotometricLight {{ position 0 3 0 file {last} }}`")
        }
        (None, _) if what.contains("word processor") => "save the document as plain text".into(),
        (None, _) if what.contains("archive") => "unpack the archive, which may contain the scene".into(),
        (None, true) => "a picture is not a model; use `--environment` to put the picture around a model".into(),
        (None, _) if *what == FBX => {
            "FBX is not supported: import the file into Blender, and export it as glTF (.glb)".into()
        }
        (None, false) => "this format is not supported: convert the file to glTF".into(),
    }))
}

#[cfg(test)]
mod tests {
    use super::wrong_format_error;

    #[test]
    fn utf16_is_refused_except_in_xml() {
        for start in [b"\xff\xfe", b"\xfe\xff"] {
            for name in ["a/b.txt", "b.obj", "b.pbrt", "b.rad", "b.stl"] {
                let error = wrong_format_error(start, 0, name, &[&name[name.len() - 3..]]).unwrap();
                let last = &name[name.len() - name.rsplit('/').next().unwrap().len()..];
                assert_eq!(error.message, format!("`{last}` is text in UTF-16, but the text must be in UTF-8"));
                assert_eq!((error.span, error.help.unwrap().contains("save the file as UTF-8")), (None, true));
            }
            assert!(wrong_format_error(start, 0, "b.xml", &["xml"]).is_none());
        }
    }

    #[test]
    fn file_with_wrong_extension_is_an_error() {
        let messages = |bytes: &[u8], name: &str, extensions: &[&str]| {
            wrong_format_error(bytes, 0, name, extensions)
                .map(|error| format!("{} ({})", error.message, error.help.unwrap()))
        };
        assert_eq!(
            messages(b"glTF\x02\0\0\0", "a/b.c.obj", &["obj"]).unwrap(),
            "`b.c.obj` is binary glTF, according to its first bytes (rename the file to `b.c.glb`)"
        );
        assert!(messages(b"ply\r\nformat", "b.stl", &["stl"]).unwrap().contains("`b.stl` is PLY"));
        assert!(messages(b"\x89PNG\r\n", "b", &[]).unwrap().contains("a picture is not a model"));
        for fbx in [&b"Kaydara FBX Binary  \0"[..], b"; FBX 7.7.0 project file\n"] {
            assert!(
                messages(fbx, "b.fbx", &[]).unwrap().contains("import the file into Blender, and export it as glTF")
            );
        }
        assert_eq!(
            messages(b"camera { location <0, 1, -3> look_at 0 }\nsphere { 0, 1 }", "b.pov", &[]).unwrap(),
            "`b.pov` is a scene of POV-Ray, which is not supported (write it in the scene language: \
             docs/coming/povray.md has the words of both)"
        );
        assert!(messages(b"ISO-10303-21;", "b.step", &[]).unwrap().contains("convert the file to glTF"));
        assert!(messages(b"PXR-USDC", "b.obj", &["obj"]).unwrap().contains("rename the file to `b.usdc`"));
        assert_eq!(messages(b"PK\x03\x04", "b.usdz", &["usda", "usdc", "usdz", "usd"]), None);
        assert!(messages(b"OFF\n8 6 12", "b.off", &[]).unwrap().contains("`b.off` is OFF"));
        assert!(messages(b"IESNA:LM-63", "b.ies", &[]).unwrap().contains("use the file in a scene"));
        assert!(messages(b"<!doctype html>", "b.glb", &["glb"]).unwrap().contains("the download probably failed"));
        assert!(messages(b"%PDF-1.7", "b.txt", &[]).unwrap().contains("`b.txt` is a PDF"));
        assert!(messages(b"Rar!\x1a\x07", "b.obj", &[]).unwrap().contains("unpack the archive"));
        assert_eq!(messages(b"glTF", "b.gltf", &["gltf", "glb"]), None);
        assert_eq!(messages(b"ply\n", "b.ply", &["ply"]), None);
        assert_eq!(messages(b"plywood", "b.obj", &["obj"]), None);
        let stl = b"solid a\nfacet normal 0 0 1\n outer loop\n vertex 0 0 0\n";
        assert!(messages(stl, "b.obj", &["obj"]).unwrap().contains("rename the file to `b.stl`"));
        assert_eq!(messages(stl, "b.stl", &["stl"]), None);
        let obj = b"# a triangle\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
        assert!(messages(obj, "b.stl", &["stl"]).unwrap().contains("`b.stl` is Wavefront OBJ"));
        assert!(messages(obj, "b.stl", &["stl"]).unwrap().contains("rename the file to `b.obj`"));
        assert_eq!(messages(obj, "b.obj", &["obj"]), None);
        assert_eq!(messages(b"v binary header of a program", "b.stl", &["stl"]), None);
    }
}
