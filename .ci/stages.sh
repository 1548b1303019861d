# Sourced by run and nightly: stages that are timed, logged under build/logs and summed up at the end.
cd "$(dirname "${BASH_SOURCE[0]}")/.."
mkdir -p build/logs
summary=()
TIMEFORMAT='%0R s, processor %0U s + %0S s'

# stage NAME COMMAND [ARGUMENT...]
stage() {
  local name=$1 log=build/logs/${1// /-} status=0
  shift
  printf '\n== %s\n' "$name"
  { time "$@" 2>&1 | tee "$log.log" >&3; } 3>&1 2>"$log.time" || status=$?
  local outcome=ok
  ((status == 0)) || outcome=FAILED
  summary+=("$(printf '%-6s  %-18s %s' "$outcome" "$name" "$(<"$log.time")")")
  local line
  while IFS= read -r line; do
    summary+=("        $line")
  done < <(grep -E 'tests passed|tests failed|\*\*\*(Failed|Exception|Timeout)' "$log.log")
  return "$status"
}

closing_summary() {
  local status=$?
  printf '\n== summary\n'
  ((${#summary[@]} == 0)) || printf '%s\n' "${summary[@]}"
  exit "$status"
}
trap closing_summary EXIT

# The paper's models, if TRIGLYPH_MODELS names them or a folder beside this checkout holds them.
if [[ -z ${TRIGLYPH_MODELS:-} ]]; then
  for models in "$PWD"/../*/models; do
    if [[ -f $models/bunny.obj && -f $models/armadillo.obj && -f $models/max-planck.obj ]]; then
      export TRIGLYPH_MODELS=$models
      break
    fi
  done
fi
