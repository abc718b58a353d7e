# a text file as rows of C strings, without lines that are comments alone
\|^ *// |d
s/[\"]/\\&/g
s/.*/"&\\n",/
