#!/bin/sh
# One archive of one object in which only the public names are global, so that nothing of the inside
# meets the names of a program that links it.
#
#   static_library.sh OUTPUT SYMBOLS ARCHIVE...
set -eu
output=$1
symbols=$2
shift 2
object=$output.o
ld -r -o "$object" --whole-archive "$@"
sed 's/@@.*//' "$symbols" >"$object.names" # the names without their versions
objcopy --keep-global-symbols="$object.names" "$object"
rm -f "$output"
ar rcs "$output" "$object"
rm -f "$object" "$object.names"
