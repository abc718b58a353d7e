#!/bin/bash
# The terminal lab asks before a scenario's program runs, remembers the answer for this content of
# both; each run starts the program once and asks it from the beginning.
#
#   test_consent.sh PROGRAM SOURCE_ROOT
set -euo pipefail
source=$(readlink -f "$2")
# shellcheck source=tests/expect.sh
. "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/../expect.sh"
lab=$program
work=$folder
export XDG_CONFIG_HOME=$work/settings

# a law that notes each start and each question
cat >law.sh <<'END'
echo x >>starts
while read -r line; do
    echo x >>questions
    case $line in
    *'"force":3.0,'*) echo '{"command": 1.2}' ;;
    *) echo '{"command": 1.5}' ;;
    esac
done
END
sed -e 's/command: .*/command: sh law.sh/' -e 's/settings: .*/rate: 100 Hz/' \
    "$source/docs/examples/soft_push.yaml" >scenario.yaml

# visit FILE KEYS...: presses keys; the screen goes to `screen`
visit() {
    local file=$1 keys=$2
    rm -f starts questions
    "$lab" lab "$file" --keys "$keys" --size 200x30 >screen 2>&1 || :
}

# times FILE: lines of it, 0 where nothing wrote any
times() {
    cat "$1" 2>/dev/null | wc -l
}

shows() {
    grep -qF -- "$1" screen || fail "the screen does not say '$1': $(tail -2 screen)"
}

# asked, nothing starts, and the rest of the lab is there
visit scenario.yaml ''
shows "y lets it start 'sh law.sh'"
shows 'not allowed'
[ "$(times starts)" = 0 ] || fail "the program started unasked"
visit scenario.yaml ':set wall.angle 0.01<Enter>:set control.law open-loop<Enter>'
shows 'control.law = open-loop from the start'
[ "$(times starts)" = 0 ] || fail "the program started unasked"
visit scenario.yaml 'n'
shows 'not allowed'
[ ! -e settings/impactlab/allowed ] || fail "remembered without an answer"

# allowed and remembered; the run is that of the command line
visit scenario.yaml 'y:save run.csv<Enter>'
[ "$(times starts)" = 1 ] || fail "the program started $(times starts) times"
grep -q '^[0-9a-f]\{64\} scenario.yaml: sh law.sh$' settings/impactlab/allowed ||
    fail "remembered: $(cat settings/impactlab/allowed)"
"$lab" run scenario.yaml --allow-code --quiet --csv plain.csv
cmp -s run.csv plain.csv || fail "the lab's run is another one"
visit scenario.yaml ''
[ "$(times starts)" = 1 ] || fail "asked although it was remembered"

# for this content only
cp law.sh kept.sh
echo '# another' >>law.sh
visit scenario.yaml ''
shows "y lets it start"
mv kept.sh law.sh
sed 's/gain/reach/; s/1 s}/1.1 s}/' scenario.yaml >other.yaml
visit other.yaml ''
shows "y lets it start"
visit scenario.yaml ''
[ "$(times starts)" = 1 ] || fail "the content is what it was, but it asks"

# what only a shell can read is allowed for one visit; nor is there a memory without a folder
sed 's/command: .*/command: "true; sh law.sh"/' scenario.yaml >shell.yaml
visit shell.yaml 'y'
shows 'allowed for this visit'
visit shell.yaml ''
shows 'y lets it start'
(unset HOME XDG_CONFIG_HOME; visit other.yaml 'y')
shows 'allowed for this visit'

# a plug-in likewise
sed -e 's/law: .*/law: plugin/' -e 's/command: .*/plugin: .\/x.so/' scenario.yaml >plugin.yaml
echo 'no library' >x.so
visit plugin.yaml ''
shows "y lets it load './x.so'"

# every run starts it: a change's, an undone one's; to look back is no run
visit scenario.yaml ':seek 0.3<Enter>:push 0.01<Enter>'
[ "$(times starts)" = 2 ] || fail "a push: started $(times starts) times, not 2"
visit scenario.yaml ':seek 0.3<Enter>:push 0.01<Enter>uU:seek 0<Enter>:seek end<Enter>u'
[ "$(times starts)" = 5 ] || fail "undo and redo: started $(times starts) times, not 5"
visit scenario.yaml ':seek 0.3<Enter>:set control.force 3<Enter>:save changed.csv<Enter>:save changed.yaml<Enter>'
shows 'saved'
"$lab" run changed.yaml --allow-code --quiet --csv again.csv
cmp -s changed.csv again.csv || fail "a changed run is not that of its file"
visit scenario.yaml ':extend 0.5<Enter>:save long.csv<Enter>'
"$lab" run scenario.yaml --allow-code --quiet --set run.duration=1.5 --csv again.csv
cmp -s long.csv again.csv || fail "a longer run is another one"

nothing_failed && echo "programs run where the user lets them, and each run starts its own"
