import { barycentric } from "./figures/barycentric";
import { camera } from "./figures/camera";
import { cameras } from "./figures/cameras";
import { caustics } from "./figures/caustics";
import { epsilon } from "./figures/epsilon";
import { glass } from "./figures/glass";
import { homogeneous } from "./figures/homogeneous";
import { machine } from "./figures/machine";
import { mirror } from "./figures/mirror";
import { normals } from "./figures/normals";
import { obscura } from "./figures/obscura";
import { own } from "./figures/own";
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
import { structure } from "./figures/structures";
import { transform } from "./figures/transform";
import type { Topic } from "./topic";

/** All topics, in the order of the lecture. */
export const topics: Topic[] = [
  machine,
  ray,
  pinhole,
  obscura,
  camera,
  projection,
  cameras,
  homogeneous,
  plane,
  sphere,
  barycentric,
  transform,
  normals,
  solids,
  epsilon,
  shading,
  shadow,
  mirror,
  glass,
  samples,
  structure,
  paths,
  caustics,
  own,
];
