import type { SceneNode } from "../protocol";

/**
 * Returns the nodes around an object as paths such as `0.2.1`, from the outermost to the object
 * itself; empty if the tree does not contain the object.
 */
export function pathsTo(nodes: SceneNode[], object: number, above = ""): string[] {
  for (const [i, node] of nodes.entries()) {
    const path = above === "" ? String(i) : `${above}.${i}`;
    if (node.object === object) return [path];
    const below = pathsTo(node.nodes, object, path);
    if (below.length > 0) return [path, ...below];
  }
  return [];
}
