#!/usr/bin/env bash
# witness.sh BUILD: what other programs make of marked glTF. Marks meshes as .glb, lets gltf-validator
# judge them (no more errors than before), loads them with three.js (the same triangles, points near
# where they were), sends them through Blender, assimp and gltfpack, and reads the mark from what comes
# back. Installs assimp-utils, blender, gltfpack, nodejs, gltf-validator and three where they are missing. Prints a line for each file and fails if a mark is lost or a file not valid.
set -euo pipefail
build=$(cd "$1" && pwd)
here=$(cd "$(dirname "$0")" && pwd)
triglyph=$build/triglyph
as_root=()
((EUID == 0)) || as_root=(sudo)
command -v blender assimp gltfpack node npm >/dev/null ||
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends \
    assimp-utils blender gltfpack nodejs npm python3-numpy
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm install --silent --no-fund --no-audit gltf-validator three >/dev/null
cp "$here/three_compare.mjs" .

errors_of() {
  node -e 'require("gltf-validator").validateBytes(new Uint8Array(require("fs").readFileSync(process.argv[1])))
    .then(r => console.log(r.issues.numErrors))' "$1"
}
failures=0
check() {  # check WHAT FILE EXPECTED
  local found
  found=$("$triglyph" extract "$2" --key-file key 2>/dev/null | head -1 || true)
  if [[ $found == *"$3"* ]]; then
    echo "ok      $1: ${found#*: }"
  else
    echo "FAILED  $1: ${found#*: }"
    failures=$((failures + 1))
  fi
}

"$triglyph" keygen --out key >/dev/null
"$triglyph" sample --out in --count 3 --triangles 20000 --format glb >/dev/null
for model in /usr/share/glmark2/models/bunny.obj /usr/share/assimp/models-nonbsd/OBJ/segment.obj; do
  [[ ! -f $model ]] || assimp export "$model" "in/$(basename "${model%.*}").glb" >/dev/null
done
for mesh in in/*.glb; do
  name=$(basename "${mesh%.glb}")
  "$triglyph" mark "$mesh" --key-file key --message "no. 7" --out out --quiet || continue
  marked=out/$name.glb
  check "$name marked" "$marked" '"no. 7"'
  before=$(errors_of "$mesh")
  after=$(errors_of "$marked")
  if ((after > before)); then
    echo "FAILED  $name: gltf-validator finds $after errors, $before before"
    failures=$((failures + 1))
  fi
  if moved=$(node three_compare.mjs "$mesh" "$marked" 2>&1 | tail -1) && [[ $moved =~ ^[01]\.[0-9]+$ ]]; then
    echo "ok      $name by three.js: the same triangles, points moved by $moved % at most"
  else
    echo "FAILED  $name by three.js: $moved"
    failures=$((failures + 1))
  fi
  blender -b --python "$here/blender_convert.py" -- "$marked" "$name-blender".{glb,obj,ply,stl} >"$name.log" 2>&1 ||
    { tail -5 "$name.log"; exit 1; }
  for ending in glb obj ply stl; do check "$name by Blender to $ending" "$name-blender.$ending" '"no. 7"'; done
  for ending in obj stl; do
    assimp export "$marked" "$name-assimp.$ending" >/dev/null
    check "$name by assimp to $ending" "$name-assimp.$ending" '"no. 7"'
  done
  gltfpack -i "$marked" -o "$name-float.glb" -noq >/dev/null
  gltfpack -i "$marked" -o "$name-quantised.glb" >/dev/null
  gltfpack -i "$marked" -o "$name-packed.glb" -c >/dev/null
  for kind in float quantised packed; do check "$name by gltfpack, $kind" "$name-$kind.glb" '"no. 7"'; done
done
((failures == 0))
