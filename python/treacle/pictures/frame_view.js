"use strict";
// The page of a run: frames in a view that can be turned. Uses plotly.js, which stands before it.

const run = JSON.parse(document.getElementById("data").textContent);
const font = { family: 'system-ui, "Segoe UI", Roboto, "DejaVu Sans", sans-serif', size: 12, color: "#1f2933" };
const config = { responsive: true, displaylogo: false };
const element = (id) => document.getElementById(id);

/** Bytes of compressed text (base64 of zlib). */
async function unpacked(text) {
  const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Response(stream).arrayBuffer();
}

/** Positions by axis and colours by field of a frame, whose data are unpacked when it is first shown. */
async function particlesOf(frame, view, fields) {
  if (frame.ready) return frame.ready;
  const buffer = await unpacked(frame.data);
  const axes = [], colours = [];
  let at = 0;
  for (let axis = 0; axis < view.dimensions; ++axis, at += 2 * frame.count) {
    const levels = new Uint16Array(buffer, at, frame.count);
    const low = view.low[axis], step = (view.high[axis] - low) / 65535;
    axes.push(Float32Array.from(levels, (level) => low + step * level));
  }
  for (const field of fields) {
    const levels = new Uint8Array(buffer, at, frame.count);
    const low = field.range[0], step = (field.range[1] - low) / 254;
    colours.push(Float32Array.from(levels, (level) => (level === 255 ? NaN : low + step * level)));
    at += frame.count;
  }
  frame.ready = { axes, colours };
  return frame.ready;
}

/** Where the view is seen from at first: as the pictures of the program, up against gravity. */
function firstCamera(view) {
  let main = 2;
  for (let axis = 0; axis < 3; ++axis)
    if (Math.abs(view.up[axis]) > Math.abs(view.up[main])) main = axis;
  const up = { x: 0, y: 0, z: 0 }, names = ["x", "y", "z"], sign = view.up[main] < 0 ? -1 : 1;
  up[names[main]] = sign;
  const along = names[main === 0 ? 1 : 0], away = names[3 - main - (main === 0 ? 1 : 0)];
  // cross(up, along) is the other axis, with this sign.
  const turn = sign * ((main === 2 || main === 0) ? 1 : -1);
  const eye = { ...up };
  eye[names[main]] *= 0.55;
  eye[along] = 0.6;
  eye[away] = -0.9 * turn;
  return { up, eye, center: { x: 0, y: 0, z: 0 }, projection: { type: "orthographic" } };
}

class FrameView {
  constructor(view) {
    this.view = view;
    this.flat = view.dimensions === 2;
    this.number = view.frames.length - 1;
    this.field = 0;
    this.timer = null;
    this.place = element("particles");
  }

