# Faults planted in a copy of the source tree, to see that tests notice them: what bench/planted_bias and
# bench/planted_hard_cases share. To be sourced; `plants` holds entries "what | file | text that is there once | new text | ...".

# Fails unless text $2 is in file $1 exactly once.
is_there_once() {
  local count
  count=$(OLD=$2 perl -0777 -ne '$count = () = /\Q$ENV{OLD}\E/g; print $count' "$1")
  [[ $count == 1 ]] && return
  echo "$(basename "$0"): the text to replace is ${count:-0} times in $1: $2" >&2
  return 1
}

# Replaces text $2 by $3 in file $1 of the copy.
plant() {
  OLD=$2 NEW=$3 perl -0777 -i -pe 's/\Q$ENV{OLD}\E/$ENV{NEW}/' "$copy/$1"
}

# Fails unless all places to plant are in the source tree.
all_are_there() {
  local missing=0 what file old
  for entry in "${plants[@]}"; do
    IFS='|' read -r what file old _ <<<"$entry"
    is_there_once "$source_tree/$file" "$old" || missing=$((missing + 1))
  done
  ((missing == 0))
}

# Makes the copy and configures it; arguments are for cmake.
make_copy() {
  for folder in bench cmake mesh scenes solver tests viewer_export; do cp -r "$source_tree/$folder" "$copy/"; done
  cp "$source_tree/CMakeLists.txt" "$copy/"
  cmake -S "$copy" -B "$copy/build" -G Ninja -DCMAKE_BUILD_TYPE=Release "$@" >"$copy/build.log"
}

# Builds targets of the copy.
build() {
  if ! nice ninja -C "$copy/build" "$@" >"$copy/build.log" 2>&1; then
    tail -30 "$copy/build.log" >&2
    echo "$(basename "$0"): the copy cannot be built" >&2
    exit 2
  fi
}

source_tree=$(cd "$(dirname "$0")/.." && pwd)
copy=$(mktemp -d)
trap 'rm -rf "$copy"' EXIT
export CCACHE_BASEDIR="$copy" CCACHE_NOHASHDIR=1
