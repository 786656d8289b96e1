import { Slider } from "../ui/slider";
import { Switch } from "../ui/switch";
import { Fields } from "./field";
import { type Store, useStore } from "./store";
import { whole } from "./zoom";

/** Panel with the settings of the camera, the display and the renderer. */
export function Settings({ store }: { store: Store }) {
  useStore(store);
  return (
    <div class="scrolls">
      <CameraFields store={store} />
      <Display store={store} />
      <Job store={store} />
    </div>
  );
}

function CameraFields({ store }: { store: Store }) {
  const { camera } = store;
  if (!camera) return null;
  return (
    <section class="settings" aria-label="Camera">
      <h3>Camera</h3>
      <CameraKind store={store} keyword={camera.keyword} />
      <Fields
        fields={camera.fields}
        set={({ name }, value, moving) => store.session.send({ kind: "field", name, ...value, moving })}
      />
      <div class="row">
        <button
          type="button"
          class="button"
          disabled={!camera.moved}
          onClick={() => store.session.send({ kind: "write_camera" })}
        >
          Write into the scene
        </button>
        <button type="button" class="button" onClick={() => store.move({ kind: "home" }, false)}>
          As written
        </button>
        <button type="button" class="button" onClick={() => store.move({ kind: "frame" }, false)}>
          See all
        </button>
      </div>
    </section>
  );
}

/** Selects the kind of the camera. Position and direction stay, as far as the new kind has them. */
function CameraKind({ store, keyword }: { store: Store; keyword: string }) {
  const kinds = store.opened?.cameras ?? [];
  return (
    <div class="field" title={kinds.find(({ name }) => name === keyword)?.doc}>
      <label for="camera">Kind</label>
      <select
        id="camera"
        value={keyword}
        onChange={(event) => store.session.send({ kind: "camera", keyword: event.currentTarget.value })}
      >
        {kinds.map(({ name, doc }) => (
          <option key={name} value={name} title={doc}>
            {name.replace(/Camera$/, "").replace(/(?<=[a-z])(?=[A-Z])/g, " ")}
          </option>
        ))}
      </select>
    </div>
  );
}

function Display({ store }: { store: Store }) {
  return (
    <section class="settings" aria-label="Display">
      <h3>Display</h3>
      <Slider
        label="Exposure"
        value={store.stops}
        min={-16}
        max={8}
        step={0.25}
        text={`${store.stops >= 0 ? "+" : "−"}${Math.abs(store.stops)} EV`}
        change={(stops) => store.show(store.picture, stops)}
      />
      <div class="field">
        <label for="tone">Tone curve</label>
        <select
          id="tone"
          value={store.tone}
          onChange={(event) => store.show(store.picture, store.stops, event.currentTarget.value)}
        >
          {store.opened?.tones.map((tone) => (
            <option key={tone}>{tone}</option>
          ))}
        </select>
      </div>
      <Switch
        label="Denoise the finished image"
        on={store.denoiseEnabled}
        change={(on) => store.denoise(on)}
      />
      <div class="row">
        {["picture.png", "picture.exr"].map((name) => (
          <button key={name} type="button" class="button" onClick={() => exportImage(store, name)}>
            {name.slice(-3).toUpperCase()}
          </button>
        ))}
      </div>
    </section>
  );
}

async function exportImage(store: Store, name: string) {
  try {
    const [, bytes] = await store.session.askBytes({ kind: "export", name }, "exported");
    download(name, bytes);
  } catch (error) {
    store.error = String(error);
    store.changed();
  }
}

/** Lets the browser download bytes as a file. */
export function download(name: string, bytes: Uint8Array<ArrayBuffer>) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([bytes]));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

const sizes = ["256x256", "512x512", "640x480", "1280x720", "1920x1080"];

function Job({ store }: { store: Store }) {
  const job = store.contents?.job;
  const option = (name: string) => store.options.find((known) => known.name === name)?.value ?? "";
  if (!job) return null;
  const size = store.head ? `${store.head.full_width}x${store.head.full_height}` : job.size.join("x");
  return (
    <section class="settings" aria-label="Render">
      <h3>Render</h3>
      <div class="field">
        <label for="size">Size</label>
        <select
          id="size"
          value={size}
          onChange={(event) => {
            const [width = 512, height = 512] = event.currentTarget.value.split("x").map(Number);
            store.setZoom(whole);
            store.session.send({ kind: "size", width, height });
          }}
        >
          {[...new Set([job.size.join("x"), size, ...sizes])].map((name) => (
            <option key={name} value={name}>
              {name.replace("x", " × ")}
            </option>
          ))}
        </select>
      </div>
      <div class="field">
        <label for="integrator">Integrator</label>
        <select
          id="integrator"
          value={option("integrator") || job.integrator}
          onChange={(event) => store.setOption("integrator", event.currentTarget.value)}
        >
          {store.opened?.integrators.map((choice) => (
            <option key={choice.name} title={choice.doc}>
              {choice.name}
            </option>
          ))}
        </select>
      </div>
      {(["samples", "bounces"] as const).map((name) => (
        <div key={name} class="field">
          <label for={name}>{name === "samples" ? "Samples" : "Bounces"}</label>
          <input
            id={name}
            type="number"
            min={name === "samples" ? 1 : 0}
            max={name === "samples" ? 65536 : 255}
            value={option(name) || job[name]}
            onChange={(event) => store.setOption(name, event.currentTarget.value || null)}
          />
        </div>
      ))}
    </section>
  );
}
