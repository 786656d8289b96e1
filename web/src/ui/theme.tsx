import { useEffect, useState } from "preact/hooks";

type Theme = "system" | "light" | "dark";
const next: Record<Theme, Theme> = { system: "light", light: "dark", dark: "system" };
const sign: Record<Theme, string> = { system: "◐", light: "☀", dark: "☾" };

function stored(): Theme {
  try {
    const known = localStorage.getItem("durer-theme");
    return known === "light" || known === "dark" ? known : "system";
  } catch {
    // Some browsers have no storage for files.
    return "system";
  }
}

function store(theme: Theme) {
  try {
    localStorage.setItem("durer-theme", theme);
  } catch {
    // The choice lasts as long as the page.
  }
}

/** Button that selects a light, dark or system theme. */
export function ThemeButton() {
  const [theme, setTheme] = useState<Theme>(stored);
  useEffect(() => {
    store(theme);
    if (theme === "system") delete document.documentElement.dataset.theme;
    else document.documentElement.dataset.theme = theme;
    window.dispatchEvent(new CustomEvent("durer-theme"));
  }, [theme]);
  return (
    <button
      type="button"
      class="button icon plain"
      title={`Colours: ${theme}`}
      aria-label={`Colours: ${theme}`}
      onClick={() => setTheme(next[theme])}
    >
      {sign[theme]}
    </button>
  );
}
