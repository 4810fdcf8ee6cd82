#!/usr/bin/env bash
# first_picture.sh ROUNDS PROGRAM...: what a first picture takes, as a Markdown table. Programs (of several commits, say)
# and cases are run in turns, with caches of their own that begin empty, the driver's as well. Each time is the median
# of all rounds, in seconds: wall clock / CPU of all threads.
set -euo pipefail
rounds=$1
shift
programs=("$@")
chains=(none cinematic default)
scene=still_life
folder=$(cd "$(dirname "$0")/../configs/chains" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export LC_ALL=C TIMEFORMAT='%R %U %S'

# chain NAME ROUND: prints the file of a chain with values of its own in each round.
chain() {
  local file=$work/$1.$2.yaml
  printf 'include: %s\n' "$folder/$1.yaml" > "$file"
  if [[ $1 != none ]]; then
    printf 'overrides: {bloom: {intensity: 0.0%d}, vignette: {strength: 0.2%d}, tonemap: {exposure: 0.%d}}\n' \
      "$2" "$2" "$2" >> "$file"
  fi
  echo "$file"
}

# render CACHE PROGRAM CHAIN SIZE: prints the seconds of wall clock and of CPU.
render() {
  mkdir -p "$1/driver" # Mesa makes no folders above its own
  {
    time XDG_CACHE_HOME="$1/ours" MESA_SHADER_CACHE_DIR="$1/driver" "$2" render "$scene" --chain "$3" --size "$4" \
      --no-times --quiet -o "$work/picture.png" 2> "$work/errors" || { cat "$work/errors" >&2; exit 1; }
  } 2>&1 | awk '{ print $1, $2 + $3 }'
}

median() { sort -n | awk '{ x[NR] = $1 } END { print NR % 2 ? x[(NR + 1) / 2] : (x[NR / 2] + x[NR / 2 + 1]) / 2 }'; }

for ((round = 1; round <= rounds; ++round)); do
  for name in "${chains[@]}"; do
    for p in "${!programs[@]}"; do
      program=${programs[p]} kept=$work/cache.$p.$name fresh=$work/fresh
      # No power of two, on this or the way down to it: drivers compile for those apart.
      [[ $round -gt 1 ]] || render "$kept" "$program" "$(chain "$name" 0)" 600x338 > /dev/null
      size=$((750 + 6 * round))x$((422 + 2 * round))
      file=$(chain "$name" "$round")
      rm -rf "$fresh"
      render "$fresh" "$program" "$file" "$size" >> "$work/none.$name.$p"
      render "$kept" "$program" "$file" "$size" >> "$work/new.$name.$p"
      render "$kept" "$program" "$file" "$size" >> "$work/seen.$name.$p"
    done
  done
done

printf '| Programs | Size and values | Chain |'
for p in "${!programs[@]}"; do printf ' %s | over none |' "${programs[p]}"; done
printf '\n|---|---|---|'
for p in "${!programs[@]}"; do printf -- '--:|--:|'; done
printf '\n'
for state in none new seen; do
  for name in "${chains[@]}"; do
    case $state in
      none) printf '| none compiled | new | %s |' "$name" ;;
      *) printf '| compiled | %s | %s |' "$state" "$name" ;;
    esac
    for p in "${!programs[@]}"; do
      for column in 1 2; do
        for of in "$name" none; do
          cut -d' ' -f$column "$work/$state.$of.$p" | median
        done
      done | paste -sd' ' | awk '{ printf " %.2f / %.2f | %.2f / %.2f |", $1, $3, $1 - $2, $3 - $4 }'
    done
    printf '\n'
  done
done
