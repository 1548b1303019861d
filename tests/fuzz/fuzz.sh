#!/usr/bin/env bash
# fuzz.sh BUILD SECONDS: runs all fuzz targets, as many side by side as there are processors, for this time
# in total, beginning from tests/fuzz/corpus. Fails if one crashes, leaks, takes more than 10 s or 2 GB
# for an input, or breaks its promise; the input stays in BUILD/fuzz/findings. What was learnt stays in
# BUILD/fuzz/corpus for the next time. FUZZ_SEED makes the inputs the same each time.
set -euo pipefail
build=$(cd "$1" && pwd)
seconds=$2
corpus=$(cd "$(dirname "$0")/corpus" && pwd)
targets=(mesh extract manifest record key ledger)
jobs=$(nproc)
((jobs < ${#targets[@]})) || jobs=${#targets[@]}
rounds=$(((${#targets[@]} + jobs - 1) / jobs))
each=$((seconds / rounds))
((each > 0)) || each=1

folder=$(mktemp -d -p "$([[ -w /dev/shm ]] && echo /dev/shm || echo "${TMPDIR:-/tmp}")")
trap 'rm -rf "$folder"' EXIT
export TMPDIR=$folder
export UBSAN_OPTIONS=${UBSAN_OPTIONS:-print_stacktrace=1}

run() {
  local target=$1 log=$build/fuzz/$1.log options=()
  mkdir -p "$build/fuzz/corpus/$target" "$build/fuzz/findings"
  [[ ! -f $corpus/$target.dict ]] || options+=(-dict="$corpus/$target.dict")
  [[ -z ${FUZZ_SEED:-} ]] || options+=(-seed="$FUZZ_SEED")
  "$build/tests/fuzz/triglyph_fuzz_$target" "$build/fuzz/corpus/$target" "$corpus/$target" \
    -max_total_time="$each" -timeout=10 -rss_limit_mb=2048 -max_len=20000 -print_final_stats=1 -verbosity=1 \
    -artifact_prefix="$build/fuzz/findings/$target-" "${options[@]}" >"$log" 2>&1
}

running=()
failed=()
for target in "${targets[@]}" ""; do
  while ((${#running[@]} >= jobs)) || [[ -z $target && ${#running[@]} -gt 0 ]]; do
    wait "${running[0]%% *}" || failed+=("${running[0]##* }")
    running=("${running[@]:1}")
  done
  [[ -n $target ]] || break
  run "$target" &
  running+=("$! $target")
done

for target in "${targets[@]}"; do
  log=$build/fuzz/$target.log
  executions=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
  coverage=$(grep -oE 'cov: [0-9]+' "$log" | tail -1 || true)
  echo "$target: ${executions:-no} executions, ${coverage:-no coverage}"
done
for target in "${failed[@]}"; do
  echo "== $target failed"
  grep -vE '^#[0-9]+\s+(NEW|REDUCE|pulse|RELOAD)|NEW_FUNC' "$build/fuzz/$target.log" | tail -60
done
((${#failed[@]} == 0))
