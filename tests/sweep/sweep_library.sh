#!/usr/bin/env bash
# sweep_library.sh BUILD [COUNT]: marks COUNT (10,000) small meshes, touches five of them in known ways,
# and expects a sweep to name exactly these five, as text, JSON and JUnit; then compares the time of a
# sweep that knows files by their bytes with one that reads every mark.
set -euo pipefail
build=$(realpath "$1")
count=${2:-10000}
triglyph=$build/triglyph
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

fail() {
  echo "sweep_library: $*" >&2
  exit 1
}
seconds() { # COMMAND..: prints how long it took
  local start=$EPOCHREALTIME
  "$@" >/dev/null 2>&1 || true
  awk -v a="$start" -v b="$EPOCHREALTIME" 'BEGIN { printf "%.2f", b - a }'
}

"$triglyph" keygen --out key >/dev/null
"$triglyph" sample --out meshes --count "$count" --triangles 600 --seed 1 >/dev/null
"$triglyph" mark meshes --out lib --message hi --key-file key --quiet ||
  (($? == 3)) # a mesh without enough units is refused
sweep=("$triglyph" sweep --ledger lib.ledger --key-file key)
"${sweep[@]}" 2>/dev/null || fail "a library that nobody touched has news"

mapfile -t files < <(find lib -name '*.obj' | sort | head -5)
rm "${files[0]}"                                 # missing
mkdir lib/elsewhere
mv "${files[1]}" lib/elsewhere/renamed.obj       # moved
echo '# a word' >>"${files[2]}"                  # altered
cp "meshes/$(basename "${files[3]}")" "${files[3]}" # mark lost
echo 'f 1 2' >"${files[4]}"                      # damaged
expected=$(printf '%s\n' missing moved altered 'mark lost' damaged)

text=$("${sweep[@]}" --junit junit.xml 2>summary) && fail "touched files are no news"
found=$(sed 's/^[^:]*: \([a-z ]*\), was intact.*/\1/' <<<"$text")
[[ $found == "$expected" ]] || fail "the text says: $text"
found=$(sed -n 's/.*<failure type="\([^"]*\)".*/\1/p' junit.xml)
[[ $found == "$expected" ]] || fail "JUnit says: $found"
found=$({ "${sweep[@]}" --json 2>/dev/null || true; } | sed 's/.*"state":"\([^"]*\)".*/\1/')
[[ $found == "$expected" ]] || fail "JSON says: $found"
cat summary

full=$(seconds "${sweep[@]}" --full)
again=$(seconds "${sweep[@]}")
awk -v a="$full" -v b="$again" \
  'BEGIN { printf "reading every mark %s s, knowing files by their bytes %s s: %.1f times as fast\n", a, b, a / b
           exit !(a >= 5 * b) }' || fail "a sweep of an unchanged library is not five times as fast"
