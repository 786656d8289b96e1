/** Parts of a figure's scene, which `sceneOf` combines: background, lights, materials and objects. */
export interface SceneParts {
  /** Background colour; see `usePaper`. */
  background: string;
  materials: string[];
  group: string;
  lights?: string;
  ambient?: string;
}

const sun = "DirectionalLight { direction -0.55 -1 -0.45 color 0.72 0.71 0.68 }";

/** Returns the text of a scene. Its camera is replaced by the figure. */
export function sceneText({
  background,
  materials,
  group,
  lights = sun,
  ambient = "0.34 0.34 0.36",
}: SceneParts): string {
  return `PerspectiveCamera { center 0 0 10 direction 0 0 -1 up 0 1 0 angle 34 }
Background { color ${background} ambientLight ${ambient} }
Lights { ${lights} }
Materials { ${materials.map((inside) => `PhongMaterial { ${inside} }`).join("\n")} }
Group { ${group} }
`;
}

/** Muted colours for objects. */
export const materialPresets = {
  clay: "diffuseColor 0.72 0.30 0.18 specularColor 0.12 0.12 0.12 exponent 30",
  sky: "diffuseColor 0.20 0.38 0.62 specularColor 0.12 0.12 0.12 exponent 30",
  sand: "diffuseColor 0.78 0.62 0.36 specularColor 0.08 0.08 0.08 exponent 20",
  sage: "diffuseColor 0.30 0.48 0.34 specularColor 0.08 0.08 0.08 exponent 20",
  stone: "diffuseColor 0.58 0.57 0.55",
  mirror: "diffuseColor 0.03 0.03 0.035 specularColor 0.7 0.7 0.7 exponent 200 reflectiveColor 0.6 0.62 0.65",
} as const;
