#!/bin/bash
# The manual as one HTML page that needs no other file and no network, with a search over all of it.
#
#   build.sh SOURCE_ROOT PROGRAM OUTPUT.html
#
# Each page of docs becomes a chapter whose identifiers begin with the page's name, so that links
# from page to page stay links; the program's tables and the commands' help are the last chapters.
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

# one reader's way: first steps, tasks, what is what, why, and how it is made; then what is left
mapfile -t pages < <(cd "$source/docs" &&
    { ls -U start.md howto/{walk,arm,wall,plot,data,sweep,cluster,controller,library,fmu,scenes,lab,web}.md faq.md glossary.md \
          reference/{scenario,laws,recipes}.md explanation/{model,trust,methods,control-design,thesis}.md \
          contributors/{architecture,testing,speed}.md
      find . -name '*.md' ! -path './matplotlib/*' | sed 's|^\./||' | sort; } 2>/dev/null |
    awk '!met[$0]++' || :)

# links to other pages and to files of the tree, as they are within the one page
one_page() {
    sed -E -e 's|href="([a-z./]*/)?([a-z-]+)\.md#([^"]*)"|href="#\2-\3"|g' \
        -e 's|href="([a-z./]*/)?([a-z-]+)\.md"|href="#\2"|g' \
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

# chapters from the program's tables and the library's headers; results, where they have been made
tables() {
    for page in parameters signals quantities events; do
        "$program" help --reference "$page" >"$work/table-of-$page.md"
    done
    bash "$source/docs/manual/laws.sh" "$program" "$source" >"$work/table-of-laws.md"
    awk -F '\t' 'NR == 1 { print "# The claims of the thesis"; next }
        $1 != chapter { print "\n## Claims of chapter " $1 "\n\n| thesis | what it says | place | command | verdict |"
                        print "|---|---|---|---|---|"; chapter = $1 }
        { print "| " $2 " | " $3 " | " $4 " | " $5 " | " $6 " |" }' \
        "$source/docs/explanation/claims.tsv" >"$work/table-of-claims.md"
    bash "$source/docs/manual/api.sh" markdown "" "$source"/src/api/impactlab/impactlab.h \
        "$source"/src/rig/controller.h >"$work/table-of-functions.md"
    for page in parameters signals quantities laws events functions claims; do
        chapter "table-of-$page" "$work/table-of-$page.md"
    done
    results=$(dirname "$output")/results.md
    if [ -e "$results" ]; then
        chapter results "$results"
    fi
}

# the chapter of scenarios, each with the figure of its run
gallery() {
    "$program" help --reference scenarios >"$work/scenarios.md"
    while IFS= read -r line; do
        printf '%s\n' "$line"
        case $line in
        '### '*)
            "$program" run "${line#\#\#\# }" --quiet --plot "$work/scenario.png" --width 85mm --dpi 90 >/dev/null 2>&1 || :
            if [ -e "$work/scenario.png" ]; then
                printf '\n<img alt="the run of %s" src="data:image/png;base64,%s">\n' \
                    "${line#\#\#\# }" "$(base64 -w 0 "$work/scenario.png")"
                rm "$work/scenario.png"
            fi
            ;;
        esac
    done <"$work/scenarios.md" >"$work/gallery.md"
    chapter gallery "$work/gallery.md"
}

# every parameter in its table is a place, to which all mentions of it lead
with_anchors() {
    perl -0pe '
        my %known;
        s{(<section id="table-of-parameters">.*?</section>)}{
            my $table = $1;
            $table =~ s|<td([^>]*)><code>([a-z]+\.\w+)</code></td>|$known{$2} = 1; "<td$1 id=\"$2\"><code>$2<!-- --></code></td>"|ge;
            $table}se;
        s{<code>([a-z]+\.\w+)</code>(?!</a>)}{$known{$1} ? "<a href=\"#$1\"><code>$1</code></a>" : $&}ge;
        s{<!-- --></code>}{</code>}g'
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
        chapter "$(basename "$page" .md)" "$source/docs/$page"
    done
    gallery
    tables
    commands
} | with_anchors >"$work/body.html"
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
        s{src="(?:docs/|(?:\.\./)+)?(pictures/[^"]+\.png)"}{
            my $path = $1; local $/; open my $f, "<", $path or die "$path: $!";
            "src=\"data:image/png;base64," . encode_base64(<$f>, "") . "\""}ge' "$work/body.html")
    echo '</main><script>'
    cat "$source/docs/manual/search.js"
    echo '</script></body></html>'
} >"$work/manual.html"
mkdir -p "$(dirname "$output")"
mv "$work/manual.html" "$output"
echo "the manual: $output"
