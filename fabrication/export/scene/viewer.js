// The 3D view of reports and of the studio: layers to switch, colours with a legend, a strip's own
// numbers under the pointer and its flat pattern beside, and strips that bend from flat to built.
// three.js is handed in; nothing here asks the network for anything.

import { made, ramp, unpacked } from "./layers.js";

const FIELD = 40, ACCENT = "#c2185b", FAINT = 0.12;
const VIEWS = { Home: null, Top: [0, -1e-3, 1], Front: [0, -1, 0], Side: [1, 0, 0] };

function tag(name, className, text) {
  const node = document.createElement(name);
  node.className = className;
  if (text !== undefined) node.textContent = text;
  return node;
}

function button(text, click) {
  const node = tag("button", "gv-button", text);
  node.type = "button";
  node.addEventListener("click", click);
  return node;
}

// Whether pictures are made by the processor: it smooths edges only while nothing moves.
function software() {
  const gl = document.createElement("canvas").getContext("webgl2");
  const known = gl && gl.getExtension("WEBGL_debug_renderer_info");
  const name = known ? gl.getParameter(known.UNMASKED_RENDERER_WEBGL) : "";
  gl?.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|software|basic render/i.test(name);
}

// A layer, and its objects once they are asked for: what nobody looks at is not made.
class Entry {
  constructor(THREE, layer, shown) { Object.assign(this, { THREE, layer, shown, own: null, placed: false }); }
  get made() { return (this.own ??= made(this.THREE, this.layer)); }
}

