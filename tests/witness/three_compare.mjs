// Loads two GLBs as a viewer does, and prints by how much of their size, in percent, points lie apart:
//   node three_compare.mjs BEFORE AFTER
// Fails if they do not have the same meshes, points and triangles.
import { readFileSync } from "node:fs";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
globalThis.self = globalThis;
globalThis.ProgressEvent ??= class extends Event {};
const load = (path) => {
  const data = readFileSync(path);
  const bytes = data.buffer.slice(data.byteOffset, data.byteOffset + data.byteLength);
  return new Promise((done, fail) => new GLTFLoader().parse(bytes, "", done, fail));
};
const meshes = async (path) => {
  const found = [];
  (await load(path)).scene.traverse((o) => o.isMesh && found.push(o.geometry));
  return found;
};
const [before, after] = [await meshes(process.argv[2]), await meshes(process.argv[3])];
if (before.length !== after.length) throw new Error("other meshes");
let farthest = 0, size = 0;
before.forEach((geometry, i) => {
  const old = geometry.attributes.position, now = after[i].attributes.position;
  if (old.count !== now.count) throw new Error("other points");
  if (String(geometry.index?.array) !== String(after[i].index?.array)) throw new Error("other triangles");
  geometry.computeBoundingSphere();
  size = Math.max(size, 2 * geometry.boundingSphere.radius);
  for (let v = 0; v < old.count; ++v) {
    farthest = Math.max(farthest, Math.hypot(now.getX(v) - old.getX(v), now.getY(v) - old.getY(v), now.getZ(v) - old.getZ(v)));
  }
});
console.log(((100 * farthest) / size).toFixed(3));
