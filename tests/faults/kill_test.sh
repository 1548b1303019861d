#!/usr/bin/env bash
# kill_test.sh BUILD [COUNT [every]]: kills runs of `mark` at COUNT random moments (default 40) and
# at single system calls (`every`: at all of them, otherwise at about 60), repeats the command until
# it is done, and compares outputs, records and ledger with those of a run that nobody disturbed.
# SEED chooses the moments.
set -euo pipefail
source "$(dirname "$0")/common.sh" "$@"
count=${2:-40}
extent=${3:-some}
dump=$build/tests/faults/triglyph_ledger_dump
fault_at=$build/tests/faults/triglyph_fault_at
RANDOM=${SEED:-$$}

place=$work/place
kills=0 torn=0 lost=0 doubled=0 other=0

# Runs the command, under the words given if any.
mark() {
  "$@" "$triglyph" mark "$place/meshes" --out "$place/out" --message 'for Ada' --threads 2 --quiet \
    --records "$place/records.jsonl" >/dev/null 2>"$work/errors"
}

# Prints what the place holds, in lines that can be compared; first each file with its hash.
state() {
  (cd "$place/out" && find . -type f -printf '%P\n' | sort | xargs -r -d '\n' sha256sum)
  records_without_run "$place/records.jsonl"
  "$dump" "$place/out.ledger"
}

# Ends the test with what was found so far; ctest takes 77 for "skipped".
skip() {
  echo "$*"
  ((torn + lost + doubled + other == 0)) || exit 1
  exit 77
}

reset() { rm -rf "$place"/{out,records.jsonl} "$place"/out.ledger*; }

# Repeats the command until it is done: a run may itself say that its worker was killed.
finish() {
  local status try
  for try in 1 2 3; do
    status=0
    mark || status=$?
    ((status == 3)) && return
  done
  echo "the command does not end as it should: exit $status: $(<"$work/errors")"
  return 1
}

# Compares with the reference, counts what is wrong, and starts over.
judge() {
  local what=$1 differences marks
  if ! finish; then
    ((++other))
    echo "  after $what"
  fi
  if [[ -n $(leftovers "$place") ]]; then
    echo "temporary files after $what: $(leftovers "$place")"
    ((++torn))
  fi
  state >"$work/state" || true
  if cmp -s "$work/reference" "$work/state"; then
    reset
    return
  fi
  marks=$(grep '^mark ' "$work/state" | cut -d' ' -f2 | uniq -d | wc -l)
  ((doubled += marks)) || true
  if ! differences=$(diff "$work/reference" "$work/state"); then
    printf '%s\n' "differences after $what:" "$(cut -c -300 <<<"$differences" | head -20)"
    ((torn += $(grep -c '^> \([0-9a-f]\{64\} \|TORN\)' <<<"$differences"))) || true
    ((lost += $(grep -c '^< ' <<<"$differences"))) || true
    ((++other))
  fi
  reset
}

# Kills the supervisor, the worker, or both, if they are still there.
kill_one() {
  local supervisor=$1 whom=$2 worker
  worker=$(cat "/proc/$supervisor/task/$supervisor/children" 2>/dev/null || true)
  worker=${worker%% *}
  case $whom in
    supervisor) kill -KILL "$supervisor" 2>/dev/null && ((++kills)) ;;
    worker) [[ -n $worker ]] && kill -KILL "$worker" 2>/dev/null && ((++kills)) ;;
    both) kill -KILL "$supervisor" $worker 2>/dev/null && ((++kills)) ;;
  esac || true
  wait "$supervisor" 2>/dev/null || true
  # a process that is being killed holds its locks to the end, when it is gone or a zombie
  while grep -qs '^State:[[:space:]]*[^Z[:space:]]' "/proc/${worker:-none}/status"; do sleep 0.002; done
}

# Starts the command, and kills it after a random part of the time that it takes.
start_and_kill() {
  # 10 % beyond the end, so that the last steps of a slow run are reached too
  local wait=$((RANDOM * duration * 11 / 10 / 32768))
  mark exec &
  sleep "$(printf '%d.%06d' $((wait / 1000000)) $((wait % 1000000)))"
  kill_one $! "$1"
}

mkdir "$place"
make_meshes "$place/meshes" 3
status=0
mark || status=$?
((status == 3)) || fail "the undisturbed run ends with $status: $(<"$work/errors")"
reset
start=${EPOCHREALTIME/./}
mark || true
duration=$((${EPOCHREALTIME/./} - start))
state >"$work/reference"
(($(grep -c '^mark ' "$work/reference") == 12)) || fail "the undisturbed run did not mark 12 meshes"
reset

victims=(supervisor worker both)
for ((i = 0; kills < count; ++i)); do
  victim=${victims[i % 3]}
  start_and_kill "$victim"
  # a second time where the first left the work half done
  ((i % 2 == 0)) || start_and_kill "${victims[RANDOM % 3]}"
  judge "kill $i of the $victim"
done
echo "random moments: $kills kills of $i collections in runs of $((duration / 1000)) ms: $torn torn, $lost lost," \
  "$doubled doubled, $other otherwise different"

# A smaller collection, killed at single calls. What changes a file, and what might lie between two
# changes; calls that only ask would add thousands of moments that differ in nothing.
calls=openat,read,write,writev,pread64,pwrite64,fdatasync,fsync,rename,unlink,ftruncate,mmap,munmap,close
calls+=,fstat,newfstatat,fcntl,flock,mkdir,getdents64,lseek,clone,clone3,mremap,wait4
rm -rf "$place/meshes"
make_meshes "$place/meshes" 1
mark || true
state >"$work/reference"
reset
status=0
mark "$fault_at" $calls 1 count || status=$?
((status == 3)) || skip "processes cannot be traced here: single system calls are left out"
reset
most=$(sed -n 's/^all //p' "$work/errors")
step=1
[[ $extent == every ]] || step=$((most / 60 + 1))
points=0
for ((n = 1 + RANDOM % step; n <= most; n += step)); do
  actions=(kill kill-one)
  mark "$fault_at" $calls "$n" "${actions[points++ % 2]}" || true
  judge "a kill at call $n of $most"
done
echo "system calls: $points kills at $most calls; in all $torn torn, $lost lost, $doubled doubled," \
  "$other otherwise different"
((torn + lost + doubled + other == 0))
