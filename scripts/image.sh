# `./station image` and `./station vm`. Sourced by ./station after steps.sh and package.sh.

# Each file of an image is as old as this, so that one set of packages gives one image.
image_time=1700000000

# The image's kernel has many drivers that no workstation with a graphics card and a disk needs.
image_without="sound drivers/media drivers/infiniband drivers/staging drivers/iio drivers/isdn drivers/atm drivers/comedi drivers/mtd drivers/bluetooth
  drivers/nfc drivers/target drivers/md/bcache drivers/net/wireless drivers/net/can drivers/net/hamradio drivers/net/fddi drivers/net/wwan
  drivers/net/ethernet/mellanox drivers/net/ethernet/chelsio drivers/net/ethernet/qlogic drivers/net/ethernet/netronome
  drivers/net/ethernet/cavium drivers/net/ethernet/emulex drivers/net/ethernet/huawei drivers/net/ethernet/cisco drivers/net/ethernet/brocade
  drivers/net/ethernet/sfc drivers/net/ethernet/broadcom/bnx2x drivers/scsi/qla2xxx drivers/scsi/qla4xxx drivers/scsi/lpfc drivers/scsi/bfa
  drivers/scsi/bnx2fc drivers/scsi/bnx2i drivers/scsi/csiostor drivers/scsi/be2iscsi drivers/scsi/aic7xxx drivers/scsi/aic94xx
  net/bluetooth net/mac80211 net/wireless net/sctp net/ceph net/openvswitch net/batman-adv net/netfilter/ipvs net/sunrpc net/tipc net/rds
  fs/ceph fs/nfs fs/nfsd fs/ocfs2 fs/gfs2 fs/xfs fs/btrfs fs/f2fs fs/jfs fs/ntfs3 fs/cifs fs/smb fs/afs fs/reiserfs fs/dlm fs/orangefs"

# build_base FOLDER: a Debian 12 without our packages, as FOLDER/base.tar. Kept for a week.
build_base() {
  local folder=$1 list without=() each
  [ -z "$(find "$folder/base.tar" -mtime -7 2>/dev/null)" ] || { [ packages.txt -nt "$folder/base.tar" ] || [ scripts/image/users.conf -nt "$folder/base.tar" ] || return 0; }
  say "Collecting Debian's packages"
  for each in $image_without; do without+=(--dpkgopt="path-exclude=/lib/modules/*/kernel/$each/*"); done
  list=$(packages run image image-and-disks | paste -sd,)
  SOURCE_DATE_EPOCH=$image_time mmdebstrap --variant=minbase --mode=root --components=main --include="$list" \
    --essential-hook="systemd-sysusers --root=\"\$1\" '$PWD/scripts/image/users.conf'" --aptopt='APT::Install-Recommends "false"' \
    --dpkgopt='path-exclude=/usr/share/man/*' --dpkgopt='path-exclude=/usr/share/locale/*' --dpkgopt='path-exclude=/usr/share/doc/*' \
    --dpkgopt='path-include=/usr/share/doc/*/copyright' "${without[@]}" bookworm "$folder/new.tar" 2>"$folder/base.log" ||
    { tail -20 "$folder/base.log" >&2; give_up "Debian's packages couldn't be collected; all that was said is in $folder/base.log"; }
  mv "$folder/new.tar" "$folder/base.tar"
}

# image_version: that of the packages, unless PRISMESH_IMAGE_VERSION names another: updates only go forward.
image_version() { echo "${PRISMESH_IMAGE_VERSION:-$(dpkg-parsechangelog -S Version)}"; }

# build_image: build/image/prismesh.img, a disk that boots by UEFI straight to the kiosk, and build/image/prismesh-VERSION.raucb, an update to it.
# PRISMESH_KEYS names the folder of the keys that sign; without it there are some in build/image/keys.
build_image() {
  [ "$(id -u)" -eq 0 ] || give_up "an image is made as root: its files belong to users of their own"
  mkdir -p build/image
  build_base build/image
  say "Making the image"
  SOURCE_DATE_EPOCH=$image_time scripts/image/make.sh build/image/base.tar build/packages "$(image_version)" "${PRISMESH_KEYS:-build/image/keys}" build/image
  ls -sh1 build/image/prismesh.img build/image/*.raucb
}

# test_image: boots the image in an emulated machine, and works with it. What can't run has failed; the other parts run all the same.
test_image() {
  local failed=0
  say "Booting the image"
  configure_and_build release -DPRISMESH_TESTS=ON -- vm_devices vm_usb_device
  SOURCE_DATE_EPOCH=$image_time python3 tests/image/image_test.py build/image build/packages || failed=1
  python3 tests/vm/run.py build/image/prismesh.img --programs build/bin --out out/vm || failed=1
  python3 tests/vm/usb.py build/image/prismesh.img --programs build/bin --out out/vm || failed=1
  SOURCE_DATE_EPOCH=$image_time python3 tests/vm/update.py build/image --out out/vm || failed=1
  [ $failed -eq 0 ] || give_up "the image has failed; what is wrong is above, in the lines that begin with FAILED"
}
