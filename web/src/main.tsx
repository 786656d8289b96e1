import "./style/font.css";
import "./style/tokens.css";
import "./style/controls.css";
import "./style/app.css";
import "./style/model.css";
import "./style/editor.css";
import "./style/explain.css";
import "./style/lecture.css";
import "./style/slides.css";
import "./style/figures.css";
import "./style/mistakes.css";
import { render } from "preact";
import { App } from "./app";
import { connect, hasServer } from "./engine/connect";
import { libraryBuild } from "./engine/level";

const root = document.getElementById("app");
if (root) render(<App engine={connect()} />, root);

// Cache static files, so that the page works offline after the first visit.
if (!hasServer() && "serviceWorker" in navigator && location.protocol.startsWith("http")) {
  navigator.serviceWorker.register(`./offline.js?level=${libraryBuild()}`).catch(() => {});
}
