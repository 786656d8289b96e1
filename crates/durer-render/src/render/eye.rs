//! From places in the picture to rays.

use super::error::center;
use crate::world::World;
use durer_scene::camera::{CameraSample, Projection, Raster};
use durer_scene::math::{Ray, Vec2};

/// The picture's pixels on the square that a world's camera covers.
pub fn raster(world: &World, width: u32, height: u32) -> Raster {
    Raster::new(width, height, world.camera().proportions(), world.camera_rules())
}

/// The ray of a camera for a pixel, through a place in the picture in pixels from the upper left
/// corner, and through a point of the lens in [0,1)^2; `None` where the camera sees nothing.
pub fn camera_ray(world: &World, raster: &Raster, pixel: (u32, u32), place: Vec2, lens: Vec2) -> Option<Ray> {
    let pixel = raster.point(center(pixel.0, pixel.1));
    world.camera().ray(world.camera_frame(), &CameraSample { point: raster.point(place), pixel, lens })
}

/// The ray through a pixel's centre and the middle of the lens.
pub fn center_ray(world: &World, raster: &Raster, (x, y): (u32, u32)) -> Option<Ray> {
    world.camera().ray(world.camera_frame(), &CameraSample::at(raster.point(center(x, y))))
}
