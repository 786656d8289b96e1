//! Structs and constants that Rust and WGSL share.
//!
//! Each struct is declared once, with the macro `shared!`, which also lists its fields. The WGSL
//! declaration is generated from that list by [`declarations`]. A test compares the offsets of all
//! fields with those that naga computes.
//!
//! A `vec3<f32>` is aligned to 16 bytes in WGSL. Every [`Vector`](VECTOR) is therefore followed by
//! a field of four bytes.

use bytemuck::{Pod, Zeroable};
use std::mem::{offset_of, size_of};

/// WGSL name of three numbers.
pub const VECTOR: &str = "vec3<f32>";

/// Field of a shared struct.
#[derive(Clone, Copy, Debug)]
pub struct Field {
    /// Name in Rust and in WGSL.
    pub name: &'static str,
    /// Type in WGSL.
    pub kind: &'static str,
    /// Offset in bytes.
    pub offset: usize,
}

/// Struct that Rust and WGSL share.
#[derive(Clone, Copy, Debug)]
pub struct Layout {
    /// Name in Rust and in WGSL.
    pub name: &'static str,
    /// Size in bytes.
    pub size: usize,
    /// Fields, in order.
    pub fields: &'static [Field],
}

macro_rules! rust_type {
    (number) => {
        f32
    };
    (index) => {
        u32
    };
    (vector) => {
        [f32; 3]
    };
    (row) => {
        [f32; 4]
    };
}

macro_rules! wgsl_type {
    (number) => {
        "f32"
    };
    (index) => {
        "u32"
    };
    (vector) => {
        VECTOR
    };
    (row) => {
        "vec4<f32>"
    };
}

