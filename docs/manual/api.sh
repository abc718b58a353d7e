#!/bin/bash
# The library's functions as its headers describe them: a chapter of the manual, or the man page.
#
#   api.sh markdown|man VERSION HEADER...
set -euo pipefail
form=$1
version=$2
shift 2
awk -v form="$form" -v version="$version" '
    function heading(text) {
        if (form == "man") print ".SH " toupper(text); else print "\n## " text "\n"
    }
    # a paragraph of a comment; in troff a dot or quote at a start of line would be a request
    function say(text) {
        if (form == "man") { gsub(/\\/, "\\e", text); gsub(/-/, "\\-", text); sub(/^[.\x27]/, "\\\\\\&&", text) }
        else gsub(/[<*_|]/, "\\\\&", text)
        print text
    }
    function flush_block() {
        if (comment != "") { if (form == "man") print ".PP"; say(comment); if (form != "man") print "" }
        if (code != "") {
            if (form == "man") { gsub(/\\/, "\\e", code); gsub(/-/, "\\-", code); printf ".PP\n.nf\n%s.fi\n", code }
            else printf "```c\n%s```\n\n", code
        }
        comment = code = ""
    }
    BEGIN {
        if (form == "man") {
            printf ".TH LIBIMPACTLAB 3 \"\" \"impactlab %s\"\n", version
            print ".SH NAME\nlibimpactlab \\- runs of a flexible robot arm that hits a wall\n.SH SYNOPSIS"
            print ".nf\n#include <impactlab/impactlab.h>\n#include <impactlab/controller.h>\n.fi"
        } else print "# The library\n\nFrom the headers, which have the last word."
    }
    FNR == 1 {
        flush_block(); parts = split(FILENAME, path, "/"); heading(path[parts]); skip = 0
    }
    # conditional lines and what only C++ and compilers read
    /^#(ifdef|if) / { skip++; next }
    /^#endif/ { if (skip > 0) skip--; next }
    /^#/ || skip > 0 { next }
    /^\/\/ --- / { flush_block(); gsub(/^\/\/ -+ | -+$/, ""); heading($0); next }
    /^\/\// && depth == 0 {
        if (code != "") flush_block()
        line = $0; sub(/^\/\/ ?/, "", line)
        if (line ~ /^    /) next # the example is a page of the manual
        if (line == "") { flush_block(); next }
        comment = comment (comment == "" ? "" : " ") line; next
    }
    /^$/ && depth == 0 { flush_block(); next }
    {
        line = $0; exported = gsub(/IMPACTLAB_EXPORT /, "", line)
        if (exported) aligned = 1
        else if (aligned) sub(/^                 /, "", line) # below the arguments of an exported one
        if (line ~ /;$/) aligned = 0
        code = code line "\n"
        depth += gsub(/{/, "{", line) - gsub(/}/, "}", line)
    }
    END { flush_block(); if (form == "man") print ".SH SEE ALSO\n\\fBimpactlab\\fR(1), \\fBimpactlab\\-scenario\\fR(5)" }
' "$@"
