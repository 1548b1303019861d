#!/usr/bin/env bash
# install_test.sh BUILD SOURCE: installs a build, then builds examples/ against it by find_package and
# by pkg-config, compares the manual pages with the executables' own help, and lets bash complete.
set -euo pipefail
build=$1
source=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
prefix=$work/prefix

fail() {
  echo "install_test: $*" >&2
  exit 1
}

cmake --install "$build" --prefix "$prefix" >/dev/null
[[ -x $prefix/bin/triglyph && -x $prefix/bin/triglyph-render ]] || fail "no executables"
lib=$(dirname "$(find "$prefix" -name libtriglyph.so)")

# The library exports what is in triglyph, and nothing else.
strangers=$(nm -DC --defined-only "$lib/libtriglyph.so" | cut -d' ' -f3- |
  grep -vE '^(triglyph::|(typeinfo|typeinfo name|vtable) for triglyph::)' || true)
[[ -z $strangers ]] || fail "the library also exports: $strangers"
grep -q 'triglyph::mark_file' <<<"$(nm -DC --defined-only "$lib/libtriglyph.so")" || fail "no mark_file"

# The headers name no other library and compile by themselves.
others=$(grep -rhE '^#include' "$prefix/include" | grep -vE '<(triglyph/[a-z]+\.h|[a-z_]+)>' || true)
[[ -z $others ]] || fail "the headers include $others"

# A program finds the CMake package, marks a mesh and reads it back; without a mark it says so.
"$prefix/bin/triglyph" sample --out "$work/meshes" --count 1 --triangles 6000 --shape closed >/dev/null
mesh=$(find "$work/meshes" -type f)
cmake -S "$source/examples" -B "$work/example" -DCMAKE_PREFIX_PATH="$prefix" >/dev/null
cmake --build "$work/example" >/dev/null
"$work/example/mark_and_read" "$mesh" "$work/marked.obj" | tee "$work/out"
grep -q '^for Ada, moved by' "$work/out" || fail "the example did not read its message"
"$work/example/mark_and_read" "$work/absent.obj" "$work/x.obj" 2>"$work/err" && fail "absent mesh marked"
grep -q 'absent.obj' "$work/err" || fail "the error names no file"

# So does one that asks pkg-config; pkg-config itself finds the package where it was moved to.
mv "$prefix" "$work/moved"
prefix=$work/moved
lib=${lib/"$work/prefix"/$prefix}
read -ra flags < <(PKG_CONFIG_PATH=$lib/pkgconfig pkg-config --cflags --libs triglyph)
c++ "$source/examples/mark_and_read.cpp" "${flags[@]}" -Wl,-rpath,"$lib" -o "$work/by_pkg_config"
grep -q '^for Ada' <<<"$("$work/by_pkg_config" "$mesh" "$work/marked_again.obj")" || fail "pkg-config"

# Every option in a verb's help is on its page, and the pages are well-formed.
for verb in mark extract trace verify sweep measure merge render attack survive profile sample keygen; do
  page=$prefix/share/man/man1/triglyph-$verb.1
  sed 's/\\-/-/g; s/\\&//g' "$page" >"$work/page"
  "$prefix/bin/triglyph" "$verb" --help | grep -oE '(^ +|,)--[a-z-]+' | grep -oE -- '--[a-z-]+' >"$work/options"
  (($(wc -l <"$work/options") > 1)) || fail "help of $verb names no options"
  while read -r option; do
    grep -qE "^\\\\fB.*$option\\\\fR" "$work/page" || fail "$page lacks $option"
  done <"$work/options"
  if command -v groff >/dev/null && [[ -e /usr/share/groff/current/tmac/an.tmac ]]; then
    complaints=$(groff -man -Tutf8 -ww "$page" 2>&1 >/dev/null)
    [[ -z $complaints ]] || fail "$complaints"
  fi
done

[[ -s $prefix/share/man/man1/triglyph-ledger.1 ]] || fail "the ledger has no page"

# bash completes verbs, options, choices and file names.
completed() {
  (
    source "$prefix/share/bash-completion/completions/triglyph"
    cd "$work"
    COMP_WORDS=(triglyph "$@")
    COMP_CWORD=$#
    _triglyph
    printf '%s\n' "${COMPREPLY[@]}"
  )
}
expect() {
  local wanted=$1
  shift
  grep -qxF -- "$wanted" <<<"$(completed "$@")" || fail "completion of '$*' lacks $wanted"
}
expect extract ex
expect --max-move mark --max
expect aie mark a.obj --scheme a
expect aie mark a.obj --scheme = a
expect meshes mark --out me
expect marked.obj extract mar
expect --panels render --pan
[[ -z $(completed mark --max-move "") ]] || fail "a number was completed"
expect --key-file mark --key
echo "installed files are complete"
