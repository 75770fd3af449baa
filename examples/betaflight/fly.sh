#!/bin/sh
# Flies an airframe in Betaflight's simulator, and prints what `sitl` says of the flight:
#
#     fly.sh AIRFRAME.toml BETAFLIGHT MIXER MANOEUVRE [options of sitl]
#
# BETAFLIGHT is the simulator's executable. MIXER is `coaxial`, for one that was built with it, `own` for Betaflight's mixer with a
# fitted `thrust_linear`, or `stock` for that without. docs/flights.md has what this printed.
set -eu
airframe=$(realpath "$1") betaflight=$(realpath "$2") mixer=$3 manoeuvre=$4
shift 4
here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
project=$(realpath "$here/../..")
own=
[ "$mixer" = coaxial ] || own=--own
folder=$(mktemp -d)
trap 'kill "${process:-}" 2>/dev/null || true; rm -rf "$folder"' EXIT

# Settings of the airframe without their `save`, then those of the simulator.
(cd "$project" && cargo mixer params "$airframe" --stack betaflight $own --pwm-range 1000,2000) >"$folder/params.txt"
sed '/^save/d' "$folder/params.txt" >"$folder/settings.txt"
[ "$mixer" != stock ] || echo 'set thrust_linear = 0' >>"$folder/settings.txt"
cat "$here/simulator.txt" >>"$folder/settings.txt"
(cd "$project" && cargo build --quiet --release -p simulation --bin sitl)
(cd "$folder" && "$betaflight" --config settings.txt >log.txt 2>&1) || true
# Its first start after that may not arm.
for start in 1 2; do
    [ "$start" = 1 ] || kill "$process"
    (cd "$folder" && exec "$betaflight" >log.txt 2>&1) &
    process=$!
    sleep 1
done
"$project/target/release/sitl" "$airframe" --betaflight --fly "$manoeuvre" "$@"
