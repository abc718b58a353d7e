#!/bin/bash
# The manual as one HTML page that needs no other file and no network, with a search over all of it.
#
#   build.sh SOURCE_ROOT PROGRAM OUTPUT.html
#
# Each page of docs becomes a chapter whose identifiers begin with the page's name, so that links
# from page to page stay links; the commands' help is the last chapter.
set -euo pipefail
if ! command -v pandoc >/dev/null; then
    echo "the manual is not built: pandoc is missing (Debian: pandoc)"
    exit 0
fi
source=$1
program=$2
output=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

pages=(terminal scenarios physics methods validity control what-a-sensor-sees sweeps figures scenes
    gallery add-a-controller library speed reliability thesis architecture)

# all pages of docs, those that nobody has put into the order last
for file in "$source"/docs/*.md; do
    page=$(basename "$file" .md)
    [[ " ${pages[*]} " == *" $page "* ]] || pages+=("$page")
done

# links to other pages and to files of the tree, as they are within the one page
one_page() {
    sed -E -e 's|href="(\./)?(docs/)?([a-z-]+)\.md#([^"]*)"|href="#\3-\4"|g' \
        -e 's|href="(\./)?(docs/)?([a-z-]+)\.md"|href="#\3"|g' \
        -e 's|<a href="[^#:"][^:"]*">([^<]*)</a>|\1|g'
}

# chapter NAME FILE: one page as a section with its contents
chapter() {
    echo "<section id=\"$1\">"
    (cd "$(dirname "$2")" && pandoc -f gfm+tex_math_dollars -t html5 --mathml --wrap=none --id-prefix="$1-" "$(basename "$2")") |
        one_page
    echo '</section>'
}

escaped() {
    sed 's/&/\&amp;/g; s/</\&lt;/g; s/>/\&gt;/g'
}

commands() {
    echo '<section id="commands"><h1>The commands</h1>'
    "$program" --help | { echo '<pre>'; escaped; echo '</pre>'; }
    "$program" --help | sed -n 's/^  \([a-z]*\)  *[A-Z].*/\1/p' | while read -r command; do
        echo "<h2 id=\"commands-$command\">impactlab $command</h2><pre>"
        "$program" "$command" --help | escaped
        echo '</pre>'
    done
    echo '</section>'
}

# the body, and a line of contents for each chapter
{
    chapter readme "$source/README.md"
    for page in "${pages[@]}"; do
        chapter "$page" "$source/docs/$page.md"
    done
    commands
} >"$work/body.html"
contents() {
    grep -o '<section id="[^"]*">\|<h1[^>]*>.*</h1>' "$work/body.html" |
        awk -F'"' '/^<section/ { id = $2; fresh = 1; next }
            fresh { gsub(/<[^>]*>/, ""); print "<li><a href=\"#" id "\">" $0 "</a></li>"; fresh = 0 }'
}

# one page, pictures included
{
    cat <<END
<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>$("$program" --version): the manual</title>
<style>
END
    cat "$source/docs/manual/style.css"
    cat <<'END'
</style>
</head>
<body>
<nav>
<input id="words" type="search" placeholder="Search (press /)" aria-label="Search the manual">
<ol id="found" hidden></ol>
<ul id="contents">
END
    contents
    echo '</ul></nav><main>'
    (cd "$source/docs" && perl -MMIME::Base64 -0pe '
        s{src="(?:docs/)?(pictures/[^"]+\.png)"}{
            my $path = $1; local $/; open my $f, "<", $path or die "$path: $!";
            "src=\"data:image/png;base64," . encode_base64(<$f>, "") . "\""}ge' "$work/body.html")
    echo '</main><script>'
    cat "$source/docs/manual/search.js"
    echo '</script></body></html>'
} >"$work/manual.html"
mkdir -p "$(dirname "$output")"
mv "$work/manual.html" "$output"
echo "the manual: $output"
