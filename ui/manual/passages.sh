#!/bin/sh
# The manual's pages as C tables for the search: each heading with the paragraphs, table rows and
# examples below it, without the marks of Markdown, and the questions that a line
# <!-- asked: QUESTION? QUESTION? --> below the heading says it answers.
#
#   passages.sh SOURCE_ROOT OUTPUT DEPENDENCIES
#
# DEPENDENCIES becomes a list of all pages and their folders for ninja, so that a new page is
# noticed, too.
set -eu
LC_ALL=C
export LC_ALL
root=$1
output=$PWD/$2
dependencies=$3

# every page by its path in the tree
pages=$(cd "$root" && find README.md docs -name '*.md' | sort)

# what ninja watches, blanks escaped
{
    printf '%s:' "$2"
    for place in $pages $(cd "$root" && find docs -type d | sort); do
        printf ' %s' "$(printf '%s' "$root/$place" | sed 's/ /\\ /g')"
    done
    echo
} >"$dependencies"

cd "$root"
# shellcheck disable=SC2086
awk '
    # the words of a line, as a reader sees them
    function plain(line) {
        gsub(/!\[[^]]*\]\([^)]*\)/, "", line)
        while (match(line, /\[[^]]*\]\([^)]*\)/)) {
            link = substr(line, RSTART, RLENGTH)
            sub(/^\[/, "", link)
            sub(/\]\(.*/, "", link)
            line = substr(line, 1, RSTART - 1) link substr(line, RSTART + RLENGTH)
        }
        gsub(/[`*]/, "", line)
        return line
    }
    # a C string; "??" would begin a trigraph
    function quoted(text) {
        gsub(/\\/, "\\\\&", text)
        gsub(/"/, "\\\\&", text)
        gsub(/\?/, "\\\\&", text)
        return "\"" text "\""
    }
    # ends the paragraph; long examples are cut, C compilers need not take longer strings
    function end_text() {
        gsub(/[ \t]+/, " ", text)
        sub(/^ /, "", text)
        if (text != "" && sections > 0) texts[count++] = substr(text, 1, 3000)
        text = ""
    }
    function begin_section(heading) {
        end_text()
        first[sections] = count
        page[sections] = FILENAME
        title[sections] = page_title
        asked[sections] = ""
        headings[sections++] = heading
    }

    BEGIN { sections = count = 0 }
    FNR == 1 { end_text(); fenced = 0; page_title = "" }
    /^```/ { end_text(); fenced = !fenced; next }
    fenced { text = text " " $0; next }
    /^<!-- asked: .*-->$/ {
        if (asked[sections - 1] != "") {
            print FILENAME ":" FNR ": a second line of questions below one heading" >"/dev/stderr"
            exit 1
        }
        sub(/^<!-- asked: /, "")
        sub(/ *-->$/, "")
        asked[sections - 1] = $0
        next
    }
    /^<!--.*-->$/ { next }
    /^#+ / {
        sub(/^#+ /, "")
        if (page_title == "") page_title = plain($0)
        begin_section(plain($0))
        next
    }
    /^ *$/ { end_text(); next }
    /^\|[-| :]*$/ { next }
    /^\|/ {
        end_text()
        text = plain($0)
        sub(/^\| */, "", text)
        sub(/ *\|$/, "", text)
        gsub(/ *\| */, ": ", text)
        end_text()
        next
    }
    /^ *([-*]|[0-9]+\.) / { end_text(); sub(/^ *([-*]|[0-9]+\.) /, "") }
    { text = text " " plain($0) }

    END {
        end_text()
        first[sections] = count
        print "static const char *const texts[] = {"
        for (i = 0; i < count; i++) print "    " quoted(texts[i]) ","
        print "    NULL,\n};\n\nstatic const struct section sections[] = {"
        for (i = 0; i < sections; i++)
            print "    {" quoted(page[i]) ", " quoted(title[i]) ", " quoted(headings[i]) ", " \
                quoted(asked[i]) ", " first[i] ", " first[i + 1] - first[i] "},"
        print "};"
    }' $pages >"$output"
