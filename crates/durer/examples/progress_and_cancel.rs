//! Shows a picture while it is being rendered and stops when it is good enough.

use durer::prelude::*;
use durer::render::RenderError;

pub(crate) fn main() -> Result<(), Error> {
    let mut scene = Scene::builder();
    scene.camera(PerspectiveCamera::look_at(vec3(0.0, 0.0, 5.0), Vec3::ZERO, 40.0));
    scene.background(Background { color: rgb(0.5, 0.6, 0.8), ..Default::default() });
    scene.add(Sphere::default());
    let world = scene.build()?.compile()?;

    let options = RenderJob::for_scene(&world).size((32, 24)).samples(1_u32 << 16);
    let mut render = Renderer::new(&world, options)?;
    // Another thread could stop the render with this handle.
    let canceller = render.canceller();
    let mut passes = 0;
    loop {
        match render.next_pass() {
            Ok(Some(progress)) => {
                let picture = render.image()?;
                let middle = picture.pixel(16, 12).unwrap_or_default();
                println!("{} of {} samples, middle {middle}", progress.samples, progress.all_samples);
                passes += 1;
                if progress.samples >= 4 {
                    canceller.cancel();
                }
            }
            Ok(None) => break,
            Err(Error::Render(RenderError::Cancelled)) => break,
            Err(error) => return Err(error),
        }
    }
    assert!(passes >= 1);
    Ok(())
}
