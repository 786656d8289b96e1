// Buffers. The structs are generated from `layout.rs`.

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> nodes: array<Node>;
@group(0) @binding(2) var<storage, read> triangles: array<Triangle>;
@group(0) @binding(3) var<storage, read> objects: array<Object>;
@group(0) @binding(4) var<storage, read> materials: array<Material>;
@group(0) @binding(5) var<storage, read> lights: array<Light>;
@group(0) @binding(6) var<storage, read> emitters: array<Emitter>;
@group(0) @binding(7) var<storage, read> camera_rays: array<CameraRay>;
@group(0) @binding(8) var<storage, read_write> results: array<RayResult>;
// Permutation of the integers from 0 to 255, for noise.
@group(0) @binding(9) var<uniform> permutation: array<vec4<u32>, 64>;
@group(0) @binding(10) var<storage, read> albedos: array<AlbedoRow>;

// Bits of `RayResult.flags` and number of rays of this invocation.
var<private> result_flags: u32 = 0u;
var<private> traced_rays: u32 = 0u;

fn has_flag(flag: u32) -> bool {
    return (params.flags & flag) != 0u;
}
