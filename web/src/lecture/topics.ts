import { barycentric } from "./figures/barycentric";
import { camera } from "./figures/camera";
import { glass } from "./figures/glass";
import { machine } from "./figures/machine";
import { mirror } from "./figures/mirror";
import { normals } from "./figures/normals";
import { paths } from "./figures/paths";
import { pinhole } from "./figures/pinhole";
import { plane } from "./figures/plane";
import { projection } from "./figures/projection";
import { ray } from "./figures/ray";
import { samples } from "./figures/samples";
import { shading } from "./figures/shading";
import { shadow } from "./figures/shadow";
import { solids } from "./figures/solids";
import { sphere } from "./figures/sphere";
import { transform } from "./figures/transform";
import type { Topic } from "./topic";

/** All topics, in the order of the lecture. */
export const topics: Topic[] = [
  machine,
  ray,
  pinhole,
  camera,
  projection,
  plane,
  sphere,
  barycentric,
  transform,
  normals,
  solids,
  shading,
  shadow,
  mirror,
  glass,
  samples,
  paths,
];
