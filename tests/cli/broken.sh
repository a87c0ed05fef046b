#!/bin/sh
# broken.sh -- every broken file is one line on stderr and exit code 2. No GPU.
. "$(dirname "$0")/lib.sh"

mkdir files
"$helpers/broken_make" files >list || fail "broken_make"
count=0
while read -r file; do
    refuses 2 "$(basename "$file" | sed 's/-.*//')" info "$file"
    count=$((count + 1))
done <list
[ "$count" -ge 60 ] || fail "only $count broken files"
echo "$count broken files"
finish
