import type { ComponentChildren } from "preact";
import { useEffect } from "preact/hooks";
import { ThemeButton } from "../ui/theme";

/** Layout of a report: a bar with the title, and the content below it. */
export function Shell({
  command,
  title,
  height = "content",
  children,
}: {
  /** Command that wrote the report. */
  command: string;
  title: string;
  /** Height of the page: that of its content, or that of the window. */
  height?: "content" | "window";
  children: ComponentChildren;
}) {
  useEffect(() => {
    document.title = title;
  }, [title]);
  return (
    <div class={`app report ${height}`}>
      <header class="bar">
        <span class="name">Dürer</span>
        <span class="file">{command}</span>
        <span class="space" />
        <ThemeButton />
      </header>
      {children}
    </div>
  );
}
