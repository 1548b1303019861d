#!/usr/bin/env bash
# fault_table.sh BUILD [DEPTH]: lets system calls of small runs of `mark`, `extract` and `verify` fail:
# for each call and error, DEPTH of the calls (default 1, spread over the run; "every": all), each alone
# and, one in three, with all that follow; and runs them with too few descriptors, too little memory,
# full disks and folders that cannot be read. Prints how the runs ended:
#   whole       exit 0 and a complete result: the fault was harmless, or handled
#   told        another exit code, and a message that says why
#   INCOMPLETE  exit 0, but something is missing or wrong
#   CRASH       a process was killed or aborted
#   SILENT      another exit code and no message
#   HANG        no end within 30 s
#   LASTING     half a file has the name of an output, or the command, repeated, does not mend it
# Those in capitals must not be. SEED chooses the calls; CALLS, a pattern of grep -E, their kinds.
set -euo pipefail
source "$(dirname "$0")/common.sh" "$@"
depth=${2:-1}
dump=$build/tests/faults/triglyph_ledger_dump
fault_at=$build/tests/faults/triglyph_fault_at
RANDOM=${SEED:-1}
place=$work/place
ends=(whole told INCOMPLETE CRASH SILENT HANG LASTING)
declare -A row total
turn=0

# What may be wrong with a system call. Not munmap, which does not fail for a whole mapping, nor brk,
# which does not tell.
declare -A errors=(
  [openat]="EMFILE EACCES EIO ENOMEM EINTR" [read]="EIO EINTR" [write]="ENOSPC EIO EINTR"
  [writev]="ENOSPC EIO" [pread64]="EIO EINTR" [pwrite64]="ENOSPC EIO EINTR" [fdatasync]="EIO ENOSPC"
  [fsync]="EIO" [rename]="ENOSPC EIO EACCES" [unlink]="EACCES EIO" [ftruncate]="ENOSPC EIO"
  [mmap]="ENOMEM" [mremap]="ENOMEM" [mprotect]="ENOMEM"
  [close]="EIO EINTR" [getdents64]="EIO" [fstat]="EIO" [newfstatat]="EIO EACCES ENOMEM" [lseek]="EIO"
  [fcntl]="EAGAIN EIO" [flock]="ENOLCK EINTR" [mkdir]="ENOSPC EACCES" [clone]="EAGAIN" [clone3]="EAGAIN ENOMEM"
  [readlink]="EACCES" [getcwd]="ENOENT" [access]="EACCES"
)

run_mark() {
  "$@" "$triglyph" mark "$place/meshes" --out "$place/out" --message 'for Ada' --threads 2 --quiet \
    --records "$place/records.jsonl" --key-file "$work/key" --json
}
run_extract() { "$@" "$triglyph" extract "$work/marked" --threads 2 --key-file "$work/key" --json; }
run_verify() {
  "$@" "$triglyph" verify "$work/records.jsonl" --threads 2 --key-file "$work/key" --json
}
run_verify_ledger() {
  "$@" "$triglyph" verify --ledger "$work/marked.ledger" --threads 2 --key-file "$work/key" --json
}

reset() { rm -rf "$place"/{out,records.jsonl} "$place"/out.ledger*; }

# Prints what is to be there after a run of the verb.
result_of() {
  if [[ $1 == mark ]]; then
    (cd "$place/out" && find . -type f -printf '%P\n' | sort | xargs -r -d '\n' sha256sum)
    records_without_run "$place/records.jsonl"
    "$dump" "$place/out.ledger"
  fi
  records_without_run "$work/stdout" | sed 's/TORN //; s/"[a-z_]*_s":[0-9.e-]*//g'
}

# Returns whether every output of a run that failed is whole, and the command, repeated, mends the rest.
is_mended() {
  local file
  while IFS= read -r -d '' file; do
    cmp -s "$file" "$work/marked/${file#"$place/out/"}" || return 1
  done < <(find "$place/out" -type f ! -name '.*' -print0 2>/dev/null)
  run_mark >"$work/stdout" 2>"$work/errors" && diff <(result_of mark) "$work/mark.reference" >"$work/difference"
}

