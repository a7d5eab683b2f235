// The layers of a scene as objects of three.js: what packed arrays become on the screen.
// Every layer answers: objects to draw, objects to pick, which part a hit belongs to, the part alone.

const KINDS = { f4: Float32Array, u1: Uint8Array, u2: Uint16Array, u4: Uint32Array };

export function unpacked({ kind, bytes }) {
  const text = atob(bytes), raw = new Uint8Array(text.length);
  for (let n = 0; n < text.length; n += 1) raw[n] = text.charCodeAt(n);
  return new KINDS[kind](raw.buffer);
}

const linear = (share) => (share <= 0.04045 ? share / 12.92 : ((share + 0.055) / 1.055) ** 2.4);

function channels(colour) {
  const hex = /^#(..)(..)(..)$/.exec(colour);
  return hex ? hex.slice(1).map((digits) => parseInt(digits, 16)) : colour.match(/\d+/g).map(Number);
}

// 256 colours of a scale [[place, colour], ...] as three.js wants them; in between as CSS mixes them.
export function ramp(scale) {
  const table = new Float32Array(768);
  for (let n = 0; n < 256; n += 1) {
    const place = n / 255, after = Math.max(1, scale.findIndex(([end]) => end >= place));
    const [[from, first], [to, second]] = [scale[after - 1], scale[after]];
    const share = (place - from) / (to - from), [a, b] = [channels(first), channels(second)];
    for (let c = 0; c < 3; c += 1) table[3 * n + c] = linear((a[c] + share * (b[c] - a[c])) / 255);
  }
  return table;
}

function cumulative(counts) {
  const ends = new Uint32Array(counts.length);
  counts.reduce((sum, count, n) => (ends[n] = sum + count), 0);
  return ends;
}

function place(ends, number) {
  let low = 0, high = ends.length - 1;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (ends[middle] > number) high = middle;
    else low = middle + 1;
  }
  return low;
}

function spread(numbers, lengths) {
  const all = new Uint32Array(lengths.reduce((sum, length) => sum + length, 0));
  let at = 0;
  lengths.forEach((length, n) => { all.fill(numbers[n], at, at + length); at += length; });
  return all;
}

// ---- bending a strip: its frames along the way from the flat sheet to where it is built --------

function turned(q, v) {
  return v.clone().applyQuaternion(q);
}

// Columns of strips by the frames they have in place. At *share* 0 every strip lies flat in a row
// on the ground; in between all curvatures and twists are that share of the built ones.
class Bending {
  constructor(THREE, x, frames, counts) {
    Object.assign(this, { THREE, x, counts, now: Float32Array.from(frames), built: frames });
    this.strips = [];
    let first = 0;
    for (const count of counts) {
      this.strips.push(this.#prepared(first, count));
      first += count;
    }
  }

  #prepared(first, count) {
    const { Vector3, Matrix4, Quaternion } = this.THREE, f = this.built;
    const vector = (at) => new Vector3(f[at], f[at + 1], f[at + 2]);
    const points = [], turns = [];
    for (let n = 0; n < count; n += 1) {
      const at = 9 * (first + n), t = vector(at + 3), h = vector(at + 6);
      points.push(vector(at));
      turns.push(new Quaternion().setFromRotationMatrix(new Matrix4().makeBasis(t, h, t.clone().cross(h))));
    }
    const steps = [], moves = [];
    for (let n = 0; n + 1 < count; n += 1) {
      const back = turns[n].clone().invert();
      steps.push(back.clone().multiply(turns[n + 1]));
      moves.push(turned(back, points[n + 1].clone().sub(points[n])));
    }
    return { first, count, middle: count >> 1, points, turns, steps, moves };
  }

