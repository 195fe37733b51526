#!/bin/bash
# Puts what boots into one file of UEFI. Usage: kernel.sh STUB OS-RELEASE COMMAND-LINE VMLINUZ INITRD OUT.
set -euo pipefail
# The sections lie one after the other, behind those of the stub.
at=0
while read -r size address; do
  end=$((16#$size + 16#$address))
  [ $end -le $at ] || at=$end
done < <(objdump -h "$1" | sed -nE 's/^ *[0-9]+ \S+ +([0-9a-f]+)  ([0-9a-f]+) .*/\1 \2/p')
arguments=()
for part in ".osrel=$2" ".cmdline=$3" ".linux=$4" ".initrd=$5"; do
  at=$(((at + 4095) / 4096 * 4096))
  arguments+=(--add-section "$part" --change-section-vma "${part%%=*}=$(printf '0x%x' $at)")
  at=$((at + $(stat -Lc %s "${part#*=}")))
done
objcopy "${arguments[@]}" "$1" "$6"
# The header's time is that of the image. Its checksum, which nothing checks, counts the time too.
header=$(od -An -tu4 -j60 -N4 "$6")
printf '%08x' "$SOURCE_DATE_EPOCH" | sed 's/\(..\)\(..\)\(..\)\(..\)/\\x\4\\x\3\\x\2\\x\1/' | xargs -0 printf | dd of="$6" bs=1 seek=$((header + 8)) conv=notrunc status=none
dd if=/dev/zero of="$6" bs=1 count=4 seek=$((header + 88)) conv=notrunc status=none