// library: {THREE, OrbitControls}. pattern(mark): a promise of the SVG of a flat part, or null.
// chosen(mark), opened(number): hear what is picked, and which position of a motion is shown.
// home: towards the eye, where one looks from at first.
export function viewer({ THREE, OrbitControls }, root, { pattern = async () => null, chosen = () => {}, opened = () => {}, home = [0.62, -0.64, 0.46] } = {}) {
  root.classList.add("gv");
  root.replaceChildren();
  const bar = tag("div", "gv-bar"), stage = tag("div", "gv-stage"), side = tag("aside", "gv-side"), foot = tag("div", "gv-foot");
  const body = tag("div", "gv-body");
  body.append(stage, side);
  root.append(bar, body, foot);
  side.hidden = true;
  const tip = tag("div", "gv-tip"), list = tag("div", "gv-layers"), ink = tag("canvas", "gv-ink");
  tip.hidden = true;

  let renderer;
  const slow = software(), ratio = Math.min(devicePixelRatio, 2);
  try {
    renderer = new THREE.WebGLRenderer({ antialias: !slow });
  } catch {
    stage.append(tag("p", "gv-none", "This browser shows no WebGL, which the 3D view needs; all else on the page works without."));
    return { replace() {}, ready: false };
  }
  renderer.setPixelRatio(ratio);
  renderer.setClearColor("#ffffff");
  stage.append(renderer.domElement, ink, list, tip);
  renderer.domElement.tabIndex = 0;
  renderer.domElement.setAttribute("aria-label", "The shell in 3D");

  const world = new THREE.Scene(), camera = new THREE.PerspectiveCamera(FIELD, 1.5, 0.01, 1000);
  camera.up.set(0, 0, 1);
  const sun = new THREE.DirectionalLight("#ffffff", 1.5);
  camera.add(sun);
  world.add(camera, new THREE.AmbientLight("#ffffff", 1.9));
  const controls = new OrbitControls(camera, renderer.domElement);
  controls.zoomToCursor = true;
  controls.addEventListener("change", draw);
  controls.addEventListener("start", () => { touched = true; });
  const mark = new THREE.MeshBasicMaterial({ color: ACCENT, side: THREE.DoubleSide });
  const picker = new THREE.Raycaster();

  const state = { layers: new Map(), maps: [], scale: [], table: null, map: null, bend: 1, opened: null, pending: false, picked: null, under: null, home, frames: 0, rows: [], news: 0 };
  let waiting = false, dragging = false, touched = false, direction = home;  // whether one looks from where one went oneself

  // ---- drawing ------------------------------------------------------------------------------

  function draw() {
    if (waiting) return;
    waiting = true;
    requestAnimationFrame(() => { waiting = false; render(); });
  }

  let rest = 0;
  function render() {
    if (renderer.getPixelRatio() !== ratio) renderer.setPixelRatio(ratio);
    renderer.render(world, camera);
    write();
    state.frames += 1;
    clearTimeout(rest);
    if (slow) rest = setTimeout(smooth, 350);
  }

  // The same picture with four samples a pixel.
  function smooth() {
    renderer.setPixelRatio(2 * ratio);
    renderer.render(world, camera);
  }

  function write() {
    const pen = ink.getContext("2d"), { width, height } = ink;
    pen.clearRect(0, 0, width, height);
    pen.font = `${11 * ratio}px system-ui, sans-serif`;
    pen.textAlign = "center";
    pen.textBaseline = "middle";
    const at = new THREE.Vector3();
    for (const entry of state.layers.values()) {
      const { layer, shown } = entry;
      if (layer.kind !== "labels" || !visible(layer, shown)) continue;
      layer.texts.forEach((text, n) => {
        at.fromArray(entry.made.points, 3 * n).project(camera);
        if (at.z > 1) return;
        pen.fillStyle = layer.colours[n % layer.colours.length];
        pen.fillText(text, (0.5 + at.x / 2) * width, (0.5 - at.y / 2) * height);
      });
    }
  }

  function resized() {
    const { clientWidth: width, clientHeight: height } = stage;
    if (!width || !height) return;
    renderer.setSize(width, height);
    [ink.width, ink.height] = [width, height].map((size) => size * ratio);
    camera.aspect = width / height;
    camera.updateProjectionMatrix();
    fit();
    draw();
  }
  new ResizeObserver(resized).observe(stage);

  // ---- camera -------------------------------------------------------------------------------

  function everything() {
    const entries = [...state.layers.values()], seen = entries.filter(({ layer, shown }) => visible(layer, shown) && layer.kind !== "labels");
    const all = (seen.length ? seen : entries).map(({ made: own }) => own.reach ?? own.points);
    return all.filter((points) => points.length);
  }

  function frame(towards = direction) {
    [direction, touched] = [towards, false];
    const back = new THREE.Vector3(...direction).normalize();
    const right = new THREE.Vector3().crossVectors(camera.up, back).normalize(), up = new THREE.Vector3().crossVectors(back, right);
    const sets = everything(), axes = [right, up, back].map((axis) => axis.toArray());
    if (!sets.length) return;
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    const each = (use) => sets.forEach((p) => { for (let n = 0; n < p.length; n += 3) use(axes.map(([x, y, z]) => x * p[n] + y * p[n + 1] + z * p[n + 2])); });
    each((q) => q.forEach((v, c) => { low[c] = Math.min(low[c], v); high[c] = Math.max(high[c], v); }));
    const middle = low.map((v, c) => (v + high[c]) / 2), reach = Math.tan((FIELD * Math.PI) / 360);
    let away = 0;
    for (let turn = 0; turn < 4; turn += 1) {
      away = 1e-3;
      each((q) => {
        away = Math.max(away, Math.abs(q[0] - middle[0]) / (reach * camera.aspect) + q[2] - middle[2], Math.abs(q[1] - middle[1]) / reach + q[2] - middle[2]);
      });
      const box = [1, 1, -1, -1].map((sign) => -sign * Infinity);
      each((q) => [0, 1].forEach((c) => {
        const seen = (q[c] - middle[c]) / (away - (q[2] - middle[2]) || 1e-9);
        box[c] = Math.max(box[c], seen); box[c + 2] = Math.min(box[c + 2], seen);
      }));
      [0, 1].forEach((c) => { middle[c] += ((box[c] + box[c + 2]) / 2) * away; });
    }
    const centre = new THREE.Vector3();
    [right, up, back].forEach((axis, c) => centre.addScaledVector(axis, middle[c]));
    controls.target.copy(centre);
    camera.position.copy(centre).addScaledVector(back, 1.06 * away);
    const size = Math.max(...low.map((v, c) => high[c] - v), 1e-3);
    [camera.near, camera.far] = [size / 500, 40 * size];
    camera.updateProjectionMatrix();
    controls.update();
    draw();
  }

  // Where nobody has turned or moved the view, what no longer fits is framed anew.
  function fit() {
    if (touched) return;
    const at = new THREE.Vector3();
    let far = 0;
    camera.updateMatrixWorld();
    for (const points of everything()) {
      for (let n = 0; n < points.length; n += 3) {
        at.fromArray(points, n).project(camera);
        far = Math.max(far, Math.abs(at.x), Math.abs(at.y));
      }
    }
    if (far > 1.001 || far < 0.6) frame();
  }

  // ---- layers -------------------------------------------------------------------------------

  const read = (maps) => maps.map((map) => ({ ...map, values: unpacked(map.values) }));

  // New contents of some layers; everything else, and where one looks from, stays.
  // *pending*: the net is new, what is built on it still to come; else the layers are all there are.
  function replace({ layers = [], maps, scale }, { pending = false } = {}) {
    const before = new Map([...state.layers].map(([id, { shown }]) => [id, shown])), first = before.size === 0;
    const fresh = new Set(layers.map(({ id }) => id));
    for (const id of before.keys()) if (!pending || fresh.has(id)) remove(id);
    for (const layer of layers) add(layer, before.has(layer.id) ? before.get(layer.id) : pending ? false : layer.visible);
    Object.assign(state, { pending, scale, table: ramp(scale) });
    if (onlyMoves() && state.opened === null) state.opened = motions()[0].layer.begin;
    if (!pending || first) state.maps = read(maps);
    else state.maps = [...read(maps), ...state.maps.filter(({ on }) => on !== "quads")];
    settle();
    if (first) frame();
    else fit();
    renderer.render(world, camera);
    state.news = performance.now();
  }

  function settle() {
    const picked = state.picked?.name;
    pick(null);
    const shown = state.maps.find(({ name }) => name === state.map);
    state.map = shown ? state.map : null;
    lit("under", null);
    if (state.bend < 1) bend(state.bend);
    listed();
    barred();
    shade();
    if (picked && !state.pending) pick(find(picked));
    draw();
  }

  function add(layer, shown) { state.layers.set(layer.id, new Entry(THREE, layer, shown)); }

  const ready = () => [...state.layers.values()].filter(({ own }) => own);

  function remove(id) {
    const entry = state.layers.get(id);
    if (!entry) return;
    state.layers.delete(id);
    if (!entry.own) return;
    for (const object of entry.made.objects) { world.remove(object); object.geometry.dispose(); if (object.dispose) object.dispose(); }
    for (const material of entry.made.materials) material.dispose();
  }

  function seen() {
    for (const entry of state.layers.values()) {
      const there = visible(entry.layer, entry.shown);
      if (!there && !entry.placed) continue;
      for (const object of entry.made.objects) object.visible = there;
      if (entry.placed) continue;
      entry.placed = true;
      for (const object of entry.made.objects) world.add(object);
      shaded(entry);
      faded(entry);
      if (entry.layer.kind === "strips" && state.bend < 1) bend(state.bend);
    }
    draw();
  }

  // While the strips bend or the net opens, only what moves is seen; while a net waits for what is
  // built on it, only the net.
  function visible(layer, shown) {
    if (layer.kind === "positions") return state.opened !== null;
    if (layer.id.startsWith("axes") || layer.id === "axis-names") return shown;
    if (state.opened !== null) return false;
    if (state.pending) return layer.of_net && (shown || layer.id.startsWith("D1"));
    return shown && !(layer.built && state.bend < 1);
  }

  function listed() {
    const groups = new Map();
    for (const entry of state.layers.values()) if (entry.layer.kind !== "positions") groups.set(entry.layer.name, [...(groups.get(entry.layer.name) || []), entry]);
    list.replaceChildren(...[...groups].map(([name, entries]) => {
      const line = tag("label", "gv-layer"), box = tag("input", "");
      box.type = "checkbox";
      box.checked = entries.some(({ shown }) => shown);
      box.addEventListener("change", () => { for (const entry of entries) entry.shown = box.checked; shade(); seen(); });
      const swatch = tag("i", "gv-swatch");
      swatch.style.background = entries[0].layer.swatch || entries[0].layer.colour || "none";
      line.append(box, swatch, tag("span", "", name));
      return line;
    }));
    seen();
  }

  // ---- colours ------------------------------------------------------------------------------

  function barred() {
    const maps = tag("div", "gv-maps");
    maps.setAttribute("role", "group");
    maps.setAttribute("aria-label", "Colours");
    for (const name of [null, ...state.maps.map((map) => map.name)]) {
      const node = button(name || "Plain", () => { state.map = name; reveal(); shade(); barred(); });
      node.setAttribute("aria-pressed", name === state.map);
      maps.append(node);
    }
    const views = tag("div", "gv-views");
    for (const [name, towards] of Object.entries(VIEWS)) views.append(button(name, () => frame(towards || state.home)));
    bar.replaceChildren(...(state.maps.length ? [maps] : []), views);
    footed();
  }

  const current = () => state.maps.find(({ name }) => name === state.map);

  // Something that carries the chosen colours has to be on the screen.
  function reveal() {
    const map = current(), carrying = [...state.layers.values()].filter(({ layer }) => map && layer.cells_of === map.on);
    if (carrying.length && !carrying.some(({ shown }) => shown)) for (const entry of carrying) entry.shown = true;
    listed();
  }

  function shade() {
    for (const entry of ready()) shaded(entry);
    draw();
  }

  function shaded({ layer, made: own }) {
    const map = current();
    if (!own.shade) return;
    own.shade(map && layer.cells_of === map.on ? map.values : null, state.table);
    if (own.rim) own.rim.color.set(map ? "#5a6472" : layer.edge || "#5a6472");
  }

  function footed() {
    const map = current(), parts = [];
    if (map) {
      const scale = tag("div", "gv-scale"), strip = tag("i", "");
      strip.style.background = `linear-gradient(to right, ${state.scale.map(([place, colour]) => `${colour} ${100 * place}%`).join(", ")})`;
      scale.append(tag("span", "gv-low", map.low), strip, tag("span", "gv-high", map.high));
      parts.push(scale);
    }
    const kinds = [...state.layers.values()].map(({ layer }) => layer.kind);
    if (kinds.includes("strips")) parts.push(slider("Flat to built", 0, 100, Math.round(100 * state.bend), (value) => bend(value / 100), "gv-bend"));
    const [moving] = motions();
    if (moving) {
      parts.push(slider("Opening", 0, moving.layer.frames.length - 1, state.opened ?? moving.layer.begin, open, "gv-open"));
      if (state.opened !== null && !onlyMoves()) parts.push(button("As built", () => open(null)));
    }
    foot.replaceChildren(...parts);
  }

  function slider(text, low, high, value, use, name) {
    const line = tag("label", `gv-slider ${name}`), box = tag("input", "");
    Object.assign(box, { type: "range", min: low, max: high, value });
    box.addEventListener("input", () => use(Number(box.value)));
    line.append(tag("span", "", text), box);
    return line;
  }

  // ---- motion -------------------------------------------------------------------------------

  const ofKind = (kind) => [...state.layers.values()].filter(({ layer }) => layer.kind === kind);
  const motions = () => ofKind("positions");
  const onlyMoves = () => motions().length > 0 && motions().length === state.layers.size;

  // Rows on the ground for all strips, one beside the other.
  function laid() {
    const strips = ofKind("strips");
    let low = Infinity, count = 0;
    const middle = [Infinity, -Infinity, Infinity, -Infinity];
    for (const { made: own, layer } of strips) {
      count += layer.counts.length;
      for (let n = 0; n < own.points.length; n += 3) {
        const [x, y, z] = own.points.subarray(n, n + 3);
        low = Math.min(low, z);
        middle[0] = Math.min(middle[0], x); middle[1] = Math.max(middle[1], x);
        middle[2] = Math.min(middle[2], y); middle[3] = Math.max(middle[3], y);
      }
    }
    let number = 0;
    for (const { made: own, layer } of strips) {
      own.rows = layer.counts.map(() => {
        const across = (number - (count - 1) / 2) * 1.3 * layer.width;
        number += 1;
        return { turn: new THREE.Quaternion(), place: new THREE.Vector3((middle[0] + middle[1]) / 2, (middle[2] + middle[3]) / 2 + across, low) };
      });
    }
  }

  function bend(share) {
    const moved = share !== state.bend || share < 1;
    state.bend = share;
    if (!moved) return;
    state.under = null;
    lit("under", null);
    if (ofKind("strips").some(({ made: own }) => !own.rows)) laid();
    for (const { made: own } of ofKind("strips")) own.bend(share, own.rows);
    if (state.picked) lit("picked", state.picked);
    seen();
    fit();
  }

  function open(number) {
    const before = state.opened;
    state.opened = number;
    if (number !== null) {
      for (const { made: own } of motions()) own.open(number);
      foot.querySelector(".gv-open input").value = number;
      opened(number);
    }
    if ((before === null) !== (number === null)) {
      if (number === null) footed();
      else if (!foot.querySelector(".gv-back")) foot.append(Object.assign(button("As built", () => open(null)), { className: "gv-button gv-back" }));
      pick(null);
    }
    seen();
  }

  // ---- parts --------------------------------------------------------------------------------

  function hit(event) {
    const box = renderer.domElement.getBoundingClientRect();
    const at = new THREE.Vector2(((event.clientX - box.left) / box.width) * 2 - 1, 1 - ((event.clientY - box.top) / box.height) * 2);
    picker.setFromCamera(at, camera);
    const size = camera.position.distanceTo(controls.target), pixel = (2 * size * Math.tan((FIELD * Math.PI) / 360)) / box.height;
    picker.params.Points.threshold = 5 * pixel;
    let best = null;
    for (const { layer, made: own } of ready()) {
      for (const object of own.pickable.filter(({ visible }) => visible)) {
        for (const found of picker.intersectObject(object, false)) {
          const part = own.part(found), near = found.distance - (layer.kind === "dots" ? 12 * pixel : 0);
          if (own.parts[part] && (!best || near < best.near)) best = { near, id: layer.id, part, name: own.parts[part].mark };
        }
      }
    }
    return best;
  }

  const about = (found) => state.layers.get(found.id).layer.parts[found.part];

  function written(node, { mark: name, lines }) {
    node.replaceChildren(tag("strong", "", name), ...lines.map((line) => tag("div", "", line)));
  }

  function point(event) {
    if (dragging) return;
    const found = hit(event);
    if (found?.id !== state.under?.id || found?.part !== state.under?.part) {
      state.under = found;
      lit("under", found && !(state.picked && state.picked.id === found.id && state.picked.part === found.part) ? found : null);
    }
    tip.hidden = !found;
    renderer.domElement.style.cursor = found ? "pointer" : "grab";
    if (!found) return;
    written(tip, about(found));
    const box = stage.getBoundingClientRect(), x = event.clientX - box.left, y = event.clientY - box.top;
    tip.style.left = `${Math.min(x + 14, box.width - tip.offsetWidth - 4)}px`;
    tip.style.top = `${Math.max(4, Math.min(y + 14, box.height - tip.offsetHeight - 4))}px`;
  }

  const marks = {};
  function lit(use, found) {
    if (marks[use]) { world.remove(marks[use]); marks[use].userData.own?.dispose(); delete marks[use]; }
    if (found) {
      const object = state.layers.get(found.id).made.alone(found.part, mark);
      object.renderOrder = 2;
      marks[use] = object;
      world.add(object);
    }
    draw();
  }

  function faded({ layer, made: own }) {
    const opacity = state.picked ? FAINT : layer.opacity ?? 1;
    for (const material of own.materials) {
      Object.assign(material, { transparent: opacity < 1, opacity, depthWrite: opacity === 1, needsUpdate: true });
    }
  }

  async function pick(found) {
    const same = found && state.picked && found.id === state.picked.id && found.part === state.picked.part;
    state.picked = found;
    if (!found) tip.hidden = true;
    lit("picked", found);
    for (const entry of ready()) faded(entry);
    if (!found) {
      const open = !side.hidden;
      side.hidden = true;
      chosen(null);
      if (open) resized();
      return draw();
    }
    if (same) return draw();
    const words = about(found), head = tag("div", "gv-about"), drawing = tag("div", "gv-pattern");
    written(head, words);
    side.replaceChildren(button("Show all", () => pick(null)), head, drawing);
    if (side.hidden) { side.hidden = false; resized(); }
    chosen(words.mark);
    draw();
    if (state.layers.get(found.id).layer.kind === "dots") return;  // nodes have none
    const svg = await pattern(words.pattern || words.mark);
    if (svg && state.picked === found) {
      drawing.append(document.importNode(new DOMParser().parseFromString(svg, "image/svg+xml").documentElement, true));
    }
  }

  let pressed = null;
  const surface = renderer.domElement;
  surface.addEventListener("pointerdown", (event) => { pressed = [event.clientX, event.clientY]; dragging = true; tip.hidden = true; });
  addEventListener("pointerup", (event) => {
    dragging = false;
    if (!pressed || event.target !== surface) { pressed = null; return; }
    const still = Math.hypot(event.clientX - pressed[0], event.clientY - pressed[1]) < 4;
    pressed = null;
    if (still) { state.under = null; lit("under", null); pick(hit(event)); }
  });
  let asked = null;
  surface.addEventListener("pointermove", (event) => {
    if (asked === null) requestAnimationFrame(() => { const last = asked; asked = null; point(last); });
    asked = event;
  });
  surface.addEventListener("pointerleave", () => { tip.hidden = true; lit("under", null); state.under = null; });
  addEventListener("keydown", (event) => { if (event.key === "Escape" && state.picked) pick(null); });

  function find(name) {
    for (const { layer } of state.layers.values()) {
      const part = (layer.parts || []).findIndex(({ mark: known }) => known === name);
      if (part >= 0) return { id: layer.id, part, name };
    }
    return null;
  }

  resized();
  return {
    ready: true, camera, replace, frame, bend, open, state,
    only: (name) => {  // the layers of this name, and no others
      for (const entry of state.layers.values()) entry.shown = entry.layer.name === name;
      listed();
    },
    select: (name) => pick(name === null ? null : find(name)),
    colour: (name) => { state.map = name; reveal(); shade(); barred(); },
    picture: () => { if (slow) smooth(); else render(); return renderer.domElement.toDataURL("image/png"); },
    where: (name) => {  // of a part, where it is on the screen, px: what tests point at
      const found = find(name), own = found && state.layers.get(found.id).made;
      if (!own) return null;
      const object = own.alone(found.part, mark), at = new THREE.Vector3(), box = surface.getBoundingClientRect();
      const points = object.geometry.getAttribute("position"), n = Math.floor(points.count / 2);
      at.fromBufferAttribute(points, n);
      if (!object.matrixAutoUpdate) at.applyMatrix4(object.matrix);
      at.project(camera);
      return [box.left + (0.5 + at.x / 2) * box.width, box.top + (0.5 - at.y / 2) * box.height];
    },
  };
}
