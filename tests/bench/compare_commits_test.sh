#!/usr/bin/env bash
# bench/compare_commits.sh lets a build pass that is as fast as the other, and stops one that marks
# everything twice. Usage: compare_commits_test.sh SOURCE EXECUTABLE
set -euo pipefail
source=$1 program=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
compare=$source/bench/compare_commits.sh
fail() {
  echo "FAILED: $*" >&2
  cat "$work/log" >&2
  exit 1
}

cat >"$work/slow" <<END
#!/usr/bin/env bash
"$program" "\$@" || exit \$?
[[ \$1 != mark ]] || "$program" "\$@" --force
END
printf '#!/bin/sh\n[ "$1" = sample ] && exec "%s" "$@"\nexit 7\n' "$program" >"$work/broken"
chmod +x "$work/slow" "$work/broken"

export COUNT=12 TRIANGLES=1000 ROUNDS=3 RATIO=1.5
"$compare" --built "$program" "$program" >"$work/log" 2>&1 || fail "the same build is slower"
code=0
"$compare" --built "$program" "$work/slow" >"$work/log" 2>&1 || code=$?
((code == 1)) && grep -q '^SLOWER' "$work/log" || fail "twice the work passes, with $code"
code=0
"$compare" --built "$program" "$work/broken" >"$work/log" 2>&1 || code=$?
((code == 3)) || fail "a run that fails passes, with $code"
code=0
(cd "$source" && "$compare" no-such-commit .) >"$work/log" 2>&1 || code=$?
((code == 3)) && grep -q 'no commit no-such-commit' "$work/log" || fail "a wrong commit passes, with $code"
code=0
"$compare" >"$work/log" 2>&1 || code=$?
((code == 2)) || fail "no arguments pass, with $code"
