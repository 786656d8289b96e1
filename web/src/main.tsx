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

const engine = connect();
const root = document.getElementById("app");
if (root) render(<App engine={engine} />, root);

// Cache static files, so that the page works offline after the first visit. Wait for the first
// picture, so that these files do not delay it.
if (!hasServer() && "serviceWorker" in navigator && location.protocol.startsWith("http")) {
  const cacheFiles = () =>
    navigator.serviceWorker.register(`./offline.js?level=${libraryBuild()}`).catch(() => {});
  engine.answered.then(() => setTimeout(cacheFiles, 1000));
}