# count_end NAME VERB COMMAND..: runs a verb under the command, and counts how it ends.
count_end() {
  local name=$1 verb=$2 status=0 end message
  shift 2
  # through a pipe, since the limit of a file size would hold for the message as well
  { "run_$verb" timeout -s KILL 30 "$@" 2>&1 >"$work/stdout" | cat >"$work/errors"; } 2>"$work/shell" || status=$?
  message=$(<"$work/errors")
  end=told
  if ((status == 137)); then
    end=HANG
  elif ((status >= 128 && status != 130)) || grep -qE 'killed (the process )?by signal|terminate called' <<<"$message"; then
    end=CRASH
  elif ((status != 0)) && [[ -z $message ]]; then
    end=SILENT
  elif ((status == 0)); then
    end=whole
    diff <(result_of "$verb" 2>&1) "$work/$verb.reference" >"$work/difference" || end=INCOMPLETE
  fi
  # when all that is written fails, so does the message
  [[ $end == SILENT && $name == write*+ ]] && end=told
  cp "$work/errors" "$work/message"
  [[ $end != INCOMPLETE ]] || cp "$work/difference" "$work/found"
  if [[ $verb == mark ]]; then
    [[ $end == whole ]] || is_mended || [[ $end == INCOMPLETE ]] || end=LASTING
    reset
  fi
  row[$end]=$((${row[$end]:-0} + 1))
  total[$end]=$((${total[$end]:-0} + 1))
  if [[ $end != whole && $end != told ]]; then
    printf '%s of %s: exit %d, %s\n' "$name" "$verb" "$status" "$end"
    sed 's/^/  | /' "$work/message" | head -5 | cut -c -200
    [[ $end != LASTING ]] || mv "$work/difference" "$work/found"
    [[ $end == CRASH || $end == SILENT || $end == HANG ]] || head -4 "$work/found" | cut -c -160 | sed 's/^/  > /'
  fi
}

