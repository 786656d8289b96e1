//! Camera rays for positions in the picture.

use super::error::center;
use crate::world::World;
use durer_scene::camera::{CameraSample, Projection, Raster};
use durer_scene::math::{Ray, Vec2};

/// Returns the mapping from pixel positions in a picture to the camera's coordinates.
pub fn raster(world: &World, width: u32, height: u32) -> Raster {
    Raster::new(width, height, world.camera().proportions(), world.camera_rules())
}

/// Returns the camera ray through a position in the picture, in pixels from the upper left corner,
/// and through a point on the lens in [0,1)^2. Returns `None` if the camera has no ray there.
pub fn camera_ray(world: &World, raster: &Raster, pixel: (u32, u32), place: Vec2, lens: Vec2) -> Option<Ray> {
    let pixel = raster.point(center(pixel.0, pixel.1));
    world.camera().ray(world.camera_frame(), &CameraSample { point: raster.point(place), pixel, lens })
}

/// Returns the camera ray through the centre of a pixel and the centre of the lens.
pub fn center_ray(world: &World, raster: &Raster, (x, y): (u32, u32)) -> Option<Ray> {
    world.camera().ray(world.camera_frame(), &CameraSample::at(raster.point(center(x, y))))
}
