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
if ((status == 0)); then exit 0; fi

ended=$(sed -n 's/^\t *[0-9]* - \([^ ]*\) (.*)$/&/p' "$log") # "	  3 - name (Failed)"
failed=$(grep -v '(Timeout)$' <<<"$ended" | awk '{ print $3 }')
cut=$(grep '(Timeout)$' <<<"$ended" | awk '{ print $3 }')
if [[ -n $cut ]]; then echo "Cut off after $seconds seconds in all, $((seconds / 3)) each: $(xargs <<<"$cut")"; fi
if [[ -n $failed || -z $cut ]]; then exit 1; fi
