#!/usr/bin/env bash
# photographs.sh COUNT PROGRAM...: what COUNT pictures of different sizes take beside as many of one size, each applied by
# a process of its own, in turns, with caches that begin empty. Prints seconds of wall clock and of CPU, and their ratios.
set -euo pipefail
count=$1
shift
programs=("$@")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export LC_ALL=C TIMEFORMAT='%R %U %S'

# picture WIDTH HEIGHT: prints the file of a black PFM.
picture() {
  local file=$work/$1x$2.pfm
  [[ -e $file ]] || { printf 'PF\n%d %d\n-1.0\n' "$1" "$2"; head -c $((12 * $1 * $2)) /dev/zero; } > "$file"
  echo "$file"
}

# apply CACHE PROGRAM FILE: prints the seconds.
apply() {
  mkdir -p "$1/driver" # Mesa makes no folders above its own
  {
    time XDG_CACHE_HOME="$1/ours" MESA_SHADER_CACHE_DIR="$1/driver" "$2" apply --color "$3" --chain cinematic \
      --no-times --quiet -o "$work/out.png" 2> "$work/errors" || { cat "$work/errors" >&2; exit 1; }
  } 2>&1 | awk '{ print $1, $2 + $3 }'
}

for ((i = 0; i < count; ++i)); do
  width=$((250 + 150 * i / count))
  for p in "${!programs[@]}"; do
    # As many pixels, give or take a row.
    apply "$work/many.$p" "${programs[p]}" "$(picture $width $((320 * 214 / width)))" >> "$work/many.times.$p"
    apply "$work/one.$p" "${programs[p]}" "$(picture 320 214)" >> "$work/one.times.$p"
  done
done

for p in "${!programs[@]}"; do
  paste -d' ' "$work/many.times.$p" "$work/one.times.$p" | awk -v program="${programs[p]}" '
    { many += $1; many_cpu += $2; one += $3; one_cpu += $4 }
    END {
      printf "%s: %d sizes %.2f / %.2f, one size %.2f / %.2f, ratio %.2f / %.2f\n", program, NR, many, many_cpu, one,
             one_cpu, many / one, many_cpu / one_cpu
    }'
done
