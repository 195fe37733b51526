#!/bin/bash
# Makes the keys of a fleet of stations, unless they are there: update-ca signs who may make updates, update makes them; boot-PK, boot-KEK and boot-db
# are those of Secure Boot. Usage: keys.sh FOLDER. Who has the *.key files can make updates: keep them off the stations.
set -euo pipefail
umask 077
mkdir -p "$1"
cd "$1"
[ ! -s update.crt ] || [ ! -s boot-db.auth ] || exit 0
[ -z "$(find . -name '*.key')" ] || { echo "keys.sh: $PWD has keys, but not all that belong to them; none is overwritten" >&2; exit 1; }
request() { openssl req -new -newkey rsa:3072 -nodes -keyout "$1.key" -subj "/O=Prismesh/CN=$2" "${@:3}" 2>/dev/null; }
request update-ca "Prismesh updates: authority" -x509 -days 7300 -out update-ca.crt -addext basicConstraints=critical,CA:TRUE -addext keyUsage=critical,keyCertSign,cRLSign
request update "Prismesh updates" -out update.csr
printf 'basicConstraints=critical,CA:FALSE\nkeyUsage=critical,digitalSignature\nextendedKeyUsage=emailProtection\n' >update.extensions
openssl x509 -req -in update.csr -CA update-ca.crt -CAkey update-ca.key -set_serial 2 -days 3650 -extfile update.extensions -out update.crt 2>/dev/null
owner=4d7bd8b9-6b4d-4c0e-9d5e-7072736d7368
for key in PK KEK db; do
  request boot-$key "Prismesh boot: $key" -x509 -days 7300 -out boot-$key.crt
  openssl x509 -in boot-$key.crt -outform DER -out boot-$key.cer
  cert-to-efi-sig-list -g $owner boot-$key.crt boot-$key.esl
done
sign-efi-sig-list -g $owner -k boot-PK.key -c boot-PK.crt PK boot-PK.esl boot-PK.auth >/dev/null
sign-efi-sig-list -g $owner -k boot-PK.key -c boot-PK.crt KEK boot-KEK.esl boot-KEK.auth >/dev/null
sign-efi-sig-list -g $owner -k boot-KEK.key -c boot-KEK.crt db boot-db.esl boot-db.auth >/dev/null