  // rows: of every strip the place of its middle and the direction of its row.
  at(share, rows) {
    if (share >= 1) { this.now.set(this.built); return; }
    const { Vector3, Quaternion } = this.THREE, none = new Quaternion(), out = this.now;
    const along = new Vector3(), write = (n, p, q) => {
      const at = 9 * n, t = turned(q, along.set(1, 0, 0)), h = turned(q, along.set(0, 1, 0));
      out.set([p.x, p.y, p.z, t.x, t.y, t.z, h.x, h.y, h.z], at);
    };
    this.strips.forEach((strip, number) => {
      const { first, count, middle, points, turns, steps, moves } = strip;
      const q0 = rows[number].turn.clone().slerp(turns[middle], share);
      const p0 = rows[number].place.clone().lerp(points[middle], share);
      write(first + middle, p0, q0);
      let p = p0.clone(), q = q0.clone();
      for (let n = middle; n + 1 < count; n += 1) {
        p.add(turned(q, this.#move(first + n, moves[n], share)));
        q.multiply(none.clone().slerp(steps[n], share));
        write(first + n + 1, p, q);
      }
      p = p0.clone(); q = q0.clone();
      for (let n = middle - 1; n >= 0; n -= 1) {
        q.multiply(none.clone().slerp(steps[n], share).invert());
        p.sub(turned(q, this.#move(first + n, moves[n], share)));
        write(first + n, p, q);
      }
    });
  }

  #move(column, move, share) {
    const flat = this.x[column + 1] - this.x[column];
    return move.clone().multiplyScalar(share).add(new this.THREE.Vector3((1 - share) * flat, 0, 0));
  }
}

// ---- layers ---------------------------------------------------------------------------------

class Faces {
  constructor(THREE, layer) {
    Object.assign(this, { THREE, layer, parts: layer.parts || [] });
    this.index = unpacked(layer.faces);
    this.ends = cumulative(layer.sizes || [this.index.length / 3]);
    this.cells = layer.cells ? spread(layer.cells.numbers, layer.cells.lengths) : null;
    this.points = this.vertices();
    this.geometry = new THREE.BufferGeometry();
    this.geometry.setAttribute("position", new THREE.BufferAttribute(this.#gathered(), 3));
    this.plain = new THREE.MeshLambertMaterial({
      color: layer.colour, side: THREE.DoubleSide, flatShading: true, vertexColors: Boolean(layer.colours),
      polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1,
      transparent: layer.opacity < 1, opacity: layer.opacity ?? 1,
    });
    this.mapped = new THREE.MeshBasicMaterial({
      side: THREE.DoubleSide, vertexColors: true, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1,
    });
    if (layer.colours) this.#own();
    this.mesh = new THREE.Mesh(this.geometry, this.plain);
    this.objects = [this.mesh];
    this.pickable = [this.mesh];
    this.materials = [this.plain, this.mapped];
    if (layer.loops) this.#edges(unpacked(layer.loops));
  }

  vertices() { return unpacked(this.layer.points); }

  #gathered() {
    const { index, points } = this, all = new Float32Array(3 * index.length);
    for (let n = 0; n < index.length; n += 1) {
      const from = 3 * index[n];
      all[3 * n] = points[from]; all[3 * n + 1] = points[from + 1]; all[3 * n + 2] = points[from + 2];
    }
    return all;
  }

  #edges(loops) {
    const { THREE, points } = this, gap = points.length / 3, pairs = [];
    for (let n = 0; n + 1 < loops.length; n += 1) {
      if (loops[n] < gap && loops[n + 1] < gap) pairs.push(loops[n], loops[n + 1]);
    }
    this.pairs = Uint32Array.from(pairs);
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(this.points, 3));
    geometry.setIndex(new THREE.BufferAttribute(this.pairs, 1));
    this.rim = new THREE.LineBasicMaterial({ color: this.layer.edge || "#5a6472" });
    this.materials.push(this.rim);
    this.objects.push(new THREE.LineSegments(geometry, this.rim));
  }

  #own() {
    const colours = unpacked(this.layer.colours);
    const all = new Float32Array(3 * this.index.length);
    for (let part = 0, at = 0; part < this.ends.length; part += 1) {
      for (; at < 3 * this.ends[part]; at += 1) {
        for (let c = 0; c < 3; c += 1) all[3 * at + c] = linear(colours[3 * part + c] / 255);
      }
    }
    this.owned = new this.THREE.BufferAttribute(all, 3);
    this.geometry.setAttribute("color", this.owned);
    this.plain.color.set("#ffffff");
  }

  // Colours by *values*, one for each cell, 0 to 1; null gives the layer its own colour back.
  shade(values, table) {
    this.mesh.material = values ? this.mapped : this.plain;
    if (!values) { if (this.owned) this.geometry.setAttribute("color", this.owned); return; }
    const all = new Float32Array(3 * this.index.length), known = this.cells;
    for (let face = 0; face < this.index.length / 3; face += 1) {
      const share = values[known ? known[face] : place(this.ends, face)];
      const at = 3 * Math.round(255 * Math.min(1, Math.max(0, share || 0)));
      for (let n = 9 * face; n < 9 * face + 9; n += 1) all[n] = table[at + (n % 3)];
    }
    this.geometry.setAttribute("color", new this.THREE.BufferAttribute(all, 3));
  }

  moved() {
    this.geometry.getAttribute("position").copyArray(this.#gathered()).needsUpdate = true;
    this.geometry.boundingSphere = null;
    if (!this.rim) return;
    const edges = this.objects[1].geometry;
    edges.getAttribute("position").copyArray(this.points).needsUpdate = true;
    edges.boundingSphere = null;
  }

  part(hit) { return place(this.ends, hit.faceIndex); }

  alone(part, material) {
    const first = part ? this.ends[part - 1] : 0, geometry = new this.THREE.BufferGeometry();
    const points = this.geometry.getAttribute("position").array.slice(9 * first, 9 * this.ends[part]);
    geometry.setAttribute("position", new this.THREE.BufferAttribute(points, 3));
    return Object.assign(new this.THREE.Mesh(geometry, material), { userData: { own: geometry } });
  }
}

class Strips extends Faces {
  vertices() {
    const { layer, THREE } = this;
    this.columns = unpacked(layer.columns);
    this.heights = unpacked(layer.heights);
    this.bending = new Bending(THREE, unpacked(layer.x), unpacked(layer.frames), layer.counts);
    return this.placed(new Float32Array(3 * this.columns.length));
  }

  placed(points) {
    const { columns, heights, bending: { now } } = this;
    for (let n = 0; n < columns.length; n += 1) {
      const at = 9 * columns[n];
      for (let c = 0; c < 3; c += 1) points[3 * n + c] = now[at + c] + heights[n] * now[at + 6 + c];
    }
    return points;
  }

  bend(share, rows) {
    this.bending.at(share, rows);
    this.placed(this.points);
    this.moved();
  }
}

// Parts in several positions, one of which is shown.
class Positions extends Faces {
  vertices() {
    const { low, scale, frames } = this.layer;
    this.frames = frames.map(unpacked);
    this.number = this.layer.begin;
    return this.placed(new Float32Array(this.frames[0].length), low, scale);
  }

  placed(points, low, scale) {
    const frame = this.frames[this.number];
    for (let n = 0; n < frame.length; n += 1) points[n] = frame[n] * scale + low[n % 3];
    return points;
  }

  // What the whole motion reaches to, about: the positions at its ends.
  get reach() {
    const { low, scale } = this.layer, ends = [this.frames[0], this.frames[this.frames.length - 1]];
    return Float32Array.from(ends.flatMap((frame) => Array.from(frame, (step, n) => step * scale + low[n % 3])));
  }

  open(number) {
    this.number = number;
    this.placed(this.points, this.layer.low, this.layer.scale);
    this.moved();
  }
}

class Lines {
  constructor(THREE, layer) {
    const points = unpacked(layer.points);
    Object.assign(this, { THREE, layer, points, parts: [], pickable: [] });
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(points, 3));
    geometry.setIndex(new THREE.BufferAttribute(unpacked(layer.pairs), 1));
    this.materials = [new THREE.LineBasicMaterial({ color: layer.colour })];
    this.objects = [new THREE.LineSegments(geometry, this.materials[0])];
  }
}

class Dots {
  constructor(THREE, layer) {
    Object.assign(this, { THREE, layer, points: unpacked(layer.points), parts: layer.parts || [] });
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(this.points, 3));
    this.materials = [new THREE.PointsMaterial({ color: layer.colour, size: layer.size, sizeAttenuation: false })];
    this.objects = [new THREE.Points(geometry, this.materials[0])];
    this.pickable = this.objects;
  }

