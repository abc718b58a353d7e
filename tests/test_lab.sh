#!/bin/bash
# The lab script, with stand-ins for apt-get and the build tools: what it says before it installs, in
# which locale it builds and starts the program, what it does where it cannot write.
# $1: the project's folder
set -u
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
failures=0
mkdir "$folder/my lab (one)" "$folder/tools"
cp "$1/lab" "$folder/my lab (one)/lab"
lab="$folder/my lab (one)/lab"
unset IMPACTLAB_BUILD IMPACTLAB_MESON_OPTIONS

fail() {
    echo "FAILED: $*"
    cat "$folder/out"
    failures=$((failures + 1))
}

says() {
    grep -qF -- "$1" "$folder/out" || fail "nothing says '$1'"
}

# stand_in NAME: a tool that does what the standard input says
stand_in() {
    { echo '#!/bin/bash'; cat; } >"$folder/tools/$1"
    chmod +x "$folder/tools/$1"
}

# tools that note their locale, and make a program that tells its own
stand_in meson <<'END'
[ "$1" != setup ] || touch "$2/build.ninja"
[ "$1" != setup ] || echo "$LC_ALL" >"$2/meson.locale"
[ "$1" != test ] || printf 'Ok:                 3   \nFail:               %d   \n' "${FAILING:-0}"
END
stand_in ninja <<'END'
echo "${LC_ALL-none}" >"$2/ninja.locale"
printf '#!/bin/bash\nprintf "locale %%s\\n" "${LC_ALL-none}"\nprintf "<%%s>\\n" "$@"\n' >"$2/impactlab"
chmod +x "$2/impactlab"
END
for tool in cc pkg-config; do
    stand_in $tool </dev/null
done
stand_in sudo <<'END'
exec "$@"
END
# nothing is installed before apt-get has been told to
stand_in dpkg-query <<'END'
[ ! -e "$INSTALLED" ] || for package in "${@:4}"; do echo "$package installed"; done
END
stand_in apt-get <<'END'
case "$*" in
*--assume-no*)
    echo "Need to get 12.3 MB/45.6 MB of archives."
    echo "After this operation, 78.9 MB of additional disk space will be used."
    exit 1 ;;
*install*) touch "$INSTALLED" ;;
esac
END

run() {
    PATH=$folder/tools:$PATH INSTALLED=$folder/installed "$@" >"$folder/out" 2>&1
}

# says what it will install, how much that is, and starts the program in the user's locale
run env LC_ALL=C "$lab" list "two words" '' || fail "exit status $?"
says "these packages are missing: build-essential"
says "12.3 MB/45.6 MB to fetch, 78.9 MB on the disk"
says "locale C"
says "<two words>"
says "<>"
for tool in meson ninja; do
    [ "$(cat "$folder/my lab (one)/build/$tool.locale")" = C.UTF-8 ] || fail "$tool is not in UTF-8"
done
run env -u LC_ALL "$lab" list || fail "exit status $?"
says "locale none"
grep -q "packages are missing" "$folder/out" && fail "it installs a second time"

# a moved folder is built anew, and what somebody keeps there stays; the last line of a test counts
echo mine >"$folder/my lab (one)/build/notes"
mv "$folder/my lab (one)" "$folder/my lab (two)"
lab="$folder/my lab (two)/lab"
run "$lab" test || fail "exit status $?"
says "building, this takes a moment"
[ "$(cat "$folder/my lab (two)/build/notes")" = mine ] || fail "a file in a moved build folder is lost"
[ "$(tail -n 1 "$folder/out")" = "3 passed, 0 failed" ] || fail "wrong last line"
run env FAILING=2 "$lab" test && fail "failing tests pass"
[ "$(tail -n 1 "$folder/out")" = "3 passed, 2 failed" ] || fail "wrong last line"

# where it cannot write it says how to go on
for command in list test build; do
    run env IMPACTLAB_BUILD=/proc/none/build "$lab" $command && fail "$command builds in /proc"
    says "there is no writing to /proc/none/build"
    says "IMPACTLAB_BUILD="
done

# refused WHAT FOLDER: no command builds there, and nothing in it changes
refused() {
    local command before
    before=$(cd "$2" && find -H . | sort)
    for command in list test build; do
        run env IMPACTLAB_BUILD="$2" "$lab" $command && fail "$command builds in $1"
        says "name another folder to build in: IMPACTLAB_BUILD="
    done
    [ "$(cd "$2" && find -H . | sort)" = "$before" ] || fail "something changed in $1"
}

# a folder is only taken that is empty, or was made by this clone or one that is gone
cp -r "$folder/my lab (two)" "$folder/other"
run "$folder/other/lab" build || fail "a copied folder is not built: exit status $?"
[ "$(cat "$folder/other/build/notes")" = mine ] || fail "a file in a copied build folder is lost"
refused "another clone's folder" "$folder/other/build"
says "$folder/other/build is the build folder of $folder/other"
ln -s "$folder/other/build" "$folder/link"
refused "another clone's folder behind a link" "$folder/link"
cp -r "$folder/other" "$folder/my lab (two)/within"
run "$folder/my lab (two)/within/lab" build || fail "a clone within another is not built"
refused "a clone within this one" "$folder/my lab (two)/within/build"
mkdir "$folder/home" && touch "$folder/home/.profile"
refused "a home folder" "$folder/home"
says "holds files that no build of the lab made"
run env IMPACTLAB_BUILD="$folder/shared" "$folder/other/lab" build || fail "exit status $?"
refused "a folder that another clone named" "$folder/shared"
echo mine >"$folder/shared/notes"
rm -r "$folder/other"
run env IMPACTLAB_BUILD="$folder/shared" "$lab" build || fail "the folder of a clone that is gone is refused"
[ "$(cat "$folder/shared/notes")" = mine ] || fail "a file in the folder of a clone that is gone is lost"
mkdir -p "$folder/my lab (two)/plain/meson-private" && touch "$folder/my lab (two)/plain/build.ninja"
run env IMPACTLAB_BUILD="$folder/my lab (two)/plain" "$lab" build || fail "what meson set up is refused"

[ $failures = 0 ] && echo "all well"
exit $failures
