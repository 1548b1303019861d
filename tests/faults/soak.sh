#!/usr/bin/env bash
# soak.sh BUILD [LINES [THREADS...]]: marks a manifest of LINES lines (default 50000) of small meshes, with 1
# and with 2 threads, and fails unless
#   the first mesh is done within 5 s of the start,
#   the worker's resident memory is in the last fifth of the run at most 5 % above that in the second,
#   --records is never more than a second behind the files that are there.
# Prints the figures, and how many meshes were done in a second.
set -euo pipefail
source "$(dirname "$0")/common.sh" "$@"
lines=${2:-50000}
threads=("${@:3}")
((${#threads[@]} > 0)) || threads=(1 2)
failures=0

# The work is as large as the collection: 2 KB a line in the outputs, 3 KB in ledger and records; that is
# for the disk.
rm -rf "$work"
work=$(mktemp -d -p "${TMPDIR:-/tmp}")

# expect CONDITION WHAT
expect() {
  (($1)) && return
  echo "FAILED: $2"
  ((++failures))
}

# 240 meshes, a quarter of which are too small for the message.
for ((i = 0; i < 240; i += 20)); do
  "$triglyph" sample --out "$work/meshes/$i" --count 20 --triangles $((i % 80 == 0 ? 250 : 500)) --seed $((i + 1)) \
    --format "$( ((i % 40 == 0)) && echo off || echo ply)" >/dev/null
done
find "$work/meshes" -type f -printf 'meshes/%P\n' | sort >"$work/names"
awk -v lines="$lines" '
  { name[NR] = $0 }
  END {
    for (i = 0; i < lines; ++i) {
      mesh = name[i % NR + 1]; ending = mesh; sub(/.*\./, "", ending)
      printf "{\"mesh\": \"%s\", \"out\": \"out/%d/%d.%s\", \"message\": \"a\"}\n", mesh, i / 1000, i, ending
    }
  }' "$work/names" >"$work/all.jsonl"

now() { echo "${EPOCHREALTIME/./}"; }
count_records() { wc -l 2>/dev/null <"$work/records.jsonl" || echo 0; }
count_files() { find "$work/out" -type f ! -name '.*' -printf x 2>/dev/null | wc -c; }
# kilobytes
resident_size() { awk '/^VmRSS:/ { print $2 }' "/proc/$1/status" 2>/dev/null || true; }

soak() {
  local count=$1 start first=0 supervisor worker files done_now marked behind=0 size status=0 seconds
  local early=0 early_samples=0 late=0 late_samples=0
  rm -rf "$work"/{out,records.jsonl} "$work"/all.jsonl.ledger*
  start=$(now)
  # units alone: what is tried here is the run, not how long a mesh takes
  "$triglyph" mark "$work/all.jsonl" --scheme tsq --threads "$count" --quiet --records "$work/records.jsonl" \
    >/dev/null 2>"$work/errors" &
  supervisor=$!
  while kill -0 $supervisor 2>/dev/null && (($(count_records) == 0)); do sleep 0.01; done
  first=$((($(now) - start) / 1000))
  worker=$(cat "/proc/$supervisor/task/$supervisor/children")
  while kill -0 $supervisor 2>/dev/null; do
    files=$(count_files)
    sleep 1
    done_now=$(count_records)
    # at the end the file is replaced by the sorted one; records of meshes that were too small have no file
    marked=$(grep -c '"status":"marked"' "$work/records.jsonl" || true)
    ((marked >= files)) || behind=$((files - marked > behind ? files - marked : behind))
    size=$(resident_size "${worker%% *}")
    [[ -n $size ]] || continue
    if ((done_now * 5 >= lines && done_now * 5 < 2 * lines)); then
      early=$((early + size)) early_samples=$((early_samples + 1))
    elif ((done_now * 5 >= 4 * lines)); then
      late=$((late + size)) late_samples=$((late_samples + 1))
    fi
  done
  wait $supervisor || status=$?
  seconds=$((($(now) - start) / 1000000))
  early=$((early / (early_samples + (early_samples == 0)))) late=$((late / (late_samples + (late_samples == 0))))
  echo "$count threads: first mesh after $first ms; resident $early KB in the second fifth, $late KB in the" \
    "last; records behind by $behind at most; $((lines / (seconds + (seconds == 0)))) meshes a second"
  expect "status == 3" "exit $status: $(tail -3 "$work/errors")"
  expect "$(count_records) == lines" "$(count_records) records of $lines lines"
  expect "first < 5000" "the first mesh came late"
  expect "late * 100 <= early * 105" "memory grew"
  expect "behind == 0" "the records were behind"
}

for count in "${threads[@]}"; do soak "$count"; done
((failures == 0))
