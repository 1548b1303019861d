#!/usr/bin/env bash
# Says whether a change makes marking slower: builds two commits, marks the same meshes with both in
# turns, and fails if the new one takes more than RATIO times the processor time of the old one.
# Nothing is compared with a time that was measured elsewhere or earlier.
#   bench/compare_commits.sh OLD NEW             commits; NEW may be "." for what is checked out
#   bench/compare_commits.sh --built OLD NEW     executables
# From the environment: RATIO (1.10), ROUNDS (7), COUNT (60 meshes), TRIANGLES (2000), THREADS (1),
# WORK (a folder for worktrees and builds, which a cache may keep; default: a temporary one).
#
# The processor time counts, of user and kernel, which other work on the machine changes least. Of
# the ratios of all rounds the median decides. Exit codes: 0 no slower, 1 slower, 2 usage, 3 a build
# or a run failed.
set -euo pipefail

ratio=${RATIO:-1.10} rounds=${ROUNDS:-7} count=${COUNT:-60} triangles=${TRIANGLES:-2000}
threads=${THREADS:-1}
usage() {
  sed -n '2,13s/^# \{0,1\}//p' "$0" >&2
  exit 2
}

built=no
if [[ ${1:-} == --built ]]; then
  built=yes
  shift
fi
(($# == 2)) || usage
work=${WORK:-$(mktemp -d)}
mkdir -p "$work"
[[ -n ${WORK:-} ]] || trap 'rm -rf "$work"; git worktree prune 2>/dev/null || true' EXIT

fail() {
  echo "compare_commits: $*" >&2
  exit 3
}

# executable NAME COMMIT: builds the commit and prints the path of its executable.
executable() {
  local tree=$work/$1
  if [[ $2 == . ]]; then
    tree=$(git rev-parse --show-toplevel)
  else
    local commit
    commit=$(git rev-parse --verify --quiet "$2^{commit}") || fail "no commit $2"
    if [[ -d $tree ]]; then
      git -C "$tree" checkout --quiet --detach "$commit" || fail "cannot check out $2"
    else
      git worktree prune
      git worktree add --quiet --detach "$tree" "$commit" || fail "cannot check out $2"
    fi
  fi
  (cd "$tree" && cmake --preset release && cmake --build --preset release --target triglyph) \
    >"$work/$1.log" 2>&1 || fail "cannot build $2: see $work/$1.log"
  echo "$tree/build/release/triglyph"
}

if [[ $built == yes ]]; then
  old=$(realpath "$1") new=$(realpath "$2")
else
  old=$(executable old "$1") || exit 3
  new=$(executable new "$2") || exit 3
fi
for program in "$old" "$new"; do [[ -x $program ]] || fail "no executable $program"; done

"$old" sample --out "$work/meshes" --count "$count" --triangles "$triangles" >/dev/null ||
  fail "cannot make meshes"

# processor_time PROGRAM: marks the meshes and prints the seconds of user and kernel.
TIMEFORMAT='%U %S'
processor_time() {
  rm -rf "$work/out" "$work/out.ledger"*
  local code=0 spent
  spent=$({ time "$1" mark "$work/meshes" --out "$work/out" --message compared --threads "$threads" \
    --quiet >"$work/run.log" 2>&1 || echo "exit $?" >"$work/code"; } 2>&1)
  # 3: some meshes were refused, as the other build refuses them too
  if [[ -e $work/code ]]; then
    code=$(sed 's/exit //' "$work/code")
    rm "$work/code"
  fi
  ((code == 0 || code == 3)) || fail "$1 ended with $code: $(tail -n 1 "$work/run.log")"
  awk '{ printf "%.3f\n", $1 + $2 }' <<<"$spent"
}

processor_time "$old" >/dev/null # what is read for the first time comes from the disk
ratios=()
for ((round = 1; round <= rounds; ++round)); do
  # whoever comes second may find the machine warmer
  if ((round % 2)); then
    a=$(processor_time "$old") b=$(processor_time "$new")
  else
    b=$(processor_time "$new") a=$(processor_time "$old")
  fi
  one=$(awk -v a="$a" -v b="$b" 'BEGIN { printf "%.4f", (a > 0 ? b / a : 1) }')
  ratios+=("$one")
  echo "round $round: old $a s, new $b s, ratio $one"
done
median=$(printf '%s\n' "${ratios[@]}" | sort -n | awk '{ v[NR] = $1 }
  END { print (NR % 2 ? v[(NR + 1) / 2] : (v[NR / 2] + v[NR / 2 + 1]) / 2) }')
if awk -v median="$median" -v ratio="$ratio" 'BEGIN { exit !(median > ratio) }'; then
  echo "SLOWER: the new build takes $median times the processor time of the old one; $ratio are allowed"
  exit 1
fi
echo "no slower: the new build takes $median times the processor time of the old one; $ratio are allowed"
