#!/bin/bash
# `impactlab help` answers the questions of tests/questions.txt in its first three hits; `show` of a
# word that is no scenario says what it may mean.
#
#   test_questions.sh PROGRAM SOURCE_ROOT
set -u
questions=$(readlink -f "$2/tests/questions.txt")
# shellcheck source=tests/expect.sh
. "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/expect.sh"
asked=0

# the first three hits, as the list of answers names them
hits() {
    sed -nE 's/^(README\.md|docs[^,]*), "(.*)"$/\1: \2/p
        s/^((parameter|quantity|signal|law) [^ ]+)( \[.*\])?$/\1/p
        s/^(impactlab [a-z]+|lab :[a-z]+)$/\1/p' out | head -n 3
}

# whether one of the answers $1 is among the hits
answered() {
    local answer hit found
    mapfile -t found < <(hits)
    while read -r answer; do
        for hit in "${found[@]}"; do
            [ "$hit" = "$answer" ] || [ "${hit%%: *}" = "$answer" ] && return
        done
    done < <(tr ';' '\n' <<<"$1" | sed 's/^ *//; s/ *$//; s/`//g')
    return 1
}

while IFS='|' read -r question answers; do
    [[ $question == '#'* ]] && continue
    # shellcheck disable=SC2086
    expect 0 help $question
    answered "$answers" || fail "'$question' is answered by $(hits | paste -s -d ';')"
    asked=$((asked + 1))
done <"$questions"
[ "$asked" -ge 300 ] || fail "only $asked questions"

# a word that is no scenario
expect 2 show k2
says err "neither a scenario nor a file"
says err "parameter arm.k2 [N m/rad]"
expect 2 show nonesuch
! grep -q 'may mean' err || fail "nonesuch has a meaning"

# what nothing is known of, one word or several, and what little is known of
expect 2 help blurp splodge
says err "no passage says 'blurp splodge'"
expect 2 help xylophone
says err "no passage says 'xylophone'"
expect 2 help rnu
says err "did you mean 'run'"
expect 0 help pneumatic bellows valve pressure of the wall
says out "no passage says it"
expect 0 help where does the wall stand
! grep -q "no passage" out || fail "nothing is said of walls"
nothing_failed
