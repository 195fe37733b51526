#!/bin/bash
# In the guest: runs each line from the test's port as root, and tells its status. Only a test's copy of the disk has it.
until exec 3<>/dev/virtio-ports/prismesh.test; do sleep 0.2; done
while IFS= read -r line <&3; do
  mark=${line##* #}
  eval "${line% #*}" >&3 2>&1 </dev/null
  printf '%s=%d\n' "$mark" $? >&3
done
