use crate::testing::{folder, read_in};
use durer_scene::material::PrincipledMaterial;
use durer_scene::math::Vec3;
use durer_scene::scene::Material;

const FACES: &str = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n";

/// Reads a material that has the given statements, and returns it with the diagnostics.
fn read(statements: &str) -> (PrincipledMaterial, Vec<String>) {
    let folder = folder(&[("m.mtl", format!("newmtl a\n{statements}\n").as_bytes())]);
    let (scene, messages) = read_in(folder.path(), "m.obj", FACES);
    match &scene.unwrap().materials[0].value {
        Material::Principled(layers) => (PrincipledMaterial::clone(layers), messages),
        _ => panic!(),
    }
}

fn of(statements: &str) -> PrincipledMaterial {
    let (layers, messages) = read(statements);
    assert_eq!(messages, [""; 0], "{statements}");
    layers
}

#[test]
fn material_has_the_place_of_its_name_or_of_the_opacity_that_hides_it() {
    let place = |statements: &str| {
        let mtl = format!("# no material\nnewmtl a\n{statements}\n");
        let folder = folder(&[("m.mtl", mtl.as_bytes())]);
        let span = read_in(folder.path(), "m.obj", FACES).0.unwrap().materials[0].span;
        assert_eq!(span.file, 1);
        mtl[span.start as usize..span.end as usize].to_string()
    };
    assert_eq!(place("Kd 1 0 0\nd 0.5"), "a");
    assert_eq!(place("Kd 1 0 0\nTr 1\nKs 0 0 0"), "Tr 1");
    assert_eq!(place("d 0\nTr 1"), "d 0");
}

#[test]
fn specular_weight_follows_ks_in_physical_materials_too() {
    let weight = |statements: &str| of(statements).specular_weight;
    assert_eq!((weight("Ks 0 0 0\nillum 1"), weight("Ks 0.5 0.5 0.5\nillum 2"), weight("illum 2")), (0.0, 0.5, 0.0));
    // 0.5 is the default value in Disney's model and in Blender: it stands for the reflectance that
    // follows from the index of refraction alone.
    assert_eq!((weight("Pr 0.5\nKs 0 0 0\nillum 1"), weight("Pr 0.5\nKs 0 0 0")), (0.0, 0.0));
    assert_eq!((weight("Pr 0.5\nKs 0.5 0.5 0.5\nillum 2"), weight("Pr 0.5\nKs 1 1 1")), (1.0, 2.0));
    assert_eq!((weight("Pr 0.5"), weight("Pr 0.5\nillum 1")), (1.0, 0.0));
    // The specular weight does not apply to metals. A material that is partly metal gets a
    // different index of refraction instead.
    let metal = of("Pr 0.5\nPm 1\nKs 0 0 0\nillum 1");
    assert_eq!((metal.specular_weight, metal.base_metalness), (1.0, 1.0));
    let half = of("Pr 0.5\nPm 0.5\nKs 0 0 0\nillum 1");
    assert_eq!((half.specular_weight, half.specular_ior), (1.0, 1.0));
    assert_eq!(of("Pr 0.5\nPm 0.5\nKs 0.5 0.5 0.5\nNi 1.25").specular_ior, 1.25);
}

#[test]
fn colours_may_be_in_xyz() {
    // The white point of D65 at half its luminance.
    let grey = of("Kd xyz 0.475235 0.5 0.544525").base_color;
    assert!((grey - 0.5).abs().max_element() < 1e-3, "{grey}");
}

#[test]
fn tf_is_the_transmission_of_physical_materials() {
    // Blender writes materials in this form.
    let glass = of("Kd 0.25 1 1\nKs 0.5 0.5 0.5\nNi 1.5\nd 1\nillum 2\nPr 0\nPm 0\nTf 1 1 1");
    assert_eq!((glass.transmission_weight, glass.transmission_color), (1.0, Vec3::new(0.5, 1.0, 1.0)));
    let tinted = of("Kd 1 1 1\nPr 0\nTf 0.125 0.5 0.5\nd 0.75\nillum 9");
    assert_eq!((tinted.transmission_weight, tinted.transmission_color), (0.5, Vec3::new(0.5, 1.0, 1.0)));
    assert_eq!((tinted.opacity, of("Pr 0\nTf 0 0 0\nillum 4").transmission_weight), (0.75, 0.0));
    // If there are no statements for physically based rendering, the illumination model determines
    // that this is glass. The filter is the combined colour after light has entered and left the
    // glass.
    let glass = of("Tf 0.25 1 1\nillum 4\nNi 1.25");
    assert_eq!((glass.transmission_weight, glass.transmission_color), (1.0, Vec3::new(0.5, 1.0, 1.0)));
    // Maya and 3ds Max write `Tf` for every material.
    assert_eq!(of("Tf 1 1 1\nillum 2\nd 0.5").transmission_weight, 0.0);
    assert_eq!(of("Tf 0 0 0\nillum 2\nd 1").transmission_weight, 0.0);
    let (layers, messages) = read("illum 2\nd 0.5\nTf 1 0 0");
    assert_eq!((layers.transmission_weight, layers.opacity), (0.0, 0.5));
    assert_eq!(messages, ["m.mtl:4:1 note some statements have no counterpart and are left out: Tf"]);
}

#[test]
fn findings_have_line_and_column() {
    assert_eq!(read("Pr 1\naniso 0\nanisor 0.000\nsharpness 60").1, [""; 0]);
    let (_, messages) =
        read("anisor 0.25\nKd 1 x 1 # red\n\tNs much\n  map_Kd -s 2 2 2 no \"such.png\nsharpness 9\nd -halo");
    assert_eq!(
        messages,
        [
            "m.mtl:4:5 warning material `a`: `Ns` needs a number, found `much`",
            "m.mtl:5:19 warning material `a`: the picture `no \\\"such.png` of `map_Kd` was not found",
            "m.mtl:7:1 warning material `a`: `d` needs a number",
            "m.mtl:2:1 note some statements have no counterpart and are left out: anisor, sharpness",
        ]
    );
}
