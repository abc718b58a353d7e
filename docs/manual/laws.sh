#!/bin/bash
# A page for each built-in control law: what the program says of it, and the derivation over its
# code, which is the section '--- LAW ---' where a file has several, and the file's head.
#
#   laws.sh PROGRAM SOURCE_ROOT
set -euo pipefail
"$1" help --reference laws | awk '
    # a comment as paragraphs; formulas and tables, which are indented, as blocks
    function say(text,    lines, count, i, line, block, fenced) {
        count = split(text, lines, "\n")
        print ""
        for (i = 1; i < count; i++) {
            line = substr(lines[i], 4)
            block = line ~ /^    / || (fenced && line == "" && substr(lines[i + 1], 4) ~ /^    /)
            if (block != fenced) print block ? "```" : "```\n"
            fenced = block
            if (!block) gsub(/[<*_|]/, "\\\\&", line)
            print line
        }
        if (fenced) print "```"
        print ""
    }

    # from the sources: heads, sections, and which law stands where
    FILENAME != "-" {
        if (FNR == 1) { in_head = 1; section = "" }
        comment = /^\/\//
        in_head = in_head && comment
        if (in_head) head[FILENAME] = head[FILENAME] $0 "\n"
        if (/^\/\/ --- [a-z-]+ ---$/) { section = $3; begun = 0 }
        else if (comment && section != "") { own[section] = own[section] $0 "\n"; begun = 1 }
        else if (begun) section = ""
        if (wrapped) sub(/^ *"/, "_LAW(\"")
        wrapped = /_LAW\($/
        if (match($0, /_LAW\("[a-z-]+"/)) {
            law = substr($0, RSTART + 6, RLENGTH - 7)
            file[law] = FILENAME
            if (first[FILENAME] == "") first[FILENAME] = law
        }
        next
    }

    # into the page of the program, before the list of parameters
    /^## / { law = substr($0, 4); told = !(law in file) }
    /^- / && !told {
        told = 1
        if (law in own) say(own[law])
        if (law == first[file[law]]) say(head[file[law]])
        else print "In the family of `" first[file[law]] "`, whose page has the rest.\n"
    }
    { print }' "$2"/src/rig/laws/*.c -
