#!/usr/bin/env bash
# test_within.sh SECONDS DIRECTORY CTEST_ARGUMENT...: the tests of a slow build, until the time is up. A test that was cut
# off is named and is no failure.
set -euo pipefail
seconds=$1 directory=$2
shift 2

# Mesa keeps what it allocated for its drivers and screens until the process ends, and unloads some of itself before.
export LSAN_OPTIONS="suppressions=$PWD/cmake/leaks_of_others.txt:print_suppressions=0${LSAN_OPTIONS:+:$LSAN_OPTIONS}"
export UBSAN_OPTIONS="print_stacktrace=1${UBSAN_OPTIONS:+:$UBSAN_OPTIONS}"

log=$directory/Testing/within.log
mkdir -p "$(dirname "$log")"
status=0
# One slow test leaves time for others.
ctest --test-dir "$directory" --timeout $((seconds / 3)) --stop-time "$(date -d "+$seconds seconds" +%T)" "$@" 2>&1 |
  tee "$log" || status=$?
listed_as() { awk -v kind="$1" '/^\t *[0-9]+ - .*\(.*\)$/ && (/\(Timeout\)$/ ? "cut" : "failed") == kind { print $3 }' "$log"; }
failed=$(listed_as failed)
cut=$(listed_as cut)
ended=$(grep -c '^ *[0-9]*/[0-9]* Test *#' "$log") || true
wanted=$(ctest --test-dir "$directory" -N "$@" | sed -n 's/^Total Tests: //p')
said="$ended of $wanted tests began within $seconds s"
if [[ -n $cut ]]; then said+="; cut off after at most $((seconds / 3)) s: $(xargs <<<"$cut")"; fi
if [[ -n $failed ]]; then said+="; failed: $(xargs <<<"$failed")"; fi
echo "$said"
if [[ -n $failed ]]; then exit 1; fi
if [[ -z $cut ]] && ((ended == wanted)); then exit "$status"; fi
