#!/bin/sh
# Halation in one file. What it needs follows these lines. It is unpacked once, into the user's folder of caches, and
# what another version unpacked there is removed as soon as that version no longer runs.
set -u
file=$(readlink -f "$0")
home=${XDG_CACHE_HOME:-$HOME/.cache}/halation/application
place=$home/@NAME@

stop() {
    echo "halation: $*" >&2
    exit 1
}

unpack() {
    mkdir -p "$home" || stop "$home: the folder cannot be made: set XDG_CACHE_HOME to another"
    [ ! -t 2 ] || echo "Unpacking Halation into $home, once" >&2
    work=$(mktemp -d "$home/.unpacking-XXXXXX") || stop "$home: cannot be written: set XDG_CACHE_HOME to another folder"
    trap 'rm -rf "$work"' EXIT
    trap 'exit 130' HUP INT TERM
    tail -n +@LINES@ "$file" | tar -xz -C "$work" ||
        stop "$home: unpacking failed: make room on its disk, or download the file again"
    # Another start may have been quicker.
    mv -T "$work" "$place" 2>/dev/null || [ -x "$place/halation" ] || stop "$home: cannot be written"
    trap - EXIT HUP INT TERM
    rm -rf "$work"
    for other in "$home"/*; do
        [ "$other" = "$place" ] || flock -xn "$other/halation" rm -rf "$other"
    done
}

[ -x "$place/halation" ] || unpack
# The running program keeps the lock that says so.
exec 9<"$place/halation" && flock -s 9
HALATION_PROGRAM=$file exec "$place/halation" "$@"