  async start() {
    const view = this.view;
    element("slider").max = view.frames.length - 1;
    view.fields.forEach((field, k) => element("field").add(new Option(field.name.replace(/ \[.*/, ""), k)));
    if (!view.walls.some((walls) => walls.count > 0)) element("walls-label").hidden = true;
    element("hint").textContent = this.flat ? "Drag to zoom, double-click for all of it." : "Drag to turn, scroll to zoom.";
    await Plotly.newPlot(this.place, await this.traces(), this.layout(), config);
    this.place.on("plotly_relayout", () => this.resize());
    window.addEventListener("resize", () => this.resize());
    await this.resize();
    element("slider").oninput = (event) => this.show(Number(event.target.value));
    element("field").onchange = (event) => { this.field = Number(event.target.value); this.show(this.number); };
    element("walls").onchange = (event) => Plotly.restyle(this.place, { visible: event.target.checked }, [0]);
    element("play").onclick = () => (this.timer ? this.stop() : this.play());
    this.label();
  }

  layout() {
    const title = (name) => `${name} [${this.view.unit}]`;
    const range = (k) => [this.view.low[k] - this.view.spacing / 2, this.view.high[k] + this.view.spacing / 2];
    const shared = { font, margin: { l: 60, r: 10, t: 10, b: 50 }, showlegend: false, uirevision: "kept", paper_bgcolor: "#fff" };
    if (this.flat)
      return { ...shared, dragmode: "zoom", xaxis: { title: { text: title("x") }, range: range(0), constrain: "domain", zeroline: false },
        yaxis: { title: { text: title("y") }, range: range(1), scaleanchor: "x", constrain: "domain", zeroline: false } };
    const axis = (name, k) => ({ title: { text: title(name) }, range: range(k), backgroundcolor: "#fafbfc", gridcolor: "#e4e9ee", showbackground: true, zeroline: false, nticks: 6 });
    return { ...shared, margin: { l: 0, r: 0, t: 0, b: 0 },
      scene: { aspectmode: "manual", aspectratio: this.aspect(), camera: firstCamera(this.view), xaxis: axis("x", 0), yaxis: axis("y", 1), zaxis: axis("z", 2), dragmode: "turntable" } };
  }

  async traces() {
    const type = this.flat ? "scattergl" : "scatter3d", fluid = await this.fluidData(), walls = await this.wallData();
    const hover = this.flat ? "x" : "none";
    return [
      { type, mode: "markers", hoverinfo: "skip", ...walls, marker: { size: 3, color: "#b9bec4", opacity: this.flat ? 1 : 0.15, line: { width: 0 } } },
      { type, mode: "markers", hovertemplate: "%{marker.color:.4g}<extra></extra>", ...fluid.places,
        marker: { size: 3, colorscale: "Viridis", line: { width: 0 }, ...fluid.colours } },
    ];
  }

  async fluidData() {
    const frame = await particlesOf(this.view.frames[this.number], this.view, this.view.fields);
    const field = this.view.fields[this.field], places = this.named(frame.axes);
    if (!field) return { places, colours: { color: "#d99a2b" } };
    const colorbar = { title: { text: field.name, side: "right" }, thickness: 16, len: 0.8 };
    return { places, colours: { color: frame.colours[this.field], cmin: field.range[0], cmax: field.range[1], showscale: true, colorbar } };
  }

  async wallData() {
    const walls = this.view.walls[Math.min(this.number, this.view.walls.length - 1)];
    return this.named((await particlesOf(walls, this.view, [])).axes);
  }

  named(axes) {
    return Object.fromEntries(axes.map((values, axis) => ["xyz"[axis], values]));
  }

  async show(number) {
    this.number = number;
    this.label();
    const { places, colours } = await this.fluidData();
    const update = {};
    for (const [name, values] of Object.entries(places)) update[name] = [values];
    for (const [name, value] of Object.entries(colours)) update[`marker.${name}`] = [value];
    await Plotly.restyle(this.place, update, [1]);
    if (this.view.walls.length > 1) {
      const walls = await this.wallData();
      await Plotly.restyle(this.place, Object.fromEntries(Object.entries(walls).map(([name, values]) => [name, [values]])), [0]);
    }
  }

  label() {
    element("slider").value = this.number;
    element("time").textContent = `t = ${Number(this.view.frames[this.number].time.toPrecision(6))} s`;
  }

  /** Particles as large as their spacing, larger where they stand for others, however near. A marker of plotly.js of size 1
   * is a pixel wide in two dimensions; in three that is 2.95 pixels, as measured. */
  async resize() {
    const pixels = Math.max(1.5, Math.min(80, this.pixelsPerUnit() * this.view.diameter));
    const size = this.flat ? pixels : pixels / 2.95;
    if (this.size && Math.abs(size - this.size) < 0.02 * size) return;
    this.size = size;
    await Plotly.restyle(this.place, { "marker.size": size });
  }

  pixelsPerUnit() {
    const layout = this.place._fullLayout;
    if (this.flat) return layout.xaxis._length / Math.abs(layout.xaxis.range[1] - layout.xaxis.range[0]);
    // In its parallel projection plotly.js zooms by the aspect ratios, and the height of the view is two of their units.
    const ratio = (this.place.layout.scene.aspectratio ?? layout.scene.aspectratio).x;
    return (this.place.clientHeight / 2) * (ratio / this.edge(0));
  }

  /** Length of an edge of the box. */
  edge(k) {
    return this.view.high[k] - this.view.low[k] + this.view.spacing;
  }

  /** Ratios with which the box fills the view from all sides. */
  aspect() {
    const longest = Math.hypot(this.edge(0), this.edge(1), this.edge(2));
    return Object.fromEntries(["x", "y", "z"].map((name, k) => [name, (2.1 * this.edge(k)) / longest]));
  }

  play() {
    element("play").textContent = "Pause";
    const step = async () => {
      const began = performance.now();
      await this.show((this.number + 1) % this.view.frames.length);
      if (this.timer) this.timer = setTimeout(step, Math.max(10, 200 - (performance.now() - began)));
    };
    this.timer = setTimeout(step, 10);
  }

  stop() {
    clearTimeout(this.timer);
    this.timer = null;
    element("play").textContent = "Play";
  }
}

new FrameView(run.view).start().then(() => document.body.setAttribute("data-ready", "true"));
