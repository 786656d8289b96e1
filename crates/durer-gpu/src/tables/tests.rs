use super::*;
use durer_render::compile::testing;

#[test]
fn objects_share_meshes_and_keep_their_numbers() {
    let world = testing::read(
        "PerspectiveCamera { center 0 0 9 direction 0 0 -1 up 0 1 0 angle 40 } Group {
        Plane { normal 0 1 0 offset -1 } Sphere { center 0 0 0 radius 1 } Plane { normal 1 0 0 offset -5 }
        Triangle { vertex0 0 0 0 vertex1 1 0 0 vertex2 0 1 0 } Cylinder { base 0 0 0 top 0 2 0 radius 0.5 } }",
    );
    let tables = Tables::new(&world);
    let kinds: Vec<u32> = tables.objects.iter().map(|object| object.kind).collect();
    assert_eq!(kinds, [layout::PLANE, layout::SPHERE, layout::PLANE, layout::MESH, layout::FRUSTUM]);
    assert_eq!(
        (tables.first_unbounded, tables.objects[0].next_unbounded, tables.objects[2].next_unbounded),
        (0, 2, NONE)
    );
    let mut leaves: Vec<u32> =
        tables.nodes[tables.root as usize..].iter().filter(|node| node.count > 0).map(|node| node.first).collect();
    leaves.sort_unstable();
    assert_eq!(leaves, [1, 3, 4]);
    // The unit cylinder along z is mapped to the one along y.
    let frustum = &tables.objects[4];
    assert_eq!((frustum.forward_y[2], frustum.shape_0[0], frustum.flags), (2.0, 1.0, layout::TRANSFORMED));
    assert_eq!(tables.triangles.len(), 1);
}

#[test]
fn probabilities_of_emitters_sum_to_one() {
    let world = testing::read(
        "PerspectiveCamera { center 0 0 9 direction 0 0 -1 up 0 1 0 angle 40 }
        Lights { PointLight { position 0 5 0 color 1 1 1 attenuation 0 0 1 } PointLight { position 0 5 0 color 0 0 0 } }
        Materials { PrincipledMaterial { emissionLuminance 3 } }
        Group { MaterialIndex 0 Sphere { center 0 0 0 radius 1 } Box { min 1 1 1 max 2 2 2 } }",
    );
    let tables = Tables::new(&world);
    let kinds: Vec<u32> = tables.emitters.iter().map(|emitter| emitter.kind).collect();
    let light = layout::LIGHT_EMITTER;
    assert_eq!(kinds, [layout::SPHERE_EMITTER, layout::HIDDEN_EMITTER, light, light]);
    let sum: f32 = tables.emitters.iter().map(|emitter| emitter.probability).sum();
    assert!((sum - 1.0).abs() < 1e-6, "{sum}");
    assert_eq!(tables.emitters[1].probability, 0.0);
    assert_eq!(tables.emitters[3].probability, 0.0);
    assert!(tables.emitters.windows(2).all(|pair| pair[0].cumulative <= pair[1].cumulative));
    assert!(tables.emitters[3].cumulative > 1.0);
    assert_eq!((tables.objects[0].first_emitter, tables.objects[1].first_emitter), (0, 1));
}