print_row() {
  local end text
  ((${#row[@]} > 0)) || return 0
  text=$(printf '%-22s' "$1")
  for end in "${ends[@]}"; do text+=$(printf ' %10s' "${row[$end]:-0}"); done
  echo "$text"
  row=()
}

# Lets calls of one kind fail in all verbs.
inject() {
  local call=$1 error=$2 verb most n step k
  local verbs=(mark extract verify verify_ledger)
  # the short form takes turns with the verbs that only read
  [[ $depth == every ]] || verbs=(mark "${verbs[1 + turn++ % 3]}")
  for verb in "${verbs[@]}"; do
    most=${calls_of[$verb $call]:-0}
    step=1
    [[ $depth == every ]] || step=$(((most + depth - 1) / depth))
    ((step > 0)) || step=1
    for ((n = 1 + RANDOM % step, k = RANDOM; n <= most; n += step, ++k)); do
      count_end "$call $n $error" "$verb" "$fault_at" "$call" "$n" "$error"
      # a call that is interrupted for ever is repeated for ever; SQLite tries a lock for ten seconds
      ((k % 3 == 0)) && [[ $error != EINTR && $call != fcntl ]] || continue
      count_end "$call $n $error+" "$verb" "$fault_at" "$call" "$n" "$error+"
    done
  done
  print_row "$call $error"
}

mkdir "$place"
for seed in 1 2; do
  "$triglyph" sample --out "$place/meshes/$seed" --count 1 --triangles 1000 --shape closed --seed "$seed" >/dev/null
done
"$triglyph" keygen --out "$work/key" >/dev/null
run_mark >"$work/stdout" 2>"$work/errors" || fail "the undisturbed run failed: $(<"$work/errors")"
result_of mark >"$work/mark.reference"
mv "$place/out" "$work/marked"
mv "$place/records.jsonl" "$work"
# verify finds what mark left in the places of its own names
sed -i "s|$place/out|$work/marked|g" "$work/records.jsonl"
reset
(cd "$work" && "$triglyph" mark "$place/meshes" --out marked --message 'for Ada' --quiet --key-file key)
for verb in extract verify verify_ledger; do
  "run_$verb" >"$work/stdout" 2>"$work/errors" || fail "the undisturbed $verb failed: $(<"$work/errors")"
  result_of $verb >"$work/$verb.reference"
done

printf '%-22s' ""
printf ' %10s' "${ends[@]}"
echo

# Without a tracer: what a shell can withhold.
for descriptors in 3 4 5 6 8 10 12 14 16; do
  for verb in mark extract verify verify_ledger; do
    count_end "$descriptors descriptors" $verb bash -c "ulimit -n $descriptors; exec \"\$@\"" -
  done
done
print_row "few descriptors"
for megabytes in 30 60 100 150 200 300; do
  for verb in mark extract verify verify_ledger; do
    count_end "$megabytes MB" $verb bash -c "ulimit -v $((megabytes * 1024)); exec \"\$@\"" -
  done
done
print_row "little memory"
for kilobytes in 0 1 20 40 100; do
  for verb in mark extract verify; do
    count_end "files of $kilobytes KB" $verb bash -c "ulimit -f $kilobytes; exec \"\$@\"" -
  done
done
print_row "short files"
for verb in mark extract verify; do
  count_end "full output" $verb bash -c '"$@" >/dev/full' -
  [[ $(<"$work/message") == *"standard output: "* ]] || fail "a full standard output of $verb is not named"
done
status=0
"$triglyph" mark "$place/meshes" --out "$place/out" --message 'for Ada' --quiet --records /dev/full \
  --key-file "$work/key" 2>"$work/errors" || status=$?
((status == 1)) && grep -q 'No space left' "$work/errors" || fail "--records /dev/full: $status, $(<"$work/errors")"
reset
print_row "full devices"

# A folder that cannot be read, in a folder, a glob and a manifest; root may read everything.
mkdir -p "$place/meshes/closed/deep"
cp "$place"/meshes/1/*.obj "$place/meshes/closed/deep"
chmod 000 "$place/meshes/closed"
as_nobody=()
((EUID != 0)) || as_nobody=(setpriv --reuid 65534 --regid 65534 --clear-groups)
chmod 755 "$work" && chmod 777 "$place"
printf '{"mesh": "meshes/**/*.obj"}\n' >"$place/all.jsonl"
if "${as_nobody[@]}" ls "$place/meshes" >/dev/null 2>&1 &&
  ! "${as_nobody[@]}" ls "$place/meshes/closed" >/dev/null 2>&1 &&
  "${as_nobody[@]}" "$triglyph" --version >/dev/null 2>&1; then
  for inputs in "$place/meshes" "$place/meshes/**/*.obj" "$place/meshes/*/*.obj" "$place/all.jsonl"; do
    for verb in mark extract; do
      words=("$inputs")
      [[ $verb == extract ]] || words+=(--out "$place/out" --message 'for Ada' --quiet)
      status=0
      "${as_nobody[@]}" "$triglyph" $verb "${words[@]}" >"$work/stdout" 2>"$work/errors" || status=$?
      ((status == 2)) && grep -q "meshes/closed: " "$work/errors" ||
        fail "$verb of $inputs with a closed folder: exit $status, $(<"$work/errors")"
    done
  done
  # a pattern that cannot match there does not mind
  "${as_nobody[@]}" "$triglyph" mark "$place/meshes/1/*.obj" --out "$place/out" --message a --quiet 2>"$work/errors" ||
    fail "a closed folder beside the pattern: $(<"$work/errors")"
  echo "closed folders are named"
else
  echo "nobody may run triglyph here: closed folders are left out"
fi
chmod 755 "$place/meshes/closed"
rm -rf "$place/meshes/closed" "$place/all.jsonl"
reset

status=0
declare -A calls_of
calls=$(IFS=, && echo "${!errors[*]}")
for verb in mark extract verify verify_ledger; do
  "run_$verb" "$fault_at" "$calls" 1 count >/dev/null 2>"$work/errors" || status=$?
  while read -r call number; do calls_of["$verb $call"]=$number; done < <(grep -E '^[a-z0-9]+ [0-9]+$' "$work/errors")
  [[ $verb != mark ]] || reset
done
if ((status == 0)); then
  for call in $(printf '%s\n' "${!errors[@]}" | grep -xE "${CALLS:-.*}" | sort); do
    for error in ${errors[$call]}; do inject "$call" "$error"; done
  done
fi
for end in "${ends[@]}"; do row[$end]=${total[$end]:-0}; done
print_row "in all"
for end in "${ends[@]:2}"; do ((${total[$end]:-0} == 0)) || exit 1; done
if ((status != 0)); then
  echo "processes cannot be traced here: failing calls are left out"
  exit 77
fi