macro_rules! shared {
    ($($(#[$doc:meta])* $name:ident { $($(#[$field_doc:meta])* $field:ident: $kind:ident,)+ })+) => {
        $(
            $(#[$doc])*
            #[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
            #[repr(C)]
            pub struct $name {
                $($(#[$field_doc])* pub $field: rust_type!($kind),)+
            }
        )+

        /// Layouts of all shared structs.
        pub const LAYOUTS: &[Layout] = &[$(Layout {
            name: stringify!($name),
            size: size_of::<$name>(),
            fields: &[$(Field {
                name: stringify!($field),
                kind: wgsl_type!($kind),
                offset: offset_of!($name, $field),
            },)+],
        },)+];
    };
}

shared! {
    /// Values that are the same for all rays of a dispatch.
    Params {
        /// Colour of rays that hit nothing, for the Whitted integrator.
        background: vector,
        /// Number of lights.
        light_count: index,
        /// Ambient light.
        ambient: vector,
        /// Root of the tree over the bounded objects, or [`NONE`].
        root: index,
        /// Radiance of rays that hit nothing, for path tracing.
        sky: vector,
        /// Number of emitters.
        emitter_count: index,
        /// Largest depth of secondary rays.
        bounces: index,
        /// Bits such as [`SHADOWS`].
        flags: index,
        /// Smallest weight of a ray of the Whitted integrator.
        min_weight: number,
        /// Largest brightness of a term of a path after the first bounce; below 0 for no limit.
        clamp: number,
        /// First object without bounds, or [`NONE`].
        first_unbounded: index,
        /// Number of rays in the dispatch.
        ray_count: index,
        /// Unused.
        unused_0: index,
        /// Unused.
        unused_1: index,
    }

    /// Node of a binary tree of boxes. The tree over objects and the trees over the triangles of
    /// each mesh share one buffer.
    Node {
        /// Corner of the box with the smallest coordinates.
        min: vector,
        /// First of the two children, or first item of a leaf.
        first: index,
        /// Corner of the box with the largest coordinates.
        max: vector,
        /// Number of items of a leaf; 0 for an inner node.
        count: index,
    }

    /// Triangle in object space.
    Triangle {
        /// First corner.
        a: vector,
        /// Number of the triangle in its mesh.
        part: index,
        /// Second corner.
        b: vector,
        /// 1 if the triangle has normals, else 0.
        smooth_normals: index,
        /// Third corner.
        c: vector,
        /// Unused.
        unused_0: index,
        /// Unit normal at the first corner.
        normal_a: vector,
        /// Unused.
        unused_1: index,
        /// Unit normal at the second corner.
        normal_b: vector,
        /// Unused.
        unused_2: index,
        /// Unit normal at the third corner.
        normal_c: vector,
        /// Unused.
        unused_3: index,
    }

    /// Object with its shape and transform.
    Object {
        /// Kind of shape, such as [`SPHERE`].
        kind: index,
        /// Root of the tree of a mesh.
        root: index,
        /// Number of the material.
        material: index,
        /// Bits such as [`TRANSFORMED`].
        flags: index,
        /// First row of the map from world to object space.
        inverse_x: row,
        /// Second row.
        inverse_y: row,
        /// Third row.
        inverse_z: row,
        /// First row of the map from object to world space.
        forward_x: row,
        /// Second row.
        forward_y: row,
        /// Third row.
        forward_z: row,
        /// Numbers of the shape; see `shapes.wgsl`.
        shape_0: row,
        /// More numbers of the shape.
        shape_1: row,
        /// More numbers of the shape.
        shape_2: row,
        /// Half the surface area of the bounds of a closed object; below 0 for an open one.
        size: number,
        /// First emitter of the object, or [`NONE`].
        first_emitter: index,
        /// Next object without bounds, or [`NONE`].
        next_unbounded: index,
        /// Unused.
        unused_0: index,
    }

    /// Material, or pattern that mixes two materials.
    Material {
        /// Kind, such as [`PHONG`].
        kind: index,
        /// Bits such as [`FRESNEL`].
        flags: index,
        /// First material of a pattern.
        first: index,
        /// Second material of a pattern.
        second: index,
        /// First row of the map from world to pattern space.
        pattern_x: row,
        /// Second row.
        pattern_y: row,
        /// Third row.
        pattern_z: row,
        /// Diffuse colour.
        diffuse: vector,
        /// Share of the first material of a mix.
        share: number,
        /// Ambient colour, if [`OWN_AMBIENT`] is set.
        ambient: vector,
        /// Exponent of the highlight.
        exponent: number,
        /// Strength of the highlight.
        specular: vector,
        /// Index of refraction.
        ior: number,
        /// Weight of the reflected ray.
        reflective: vector,
        /// Roughness of the diffuse base of a principled material.
        roughness: number,
        /// Weight of the transmitted ray.
        transparent: vector,
        /// Number of octaves of the noise of a pattern or, with [`NOISE`], of the diffuse colour.
        octaves: index,
        /// Emitted radiance.
        emission: vector,
        /// Frequency of veins and rings.
        frequency: number,
        /// Diffuse colour where the sine is -1, if [`NOISE`] is set.
        second_diffuse: vector,
        /// Strength of the noise that distorts veins and rings.
        amplitude: number,
        /// Base colour of a principled material.
        base: vector,
        /// Share of the metal.
        metalness: number,
        /// Tint of its reflection.
        tint: vector,
        /// Alpha of its facets; below 0.001 for a mirror.
        facet_alpha: number,
        /// Tint of the transmitted light.
        transmission: vector,
        /// Share of the glass.
        transmission_weight: number,
        /// Index of refraction of the boundary of the opaque base; 1 for none.
        boundary_ior: number,
        /// Cosine-weighted mean of the reflectance of that boundary.
        boundary_mean: number,
        /// Factor on the reflection of the metal.
        specular_weight: number,
        /// First row of the material's table of albedos.
        first_albedo: index,
    }

    /// Row of a table of albedos for one cosine.
    AlbedoRow {
        /// Reflectance of the boundary, the share of the light that single scattering at the
        /// boundary keeps, and that of facets that reflect all light.
        values: row,
    }

    /// Point, directional or spot light.
    Light {
        /// Position, or unit direction towards a directional light.
        position: vector,
        /// Kind, such as [`POINT_LIGHT`].
        kind: index,
        /// Colour.
        color: vector,
        /// Squared chord of half the angular radius of a directional light; 0 without extent.
        chord2: number,
        /// Coefficients of the distance polynomial of a point light.
        attenuation: vector,
        /// Cosine at which the fade of a spot light begins.
        cos_inner: number,
        /// Unit axis of a spot light.
        axis: vector,
        /// Cosine at which the cone of a spot light ends.
        cos_outer: number,
        /// Fade of a spot light: 0 for squared, 1 for smooth, 2 for fourth.
        fade: index,
        /// Cosine of the angular radius of a directional light.
        cos_extent: number,
        /// Unused.
        unused_0: index,
        /// Unused.
        unused_1: index,
    }

    /// Light that path tracing can choose: a part of an emissive object, or a light of the scene.
    Emitter {
        /// Corner or centre.
        point: vector,
        /// Kind, such as [`TRIANGLE_EMITTER`].
        kind: index,
        /// First edge or half axis.
        edge_0: vector,
        /// Surface area.
        area: number,
        /// Second edge or half axis.
        edge_1: vector,
        /// Inner radius of a ring as a fraction of the outer one, or radius of a sphere.
        radius: number,
        /// Unit normal; 0 for a sphere.
        normal: vector,
        /// 1 if both sides emit light, else 0.
        two_sided: index,
        /// Emitted radiance.
        radiance: vector,
        /// Probability with which the emitter is chosen.
        probability: number,
        /// Sum of the probabilities up to and including this emitter.
        cumulative: number,
        /// Bound on the distance between the sampled and the traced surface.
        error: number,
        /// Number of the light.
        light: index,
        /// Unused.
        unused_0: index,
    }

    /// Camera ray with the identity of its sample.
    CameraRay {
        /// Origin in world space.
        origin: vector,
        /// Smallest `t` of a hit.
        t_min: number,
        /// Direction.
        dir: vector,
        /// Largest `t` of a hit.
        t_max: number,
        /// Lower half of the hash of the seed and the pixel.
        key_low: index,
        /// Upper half of that hash.
        key_high: index,
        /// Number of the sample in its pixel.
        sample: index,
        /// Unused.
        unused_0: index,
    }

    /// Result for one camera ray.
    RayResult {
        /// Radiance or, for a hit, `t` and the two surface coordinates.
        color: vector,
        /// Number of rays that were traced or, for a hit, the object.
        rays: index,
        /// Bits such as [`TOO_MANY_RAYS`] or, for a hit, the part.
        flags: index,
        /// Unused.
        unused_0: index,
        /// Unused.
        unused_1: index,
        /// Unused.
        unused_2: index,
    }
}

/// Value of a shared constant.
#[derive(Clone, Copy, Debug)]
pub enum Constant {
    /// An unsigned integer.
    Index(u32),
    /// A number in single precision.
    Number(f32),
}

impl From<u32> for Constant {
    fn from(value: u32) -> Self {
        Constant::Index(value)
    }
}

impl From<f32> for Constant {
    fn from(value: f32) -> Self {
        Constant::Number(value)
    }
}

macro_rules! constants {
    ($($(#[$doc:meta])* $name:ident: $kind:ident = $value:expr;)+) => {
        $($(#[$doc])* pub const $name: $kind = $value;)+

        /// Returns the names and values of all shared constants.
        pub fn constants() -> Vec<(&'static str, Constant)> {
            vec![$((stringify!($name), Constant::from($name)),)+]
        }
    };
}

constants! {
    /// Index that stands for nothing.
    NONE: u32 = u32::MAX;
    /// Distance that stands for infinity. WGSL does not guarantee infinities.
    FAR: f32 = 3.0e38;
    /// Number of invocations of a workgroup.
    WORKGROUP: u32 = 64;
    /// Greatest depth of a tree, and therefore the size of the traversal stack.
    MAX_DEPTH: u32 = 64;
    /// Number of materials that a pattern can mix at one point.
    MAX_PARTS: u32 = 4;
    /// Number of lobes of all these materials.
    MAX_LOBES: u32 = 20;
    /// Number of transparent objects that can contain a ray.
    MAX_MEDIA: u32 = 4;
    /// Greatest depth of secondary rays of the Whitted integrator.
    MAX_WHITTED_BOUNCES: u32 = 32;
    /// Size of the stack of waiting rays, which is one more than the greatest depth.
    MAX_WAITING: u32 = 33;
    /// Number of rays that one camera ray can cause in the Whitted integrator.
    MAX_WHITTED_RAYS: u32 = 16384;
    /// Number of transparent surfaces that a shadow ray can pass.
    MAX_LAYERS: u32 = 64;
    /// Number of surfaces without effect that a path can pass between two vertices.
    MAX_PASSED: u32 = 64;
    /// Numbers of pairs of random numbers at each vertex of a path.
    DIMENSIONS: u32 = 4;

    /// Flag of [`Params`]: objects cast shadows.
    SHADOWS: u32 = 1;
    /// Flag of [`Params`]: surfaces seen from behind are shaded with a flipped normal.
    SHADE_BACK: u32 = 2;
    /// Flag of [`Params`]: transparent objects cast coloured shadows.
    TRANSPARENT_SHADOWS: u32 = 4;
    /// Flag of [`Params`]: reflected rays are traced.
    REFLECTION: u32 = 8;
    /// Flag of [`Params`]: transmitted rays are traced.
    REFRACTION: u32 = 16;

    /// Shape: triangles in a tree of their own.
    MESH: u32 = 0;
    /// Shape: sphere.
    SPHERE: u32 = 1;
    /// Shape: infinite plane.
    PLANE: u32 = 2;
    /// Shape: axis-aligned box.
    CUBOID: u32 = 3;
    /// Shape: disc with a hole.
    DISC: u32 = 4;
    /// Shape: parallelogram.
    RECTANGLE: u32 = 5;
    /// Shape: frustum of a cone along z from 0 to 1, with radius 1 at the base.
    FRUSTUM: u32 = 6;

    /// Face of a frustum: disc at the base.
    BASE_FACE: u32 = 0;
    /// Face of a frustum: disc at the top.
    TOP_FACE: u32 = 1;
    /// Face of a frustum: side.
    SIDE_FACE: u32 = 2;

    /// Flag of an [`Object`]: it has a transform.
    TRANSFORMED: u32 = 1;

    /// Kind of material: Phong, or a principled material reduced to the same parameters.
    PHONG: u32 = 0;
    /// Kind of material: checkerboard of unit cubes.
    CHECKERBOARD: u32 = 1;
    /// Kind of material: mix in a constant proportion.
    MIX: u32 = 2;
    /// Kind of material: one material on the front and another on the back.
    TWO_SIDED: u32 = 3;
    /// Kind of material: two materials in veins across the x axis.
    MARBLE: u32 = 4;
    /// Kind of material: two materials in rings around the y axis.
    WOOD: u32 = 5;
    /// Kind of material: two materials mixed by noise.
    SOLID_NOISE: u32 = 6;

    /// Flag of a [`Material`]: the ambient colour differs from the diffuse colour.
    OWN_AMBIENT: u32 = 1;
    /// Flag of a [`Material`]: it has a highlight.
    HIGHLIGHT: u32 = 2;
    /// Flag of a [`Material`]: the highlight is Phong's instead of Blinn's.
    PHONG_HIGHLIGHT: u32 = 4;
    /// Flag of a [`Material`]: surfaces that face away from a light also have highlights.
    HIGHLIGHT_BEHIND: u32 = 8;
    /// Flag of a [`Material`]: reflection and transmission are weighted by Fresnel's equations.
    FRESNEL: u32 = 16;
    /// Flag of a [`Material`]: it emits light.
    EMITS: u32 = 32;
    /// Flag of a [`Material`]: both sides emit light.
    EMITS_BOTH: u32 = 64;
    /// Flag of a [`Material`]: the diffuse colour varies in veins.
    NOISE: u32 = 256;
    /// Flag of a [`Material`]: paths use the parameters of a principled material.
    PRINCIPLED: u32 = 128;
    /// Flag of a [`Material`]: light that is scattered several times between facets is restored.
    COMPENSATES: u32 = 512;
    /// Number of rows of a material's table of albedos.
    ALBEDO_ROWS: u32 = 32;

    /// Kind of [`Light`]: point light.
    POINT_LIGHT: u32 = 0;
    /// Kind of [`Light`]: directional light.
    DIRECTIONAL_LIGHT: u32 = 1;
    /// Kind of [`Light`]: spot light.
    SPOT_LIGHT: u32 = 2;

    /// Kind of [`Emitter`]: triangle.
    TRIANGLE_EMITTER: u32 = 0;
    /// Kind of [`Emitter`]: parallelogram.
    PARALLELOGRAM_EMITTER: u32 = 1;
    /// Kind of [`Emitter`]: ellipse with a hole.
    ELLIPSE_EMITTER: u32 = 2;
    /// Kind of [`Emitter`]: sphere.
    SPHERE_EMITTER: u32 = 3;
    /// Kind of [`Emitter`]: light of the scene.
    LIGHT_EMITTER: u32 = 4;
    /// Kind of [`Emitter`]: surface that only rays that hit it find.
    HIDDEN_EMITTER: u32 = 5;

    /// Flag of a [`RayResult`]: a camera ray caused more rays than [`MAX_WHITTED_RAYS`].
    TOO_MANY_RAYS: u32 = 1;
    /// Flag of a [`RayResult`]: more transparent objects overlap than [`MAX_MEDIA`].
    TOO_MANY_MEDIA: u32 = 2;
    /// Flag of a [`RayResult`]: a point has more materials than [`MAX_PARTS`].
    TOO_MANY_PARTS: u32 = 4;
}

/// Returns the WGSL declarations of all shared constants and structs.
pub fn declarations() -> String {
    let mut text = String::new();
    for (name, value) in constants() {
        text += &match value {
            Constant::Index(value) => format!("const {name}: u32 = {value}u;\n"),
            Constant::Number(value) => format!("const {name}: f32 = {value:?}f;\n"),
        };
    }
    for Layout { name, fields, .. } in LAYOUTS {
        text += &format!("struct {name} {{\n");
        for field in *fields {
            text += &format!("    {}: {},\n", field.name, field.kind);
        }
        text += "}\n";
    }
    text
}
