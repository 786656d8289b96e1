// First hits of rays, for tests against the CPU.

@compute @workgroup_size(WORKGROUP)
fn trace_hits(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= params.ray_count {
        return;
    }
    let camera = camera_rays[id.x];
    let ray = Ray(camera.origin, camera.dir, camera.t_min, camera.t_max, NONE, NONE);
    let hit = find_hit(ray, false);
    results[id.x] = RayResult(vec3<f32>(hit.t, hit.uv), hit.object, hit.part, 0u, 0u, 0u);
}
