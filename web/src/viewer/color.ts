/** Converts linear RGB to a CSS colour. */
export function hex(values: number[]): string {
  const eight = (x: number) => {
    const clear = Math.min(1, Math.max(0, x));
    const curve = clear <= 0.0031308 ? 12.92 * clear : 1.055 * clear ** (1 / 2.4) - 0.055;
    return Math.round(255 * curve)
      .toString(16)
      .padStart(2, "0");
  };
  return `#${values.map(eight).join("")}`;
}

/** Converts a CSS colour to linear RGB. */
export function linear(color: string): number[] {
  return [1, 3, 5].map((at) => {
    const curve = Number.parseInt(color.slice(at, at + 2), 16) / 255;
    const light = curve <= 0.04045 ? curve / 12.92 : ((curve + 0.055) / 1.055) ** 2.4;
    return Number(light.toFixed(5));
  });
}
