# Sourced by the scripts of this folder, with BUILD as first argument: a small collection, and how
# what a run left is compared with what it should have left.
build=$(cd "${1:?the build folder}" && pwd)
triglyph=$build/triglyph
# In memory where there is room: what a killed process leaves is the same, and takes half the time.
work=$(mktemp -d -p "$([[ -w /dev/shm ]] && echo /dev/shm || echo "${TMPDIR:-/tmp}")")
trap 'rm -rf "$work"' EXIT

fail() {
  echo "${0##*/}: $*" >&2
  exit 1
}

[[ -x $triglyph ]] || fail "no $triglyph"

# Makes the collection in a folder: SETS times four meshes that can be marked, one that is malformed,
# one that is too small.
make_meshes() {
  local folder=$1 sets=$2 set format
  for ((set = 1; set <= sets; ++set)); do
    for format in obj off ply stl; do
      "$triglyph" sample --out "$folder/$set-$format" --count 1 --triangles $((700 + 300 * set)) \
        --shape closed --seed "$set" --format "$format" >/dev/null
    done
  done
  printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n' >"$folder/malformed.obj"
  printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >"$folder/small.obj"
}

# Prints the records of a file without what differs from run to run; every line must be whole.
records_without_run() {
  local line
  while IFS= read -r line || [[ -n $line ]]; do
    [[ $line == '{"schema":'*',"run":{'*'}}' ]] || echo "TORN $line"
    printf '%s\n' "${line%%,\"run\":\{*}"
  done <"$1"
}

# Prints the names of temporary files below a folder.
leftovers() { find "$1" -name '.*.part*'; }