  part(hit) { return hit.index; }

  alone(part) {
    const geometry = new this.THREE.BufferGeometry(), at = this.points.slice(3 * part, 3 * part + 3);
    geometry.setAttribute("position", new this.THREE.BufferAttribute(at, 3));
    const size = 4 * this.layer.size, color = "#c2185b";
    const dot = new this.THREE.PointsMaterial({ color, size, sizeAttenuation: false });
    return Object.assign(new this.THREE.Points(geometry, dot), { userData: { own: geometry } });
  }
}

class Labels {
  constructor(THREE, layer) {
    Object.assign(this, { layer, points: unpacked(layer.points), parts: [], pickable: [], objects: [], materials: [] });
  }
}

class Bodies {
  constructor(THREE, layer) {
    const numbers = unpacked(layer.bodies), frames = unpacked(layer.frames);
    Object.assign(this, { THREE, layer, parts: layer.parts });
    this.materials = [new THREE.MeshLambertMaterial({ color: layer.colour, flatShading: true, side: THREE.DoubleSide })];
    this.members = layer.shapes.map(() => []);
    numbers.forEach((shape, body) => this.members[shape].push(body));
    this.objects = layer.shapes.map(({ points, faces }, shape) => {
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute("position", new THREE.BufferAttribute(unpacked(points), 3));
      geometry.setIndex(new THREE.BufferAttribute(unpacked(faces), 1));
      const mesh = new THREE.InstancedMesh(geometry, this.materials[0], this.members[shape].length);
      this.members[shape].forEach((body, n) => mesh.setMatrixAt(n, this.#matrix(frames, 9 * body)));
      mesh.userData.shape = shape;
      return mesh;
    });
    this.pickable = this.objects;
    this.points = Float32Array.from(Array.from(numbers.keys()).flatMap((n) => [...frames.slice(9 * n, 9 * n + 3)]));
  }

  #matrix(f, at) {
    const { Vector3, Matrix4 } = this.THREE, vector = (k) => new Vector3(f[k], f[k + 1], f[k + 2]);
    const x = vector(at + 3), y = vector(at + 6);
    return new Matrix4().makeBasis(x, y, x.clone().cross(y)).setPosition(vector(at));
  }

  part(hit) { return this.members[hit.object.userData.shape][hit.instanceId]; }

  alone(part, material) {
    const shape = this.members.findIndex((bodies) => bodies.includes(part));
    const mesh = new this.THREE.Mesh(this.objects[shape].geometry, material);
    this.objects[shape].getMatrixAt(this.members[shape].indexOf(part), mesh.matrix);
    mesh.matrixAutoUpdate = false;
    return mesh;
  }
}

const LAYERS = { faces: Faces, strips: Strips, positions: Positions, lines: Lines, dots: Dots, labels: Labels, bodies: Bodies };

export function made(THREE, layer) {
  return new LAYERS[layer.kind](THREE, layer);
}
