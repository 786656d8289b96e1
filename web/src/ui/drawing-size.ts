import type { RefObject } from "preact";
import { useEffect, useState } from "preact/hooks";

/** Size of a drawing in units of 1/16 of the page's font size, so that lines and labels grow with the text. */
export interface DrawingSize {
  width: number;
  height: number;
  /** Page pixels per unit. */
  unit: number;
}

/** Returns the size of an element as a drawing, and renders again when it changes. */
export function useDrawingSize(box: RefObject<HTMLElement | null>): DrawingSize {
  const [size, setSize] = useState<DrawingSize>({ width: 0, height: 0, unit: 1 });
  useEffect(() => {
    if (!box.current) return;
    const observer = new ResizeObserver(([entry]) => {
      if (!entry) return;
      const unit = Number.parseFloat(getComputedStyle(document.documentElement).fontSize) / 16 || 1;
      setSize({ width: entry.contentRect.width / unit, height: entry.contentRect.height / unit, unit });
    });
    observer.observe(box.current);
    return () => observer.disconnect();
  }, []);
  return size;
}
