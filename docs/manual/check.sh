#!/bin/bash
# The manual is whole: every page of docs is a chapter, no link leads nowhere, nothing is fetched.
#
#   check.sh SOURCE_ROOT PROGRAM
set -euo pipefail
command -v pandoc >/dev/null || { echo "pandoc is missing, the manual is not built"; exit 77; }
source=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
bash "$source/docs/manual/build.sh" "$source" "$2" "$work/manual.html" >"$work/said"
page=$work/manual.html
fails=0

complain() {
    echo "FAILED: $*"
    fails=$((fails + 1))
}

while read -r file; do
    grep -q "<section id=\"$(basename "$file" .md)\">" "$page" || complain "$file is no chapter"
done < <(find "$source/docs" -name '*.md' ! -path '*/matplotlib/*')
for name in parameters signals quantities laws events functions claims; do
    grep -q "<section id=\"table-of-$name\">" "$page" || complain "the table of $name is no chapter"
done
# each parameter is a place that its mentions lead to, each scenario has its figure
"$2" help --reference parameters | sed -n 's/^| `\([^`]*\)` |.*/\1/p' >"$work/paths"
[ "$(wc -l <"$work/paths")" -gt 100 ] || complain "only $(wc -l <"$work/paths") parameters"
while read -r path; do
    grep -qF " id=\"$path\"" "$page" || complain "$path has no anchor"
done <"$work/paths"
grep -qF '<a href="#arm.tilt"><code>arm.tilt</code></a>' "$page" || complain "no mention leads to arm.tilt"
while read -r name; do
    grep -qF "alt=\"the run of $name\" src=\"data:image/png" "$page" || complain "$name has no figure in the gallery"
done < <("$2" list -q)
# the chapter of the laws has what stands over their code: of a file, of a family, of a member
for words in 'm_a v' 'force_gain (f - reading)' 'In the family of <code>hybrid</code>' '= integral_gain (f'; do
    grep -qF "$words" "$page" || complain "the chapter of the laws has no '$words'"
done
grep -o ' id="[^"]*"' "$page" | sed 's/.*="//; s/"//' | sort >"$work/ids"
grep -o 'href="#[^"]*"' "$page" | sed 's/.*="#//; s/"//' | sort -u >"$work/links"
[ "$(wc -l <"$work/links")" -gt 20 ] || complain "only $(wc -l <"$work/links") links"
dead=$(comm -23 "$work/links" <(sort -u "$work/ids"))
[ -z "$dead" ] || complain "links to nowhere: $dead"
twice=$(uniq -d "$work/ids")
[ -z "$twice" ] || complain "identifiers twice: $twice"
! grep -oE '(src|href)="[^"#d][^"]*"' "$page" | grep -vE '"(https?|mailto):' | grep -q . ||
    complain "places outside the page"
! grep -qE '<(script|link|img)[^>]*(src|href)="http' "$page" || complain "something is fetched"

# the search finds a section by words of its text, where there is something to run it with
if command -v chromium >/dev/null; then
    found=$(chromium --headless --no-sandbox --disable-gpu --dump-dom \
        "file://$page?babbles+stdin+nonesuch" 2>/dev/null || :)
    grep -q 'nothing has all these words' <<<"$found" || complain "the search finds nonesuch"
    found=$(chromium --headless --no-sandbox --disable-gpu --dump-dom \
        "file://$page?steady_force_N" 2>/dev/null || :)
    grep -q '<li><a href="#table-of-quantities' <<<"$found" ||
        complain "the search does not find steady_force_N"
fi

[ "$fails" = 0 ] && echo "the manual is whole"
