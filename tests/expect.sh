# What tests of the program as a process share; sourced with the program in $1. Makes a folder of its
# own the current one, which goes at the end, and counts in $failures.
# shellcheck shell=bash
program=$(readlink -f "$1")
export LC_ALL=C.UTF-8
folder=$(mktemp -d /tmp/impactlab-test-XXXXXX)
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1
failures=0

# a failure, with what the program said last
fail() {
    echo "FAILED: $*"
    [ ! -s out ] || echo "  stdout: $(head -c 400 out)"
    [ ! -s err ] || echo "  stderr: $(head -c 400 err)"
    failures=$((failures + 1))
}

# expect STATUS ARGUMENT...: runs the program, its output lands in the files out and err
expect() {
    local wanted=$1 status=0
    shift
    "$program" "$@" >out 2>err </dev/null || status=$?
    [ "$status" = "$wanted" ] || fail "impactlab $*: exit status $status, expected $wanted"
}

# says FILE TEXT: the text occurs in it
says() {
    grep -qF -e "$2" "$1" || fail "'$2' is not in $1"
}

# on_terminal COMMAND ARGUMENT...: runs it on a terminal of its own; what that shows lands in seen
on_terminal() {
    timeout -s INT 120 script -qec "$(printf '%q ' "$@")" seen >out 2>err </dev/null
}

# true only if nothing failed; a test ends with it
nothing_failed() {
    [ "$failures" = 0 ] || echo "$failures failed"
    [ "$failures" = 0 ]
}
