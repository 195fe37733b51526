#!/bin/bash
# Which type files have once Prismesh's types are installed: decks their own, everything else what it had before. Usage: types.sh PRISMESH.XML
set -euo pipefail
types=$(realpath "$1")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
for when in before after; do
  mkdir -p "$work/$when/mime/packages"
  cp /usr/share/mime/packages/freedesktop.org.xml "$work/$when/mime/packages/"
done
cp "$types" "$work/after/mime/packages/"
for when in before after; do update-mime-database "$work/$when/mime" >/dev/null 2>&1; done

failed=0
type_of() {  # type_of WHEN FILE
  XDG_DATA_HOME=/nonexistent XDG_DATA_DIRS=$work/$1 gio info -a standard::content-type "$2" | awk '/standard::content-type/ { print $2 }'
}
file() {  # file NAME TEXT: the path of a file
  mkdir -p "$work/files"
  printf -- "$2" >"$work/files/$1"
  echo "$work/files/$1"
}
is() {  # is TYPE NAME TEXT
  local found
  found=$(type_of after "$(file "$2" "$3")")
  [ "$found" = "$1" ] || { echo "FAILED: $2 is $found, not $1"; failed=1; }
}
stays() {  # stays NAME TEXT: the type that it had before
  local path
  path=$(file "$1" "$2")
  is "$(type_of before "$path")" "$1" "$2"
}

is text/x-ls-dyna rail.k '$ a rail\n*NODE\n'
is text/x-ls-dyna rail.dyn '*KEYWORD\n'
is text/x-ls-dyna rail.key '*KEYWORD\n*NODE\n'
is text/x-ls-dyna rail.key '$ a rail\n$\n*KEYWORD\n'
is text/x-ls-dyna rail '*KEYWORD\n*NODE\n'
is text/x-nastran wing.bdf 'SOL 101\nCEND\nBEGIN BULK\n'
is text/x-nastran wing.bdf '$ a wing\nGRID,1,,0.,0.,0.\n'
is text/x-nastran wing.nas 'GRID,1,,0.,0.,0.\n'
is text/x-nastran wing.fem '$$ a wing\n'
is text/x-nastran wing.dat 'SOL 101\nCEND\n'
is text/x-radioss BEAM_0000.rad '#RADIOSS STARTER\n/BEGIN\n'
is text/x-abaqus plate.inp '*HEADING\nA plate\n'
is text/x-abaqus plate.inp '**\n** A plate\n**\n*NODE, NSET=ALL\n1, 0, 0, 0\n'

stays font.bdf 'STARTFONT 2.1\nFONT -misc-fixed\n'
stays secret.key '-----BEGIN PGP PRIVATE KEY BLOCK-----\n\nx\n'
stays server.key '-----BEGIN PRIVATE KEY-----\nMIIE\n-----END PRIVATE KEY-----\n'
stays talk.key 'PK\003\004aaaaaaaaaaaaaaaaaaaaaaaaaaindex.apxl'
stays water.inp '&GLOBAL\n  PROJECT water\n&END GLOBAL\n'
stays network.inp '[TITLE]\nA network\n'
stays scene.rad 'void plastic red\n0\n0\n5 1 0 0 0 0\n'
stays table.dat '1 2 3\n'
stays notes.md '** bold **\n\n*NODE, a word\n'
stays notes.txt '*KEYWORD begins a deck\n'
stays run.sh '#!/bin/sh\necho "*KEYWORD"\n'
stays prices 'SOL 5\nUSD 3\n'
[ $failed -eq 0 ] && echo "ok: decks have their types, other files keep theirs"
exit $failed
